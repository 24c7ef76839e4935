#include "world/gnss/sbas_message.hpp"

#include <algorithm>
#include <iterator>

#include "base/core/bytes.hpp"
#include "base/time/gps_time.hpp"
#include "detail/broadcast_fields.hpp"
#include "world/gnss/broadcast_lnav.hpp"

namespace skyloop::inline world {
namespace {

constexpr int sbas_data_bits = 212, sbas_type_bits = 6;
constexpr std::array<std::uint8_t, 3> preambles{0x53, 0x9A, 0xC6};

// Both say of the same fields what they do, so that each layout is written once.
class SbasFieldWriter {
public:
    void whole(int value, int width) { bits_.put_signed(value, width); }
    void flag(bool value) { bits_.put(value ? 1 : 0, 1); }
    void integer(int value, int width) { bits_.put_signed(value, width); }
    void scaled(double value, int width, double step) { put_scaled(bits_, value, width, step); }
    void positive(double value, int width, double step) { put_scaled_unsigned(bits_, value, width, step); }
    void spare(int width) { bits_.put(0, width); }
    void mask(const std::vector<int>& set, int size) {
        for (int i = 1; i <= size; ++i)
            flag(std::ranges::binary_search(set, i));
    }
    // All ones say that there is none.
    void optional(const std::optional<double>& value, int width, double step) {
        const std::int64_t none = (std::int64_t{1} << width) - 1;
        bits_.put_signed(value ? quantised(*value, step, 0, none - 1) : none, width);
    }
    [[nodiscard]] const BitWriter& bits() const { return bits_; }

private:
    BitWriter bits_;
};

class SbasFieldReader {
public:
    explicit SbasFieldReader(BitReader& bits) : bits_(bits) {}
    void whole(int& value, int width) { value = static_cast<int>(bits_.get(width)); }
    void flag(bool& value) { value = bits_.get(1) != 0; }
    void integer(int& value, int width) { value = static_cast<int>(bits_.get_signed(width)); }
    void scaled(double& value, int width, double step) { value = static_cast<double>(bits_.get_signed(width)) * step; }
    void positive(double& value, int width, double step) { value = static_cast<double>(bits_.get(width)) * step; }
    void spare(int width) { bits_.skip(static_cast<std::size_t>(width)); }
    void mask(std::vector<int>& set, int size) {
        for (int i = 1; i <= size; ++i)
            if (bits_.get(1) != 0) set.push_back(i);
    }
    void optional(std::optional<double>& value, int width, double step) {
        const std::uint64_t raw = bits_.get(width);
        if (raw != (std::uint64_t{1} << width) - 1) value = static_cast<double>(raw) * step;
    }

private:
    BitReader& bits_;
};

constexpr double sbas_range_step = 0.125, sbas_long_term_step = 0.125, sbas_delay_step = 0.125;

void layout(auto& f, auto& m, const SbasPrnMask*) {
    f.mask(m.slots, sbas_mask_size);
    f.whole(m.iodp, 2);
}

void fast_fields(auto& f, auto& satellites) {
    for (auto& s : satellites)
        f.scaled(s.range_m, 12, sbas_range_step);
    for (auto& s : satellites)
        f.whole(s.udrei, 4);
}

// The block is in the type.
void layout(auto& f, auto& m, const SbasFastCorrections*) {
    f.whole(m.iodf, 2);
    f.whole(m.iodp, 2);
    fast_fields(f, m.satellites);
}

void layout(auto& f, auto& m, const SbasIntegrity*) {
    for (auto& iodf : m.iodf)
        f.whole(iodf, 2);
    for (auto& udrei : m.udrei)
        f.whole(udrei, 4);
}

void layout(auto& f, auto& m, const SbasFastDegradation*) {
    f.whole(m.latency_s, 4);
    f.whole(m.iodp, 2);
    f.spare(2);
    for (auto& indicator : m.indicators)
        f.whole(indicator, 4);
}

void layout(auto& f, auto& m, const SbasNavigation*) {
    f.whole(m.issue, 8);
    f.positive(m.time_of_day_s, 13, 16);
    f.whole(m.accuracy_index, 4);
    f.scaled(m.position_m[0], 30, 0.08);
    f.scaled(m.position_m[1], 30, 0.08);
    f.scaled(m.position_m[2], 25, 0.4);
    f.scaled(m.velocity_mps[0], 17, 0.000625);
    f.scaled(m.velocity_mps[1], 17, 0.000625);
    f.scaled(m.velocity_mps[2], 18, 0.004);
    f.scaled(m.acceleration_mps2[0], 10, 0.0000125);
    f.scaled(m.acceleration_mps2[1], 10, 0.0000125);
    f.scaled(m.acceleration_mps2[2], 10, 0.0000625);
    f.scaled(m.clock_bias, 12, power_of_two(-31));
    f.scaled(m.clock_drift, 8, power_of_two(-40));
}

void layout(auto& f, auto& m, const SbasDegradation*) {
    f.positive(m.b_rrc_m, 10, 0.002);
    f.positive(m.c_ltc_lsb_m, 10, 0.002);
    f.positive(m.c_ltc_v1_mps, 10, 0.00005);
    f.whole(m.i_ltc_v1_s, 9);
    f.positive(m.c_ltc_v0_m, 10, 0.002);
    f.whole(m.i_ltc_v0_s, 9);
    f.positive(m.c_geo_lsb_m, 10, 0.0005);
    f.positive(m.c_geo_v_mps, 10, 0.00005);
    f.whole(m.i_geo_s, 9);
    f.positive(m.c_er_m, 6, 0.5);
    f.positive(m.c_iono_step_m, 10, 0.001);
    f.whole(m.i_iono_s, 9);
    f.positive(m.c_iono_ramp_mps, 10, 0.000005);
    f.whole(m.rss_udre, 1);
    f.whole(m.rss_iono, 1);
    f.positive(m.c_covariance, 7, 0.1);
}

void layout(auto& f, auto& m, const SbasAlmanacs*) {
    for (auto& s : m.satellites) {
        f.whole(s.data_id, 2);
        f.whole(s.prn, 8);
        f.whole(s.health, 8);
        f.scaled(s.position_m[0], 15, 2600);
        f.scaled(s.position_m[1], 15, 2600);
        f.scaled(s.position_m[2], 9, 26000);
        f.scaled(s.velocity_mps[0], 3, 10);
        f.scaled(s.velocity_mps[1], 3, 10);
        f.scaled(s.velocity_mps[2], 4, 60);
    }
    f.positive(m.time_of_day_s, 11, 64);
}

void layout(auto& f, auto& m, const SbasGridMask*) {
    f.whole(m.bands, 4);
    f.whole(m.band, 4);
    f.whole(m.iodi, 2);
    f.mask(m.points, 201);
}

void long_term_head(auto& f, auto& c) {
    f.whole(c.number, 6);
    f.whole(c.iode, 8);
}

void long_term_half(auto& f, auto& half) {
    f.flag(half.with_velocity);
    if (half.with_velocity) {
        auto& c = half.satellites[0];
        long_term_head(f, c);
        for (auto& metres : c.position_m)
            f.scaled(metres, 11, sbas_long_term_step);
        f.scaled(c.clock_s, 11, power_of_two(-31));
        for (auto& rate : c.velocity_mps)
            f.scaled(rate, 8, power_of_two(-11));
        f.scaled(c.clock_drift, 8, power_of_two(-39));
        f.positive(c.time_of_day_s, 13, 16);
        f.whole(half.iodp, 2);
        return;
    }
    for (auto& c : half.satellites) {
        long_term_head(f, c);
        for (auto& metres : c.position_m)
            f.scaled(metres, 9, sbas_long_term_step);
        f.scaled(c.clock_s, 10, power_of_two(-31));
    }
    f.whole(half.iodp, 2);
    f.spare(1);
}

void layout(auto& f, auto& m, const SbasMixedCorrections*) {
    fast_fields(f, m.satellites);
    f.whole(m.iodp, 2);
    f.whole(m.block, 2);
    f.whole(m.iodf, 2);
    f.spare(4);
    long_term_half(f, m.long_term);
}

void layout(auto& f, auto& m, const SbasLongTermCorrections*) {
    for (auto& half : m.halves)
        long_term_half(f, half);
}

void layout(auto& f, auto& m, const SbasIonosphere*) {
    f.whole(m.band, 4);
    f.whole(m.block, 4);
    for (auto& point : m.points) {
        f.optional(point.vertical_m, 9, sbas_delay_step);
        f.whole(point.givei, 4);
    }
    f.whole(m.iodi, 2);
}

void layout(auto& f, auto& m, const SbasServiceRegions*) {
    f.whole(m.issue, 3);
    f.whole(m.messages, 3);
    f.whole(m.number, 3);
    f.whole(m.region_count, 3);
    f.whole(m.priority, 2);
    f.whole(m.udre_inside, 4);
    f.whole(m.udre_outside, 4);
    for (auto& r : m.regions) {
        f.integer(r.first_latitude, 8);
        f.integer(r.first_longitude, 9);
        f.integer(r.second_latitude, 8);
        f.integer(r.second_longitude, 9);
        f.flag(r.square);
    }
}

void layout(auto&, auto&, const SbasNull*) {}

void layout(auto& f, auto& m, const SbasDoNotUse*) {
    if (m.test) layout(f, *m.test, static_cast<const SbasFastCorrections*>(nullptr));
}

template <class Message>
Message read_fields(SbasFieldReader& fields) {
    Message m;
    layout(fields, m, &m);
    return m;
}

// CRC-24Q over a number of bits (DO-229, A.4.3.3), which are no whole bytes.
std::uint32_t sbas_parity(const BitWriter& bits, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const bool carry = (value >> 23 & 1) != 0;
        value = value << 1 & 0xFF'FFFF;
        if (carry != bits.bit(i)) value ^= 0x86'4CFB;
    }
    return value;
}

std::optional<SbasMessage> sbas_message_of(int type, SbasFieldReader& fields, bool empty) {
    switch (type) {
        case 0: {
            if (empty) return SbasDoNotUse{};
            return SbasDoNotUse{read_fields<SbasFastCorrections>(fields)};
        }
        case 1:
            return read_fields<SbasPrnMask>(fields);
        case 2:
        case 3:
        case 4:
        case 5: {
            auto m = read_fields<SbasFastCorrections>(fields);
            m.block = type - 2;
            return m;
        }
        case 6:
            return read_fields<SbasIntegrity>(fields);
        case 7:
            return read_fields<SbasFastDegradation>(fields);
        case 9:
            return read_fields<SbasNavigation>(fields);
        case 10:
            return read_fields<SbasDegradation>(fields);
        case 17:
            return read_fields<SbasAlmanacs>(fields);
        case 18:
            return read_fields<SbasGridMask>(fields);
        case 24:
            return read_fields<SbasMixedCorrections>(fields);
        case 25:
            return read_fields<SbasLongTermCorrections>(fields);
        case 26:
            return read_fields<SbasIonosphere>(fields);
        case 27:
            return read_fields<SbasServiceRegions>(fields);
        case 63:
            return SbasNull{};
        default:
            return std::nullopt;
    }
}

}  // namespace

