/// run.json: what ran and what it counted.
#pragma once

#include <string>
#include <string_view>

#include "run/emulator/assembly.hpp"

namespace skyloop {

/// What a summary is of: a run that begins, so that one that is killed can still be repeated, or one that has ended, as
/// it was to or, stopped from outside, before.
enum class SummaryOf { beginning, end, cut_end };

/// The text of run.json: version, seed, digest, start, counts, bytes and the lateness histogram.
std::string run_summary(const Scenario& scenario, const Assembly& assembly, std::string_view version,
                        SummaryOf what = SummaryOf::end);

}  // namespace skyloop
