#include "world/gnss/nominal_sky.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/time/utc_time.hpp"
#include "detail/nominal_slots.hpp"
#include "detail/secular_motion.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline world {
namespace {

constexpr std::int64_t sky_epoch_week = 2243;  // 2023-01-01T00:00:00
constexpr double geosynchronous_axis_m = 42164.2e3;

constexpr double sky_radians(double degrees) { return degrees * (std::numbers::pi / 180); }

// How the satellites of a system fly, and what their records are like.
struct OrbitKind {
    double axis_m = geosynchronous_axis_m;
    double turns = 1;  // revolutions while the Earth turns once below the nodes
    double gravity = gravitational_constant_gps;
    double earth_rate = earth_rotation_rate;
    NavigationMessage message = NavigationMessage::lnav;
    std::int64_t record_s = 7200;
    double fit_interval_h = 0;
    double accuracy_m = 2;
    Nanoseconds week_lag{0};
};

OrbitKind galileo_orbit() {
    constexpr double sisa_m = 3.12;
    return {
        29599.8e3, 1.7,           gravitational_constant_galileo, earth_rotation_rate, NavigationMessage::inav, 1800, 0,
        sisa_m,    Nanoseconds(0)};
}

OrbitKind beidou_orbit(bool inclined_geosynchronous) {
    OrbitKind kind{
        27906.1e3, 13.0 / 7, gravitational_constant_beidou, earth_rotation_rate_beidou, NavigationMessage::d1, 3600, 0,
        2,         bdt_lag};
    if (inclined_geosynchronous) {
        kind.axis_m = geosynchronous_axis_m;
        kind.turns = 1;
    }
    return kind;
}

OrbitKind glonass_orbit() {
    return {25510e3,
            17.0 / 8,
            gravitational_constant_glonass,
            earth_rotation_rate_glonass,
            NavigationMessage::fdma,
            1800,
            0,
            2,
            Nanoseconds(0)};
}

// C06 … C10, C13, C16, C31, C38 … C40 (BDS-SIS-ICD-B1I 3.0, table 4-1 and Open Service Performance Standard 3.0).
bool is_beidou_inclined_geosynchronous(int number) {
    return (number >= 6 && number <= 10) || number == 13 || number == 16 || number == 31 ||
           (number >= 38 && number <= 40);
}

OrbitKind kind_of(SatelliteId satellite) {
    using enum Constellation;
    switch (satellite.constellation) {
        case galileo:
            return galileo_orbit();
        case beidou:
            return beidou_orbit(is_beidou_inclined_geosynchronous(satellite.number) || is_beidou_geo(satellite));
        case glonass:
            return glonass_orbit();
        default:
            return {};
    }
}

// Regression of the nodes by the Earth's oblateness, rad/s (Montenbruck and Gill 2000, equation 2.118, e = 0).
double node_rate(double axis_m, double inclination, double gravity) {
    const double motion = std::sqrt(gravity / (axis_m * axis_m * axis_m));
    const double radii = equatorial_radius_glonass / axis_m;
    return -1.5 * motion * second_zonal_harmonic_glonass * radii * radii * std::cos(inclination);
}

// Which record serves, counted from the epoch.
std::int64_t record_count(GpsTime time, std::int64_t record_s) {
    const GpsTime epoch = to_gps_time({sky_epoch_week, Nanoseconds(0)});
    return floor_divide(std::chrono::floor<std::chrono::seconds>(time - epoch).count(), record_s);
}

// All but the orbit.
KeplerEphemeris record_of(SatelliteId satellite, const OrbitKind& kind, std::int64_t count) {
    KeplerEphemeris r;
    r.satellite = satellite;
    r.message = is_beidou_geo(satellite) ? NavigationMessage::d2 : kind.message;
    r.toe = r.toc = to_gps_time({sky_epoch_week, Nanoseconds(0)}) + std::chrono::seconds(count * kind.record_s);
    r.sqrt_a = std::sqrt(kind.axis_m);
    r.accuracy_m = kind.accuracy_m;
    r.fit_interval_h = kind.fit_interval_h;
    constexpr std::int64_t issues = 128;  // Galileo has more, BeiDou's age of data fewer
    const bool beidou = satellite.constellation == Constellation::beidou;
    r.iode = r.iodc = beidou ? 1 : static_cast<int>(count - floor_divide(count, issues) * issues);
    return r;
}

// The user algorithm squares sqrt_a again; the rate must be the one that it will find.
void fly_at(KeplerEphemeris& r, const OrbitKind& kind, double rate) {
    const double a = r.sqrt_a * r.sqrt_a;
    r.delta_n = rate - std::sqrt(kind.gravity / (a * a * a));
}

double turned_since_week(const KeplerEphemeris& r, const OrbitKind& kind) {
    return kind.earth_rate * week_and_tow(r.toe - kind.week_lag).tow_seconds();
}

KeplerEphemeris inclined_record(const InclinedSlot& slot, GpsTime time) {
    const OrbitKind kind = kind_of(slot.satellite);
    const std::int64_t count = record_count(time, kind.record_s);
    const auto record_s = static_cast<double>(kind.record_s);
    KeplerEphemeris r = record_of(slot.satellite, kind, count);
    r.i0 = sky_radians(slot.inclination_deg);
    r.omega_dot = node_rate(kind.axis_m, r.i0, kind.gravity);
    const double rate = kind.turns * (kind.earth_rate - r.omega_dot);
    fly_at(r, kind, rate);
    r.e = slot.eccentricity;
    r.omega = sky_radians(slot.perigee_deg);
    r.m0 = reduced_angle(sky_radians(slot.argument_deg - slot.perigee_deg), rate * record_s, count);
    const double node = reduced_angle(sky_radians(slot.node_deg), (r.omega_dot - kind.earth_rate) * record_s, count);
    r.omega0 = std::remainder(node + turned_since_week(r, kind), 2 * std::numbers::pi);
    return r;
}

// Of BeiDou in a frame that is tilted by 5°, in which the equator is a plane of 5° with its node at 180°
// (BDS-SIS-ICD-B1I 3.0, table 5-11).
KeplerEphemeris geostationary_record(const GeostationarySlot& slot, GpsTime time) {
    const OrbitKind kind = kind_of(slot.satellite);
    KeplerEphemeris r = record_of(slot.satellite, kind, record_count(time, kind.record_s));
    fly_at(r, kind, kind.earth_rate);
    const double longitude = sky_radians(slot.longitude_deg);
    const bool tilted = is_beidou_geo(slot.satellite);
    r.i0 = tilted ? sky_radians(5) : 0;
    r.m0 = tilted ? std::remainder(longitude - std::numbers::pi, 2 * std::numbers::pi) : 0;
    r.omega0 =
        std::remainder((tilted ? std::numbers::pi : longitude) + turned_since_week(r, kind), 2 * std::numbers::pi);
    return r;
}

SbasEphemeris sbas_record(const GeostationarySlot& slot, GpsTime time) {
    constexpr std::int64_t record_s = 120;
    const std::int64_t count = record_count(time, record_s);
    SbasEphemeris r;
    r.satellite = slot.satellite;
    r.toe = to_gps_time({sky_epoch_week, Nanoseconds(0)}) + std::chrono::seconds(count * record_s);
    const double longitude = sky_radians(slot.longitude_deg);
    r.position_m = {geosynchronous_axis_m * std::cos(longitude), geosynchronous_axis_m * std::sin(longitude), 0};
    r.iode = static_cast<int>(count - floor_divide(count, 256) * 256);
    r.accuracy_m = 2;
    return r;
}

// A GLONASS satellite by secular motion and the periodic terms of the Earth's oblateness (Hoots and Roehrich 1980,
// Spacetrack Report 3, section 6, for e = 0), which its records are integrated with.
class GlonassMotion {
public:
    explicit GlonassMotion(const InclinedSlot& slot)
        : inclination_(sky_radians(slot.inclination_deg)),
          node_(sky_radians(slot.node_deg)),
          argument_(sky_radians(slot.argument_deg)) {
        const OrbitKind kind = glonass_orbit();
        const double node_rate_inertial = node_rate(kind.axis_m, inclination_, kind.gravity);
        node_rate_ = node_rate_inertial - kind.earth_rate;
        argument_rate_ = -kind.turns * node_rate_;
        const double sine = std::sin(inclination_), cosine = std::cos(inclination_);
        // The radius at which gravity holds a satellite that turns so fast.
        const double turn_rate = argument_rate_ + node_rate_inertial * cosine;
        radius_m_ = kind.axis_m;
        for (int i = 0; i < 5; ++i) {
            const double radii = equatorial_radius_glonass / radius_m_;
            const double oblate = 1.5 * second_zonal_harmonic_glonass * radii * radii * (1 - 1.5 * sine * sine);
            radius_m_ = std::cbrt(kind.gravity * (1 + oblate) / (turn_rate * turn_rate));
        }
        flattening_ = 0.5 * second_zonal_harmonic_glonass * std::pow(equatorial_radius_glonass / radius_m_, 2);
    }

