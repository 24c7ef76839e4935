/// run.json: what ran and what it counted.
#pragma once

#include <string>
#include <string_view>

#include "skyloop/emulator/assembly.hpp"

namespace skyloop {

/// The text of run.json: version, seed, digest, start, counts, bytes and the lateness histogram.
std::string run_summary(const Scenario& scenario, const Assembly& assembly, std::string_view version);

}  // namespace skyloop
