#include <cmath>

#include "firmware/state_tracker.hpp"

namespace skyloop::firmware {
namespace {

// The export limit of all receivers: "velocity 500 m/s" of their data sheets, whose direction they leave open.
constexpr double fastest_mps = 500;

double speed_in_space(const Fix& fix) { return std::hypot(fix.speed.value(), fix.velocity.down); }

double altitude_of(const Fix& fix) {
    return above_sea_level(fix.position.height, fix.geoid_undulation).above_sea_level.value();
}

}  // namespace

bool within_dynamic_model(std::uint64_t number, const Fix& fix, int generation) {
    const MotionLimits limits = motion_limits(dynamic_model_of(number), airborne_ceiling(generation));
    return speed_in_space(fix) <= fastest_mps && altitude_of(fix) <= limits.height.value() &&
           fix.speed <= limits.horizontal_speed && std::abs(fix.velocity.down) <= limits.vertical_speed.value();
}

Metres airborne_ceiling(int generation) {
    constexpr Metres up_to_m8(50'000), since_m9(80'000);
    return generation <= 8 ? up_to_m8 : since_m9;
}

bool within_export_limits(ExportLimits limits, const Fix& fix) {
    constexpr double highest_m = 18'288, fastest_of_export_mps = 515;
    const bool high = altitude_of(fix) > highest_m, fast = speed_in_space(fix) > fastest_of_export_mps;
    if (limits == ExportLimits::off) return true;
    return limits == ExportLimits::both_exceeded ? !(high && fast) : !(high || fast);
}

bool within_limits(const BoardProfile& board, std::uint64_t dynamic_model, const Fix& fix) {
    const bool moves_as_expected = board.dynamic_limits
                                       ? within_dynamic_model(dynamic_model, fix, board.identity.generation)
                                       : speed_in_space(fix) <= fastest_mps;
    return moves_as_expected && within_export_limits(board.export_limits, fix);
}

}  // namespace skyloop::firmware