    // @param whole records since the epoch of the sky  @param seconds since that one
    [[nodiscard]] Eigen::Vector3d position(std::int64_t records, double record_s, double seconds) const {
        const double u = reduced_angle(argument_, argument_rate_ * record_s, records) + argument_rate_ * seconds;
        const double node = reduced_angle(node_, node_rate_ * record_s, records) + node_rate_ * seconds;
        const double cosine = std::cos(inclination_), sine = std::sin(inclination_);
        const double s2 = std::sin(2 * u), c2 = std::cos(2 * u);
        const double r = radius_m_ * (1 + 0.5 * flattening_ * sine * sine * c2);
        const double along = u - 0.25 * flattening_ * (7 * cosine * cosine - 1) * s2;
        const double longitude = node + 1.5 * flattening_ * cosine * s2;
        const double tilt = inclination_ + 1.5 * flattening_ * cosine * sine * c2;
        const double x = r * std::cos(along), y = r * std::sin(along);
        return {x * std::cos(longitude) - y * std::cos(tilt) * std::sin(longitude),
                x * std::sin(longitude) + y * std::cos(tilt) * std::cos(longitude), y * std::sin(tilt)};
    }

private:
    double inclination_, node_, argument_;
    double node_rate_ = 0, argument_rate_ = 0, radius_m_ = 0, flattening_ = 0;
};

// Times of reference lie in the middle of half hours of UTC (ICD L1, L2 GLONASS 5.1, table 4.6).
GlonassEphemeris glonass_record(const InclinedSlot& slot, GpsTime time) {
    constexpr std::int64_t record_s = 1800, quarter_s = 900, ahead_s = 3 * 3600;
    const std::int64_t leap = LeapSeconds::announced().offset(time);
    const std::int64_t count = record_count(time - std::chrono::seconds(leap), record_s);
    const GlonassMotion motion(slot);
    const auto at = [&](double seconds) {
        return motion.position(count, record_s, static_cast<double>(quarter_s + leap) + seconds);
    };
    GlonassEphemeris r;
    r.satellite = slot.satellite;
    r.toe = to_gps_time({sky_epoch_week, Nanoseconds(0)}) + std::chrono::seconds(count * record_s + quarter_s + leap);
    const Eigen::Vector3d place = at(0), velocity = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / 12;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        r.position_m[axis] = place[static_cast<Eigen::Index>(axis)];
        r.velocity_mps[axis] = velocity[static_cast<Eigen::Index>(axis)];
    }
    r.frequency_channel = slot.channel;
    const std::int64_t of_epoch_day = count * record_s + quarter_s + ahead_s;
    r.iode =
        static_cast<int>((of_epoch_day - floor_divide(of_epoch_day, seconds_per_day) * seconds_per_day) / quarter_s);
    r.accuracy_m = 2.5;
    return r;
}

