#include "world/gnss/nominal_constellation.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

// Right ascensions of the ascending nodes of planes A … F at the epoch, degrees (SPS PS 2008, table 3.2-1).
constexpr std::array<double, 6> nominal_nodes_deg{272.847, 332.847, 32.847, 92.847, 152.847, 212.847};
// Greenwich hour angle at the epoch: 18 h 36 min 14.4 s (the same table).
constexpr double greenwich_hour_angle_deg = 279.06;
// 1993-07-01T00:00:00, as week and second of week; the table says 0000Z, and the 9 leap seconds of then move a
// satellite by 0.08°, far less than a slot's tolerance.
constexpr std::int64_t nominal_epoch_week = 703;
constexpr std::int64_t nominal_epoch_tow_s = 4 * seconds_per_day;
constexpr double nominal_semi_major_axis_m = 26559.7e3;
constexpr double nominal_inclination_deg = 55;
// Regression of the nodes by the Earth's oblateness, degrees per second (SPS PS 2001, table A-2-1).
constexpr double nominal_node_rate_deg_s = -4.4874e-7;
constexpr std::int64_t nominal_record_s = 7200;

constexpr std::array<NominalSlot, 31> nominal_slots{{
    {"A1", 268.126},  {"A2", 161.786}, {"A3", 11.676},  {"A4", 41.806},  {"A5", 101.796},  {"B1F", 94.916},
    {"B1A", 66.356},  {"B2", 173.336}, {"B3", 309.976}, {"B4", 204.376}, {"B5", 8.166},    {"C1", 111.876},
    {"C2", 11.796},   {"C3", 339.666}, {"C4", 241.556}, {"C5", 176.716}, {"D1", 135.226},  {"D2F", 282.676},
    {"D2A", 257.976}, {"D3", 35.156},  {"D4", 167.356}, {"E1", 197.046}, {"E2", 302.596},  {"E3", 66.066},
    {"E4", 333.686},  {"E5", 131.556}, {"F1", 238.886}, {"F2F", 0.456},  {"F2A", 334.016}, {"F3", 105.206},
    {"F4", 135.346},
}};

constexpr double nominal_radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }

// start + rate·count reduced to ±π. The product is kept whole by its rounding error, so that neighbouring counts differ
// by exactly one step even after decades.
double reduced_angle(double start, double rate, std::int64_t count) {
    const auto times = static_cast<double>(count);
    const double product = rate * times;
    const double rounding = std::fma(rate, times, -product);
    constexpr double turn = 2 * std::numbers::pi;
    return std::remainder(std::remainder(product, turn) + rounding + start, turn);
}

std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

}  // namespace

std::span<const NominalSlot> NominalConstellation::slots() { return nominal_slots; }

std::vector<SatelliteId> NominalConstellation::satellites() const {
    std::vector<SatelliteId> all;
    for (int number = 1; number <= static_cast<int>(nominal_slots.size()); ++number)
        all.push_back({Constellation::gps, number});
    return all;
}

std::optional<Ephemeris> NominalConstellation::ephemeris(SatelliteId satellite, GpsTime time) const {
    if (auto found = record(satellite, time)) return *found;
    return std::nullopt;
}

std::optional<KeplerEphemeris> NominalConstellation::record(SatelliteId satellite, GpsTime time) const {
    if (satellite.constellation != Constellation::gps || satellite.number < 1 ||
        satellite.number > static_cast<int>(nominal_slots.size()))
        return std::nullopt;
    const NominalSlot& slot = nominal_slots[static_cast<std::size_t>(satellite.number - 1)];
    const double node = nominal_radians(nominal_nodes_deg[static_cast<std::size_t>(slot.name[0] - 'A')]);

    const GpsTime epoch = to_gps_time({nominal_epoch_week, std::chrono::seconds(nominal_epoch_tow_s)});
    const auto elapsed = std::chrono::floor<std::chrono::seconds>(time - epoch).count();
    const std::int64_t count = floor_divide(elapsed, nominal_record_s);

    KeplerEphemeris r;
    r.satellite = satellite;
    r.toe = epoch + std::chrono::seconds(count * nominal_record_s);
    r.toc = r.toe;
    r.sqrt_a = std::sqrt(nominal_semi_major_axis_m);
    r.i0 = nominal_radians(nominal_inclination_deg);
    r.omega_dot = nominal_radians(nominal_node_rate_deg_s);
    // The user algorithm squares sqrt_a again; the mean motion must be the one that it will find.
    const double a = r.sqrt_a * r.sqrt_a;
    const double motion = std::sqrt(gravitational_constant_gps / (a * a * a));
    r.m0 = reduced_angle(nominal_radians(slot.argument_of_latitude_deg), motion * static_cast<double>(nominal_record_s),
                         count);
    // omega0 counts from the start of the week of toe: the Earth's rotation since then is the algorithm's, whole weeks
    // are taken out here.
    const std::int64_t weeks = week_and_tow(r.toe).week - nominal_epoch_week;
    const double node_at_epoch = node - nominal_radians(greenwich_hour_angle_deg) +
                                 earth_rotation_rate * static_cast<double>(nominal_epoch_tow_s);
    r.omega0 = reduced_angle(node_at_epoch + r.omega_dot * static_cast<double>(count * nominal_record_s),
                             -earth_rotation_rate * static_cast<double>(seconds_per_week), weeks);
    r.accuracy_m = 2;
    r.fit_interval_h = 4;
    r.iode = static_cast<int>(((count % 256) + 256) % 256);
    r.iodc = r.iode;
    return r;
}

}  // namespace skyloop
