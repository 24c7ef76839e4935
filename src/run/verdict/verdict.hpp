/// Whether a run did what was expected of it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline run {

/// How a run ends: by itself or because it was asked to, or stopped from outside before the end that it was to have.
enum class RunEnd { over, cut };

/// How an expectation came out.
enum class Outcome {
    passed,
    failed,
    undecided,  ///< the run ended too soon to tell, or showed no evidence
    not_run     ///< a probe in virtual time
};
/// As reports have them: "passed", "failed", "undecided", "not run".
std::string_view outcome_name(Outcome outcome);

/// What became of one expectation.
struct Verdict {
    std::string name;      ///< of the expectation
    std::string expected;  ///< the sentence as it was understood, or the probe
    Outcome outcome = Outcome::undecided;
    std::string evidence;               ///< a sentence: "no fix came true 1.2 s after outage began"
    std::optional<GpsTime> decided_at;  ///< nothing: only known once the run was over
    Seconds run_time{0};                ///< of `decided_at`, or of the end, since the start of the run
};

/// Whether the run did all that was expected: not where something failed or is undecided; nothing where the rest
/// passed, but something was not run.
std::optional<bool> all_met(std::span<const Verdict> verdicts);
/// Whether the run may be called a success: nothing failed, nothing is undecided, and where something was expected at
/// least one passed. A run that judged nothing has shown nothing.
bool is_success(std::span<const Verdict> verdicts);

}  // namespace skyloop::inline run
