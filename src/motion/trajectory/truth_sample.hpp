/// What a simulator, or any other live source, says of its vehicle.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "base/core/units.hpp"
#include "world/flow/truth_state.hpp"

namespace skyloop {

/// One statement of a live source, in our frames and units, whatever its own are. Every adapter gives these and nothing
/// else (FEEDS.md 0).
struct TruthSample {
    std::string vehicle = "0";                 ///< which one of the source's
    std::optional<Nanoseconds> source_time{};  ///< on the source's own clock; nothing: it tells none
    std::int64_t received_ns = 0;              ///< when it came, on our steady clock (steady_clock_ns())
    Position<Ecef> position;
    std::optional<Velocity<Ecef>> velocity{};       ///< over ground
    std::optional<Eigen::Vector3d> acceleration{};  ///< of the motion, gravity not in it; ECEF axes, m/s²
    std::optional<Attitude> attitude{};
    std::optional<Eigen::Vector3d> turn_rate{};  ///< body axes, rad/s
    bool jump = false;  ///< the source says that it begins anew here: no way leads from the sample before to this one
};

}  // namespace skyloop
