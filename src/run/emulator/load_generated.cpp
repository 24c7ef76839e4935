#include <fmt/format.h>

#include <cmath>

#include "run/emulator/load_track.hpp"

namespace skyloop {

Result<LoadedTrack> load_generated(GeneratedSettings& path, std::uint64_t run_seed) {
    auto plan = plan_generated(path.path, run_seed);
    if (!plan) return fail(ErrorCode::input, "trajectory: " + plan.error());
    path.shape = plan->shape;
    LoadedTrack loaded;
    const double seconds = plan->shape->duration();
    loaded.description = plan->summary.empty() ? std::string("generated path") : plan->summary;
    loaded.description += std::isfinite(seconds) ? fmt::format(", {:.1f} s", seconds) : ", without an end";
    for (const std::string& note : plan->notes)
        loaded.warnings.push_back("trajectory: " + note);
    return loaded;
}

}  // namespace skyloop
