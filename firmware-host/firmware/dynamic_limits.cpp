#include <array>
#include <cmath>

#include "firmware/state_tracker.hpp"

namespace skyloop::firmware {
namespace {

// Most altitude above sea level, m; most speed over ground and vertical, m/s; whether speeds are looked at.
struct Limits {
    double altitude, horizontal, vertical;
    bool speeds;
};

constexpr std::array<Limits, 10> model_limits{{{12'000, 310, 50, true},
                                               {12'000, 310, 50, true},
                                               {9'000, 10, 6, true},
                                               {9'000, 30, 20, true},
                                               {6'000, 100, 15, true},
                                               {500, 25, 5, true},
                                               {80'000, 100, 6'400, false},
                                               {80'000, 250, 10'000, false},
                                               {80'000, 500, 20'000, false},
                                               {9'000, 30, 20, true}}};
// The export limit of all receivers: "velocity 500 m/s" of their data sheets, whose direction they leave open.
constexpr double fastest_mps = 500;

double speed_in_space(const Fix& fix) { return std::hypot(fix.speed.value(), fix.velocity.down); }

double altitude_of(const Fix& fix) {
    return above_sea_level(fix.position.height, fix.geoid_undulation).above_sea_level.value();
}

}  // namespace

bool within_dynamic_model(std::uint64_t number, const Fix& fix, int generation) {
    const bool airborne = number >= 6 && number <= 8;
    const Limits limits = model_limits[number < model_limits.size() ? number : 0];
    const double altitude = altitude_of(fix);
    const double highest = airborne ? airborne_ceiling(generation).value() : limits.altitude;
    if (speed_in_space(fix) > fastest_mps || altitude > highest) return false;
    if (!limits.speeds) return true;
    return fix.speed.value() <= limits.horizontal && std::abs(fix.velocity.down) <= limits.vertical;
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