int sbas_message_type(const SbasMessage& message) {
    static constexpr std::array<int, std::variant_size_v<SbasMessage>> types{0,  1,  2,  6,  7,  9,  10,
                                                                             17, 18, 24, 25, 26, 27, 63};
    const auto* fast = std::get_if<SbasFastCorrections>(&message);
    return types[message.index()] + (fast != nullptr ? fast->block : 0);
}

SbasWords encode_sbas(const SbasMessage& message, GpsTime start) {
    const auto second = week_and_tow(start).tow / std::chrono::seconds(1);
    SbasFieldWriter data;
    std::visit([&](const auto& m) { layout(data, m, &m); }, message);
    BitWriter bits;
    bits.put(preambles[static_cast<std::size_t>(second % 3)], 8);
    bits.put_signed(sbas_message_type(message), sbas_type_bits);
    for (std::size_t i = 0; i < sbas_data_bits; ++i)
        bits.put(i < data.bits().size() && data.bits().bit(i) ? 1 : 0, 1);
    bits.put(sbas_parity(bits, bits.size()), 24);
    SbasWords words{};
    std::ranges::copy(bits.words(), words.begin());
    return words;
}

std::optional<SbasMessage> decode_sbas(const std::vector<std::uint32_t>& words) {
    if (words.size() < std::tuple_size_v<SbasWords>) return std::nullopt;
    BitWriter bits;
    for (const std::uint32_t word : words)
        bits.put(word, 32);
    if (std::ranges::find(preambles, bits.field(0, 8)) == preambles.end()) return std::nullopt;
    constexpr std::size_t covered = 8 + sbas_type_bits + sbas_data_bits;
    if (sbas_parity(bits, covered) != bits.field(covered, 24)) return std::nullopt;
    const Bytes bytes = bits.bytes();
    BitReader reader(bytes);
    reader.skip(8);
    const auto type = static_cast<int>(reader.get(sbas_type_bits));
    bool empty = true;
    for (std::size_t i = covered - sbas_data_bits; i < covered; ++i)
        empty = empty && !bits.bit(i);
    SbasFieldReader fields(reader);
    return sbas_message_of(type, fields, empty);
}

