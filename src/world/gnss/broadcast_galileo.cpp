#include "world/gnss/broadcast_galileo.hpp"

#include <utility>

#include "detail/galileo_words.hpp"

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

// Galileo's time is UTC but for whole seconds.
void put_utc(BitWriter& bits, const LeapSeconds& leap_seconds, GpsTime start) {
    const LeapChange change = leap_change(leap_seconds, start);
    constexpr double hour = 3600;
    bits.put(0, 32 + 24);
    bits.put_signed(leap_seconds.offset(start), 8);
    put_scaled_unsigned(bits, std::floor(gst_tow(start) / hour), 8, 1);
    bits.put(gst_week(start), 8);
    bits.put(change.week, 8);
    bits.put(change.day, 3);
    bits.put_signed(change.offset, 8);
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
        put_utc(bits, data.leap_seconds, start);
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
    void dummy() {
        for (int pairs = 0; pairs < 61; ++pairs)
            bits.put(0b01, 2);
    }
    void put(int word) {
        bits.put_signed(word, 6);
        using Part = void (InavFields::*)();
        constexpr std::array<Part, 7> parts{&InavFields::spare, &InavFields::first,  &InavFields::second,
                                            &InavFields::third, &InavFields::fourth, &InavFields::fifth,
                                            &InavFields::sixth};
        if (word >= 17 && word <= 20)
            put_mending_octets(bits, word, data, start);
        else if (word == 16)
            put_reduced_record(bits, data.record, start);
        else if (word >= 7 && word <= 10)
            put_inav_almanac(bits, word, data, start);
        else if (word == dummy_inav_word)
            dummy();
        else
            (this->*parts[static_cast<std::size_t>(word)])();
        bits.put(0, static_cast<int>(word_bits - bits.size()));
    }
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
    constexpr std::array<int, 15> of_e1{2, 4, 6, 7, 8, 17, 19, 16, 0, 0, 1, 3, 5, 0, 16};
    constexpr std::array<int, 15> of_e5b{1, 3, 5, 7, 8, 0, 0, 0, 0, 0, 2, 4, 6, 0, 0};
    const auto place = static_cast<std::size_t>(tow / pair_length % 15);
    const int word = e5b ? of_e5b[place] : of_e1[place];
    // In the second half of a minute the other ones of those that take a minute.
    if (tow / pair_length % 30 < 15) return word;
    if (word == 7 || word == 8) return word + 2;
    return word == 17 || word == 19 ? word + 1 : word;
}

int inav_accuracy_index(double metres) {
    // Steps of 1, 2, 4 and 16 cm.
    if (!(metres >= 0 && metres <= 6)) return 255;
    if (metres < 0.5) return static_cast<int>(std::lround(metres / 0.01));
    if (metres < 1) return 50 + static_cast<int>(std::lround((metres - 0.5) / 0.02));
    if (metres < 2) return 75 + static_cast<int>(std::lround((metres - 1) / 0.04));
    return 100 + static_cast<int>(std::lround((metres - 2) / 0.16));
}

BitWriter inav_word(const InavData& data, int word, GpsTime start) {
    InavFields fields{data, start};
    fields.put(word);
    return std::move(fields.bits);
}

namespace {

constexpr std::size_t even_page_bits = 114;  // without its tail, as an odd one before its checksum is of 82
constexpr std::size_t authentication_at = 2 + 16;

// The odd page of the last bits of a word.
BitWriter odd_page(std::uint64_t last_of_word, std::uint64_t authentication) {
    constexpr std::uint64_t odd = 0b10, filling = 0x2AAAAA;
    BitWriter page;
    page.put(odd, 2);
    page.put(last_of_word, 16);
    page.put(authentication, 40);
    page.put(filling, 22);  // no return link; of E5b reserved
    page.put(0b10, 2);
    return page;
}

InavWords whole_pages(BitWriter even, BitWriter odd) {
    MessageChecksum checksum;
    checksum.add(even);
    checksum.add(odd);
    odd.put(checksum.value(), 24);
    InavWords words{};
    for (std::size_t i = 0; i < 4; ++i) {
        words[i] = static_cast<std::uint32_t>(even.field(32 * i, 32));
        words[i + 4] = static_cast<std::uint32_t>(odd.field(32 * i, 32));
    }
    return words;
}

}  // namespace

InavWords inav_pages(const InavData& data, int word, GpsTime end) {
    const BitWriter bits = inav_word(data, word, end - pair_length);
    BitWriter even;
    even.put(0, 2);
    copy_bits(bits, 0, even_data_bits, even);
    return whole_pages(std::move(even), odd_page(bits.field(even_data_bits, 16), data.authentication));
}

std::uint64_t inav_authentication(const InavWords& pages) {
    BitWriter odd;
    odd.put(pages[4], 32);
    odd.put(pages[5], 32);
    return odd.field(authentication_at, 40);
}

InavWords with_authentication(const InavWords& pages, std::uint64_t authentication) {
    BitWriter all, even;
    for (std::size_t i = 0; i < 4; ++i)
        all.put(pages[i], 32);
    copy_bits(all, 0, even_page_bits, even);
    return whole_pages(std::move(even), odd_page(pages[4] >> 14 & 0xFFFF, authentication));
}

