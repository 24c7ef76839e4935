// Galileo's almanacs, the reduced record of word 16 and the octets of words 17 to 20.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "detail/galileo_words.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::inline world {
namespace {

constexpr int almanac_numbers = 36, almanacs_together = 3;
constexpr std::chrono::seconds almanac_minute{60};
constexpr double almanac_time_step_s = 600, nominal_axis_m = 29'600'000;
constexpr double nominal_inclination = 56 * std::numbers::pi / 180;

// What one almanac's fields hold; as satellites send them [seen in captures], a number 0 and bits that alternate stand
// for a satellite that there is not.
struct AlmanacEntry {
    std::optional<KeplerEphemeris> record;

    void number(BitWriter& bits) const { bits.put_signed(record ? record->satellite.number : 0, 6); }
    // @param place of the field's first bit behind the number; those that are even are 0
    static void filling(BitWriter& bits, int width, int place) {
        for (int i = 0; i < width; ++i)
            bits.put_signed((place + i) % 2, 1);
    }
    void axis(BitWriter& bits) const {
        if (!record) return filling(bits, 13, 0);
        put_scaled(bits, record->sqrt_a - std::sqrt(nominal_axis_m), 13, power_of_two(-9));
    }
    void eccentricity(BitWriter& bits) const {
        if (!record) return filling(bits, 11, 13);
        put_scaled_unsigned(bits, record->e, 11, power_of_two(-16));
    }
    void perigee(BitWriter& bits) const { record ? put_circle(bits, record->omega, 16) : filling(bits, 16, 24); }
    void inclination(BitWriter& bits) const {
        if (!record) return filling(bits, 11, 40);
        put_semicircles(bits, record->i0 - nominal_inclination, 11, -14);
    }
    void node(BitWriter& bits) const { record ? put_circle(bits, record->omega0, 16) : filling(bits, 16, 51); }
    void node_rate(BitWriter& bits) const {
        if (!record) return filling(bits, 11, 67);
        put_semicircles(bits, record->omega_dot, 11, -33);
    }
    void anomaly(BitWriter& bits) const { record ? put_circle(bits, record->m0, 16) : filling(bits, 16, 78); }
    void clock(BitWriter& bits) const {
        if (!record) return filling(bits, 16 + 13, 94);
        put_scaled(bits, record->af0, 16, power_of_two(-19));
        put_scaled(bits, record->af1, 13, power_of_two(-38));
    }
    // Of a signal by the place of its two bits of health in a record (RINEX 3.05, table A8).
    void health(BitWriter& bits, int first) const {
        if (!record) return filling(bits, 2, 123);
        bits.put(static_cast<std::uint64_t>(record->health) >> first & 3, 2);
    }
};

// What a batch of almanacs has in common: 36 numbers in twelve minutes, the first from six minutes on [seen in
// captures].
struct AlmanacBatch {
    const InavData& data;
    int first = 1;           // number of the first satellite in this minute
    GpsTime reference;       // t_0a, one for all of the twelve minutes
    std::int64_t issue = 0;  // IOD_a

    AlmanacBatch(const InavData& d, GpsTime start) : data(d) {
        constexpr std::int64_t minutes = almanac_numbers / almanacs_together, offset = 6, issues = 16;
        const std::int64_t count = start.time_since_epoch() / almanac_minute + offset;
        first = static_cast<int>(count % minutes) * almanacs_together + 1;
        issue = count / minutes % issues;
        const GpsTime begin(almanac_minute * (count / minutes * minutes - offset));
        const WeekAndTow at = gst_week_and_tow(begin);
        reference = begin - at.tow % std::chrono::seconds(600);
    }
    [[nodiscard]] AlmanacEntry entry(int place) const {
        if (data.almanacs == nullptr) return {};
        const auto found = data.almanacs->ephemeris({Constellation::galileo, first + place}, reference);
        const auto* record = found ? std::get_if<KeplerEphemeris>(&*found) : nullptr;
        return record == nullptr ? AlmanacEntry{} : AlmanacEntry{carried_almanac(*record, reference)};
    }
    void put_head(BitWriter& bits, bool with_time) const {
        bits.put_signed(issue, 4);
        if (!with_time) return;
        const WeekAndTow at = gst_week_and_tow(reference);
        bits.put_signed(at.week, 2);
        put_scaled_unsigned(bits, at.tow_seconds(), 10, almanac_time_step_s);
    }
};

constexpr int e1b_health = 1, e5b_health = 7, e5a_health = 4;

void put_orbit(BitWriter& bits, const AlmanacEntry& entry) {
    entry.number(bits);
    entry.axis(bits);
    entry.eccentricity(bits);
    entry.perigee(bits);
    entry.inclination(bits);
}

void put_inav_clock(BitWriter& bits, const AlmanacEntry& entry) {
    entry.clock(bits);
    entry.health(bits, e5b_health);
    entry.health(bits, e1b_health);
}

// Galileo's time is GPS time: A_0G and A_1G are 0.
void put_gps_offset(BitWriter& bits, GpsTime start) {
    constexpr double hour_s = 3600;
    const WeekAndTow at = gst_week_and_tow(start);
    bits.put(0, 16 + 12);
    put_scaled_unsigned(bits, std::floor(at.tow_seconds() / hour_s), 8, 1);
    bits.put_signed(at.week, 6);
}

}  // namespace

