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
// Of the airborne models on M8 and before.
constexpr double old_airborne_altitude = 50'000;
// The export limit of all receivers.
constexpr double fastest_mps = 500;

}  // namespace

bool within_dynamic_model(std::uint64_t number, const Fix& fix, int generation) {
    const bool airborne = number >= 6 && number <= 8;
    const Limits limits = model_limits[number < model_limits.size() ? number : 0];
    const double altitude = above_sea_level(fix.position.height, fix.geoid_undulation).above_sea_level.value();
    const double highest = airborne && generation <= 8 ? old_airborne_altitude : limits.altitude;
    if (fix.speed.value() > fastest_mps || altitude > highest) return false;
    if (!limits.speeds) return true;
    return fix.speed.value() <= limits.horizontal && std::abs(fix.velocity.down) <= limits.vertical;
}

}  // namespace skyloop::firmware
