#include "world/gnss/broadcast_beidou.hpp"

#include "detail/beidou_words.hpp"
#include "detail/broadcast_fields.hpp"
#include "world/gnss/broadcast_lnav.hpp"

namespace skyloop::inline world {
namespace {

constexpr double d1_time_step_s = 8;  // of toc and toe
constexpr int toe_bits = 17, toe_bits_before = 2;

double bdt_tow(GpsTime time) { return bdt_week_and_tow(time).tow_seconds(); }

BitWriter d1_toe_field(const KeplerEphemeris& r) {
    BitWriter bits;
    put_scaled_unsigned(bits, bdt_tow(r.toe), toe_bits, d1_time_step_s);
    return bits;
}

// What D1 and D2 both begin with. @param start of the subframe
void put_state_and_delays(BitWriter& bits, const KeplerEphemeris& r, const KlobucharCoefficients& c, GpsTime start) {
    constexpr double delay_step = 1e-10;
    bits.put(r.health_bits_clear() ? 0 : 1, 1);
    bits.put_signed(r.iodc, 5);
    bits.put_signed(lnav_accuracy_index(r.accuracy_m), 4);
    bits.put_signed(bdt_week_and_tow(start).week, 13);
    put_scaled_unsigned(bits, bdt_tow(r.toc), 17, d1_time_step_s);
    put_scaled(bits, r.tgd, 10, delay_step);
    put_scaled(bits, r.tgd2, 10, delay_step);
    put_klobuchar(bits, c);
}

void put_d1_clock(BitWriter& bits, const KeplerEphemeris& r, const KlobucharCoefficients& c, GpsTime end) {
    put_state_and_delays(bits, r, c, end - std::chrono::seconds(6));
    put_scaled(bits, r.af2, 11, power_of_two(-66));
    put_scaled(bits, r.af0, 24, power_of_two(-33));
    put_scaled(bits, r.af1, 22, power_of_two(-50));
    bits.put_signed(r.iode, 5);
}

void put_d1_first_orbit(BitWriter& bits, const KeplerEphemeris& r) {
    put_semicircles(bits, r.delta_n, 16, -43);
    put_scaled(bits, r.cuc, 18, power_of_two(-31));
    put_circle(bits, r.m0, 32);
    put_scaled_unsigned(bits, r.e, 32, power_of_two(-33));
    put_scaled(bits, r.cus, 18, power_of_two(-31));
    put_scaled(bits, r.crc, 18, power_of_two(-6));
    put_scaled(bits, r.crs, 18, power_of_two(-6));
    put_scaled_unsigned(bits, r.sqrt_a, 32, power_of_two(-19));
    bits.put(d1_toe_field(r).field(0, toe_bits_before), toe_bits_before);
}

void put_d1_second_orbit(BitWriter& bits, const KeplerEphemeris& r) {
    bits.put(d1_toe_field(r).field(toe_bits_before, toe_bits - toe_bits_before), toe_bits - toe_bits_before);
    put_circle(bits, r.i0, 32);
    put_scaled(bits, r.cic, 18, power_of_two(-31));
    put_semicircles(bits, r.omega_dot, 24, -43);
    put_scaled(bits, r.cis, 18, power_of_two(-31));
    put_semicircles(bits, r.idot, 14, -43);
    put_circle(bits, r.omega0, 32);
    put_circle(bits, r.omega, 32);
}

// BCH(15,11,1) with g = x⁴ + x + 1 (section 5.1.3): the remainder of eleven bits times x⁴.
std::uint32_t d1_parity(std::uint32_t eleven) {
    std::uint32_t rest = eleven << 4;
    for (int bit = 14; bit >= 4; --bit)
        if ((rest >> bit & 1) != 0) rest ^= 0b10011u << (bit - 4);
    return rest;
}

// Of D2's subframe 1 (section 5.3, table 5-16 and figures 5-14-1 to 5-14-10): how many bits of the clock, ionosphere
// and orbit each page holds of the 72 between its number and the end of word 5; what is left is reserved, of page 3
// before a_0, too. Words 6 to 10 are reserved throughout.
constexpr std::array<std::size_t, d2_page_count> d2_page_bits{60, 64, 28, 64, 64, 64, 64, 66, 64, 19};
constexpr int d2_data_bits = 72, d2_bits_before_a0 = 38, d2_reserved_words = 5;

// The fields of the ten pages in their order, without what is reserved.
BitWriter d2_fields(const KeplerEphemeris& r, const KlobucharCoefficients& c, GpsTime start) {
    BitWriter bits;
    put_state_and_delays(bits, r, c, start);
    put_scaled(bits, r.af0, 24, power_of_two(-33));
    put_scaled(bits, r.af1, 22, power_of_two(-50));
    put_scaled(bits, r.af2, 11, power_of_two(-66));
    bits.put_signed(r.iode, 5);
    put_semicircles(bits, r.delta_n, 16, -43);
    put_scaled(bits, r.cuc, 18, power_of_two(-31));
    put_circle(bits, r.m0, 32);
    put_scaled(bits, r.cus, 18, power_of_two(-31));
    put_scaled_unsigned(bits, r.e, 32, power_of_two(-33));
    put_scaled_unsigned(bits, r.sqrt_a, 32, power_of_two(-19));
    put_scaled(bits, r.cic, 18, power_of_two(-31));
    put_scaled(bits, r.cis, 18, power_of_two(-31));
    put_scaled_unsigned(bits, bdt_tow(r.toe), toe_bits, d1_time_step_s);
    put_circle(bits, r.i0, 32);
    put_scaled(bits, r.crc, 18, power_of_two(-6));
    put_scaled(bits, r.crs, 18, power_of_two(-6));
    put_semicircles(bits, r.omega_dot, 24, -43);
    put_circle(bits, r.omega0, 32);
    put_circle(bits, r.omega, 32);
    put_semicircles(bits, r.idot, 14, -43);
    return bits;
}

}  // namespace

void put_beidou_head(BitWriter& bits, int subframe, GpsTime sow) {
    constexpr std::uint64_t preamble = 0b11100010010;
    bits.put(preamble, 11);
    bits.put(0, 4);
    bits.put_signed(subframe, 3);
    put_scaled_unsigned(bits, bdt_tow(sow), 20, 1);
}

D1Words with_d1_parity(const BitWriter& bits) {
    constexpr int first_bits = 26, other_bits = 22, half = 11;
    const auto field = [&bits](std::size_t at, int width) { return static_cast<std::uint32_t>(bits.field(at, width)); };
    D1Words words{};
    words[0] = field(0, first_bits) << 4 | d1_parity(field(first_bits - half, half));
    for (std::size_t i = 1; i < words.size(); ++i) {
        const std::size_t at = first_bits + (i - 1) * other_bits;
        words[i] = field(at, other_bits) << 8 | d1_parity(field(at, half)) << 4 | d1_parity(field(at + half, half));
    }
    return words;
}

D1Words d1_subframe(const KeplerEphemeris& record, const std::optional<KlobucharCoefficients>& ionosphere, int subframe,
                    GpsTime end) {
    BitWriter bits;
    put_beidou_head(bits, subframe, end - std::chrono::seconds(6));
    if (subframe == 1)
        put_d1_clock(bits, record, ionosphere.value_or(KlobucharCoefficients{}), end);
    else if (subframe == 2)
        put_d1_first_orbit(bits, record);
    else
        put_d1_second_orbit(bits, record);
    return with_d1_parity(bits);
}

std::optional<int> d2_page_ending(GpsTime end) {
    constexpr std::chrono::seconds frame{3};
    const Nanoseconds tow = bdt_week_and_tow(end - d2_subframe_length).tow;
    if (tow % frame != Nanoseconds(0)) return std::nullopt;
    return static_cast<int>(tow / frame % d2_page_count) + 1;
}

D1Words d2_page(const KeplerEphemeris& record, const std::optional<KlobucharCoefficients>& ionosphere, int page,
                GpsTime end) {
    constexpr int with_a0 = 3;
    const GpsTime start = end - d2_subframe_length;
    const BitWriter fields = d2_fields(record, ionosphere.value_or(KlobucharCoefficients{}), start);
    const auto index = static_cast<std::size_t>(page - 1);
    std::size_t at = 0;
    for (std::size_t i = 0; i < index; ++i)
        at += d2_page_bits[i];
    BitWriter bits;
    put_beidou_head(bits, 1, start);
    bits.put_signed(page, 4);
    const std::size_t begin = bits.size();
    if (page == with_a0) bits.put(0, d2_bits_before_a0);
    for (std::size_t i = 0; i < d2_page_bits[index]; ++i)
        bits.put(fields.bit(at + i) ? 1 : 0, 1);
    bits.put(0, d2_data_bits - static_cast<int>(bits.size() - begin) + d2_reserved_words * 22);
    return with_d1_parity(bits);
}

}  // namespace skyloop::inline world