std::optional<int> sbas_mask_slot(SatelliteId satellite) {
    constexpr int before_glonass = 37, before_sbas = 100;
    switch (satellite.constellation) {
        case Constellation::gps:
            return satellite.number <= before_glonass ? std::optional(satellite.number) : std::nullopt;
        case Constellation::glonass:
            return satellite.number <= 24 ? std::optional(satellite.number + before_glonass) : std::nullopt;
        case Constellation::sbas:
            return satellite.number + before_sbas;
        default:
            return std::nullopt;
    }
}

namespace {

// DO-229, table A-6; ICAO Annex 10, table B-62.
constexpr std::array<double, 14> udre_bounds{0.75, 1, 1.25, 1.75, 2.25, 3, 3.75, 4.5, 5.25, 6, 7.5, 15, 50, 150};
// DO-229, table A-17; ICAO Annex 10, table B-66.
constexpr std::array<double, 15> give_bounds{0.3, 0.6, 0.9, 1.2, 1.5, 1.8, 2.1, 2.4, 2.7, 3, 3.6, 4.5, 6, 15, 45};
// DO-229, table A-8, user time-out interval of fast corrections.
constexpr std::array<int, 16> fast_timeouts{180, 180, 153, 135, 135, 117, 99, 81, 63, 45, 45, 27, 27, 27, 18, 18};

template <std::size_t N>
int index_of_bound(const std::array<double, N>& bounds, double bound) {
    const auto found = std::ranges::lower_bound(bounds, bound);
    return static_cast<int>(std::min<std::ptrdiff_t>(found - bounds.begin(), N - 1));
}

}  // namespace

double sbas_udre(int index) { return udre_bounds.at(static_cast<std::size_t>(index)); }
int sbas_udre_index(double bound) { return index_of_bound(udre_bounds, bound); }
double sbas_give(int index) { return give_bounds.at(static_cast<std::size_t>(index)); }
int sbas_give_index(double bound) { return index_of_bound(give_bounds, bound); }
Seconds sbas_fast_timeout(int indicator) { return Seconds(fast_timeouts.at(static_cast<std::size_t>(indicator))); }

SbasNavigation sbas_navigation(const SbasEphemeris& record) {
    constexpr int not_for_ranging = 15;
    const auto of_day = record.toe.time_since_epoch() % std::chrono::days(1);
    SbasNavigation m;
    m.issue = record.iode;
    m.time_of_day_s = to_seconds(of_day).value();
    m.accuracy_index = record.healthy() ? lnav_accuracy_index(record.accuracy_m) : not_for_ranging;
    m.position_m = record.position_m;
    m.velocity_mps = record.velocity_mps;
    m.acceleration_mps2 = record.acceleration_mps2;
    m.clock_bias = record.clock_bias;
    m.clock_drift = record.clock_drift;
    return m;
}

}  // namespace skyloop::inline world
