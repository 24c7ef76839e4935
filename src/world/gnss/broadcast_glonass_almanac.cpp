// GLONASS' almanacs: an orbit followed to its nodes, and the strings that tell them.
#include <cmath>
#include <numbers>

#include "detail/broadcast_fields.hpp"
#include "detail/glonass_strings.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::inline world {
namespace {

constexpr double mean_inclination = 63 * std::numbers::pi / 180, mean_period_s = 43200;
constexpr int satellites_of_a_frame = 5, satellites_of_all = 24;

// Where and when an orbit crosses the equator northwards.
struct AscendingNode {
    GpsTime time;
    double longitude = 0;
    GlonassEphemeris there;  // the orbit at its last whole minute before
};

// The next one after the record's reference time, minute by minute; nothing within 16 hours.
std::optional<AscendingNode> next_node(const GlonassEphemeris& record) {
    constexpr int longest_min = 960, earliest_min = 30;  // that a node at the start is not found again
    constexpr double minute_s = 60;
    GlonassEphemeris before = record;
    for (int minute = 1; minute <= longest_min; ++minute) {
        const auto now = std::get<GlonassEphemeris>(carried_to(before, before.toe + std::chrono::minutes(1)));
        const double z = before.position_m[2], rate = before.velocity_mps[2];
        if (minute > earliest_min && z < 0 && now.position_m[2] >= 0 && rate > 0) {
            // Straight on in the minute: the rate changes by 1e-5 of itself.
            const double passed = std::min(z / (z - now.position_m[2]), 1.0) * minute_s;
            const SatelliteState state = satellite_state(before, before.toe, Seconds(passed));
            const Eigen::Vector3d p = state.position.vector();
            return AscendingNode{before.toe + to_nanoseconds(Seconds(passed)), std::atan2(p.y(), p.x()), before};
        }
        before = now;
    }
    return std::nullopt;
}

// Eccentricity, perigee and inclination of the ellipse at a node.
void take_shape(const AscendingNode& node, GlonassAlmanac& almanac) {
    const SatelliteState state = satellite_state(node.there, node.time);
    const Eigen::Vector3d r = state.position.vector(), spin(0, 0, earth_rotation_rate_glonass);
    const Eigen::Vector3d v = state.velocity.vector() + spin.cross(r), h = r.cross(v);
    const Eigen::Vector3d shape = v.cross(h) / gravitational_constant_glonass - r.normalized();
    const Eigen::Vector3d to_node = r.normalized(), across = h.normalized().cross(to_node);
    almanac.eccentricity = shape.norm();
    almanac.perigee = std::atan2(shape.dot(across), shape.dot(to_node));
    almanac.inclination = std::atan2(std::hypot(h.x(), h.y()), h.z());
}

}  // namespace

std::optional<GlonassAlmanac> glonass_almanac(const GlonassEphemeris& record, GpsTime day,
                                              const LeapSeconds& leap_seconds) {
    GlonassEphemeris free = record;
    free.acceleration_mps2 = {};  // of half an hour, not of half a day
    const auto first = next_node(free);
    const auto second = first ? next_node(first->there) : std::nullopt;
    if (!second) return std::nullopt;
    GlonassAlmanac almanac{record.satellite, record.frequency_channel, record.healthy(), -record.clock_bias};
    take_shape(*first, almanac);
    almanac.draconic_period = difference(second->time, first->time).value();
    const double turn = std::remainder(second->longitude - first->longitude, 2 * std::numbers::pi);
    const std::int64_t now = glonass_seconds(day, leap_seconds);
    const GpsTime begin = std::chrono::floor<std::chrono::seconds>(day) - std::chrono::seconds(now % seconds_per_day);
    const double since = difference(first->time, begin).value();
    const double orbits = std::ceil(-since / almanac.draconic_period);
    almanac.node_time = since + orbits * almanac.draconic_period;
    almanac.node_longitude = std::remainder(first->longitude + orbits * turn, 2 * std::numbers::pi);
    return almanac;
}

namespace {

void put_even_string(BitWriter& bits, const GlonassAlmanac& a) {
    constexpr std::uint64_t glonass_m = 1;
    constexpr double semicircle = std::numbers::pi;
    bits.put(a.healthy ? 1 : 0, 1);
    bits.put(glonass_m, 2);
    bits.put_signed(a.satellite.number, 5);
    put_sign_magnitude(bits, a.time_correction, 10, power_of_two(-18));
    put_sign_magnitude(bits, a.node_longitude, 21, semicircle * power_of_two(-20));
    put_sign_magnitude(bits, a.inclination - mean_inclination, 18, semicircle * power_of_two(-20));
    put_scaled_unsigned(bits, a.eccentricity, 15, power_of_two(-20));
}

void put_odd_string(BitWriter& bits, const GlonassAlmanac& a) {
    constexpr int channels = 32;  // negative ones count down from it (table 4.11)
    put_sign_magnitude(bits, a.perigee, 16, std::numbers::pi * power_of_two(-15));
    put_scaled_unsigned(bits, a.node_time, 21, power_of_two(-5));
    put_sign_magnitude(bits, a.draconic_period - mean_period_s, 22, power_of_two(-9));
    bits.put(0, 7);  // its rate: that of the orbit's decay
    bits.put_signed((a.frequency_channel + channels) % channels, 5);
}

}  // namespace

const std::optional<GlonassAlmanac>& GlonassAlmanacStrings::of(const GlonassEphemeris& record, GpsTime day,
                                                               const LeapSeconds& leap_seconds) {
    Known& known = known_[record.satellite];
    if (known.toe != record.toe || known.day != day)
        known = {record.toe, day, glonass_almanac(record, day, leap_seconds)};
    return known.almanac;
}

GlonassWords GlonassAlmanacStrings::at(const NavigationSource& source, const GlonassEphemeris& sender, int string,
                                       GpsTime end, const LeapSeconds& leap_seconds) {
    constexpr int first_string = 6, content_bits = 72;
    constexpr std::chrono::seconds string_length{2};
    const std::int64_t sent = glonass_seconds(end - string_length, leap_seconds);
    const GpsTime day =
        std::chrono::floor<std::chrono::seconds>(end - string_length) - std::chrono::seconds(sent % seconds_per_day);
    const int number = (glonass_frame(sent) - 1) * satellites_of_a_frame + (string - first_string) / 2 + 1;
    BitWriter content;
    if (number <= satellites_of_all) {
        const auto found = source.ephemeris({Constellation::glonass, number}, end);
        const auto* record = found ? std::get_if<GlonassEphemeris>(&*found) : nullptr;
        const std::optional<GlonassAlmanac> told = record == nullptr ? std::nullopt : of(*record, day, leap_seconds);
        if (told && string % 2 == 0) put_even_string(content, *told);
        if (told && string % 2 != 0) put_odd_string(content, *told);
    }
    content.put(0, content_bits - static_cast<int>(content.size()));
    BitWriter whole;
    whole.put(content.field(0, 64), 64);
    whole.put(content.field(64, 7), 7);
    whole.put(string % 2 == 0 ? content.field(71, 1) : (sender.healthy() ? 0 : 1), 1);
    return whole_glonass_string(string, whole, end, leap_seconds);
}

}  // namespace skyloop::inline world
