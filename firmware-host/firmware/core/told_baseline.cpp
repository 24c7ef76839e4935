#include "firmware/core/told_baseline.hpp"

#include <numbers>

#include "base/geo/local_frame.hpp"

namespace skyloop::firmware {
namespace {

CorrectionState solution_of(FixType type) {
    switch (type) {
        case FixType::rtk_fixed:
            return CorrectionState::rtk_fixed;
        case FixType::rtk_float:
            return CorrectionState::rtk_float;
        default:
            return CorrectionState::differential;
    }
}

}  // namespace

std::optional<ToldBaseline> told_baseline(const NavigationState& state) {
    const Fix& fix = state.epoch.fix;
    if (!fix.has_position()) return std::nullopt;
    if (const auto& vector = state.epoch.relative)
        return ToldBaseline{*vector, vector->fixed ? CorrectionState::rtk_fixed : CorrectionState::rtk_float};
    const CorrectionStatus& corrections = state.corrections;
    if (corrections.state == CorrectionState::none || !corrections.base) return std::nullopt;
    const LocalFrame base(to_geodetic(*corrections.base));
    const Eigen::Vector3d to_rover = base.to_enu(to_ecef(fix.position)).vector();
    const CorrectionState solution = solution_of(fix.type);
    return ToldBaseline{{.north_m = to_rover.y(),
                         .east_m = to_rover.x(),
                         .down_m = -to_rover.z(),
                         .deviation = fix.horizontal_accuracy / std::numbers::sqrt2,
                         .base_moves = false,
                         .fixed = solution == CorrectionState::rtk_fixed,
                         .base_station = corrections.station.value_or(0),
                         .down_deviation = fix.vertical_accuracy,
                         .age = corrections.age.value_or(Seconds(0))},
                        solution};
}

}  // namespace skyloop::firmware