namespace {

constexpr std::chrono::seconds fnav_page_length{10};
constexpr int fnav_pages = 5;

// The fields of F/NAV's pages behind their type (tables 31 to 36).
struct FnavFields {
    const InavData& data;
    GpsTime start;
    BitWriter bits{};

    void issue() { bits.put_signed(data.record.iode, 10); }
    void week() { bits.put(gst_week(start), 12); }
    void tow() { put_scaled_unsigned(bits, gst_tow(start), 20, 1); }
    void clock() {
        const KeplerEphemeris& r = data.record;
        // Either clock less its group delay is that of E1 (5.1.5), so that one follows from the other.
        const double to_e5a = r.message == NavigationMessage::inav ? r.tgd - r.tgd2 : 0;
        const std::array<double, 3> a = data.ionosphere.galileo.value_or(std::array<double, 3>{});
        bits.put_signed(r.satellite.number, 6);
        issue();
        put_scaled_unsigned(bits, gst_tow(r.toc), 14, gst_time_step_s);
        put_scaled(bits, r.af0 + to_e5a, 31, power_of_two(-34));
        put_scaled(bits, r.af1, 21, power_of_two(-46));
        put_scaled(bits, r.af2, 6, power_of_two(-59));
        bits.put_signed(inav_accuracy_index(r.accuracy_m), 8);
        put_scaled_unsigned(bits, a[0], 11, power_of_two(-2));
        put_scaled(bits, a[1], 11, power_of_two(-8));
        put_scaled(bits, a[2], 14, power_of_two(-15));
        bits.put(0, 5);  // no ionospheric disturbance
        put_scaled(bits, r.tgd, 10, power_of_two(-32));
        bits.put(health_bits(r, 4, 3), 2);
        week();
        tow();
        bits.put(health_bits(r, 3, 1), 1);
    }
    void first_orbit() {
        const KeplerEphemeris& r = data.record;
        issue();
        put_circle(bits, r.m0, 32);
        put_semicircles(bits, r.omega_dot, 24, -43);
        put_scaled_unsigned(bits, r.e, 32, power_of_two(-33));
        put_scaled_unsigned(bits, r.sqrt_a, 32, power_of_two(-19));
        put_circle(bits, r.omega0, 32);
        put_semicircles(bits, r.idot, 14, -43);
        week();
        tow();
    }
    void second_orbit() {
        const KeplerEphemeris& r = data.record;
        issue();
        put_circle(bits, r.i0, 32);
        put_circle(bits, r.omega, 32);
        put_semicircles(bits, r.delta_n, 16, -43);
        put_scaled(bits, r.cuc, 16, power_of_two(-29));
        put_scaled(bits, r.cus, 16, power_of_two(-29));
        put_scaled(bits, r.crc, 16, power_of_two(-5));
        put_scaled(bits, r.crs, 16, power_of_two(-5));
        put_scaled_unsigned(bits, gst_tow(r.toe), 14, gst_time_step_s);
        week();
        tow();
    }
    void third_orbit() {
        const KeplerEphemeris& r = data.record;
        issue();
        put_scaled(bits, r.cic, 16, power_of_two(-29));
        put_scaled(bits, r.cis, 16, power_of_two(-29));
        put_utc(bits, data.leap_seconds, start);
        // Galileo's time is GPS time: A_0G and A_1G are 0.
        constexpr double hour = 3600;
        put_scaled_unsigned(bits, std::floor(gst_tow(start) / hour), 8, 1);
        bits.put(0, 16 + 12);
        bits.put(gst_week(start), 6);
        tow();
    }
    void put(int page) {
        bits.put_signed(page, 6);
        if (page == 1) clock();
        if (page == 2) first_orbit();
        if (page == 3) second_orbit();
        if (page == 4) third_orbit();
        if (page >= 5) put_fnav_almanac(bits, page, data, start);
        bits.put(0, static_cast<int>(fnav_data_bits - bits.size()));
    }
    static constexpr std::size_t fnav_data_bits = 214;
};

}  // namespace

std::optional<int> fnav_page_ending(SatelliteId satellite, GpsTime end) {
    const Nanoseconds tow = gst_week_and_tow(end - fnav_page_length).tow;
    if (tow % fnav_page_length != Nanoseconds(0)) return std::nullopt;
    const std::int64_t count = tow / fnav_page_length;
    const auto page = static_cast<int>(count % fnav_pages) + 1;
    return page < fnav_pages || (count / fnav_pages + satellite.number) % 2 != 0 ? page : fnav_pages + 1;
}

FnavWords fnav_page(const InavData& data, int page, GpsTime end) {
    FnavFields fields{data, end - fnav_page_length};
    fields.put(page);
    MessageChecksum checksum;
    checksum.add(fields.bits);
    fields.bits.put(checksum.value(), 24);
    FnavWords words{};
    for (std::size_t i = 0; i < words.size(); ++i)
        words[i] = static_cast<std::uint32_t>(fields.bits.field(32 * i, 32));
    return words;
}

}  // namespace skyloop::inline world