template <class Slot>
const Slot* find_slot(std::span<const Slot> slots, SatelliteId satellite) {
    const auto found =
        std::find_if(slots.begin(), slots.end(), [&](const Slot& s) { return s.satellite == satellite; });
    return found == slots.end() ? nullptr : &*found;
}

}  // namespace

NominalSky::NominalSky(const std::vector<Constellation>& systems) {
    const auto wanted = [&](SatelliteId id) { return std::ranges::find(systems, id.constellation) != systems.end(); };
    std::vector<SatelliteId> all = gps_.satellites();
    for (const InclinedSlot& slot : inclined_slots())
        all.push_back(slot.satellite);
    for (const GeostationarySlot& slot : geostationary_slots())
        all.push_back(slot.satellite);
    std::copy_if(all.begin(), all.end(), std::back_inserter(satellites_), wanted);
    std::sort(satellites_.begin(), satellites_.end());
    std::vector<std::string_view> titles;
    for (std::size_t i = 0; i < constellation_names.size(); ++i)
        if (const auto system = static_cast<Constellation>(i); std::ranges::find(systems, system) != systems.end())
            titles.push_back(constellation_title(system));
    description_ = fmt::format("nominal {} constellation{}", fmt::join(titles, ", "), titles.size() > 1 ? "s" : "");
}

std::optional<Ephemeris> NominalSky::ephemeris(SatelliteId satellite, GpsTime time) const {
    if (!std::ranges::binary_search(satellites_, satellite)) return std::nullopt;
    if (satellite.constellation == Constellation::gps) return gps_.ephemeris(satellite, time);
    if (const auto* slot = find_slot(inclined_slots(), satellite)) {
        if (satellite.constellation == Constellation::glonass) return glonass_record(*slot, time);
        return inclined_record(*slot, time);
    }
    const auto* slot = find_slot(geostationary_slots(), satellite);
    if (slot == nullptr) return std::nullopt;
    if (satellite.constellation == Constellation::sbas) return sbas_record(*slot, time);
    return geostationary_record(*slot, time);
}

}  // namespace skyloop::inline world
