#include "world/gnss/broadcast_galileo_beidou.hpp"

#include "detail/broadcast_fields.hpp"
#include "world/gnss/broadcast_lnav.hpp"

namespace skyloop::inline world {
namespace {

constexpr std::chrono::seconds pair_length{2};
constexpr double gst_time_step_s = 60;  // of toe and toc
constexpr std::size_t word_bits = 128, even_data_bits = 112;

double gst_tow(GpsTime time) { return gst_week_and_tow(time).tow_seconds(); }
std::uint64_t gst_week(GpsTime time) { return static_cast<std::uint64_t>(gst_week_and_tow(time).week); }

// Bits of the health as records keep it (RINEX 3.05, table A8).
std::uint64_t health_bits(const KeplerEphemeris& r, int first, std::uint64_t mask) {
    return static_cast<std::uint64_t>(r.health >> first) & mask;
}

// The fields of the words behind their type.
struct InavFields {
    const InavData& data;
    GpsTime start;
    BitWriter bits{};

    void issue() { bits.put_signed(data.record.iode, 10); }
    void first() {
        const KeplerEphemeris& r = data.record;
        issue();
        put_scaled_unsigned(bits, gst_tow(r.toe), 14, gst_time_step_s);
        put_circle(bits, r.m0, 32);
        put_scaled_unsigned(bits, r.e, 32, power_of_two(-33));
        put_scaled_unsigned(bits, r.sqrt_a, 32, power_of_two(-19));
    }
    void second() {
        const KeplerEphemeris& r = data.record;
        issue();
        put_circle(bits, r.omega0, 32);
        put_circle(bits, r.i0, 32);
        put_circle(bits, r.omega, 32);
        put_semicircles(bits, r.idot, 14, -43);
    }
    void third() {
        const KeplerEphemeris& r = data.record;
        issue();
        put_semicircles(bits, r.omega_dot, 24, -43);
        put_semicircles(bits, r.delta_n, 16, -43);
        put_scaled(bits, r.cuc, 16, power_of_two(-29));
        put_scaled(bits, r.cus, 16, power_of_two(-29));
        put_scaled(bits, r.crc, 16, power_of_two(-5));
        put_scaled(bits, r.crs, 16, power_of_two(-5));
        bits.put_signed(inav_accuracy_index(r.accuracy_m), 8);
    }
    void fourth() {
        const KeplerEphemeris& r = data.record;
        issue();
        bits.put_signed(r.satellite.number, 6);
        put_scaled(bits, r.cic, 16, power_of_two(-29));
        put_scaled(bits, r.cis, 16, power_of_two(-29));
        put_scaled_unsigned(bits, gst_tow(r.toc), 14, gst_time_step_s);
        put_scaled(bits, r.af0, 31, power_of_two(-34));
        put_scaled(bits, r.af1, 21, power_of_two(-46));
        put_scaled(bits, r.af2, 6, power_of_two(-59));
    }
    void fifth() {
        const KeplerEphemeris& r = data.record;
        const std::array<double, 3> a = data.ionosphere.galileo.value_or(std::array<double, 3>{});
        put_scaled_unsigned(bits, a[0], 11, power_of_two(-2));
        put_scaled(bits, a[1], 11, power_of_two(-8));
        put_scaled(bits, a[2], 14, power_of_two(-15));
        bits.put(0, 5);  // no ionospheric disturbance
        put_scaled(bits, r.tgd, 10, power_of_two(-32));
        put_scaled(bits, r.tgd2, 10, power_of_two(-32));
        bits.put(health_bits(r, 7, 3), 2);  // E5b, then E1-B
        bits.put(health_bits(r, 1, 3), 2);
        bits.put(health_bits(r, 6, 1), 1);
        bits.put(health_bits(r, 0, 1), 1);
        time();
    }
    void sixth() {
        const LeapChange change = leap_change(data.leap_seconds, start);
        constexpr double hour = 3600;
        bits.put(0, 32 + 24);  // Galileo's time is UTC but for whole seconds
        bits.put_signed(data.leap_seconds.offset(start), 8);
        put_scaled_unsigned(bits, std::floor(gst_tow(start) / hour), 8, 1);
        bits.put(gst_week(start), 8);
        bits.put(change.week, 8);
        bits.put(change.day, 3);
        bits.put_signed(change.offset, 8);
        put_scaled_unsigned(bits, gst_tow(start), 20, 1);
    }
    void spare() {
        constexpr std::uint64_t time_is_told = 0b10;
        bits.put(time_is_told, 2);
        for (int pairs = 0; pairs < 44; ++pairs)
            bits.put(0b01, 2);
        time();
    }
    void time() {
        bits.put(gst_week(start), 12);
        put_scaled_unsigned(bits, gst_tow(start), 20, 1);
    }
    void put(int word) {
        bits.put_signed(word, 6);
        using Part = void (InavFields::*)();
        constexpr std::array<Part, 7> parts{&InavFields::spare, &InavFields::first,  &InavFields::second,
                                            &InavFields::third, &InavFields::fourth, &InavFields::fifth,
                                            &InavFields::sixth};
        (this->*parts[static_cast<std::size_t>(word)])();
        bits.put(0, static_cast<int>(word_bits - bits.size()));
    }
};

// CRC-24Q over even and odd page (section 5.1.9.4), bit by bit, since the pages are no whole bytes.
class PageChecksum {
public:
    void add(bool bit) {
        const bool carry = (value_ >> 23 & 1) != 0;
        value_ = value_ << 1 & 0xFFFFFF;
        if (carry != bit) value_ ^= 0x864CFB;
    }
    [[nodiscard]] std::uint64_t value() const { return value_; }

private:
    std::uint32_t value_ = 0;
};

void copy_bits(const BitWriter& from, std::size_t first, std::size_t count, BitWriter& to) {
    for (std::size_t i = 0; i < count; ++i)
        to.put(from.bit(first + i) ? 1 : 0, 1);
}

}  // namespace

std::optional<int> inav_word_ending(Signal signal, GpsTime end) {
    const bool e5b = signal == Signal::e5b;
    const std::chrono::seconds late{e5b ? 0 : 1};
    const Nanoseconds tow = gst_week_and_tow(end - pair_length - late).tow;
    if (tow % pair_length != Nanoseconds(0)) return std::nullopt;
    constexpr std::array<int, 15> of_e1{2, 4, 6, 0, 0, 0, 0, 0, 0, 0, 1, 3, 5, 0, 0};
    constexpr std::array<int, 15> of_e5b{1, 3, 5, 0, 0, 0, 0, 0, 0, 0, 2, 4, 6, 0, 0};
    const auto place = static_cast<std::size_t>(tow / pair_length % 15);
    return e5b ? of_e5b[place] : of_e1[place];
}

int inav_accuracy_index(double metres) {
    // Steps of 1, 2, 4 and 16 cm.
    if (!(metres >= 0 && metres <= 6)) return 255;
    if (metres < 0.5) return static_cast<int>(std::lround(metres / 0.01));
    if (metres < 1) return 50 + static_cast<int>(std::lround((metres - 0.5) / 0.02));
    if (metres < 2) return 75 + static_cast<int>(std::lround((metres - 1) / 0.04));
    return 100 + static_cast<int>(std::lround((metres - 2) / 0.16));
}

InavWords inav_pages(const InavData& data, int word, GpsTime end) {
    InavFields fields{data, end - pair_length};
    fields.put(word);

    BitWriter even, odd;
    even.put(0, 2);
    copy_bits(fields.bits, 0, even_data_bits, even);
    odd.put(0b10, 2);
    copy_bits(fields.bits, even_data_bits, word_bits - even_data_bits, odd);
    constexpr std::uint64_t filling = 0x2AAAAA;
    odd.put(0, 40);        // authentication; of E5b reserved
    odd.put(filling, 22);  // no return link; of E5b reserved
    odd.put(0b10, 2);
    PageChecksum checksum;
    for (std::size_t i = 0; i < even.size(); ++i)
        checksum.add(even.bit(i));
    for (std::size_t i = 0; i < odd.size(); ++i)
        checksum.add(odd.bit(i));
    odd.put(checksum.value(), 24);
    odd.put(0, 8);
    for (BitWriter* page : {&even, &odd})
        page->put(0, static_cast<int>(word_bits - page->size()));
    InavWords words{};
    for (std::size_t i = 0; i < 4; ++i) {
        words[i] = static_cast<std::uint32_t>(even.field(32 * i, 32));
        words[i + 4] = static_cast<std::uint32_t>(odd.field(32 * i, 32));
    }
    return words;
}

namespace {

constexpr double d1_time_step_s = 8;  // of toc and toe
constexpr int toe_bits = 17, toe_bits_before = 2;

double bdt_tow(GpsTime time) { return bdt_week_and_tow(time).tow_seconds(); }

void put_d1_head(BitWriter& bits, int subframe, GpsTime end) {
    constexpr std::uint64_t preamble_d1 = 0b11100010010;
    bits.put(preamble_d1, 11);
    bits.put(0, 4);
    bits.put_signed(subframe, 3);
    put_scaled_unsigned(bits, bdt_tow(end - std::chrono::seconds(6)), 20, 1);
}

BitWriter d1_toe_field(const KeplerEphemeris& r) {
    BitWriter bits;
    put_scaled_unsigned(bits, bdt_tow(r.toe), toe_bits, d1_time_step_s);
    return bits;
}

void put_d1_clock(BitWriter& bits, const KeplerEphemeris& r, const KlobucharCoefficients& c, GpsTime end) {
    constexpr double delay_step = 1e-10;
    bits.put(r.health_bits_clear() ? 0 : 1, 1);
    bits.put_signed(r.iodc, 5);
    bits.put_signed(lnav_accuracy_index(r.accuracy_m), 4);
    bits.put_signed(bdt_week_and_tow(end - std::chrono::seconds(6)).week, 13);
    put_scaled_unsigned(bits, bdt_tow(r.toc), 17, d1_time_step_s);
    put_scaled(bits, r.tgd, 10, delay_step);
    put_scaled(bits, r.tgd2, 10, delay_step);
    put_klobuchar(bits, c);
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

}  // namespace

D1Words d1_subframe(const KeplerEphemeris& record, const std::optional<KlobucharCoefficients>& ionosphere, int subframe,
                    GpsTime end) {
    BitWriter bits;
    put_d1_head(bits, subframe, end);
    if (subframe == 1)
        put_d1_clock(bits, record, ionosphere.value_or(KlobucharCoefficients{}), end);
    else if (subframe == 2)
        put_d1_first_orbit(bits, record);
    else
        put_d1_second_orbit(bits, record);
    return with_d1_parity(bits);
}

}  // namespace skyloop::inline world
