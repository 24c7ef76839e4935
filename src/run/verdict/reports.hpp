/// Verdicts for people, programs and build servers.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "run/verdict/verdict.hpp"

namespace skyloop::inline run {

/// The run that the verdicts are about.
struct ReportedRun {
    std::string scenario;  ///< its name or file
    std::uint64_t seed = 1;
    GpsTime start;
    Seconds length{0};                    ///< of the run, GPS time
    std::vector<std::string> evidence{};  ///< names of the files that show it: "port0.out"
};

/// A line per verdict and one that counts them: `FAILED  client reconfigures …: client sent nothing (at 12.000 s)`.
/// Control characters of names and evidence are written as JSON writes them.
std::string verdict_text(std::span<const Verdict> verdicts, const ReportedRun& run);

/// A JSON object: scenario, seed, start_utc, length_s, met (true, false, or null: all_met() says nothing), evidence,
/// verdicts (name, expected, outcome, evidence, run_time_s; decided_at_utc and decided_at_gps_ns where it was decided
/// before the end).
std::string verdict_json(std::span<const Verdict> verdicts, const ReportedRun& run);

/// A JUnit document (the form that Jenkins, GitLab and GitHub actions read): one suite, a case per verdict. `failed` is
/// a failure, `undecided` an error, `not run` is skipped. Times are seconds of the run. Characters that XML 1.0 does
/// not have become U+FFFD.
std::string junit_xml(std::span<const Verdict> verdicts, const ReportedRun& run);

}  // namespace skyloop::inline run