void put_inav_almanac(BitWriter& bits, int word, const InavData& data, GpsTime start) {
    const AlmanacBatch batch(data, start);
    batch.put_head(bits, word == 7 || word == 9);
    const AlmanacEntry one = batch.entry(0), two = batch.entry(1), three = batch.entry(2);
    switch (word) {
        case 7:
            put_orbit(bits, one);
            one.node(bits);
            one.node_rate(bits);
            one.anomaly(bits);
            return bits.put(0b010101, 6);
        case 8:
            put_inav_clock(bits, one);
            put_orbit(bits, two);
            two.node(bits);
            two.node_rate(bits);
            return bits.put(0, 1);
        case 9:
            two.anomaly(bits);
            put_inav_clock(bits, two);
            return put_orbit(bits, three);
        default:
            three.node(bits);
            three.node_rate(bits);
            three.anomaly(bits);
            put_inav_clock(bits, three);
            return put_gps_offset(bits, start);
    }
}

void put_fnav_almanac(BitWriter& bits, int page, const InavData& data, GpsTime start) {
    constexpr int parted = 16, before = 4;  // Ω_0 of the second satellite, and its bits on page 5
    const AlmanacBatch batch(data, start);
    const AlmanacEntry two = batch.entry(1);
    BitWriter node;
    two.node(node);
    const auto whole = [&bits](const AlmanacEntry& entry) {
        put_orbit(bits, entry);
        entry.node(bits);
        entry.node_rate(bits);
        entry.anomaly(bits);
        entry.clock(bits);
        entry.health(bits, e5a_health);
    };
    batch.put_head(bits, page == 5);
    if (page == 5) {
        whole(batch.entry(0));
        put_orbit(bits, two);
        return bits.put(node.field(0, before), before);
    }
    bits.put(node.field(before, parted - before), parted - before);
    two.node_rate(bits);
    two.anomaly(bits);
    two.clock(bits);
    two.health(bits, e5a_health);
    whole(batch.entry(2));
}

