#include "world/gnss/broadcast_cnav.hpp"

#include <cmath>

#include "detail/broadcast_fields.hpp"
#include "detail/galileo_words.hpp"
#include "world/gnss/broadcast_lnav.hpp"

namespace skyloop::inline world {
namespace {

constexpr std::array<int, 4> cnav_types{10, 11, 30, 33};
constexpr double cnav_time_step_s = 300, leap_time_step_s = 16, fine_day_step_s = 4096;
constexpr int message_bits = 276;

double gps_tow(GpsTime time) { return week_and_tow(time).tow_seconds(); }

// The reference of orbits is the axis of GPS, or of QZSS (IS-QZSS-PNT-005, table 4.3.2-5), and a drift of the node.
double reference_axis_m(Constellation constellation) {
    return constellation == Constellation::qzss ? 42'164'200 : 26'559'710;
}
constexpr double reference_node_rate = -2.6e-9 * std::numbers::pi;

struct CnavFields {
    const CnavData& data;
    GpsTime end;
    BitWriter bits{};

    // Of the week of the message's end, whose time it tells.
    void predicted() { put_scaled_unsigned(bits, gps_tow(data.record.toe), 11, cnav_time_step_s); }
    void first_orbit() {
        const KeplerEphemeris& r = data.record;
        bits.put_signed(week_and_tow(end).week, 13);
        const bool healthy = r.health_bits_clear();
        bits.put(healthy ? 0 : 0b111, 3);  // L1, L2, L5
        predicted();
        bits.put_signed(cnav_accuracy_index(r.accuracy_m), 5);
        put_scaled_unsigned(bits, gps_tow(r.toe), 11, cnav_time_step_s);
        const double axis = r.sqrt_a * r.sqrt_a;
        put_scaled(bits, axis - reference_axis_m(r.satellite.constellation), 26, power_of_two(-9));
        put_scaled(bits, r.axis_rate, 25, power_of_two(-21));
        put_semicircles(bits, r.delta_n, 17, -44);
        put_semicircles(bits, r.delta_n_rate, 23, -57);
        put_circle(bits, r.m0, 33);
        put_scaled_unsigned(bits, r.e, 33, power_of_two(-34));
        put_circle(bits, r.omega, 33);
        bits.put(0, 1 + 1 + 3);  // no integrity beyond the legacy one, L2C in quadrature
    }
    void second_orbit() {
        const KeplerEphemeris& r = data.record;
        put_scaled_unsigned(bits, gps_tow(r.toe), 11, cnav_time_step_s);
        put_circle(bits, r.omega0, 33);
        put_circle(bits, r.i0, 33);
        put_semicircles(bits, r.omega_dot - reference_node_rate, 17, -44);
        put_semicircles(bits, r.idot, 15, -44);
        put_scaled(bits, r.cis, 16, power_of_two(-30));
        put_scaled(bits, r.cic, 16, power_of_two(-30));
        put_scaled(bits, r.crs, 24, power_of_two(-8));
        put_scaled(bits, r.crc, 24, power_of_two(-8));
        put_scaled(bits, r.cus, 21, power_of_two(-30));
        put_scaled(bits, r.cuc, 21, power_of_two(-30));
    }
    void clock() {
        const KeplerEphemeris& r = data.record;
        predicted();
        bits.put_signed(cnav_accuracy_index(r.accuracy_m), 5);
        bits.put(0, 3 + 3);
        put_scaled_unsigned(bits, gps_tow(r.toc), 11, cnav_time_step_s);
        put_scaled(bits, r.af0, 26, power_of_two(-35));
        put_scaled(bits, r.af1, 20, power_of_two(-48));
        put_scaled(bits, r.af2, 10, power_of_two(-60));
    }
    void delays() {
        const KeplerEphemeris& r = data.record;
        // What is subtracted for a signal is T_GD less its correction (30.3.3.3.1.1.1).
        const auto correction = [&](Signal signal) {
            const double sent = sent_group_delay(r, signal).value_or(Seconds(0)).value();
            put_scaled(bits, r.tgd - sent, 13, power_of_two(-35));
        };
        const bool qzss = r.satellite.constellation == Constellation::qzss;
        clock();
        put_scaled(bits, r.tgd, 13, power_of_two(-35));
        for (const Signal signal : {Signal::l1, Signal::l2, Signal::l5, Signal::l5})
            correction(signal);
        put_klobuchar(bits, (qzss ? data.ionosphere.qzss : data.ionosphere.gps).value_or(KlobucharCoefficients{}));
        bits.put_signed(week_and_tow(r.toe).week, 8);
    }
    void universal_time() {
        const LeapChange change = leap_change(data.leap_seconds, end);
        clock();
        bits.put(0, 16 + 13 + 7);  // GPS time is UTC but for whole seconds
        bits.put_signed(data.leap_seconds.offset(end), 8);
        const double reference = fine_day_step_s * std::floor(gps_tow(end) / fine_day_step_s);
        put_scaled_unsigned(bits, reference, 16, leap_time_step_s);
        bits.put_signed(week_and_tow(end).week, 13);
        bits.put(change.week, 13);
        bits.put(change.day, 4);
        bits.put_signed(change.offset, 8);
    }
};

// Preamble, satellite, type and the time of the message's end (30.3.3).
BitWriter cnav_head(const KeplerEphemeris& r, int type, GpsTime end) {
    constexpr std::uint64_t cnav_preamble = 0x8B;
    constexpr std::chrono::seconds time_step{6};
    BitWriter bits;
    bits.put(cnav_preamble, 8);
    bits.put_signed(r.satellite.number, 6);
    bits.put_signed(type, 6);
    bits.put_signed(week_and_tow(end).tow / time_step, 17);
    bits.put(0, 1);
    return bits;
}

}  // namespace

std::chrono::seconds cnav_length(Signal signal) { return std::chrono::seconds(signal == Signal::l2 ? 12 : 6); }

std::optional<int> cnav_type_ending(Signal signal, GpsTime end) {
    const std::chrono::seconds length = cnav_length(signal);
    const Nanoseconds start = week_and_tow(end - length).tow;
    if (start % length != Nanoseconds(0)) return std::nullopt;
    return cnav_types[static_cast<std::size_t>(start / length) % cnav_types.size()];
}

int cnav_accuracy_index(double metres) {
    constexpr std::array<double, 16> finer{0.01, 0.02, 0.03, 0.04, 0.06, 0.08, 0.11, 0.15,
                                           0.21, 0.3,  0.43, 0.6,  0.85, 1.2,  1.7,  2.4};
    for (std::size_t i = 0; i < finer.size(); ++i)
        if (metres >= 0 && metres <= finer[i]) return static_cast<int>(i) - 15;
    return lnav_accuracy_index(metres);
}

CnavWords cnav_message(const CnavData& data, int type, Signal signal, GpsTime end) {
    CnavFields fields{data, end, cnav_head(data.record, type, end)};
    switch (type) {
        case 10:
            fields.first_orbit();
            break;
        case 11:
            fields.second_orbit();
            break;
        case 30:
            fields.delays();
            break;
        default:
            fields.universal_time();
    }
    BitWriter& bits = fields.bits;
    bits.put(0, message_bits - static_cast<int>(bits.size()));
    MessageChecksum checksum;
    checksum.add(bits);
    bits.put(checksum.value(), 24);
    const GpsTime next = end + cnav_length(signal);
    const BitWriter after = cnav_head(data.record, cnav_type_ending(signal, next).value_or(type), next);
    bits.put(after.field(0, 20), 20);
    CnavWords words{};
    for (std::size_t i = 0; i < words.size(); ++i)
        words[i] = static_cast<std::uint32_t>(bits.field(32 * i, 32));
    return words;
}

}  // namespace skyloop::inline world