// The user takes the orbit for a Kepler ellipse from t_0r on, the start of the subframe of 30 s, a second late as all
// of E1-B. With the axis rounded to 256 m, eccentricity and perigee are those of the ellipse on which distance, its
// rate and the place along the orbit are right at t_0r.
void put_reduced_record(BitWriter& bits, const KeplerEphemeris& record, GpsTime start) {
    constexpr std::chrono::seconds subframe{30}, late{1};
    constexpr double axis_step_m = 256;
    const GpsTime reference = start - (gst_week_and_tow(start - late).tow % subframe);
    const SatelliteState state = satellite_state(record, reference);
    const Eigen::Vector3d r = state.position.vector(), spin(0, 0, earth_rotation_rate);
    const Eigen::Vector3d v = state.velocity.vector() + spin.cross(r), h = r.cross(v);
    const double distance = r.norm(), rate = r.dot(v) / distance, gravity = gravitational_constant_galileo;
    const double true_axis = 1 / (2 / distance - v.squaredNorm() / gravity);
    const double steps = std::clamp(std::round((true_axis - nominal_axis_m) / axis_step_m), -16.0, 15.0);
    const double axis = nominal_axis_m + (std::isfinite(steps) ? steps : 0) * axis_step_m;
    const double node = std::atan2(h.x(), -h.y());
    const Eigen::Vector3d to_node(std::cos(node), std::sin(node), 0);
    const double along = std::atan2(h.normalized().cross(to_node).dot(r), to_node.dot(r));
    const double cosine = 1 - distance / axis, sine = distance * rate / std::sqrt(gravity * axis);  // e cos E, e sin E
    const double e = std::hypot(cosine, sine), anomaly = std::atan2(sine, cosine);
    const double perigee = along - std::atan2(std::sqrt(1 - e * e) * std::sin(anomaly), std::cos(anomaly) - e);
    bits.put_signed(static_cast<std::int64_t>((axis - nominal_axis_m) / axis_step_m), 5);
    put_scaled(bits, e * std::cos(perigee), 13, power_of_two(-22));
    put_scaled(bits, e * std::sin(perigee), 13, power_of_two(-22));
    put_semicircles(bits, std::atan2(std::hypot(h.x(), h.y()), h.z()) - nominal_inclination, 17, -22);
    put_circle(bits, node + earth_rotation_rate * gst_week_and_tow(reference).tow_seconds(), 23);
    put_circle(bits, anomaly - sine + perigee, 23);
    const double passed = difference(reference, record.toc).value();
    put_scaled(bits, record.af0 + passed * (record.af1 + passed * record.af2), 22, power_of_two(-26));
    put_scaled(bits, record.af1, 6, power_of_two(-35));
}

namespace {

// GF(256) with x⁸ + x⁴ + x³ + x² + 1.
std::uint8_t field_product(std::uint8_t a, std::uint8_t b) {
    unsigned product = 0, shifted = a;
    for (unsigned rest = b; rest != 0; rest >>= 1) {
        if ((rest & 1) != 0) product ^= shifted;
        shifted = shifted << 1 ^ ((shifted & 0x80) != 0 ? 0x11Du : 0u);
    }
    return static_cast<std::uint8_t>(product);
}

constexpr std::size_t mending_octets = 60;

// The generator of the code, by powers; its roots are α¹ … α⁶⁰.
std::array<std::uint8_t, mending_octets + 1> mending_generator() {
    std::array<std::uint8_t, mending_octets + 1> g{1};
    std::uint8_t root = 2;
    for (std::size_t degree = 0; degree < mending_octets; ++degree) {
        for (std::size_t i = degree + 1; i > 0; --i)
            g[i] = static_cast<std::uint8_t>(g[i - 1] ^ field_product(g[i], root));
        g[0] = field_product(g[0], root);
        root = field_product(root, 2);
    }
    return g;
}

}  // namespace

void put_mending_octets(BitWriter& bits, int word, const InavData& data, GpsTime start) {
    // Words 1 to 4 without what they have in common; of the issue the last two bits stand before the first eight.
    BitWriter told;
    for (int of = 1; of <= 4; ++of) {
        const BitWriter from = inav_word(data, of, start);
        if (of == 1) told.put(from.field(0, 6) << 10 | from.field(14, 2) << 8 | from.field(6, 8), 16);
        for (std::size_t at = 16; at < 128; at += 16)
            told.put(from.field(at, 16), 16);
    }
    // The last octet told has the highest power.
    static const std::array<std::uint8_t, mending_octets + 1> generator = mending_generator();
    std::array<std::uint8_t, mending_octets> rest{};
    const Bytes octets = told.bytes();
    for (auto octet = octets.rbegin(); octet != octets.rend(); ++octet) {
        const std::uint8_t factor = *octet ^ rest.back();
        for (std::size_t i = mending_octets; i-- > 0;)
            rest[i] = static_cast<std::uint8_t>((i > 0 ? rest[i - 1] : 0) ^ field_product(factor, generator[i]));
    }
    const auto first = static_cast<std::size_t>(word - 17) * 15;
    bits.put(rest[first], 8);
    bits.put_signed(data.record.iode, 2);
    for (std::size_t i = 1; i < 15; ++i)
        bits.put(rest[first + i], 8);
}

}  // namespace skyloop::inline world
