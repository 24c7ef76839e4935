#include "world/gnss/broadcast_glonass.hpp"

#include <bit>

#include "detail/broadcast_fields.hpp"
#include "detail/glonass_strings.hpp"

namespace skyloop::inline world {
namespace {

constexpr std::int64_t string_s = 2, superframe_s = 150, moscow_s = 3 * 3600;
constexpr int string_bits = 85, check_bits = 8;

// Where a date lies in the four years that begin with a leap year (table 4.5, N_T and N_4).
struct FourYears {
    std::uint64_t day = 1;       // from 1 on
    std::uint64_t interval = 1;  // from 1996 on, the first is 1
};

FourYears four_years(std::int64_t seconds) {
    constexpr std::int64_t days_to_1996 = 5839, days_in_four_years = 1461;  // from 1980-01-06
    const std::int64_t days = std::max<std::int64_t>(seconds / seconds_per_day - days_to_1996, 0);
    return {static_cast<std::uint64_t>(days % days_in_four_years) + 1,
            static_cast<std::uint64_t>(days / days_in_four_years) + 1};
}

void put_axis(BitWriter& bits, const GlonassEphemeris& r, std::size_t axis) {
    constexpr double km = 1000;
    put_sign_magnitude(bits, r.velocity_mps[axis], 24, km * power_of_two(-20));
    put_sign_magnitude(bits, r.acceleration_mps2[axis], 5, km * power_of_two(-30));
    put_sign_magnitude(bits, r.position_m[axis], 27, km * power_of_two(-11));
}

std::uint64_t accuracy_factor(double metres) {
    for (std::size_t i = 0; i < glonass_accuracies_m.size(); ++i)
        if (metres <= glonass_accuracies_m[i]) return i;
    return glonass_accuracies_m.size();
}

// The bits 80 to 9 of a string, made from a record as it is told at one instant.
struct StringFields {
    const GlonassEphemeris& r;
    std::int64_t start;      // of the frame, GLONASS time
    std::int64_t reference;  // of the record, the same

    void first(BitWriter& bits) const {
        const std::int64_t of_day = start % seconds_per_day;
        constexpr std::int64_t half_hour_s = 1800;
        constexpr std::uint64_t half_hour = 1, as_before = 0;
        bits.put(0, 2);
        // P1: by how much t_b is another one than in the frame before; the nearest record changes on the half hour.
        bits.put(of_day % half_hour_s == 0 ? half_hour : as_before, 2);
        bits.put_signed(of_day / 3600, 5);
        bits.put_signed(of_day / 60 % 60, 6);
        bits.put_signed(of_day / glonass_frame_s % 2, 1);
        put_axis(bits, r, 0);
    }
    void second(BitWriter& bits) const {
        constexpr std::uint64_t malfunction = 0b100;
        const auto told = static_cast<std::uint64_t>(r.health) & 7;
        bits.put(r.healthy() ? 0 : (told | malfunction), 3);
        constexpr std::int64_t quarter_hour = 900;
        const std::int64_t nearest = (reference % seconds_per_day + quarter_hour / 2) / quarter_hour % 96;
        bits.put_signed(nearest & 1, 1);
        bits.put_signed(nearest, 7);
        bits.put(0, 5);
        put_axis(bits, r, 1);
    }
    void third(BitWriter& bits) const {
        constexpr std::uint64_t modern = 0b11;  // P: both corrections from the satellite itself
        constexpr std::int64_t last_frame = 4;
        bits.put(start % superframe_s / glonass_frame_s == last_frame ? 0 : 1,
                 1);  // P3: almanacs of five satellites, or of four
        put_sign_magnitude(bits, r.clock_drift, 11, power_of_two(-40));
        bits.put(0, 1);
        bits.put(modern, 2);
        bits.put(r.healthy() ? 0 : 1, 1);
        put_axis(bits, r, 2);
    }
    void fourth(BitWriter& bits) const {
        constexpr std::uint64_t glonass_m = 1;
        put_sign_magnitude(bits, -r.clock_bias, 22, power_of_two(-30));
        put_sign_magnitude(bits, r.group_delay_l2, 5, power_of_two(-30));
        bits.put(0, 5 + 14 + 1);  // E_n: the data is of today
        bits.put(accuracy_factor(r.accuracy_m), 4);
        bits.put(0, 3);
        bits.put(four_years(start).day, 11);
        bits.put_signed(r.satellite.number, 5);
        bits.put(glonass_m, 2);
    }
    void fifth(BitWriter& bits) const {
        bits.put(four_years(start).day, 11);
        bits.put(0, 32 + 1);  // τ_c: GLONASS time is UTC + 3 h
        bits.put(four_years(start).interval, 5);
        bits.put(0, 22);  // τ_GPS
        bits.put(r.healthy() ? 0 : 1, 1);
    }
};

// The check bits β8 … β1 of table 4.13: a Hamming code whose k-th data bit, from bit 9 of the string on, stands at the
// k-th place that is no power of two, and one bit over all.
std::uint64_t hamming(const BitWriter& bits) {
    unsigned places = 0, all = 0;
    unsigned place = 2;
    for (int bit = check_bits + 1; bit <= string_bits; ++bit) {
        do
            ++place;
        while (std::has_single_bit(place));
        if (!bits.bit(static_cast<std::size_t>(string_bits - bit))) continue;
        places ^= place;
        all ^= 1;
    }
    all ^= static_cast<unsigned>(std::popcount(places)) & 1;
    return all << 7 | places;
}

}  // namespace

std::int64_t glonass_seconds(GpsTime time, const LeapSeconds& leap_seconds) {
    return std::chrono::floor<std::chrono::seconds>(time.time_since_epoch()).count() - leap_seconds.offset(time) +
           moscow_s;
}

GlonassWords whole_glonass_string(int string, const BitWriter& content, GpsTime end, const LeapSeconds& leap_seconds) {
    const std::int64_t sent = glonass_seconds(end, leap_seconds) - string_s;
    BitWriter bits;
    bits.put(0, 1);
    bits.put_signed(string, 4);
    bits.put(content.field(0, 64), 64);
    bits.put(content.field(64, 8), 8);
    bits.put(hamming(bits), check_bits);
    const std::int64_t of_week = sent % seconds_per_week;
    const auto superframe = static_cast<std::uint32_t>(of_week / superframe_s) + 1;
    const auto word = [&bits](std::size_t at) { return static_cast<std::uint32_t>(bits.field(32 * at, 32)); };
    return {word(0), word(1), word(2), superframe << 16 | static_cast<std::uint32_t>(glonass_frame(sent))};
}

int glonass_frame(std::int64_t seconds) {
    return static_cast<int>(seconds % seconds_per_week % superframe_s / glonass_frame_s) + 1;
}

std::optional<int> glonass_string_ending(GpsTime end, const LeapSeconds& leap_seconds) {
    if (end.time_since_epoch() % std::chrono::seconds(1) != Nanoseconds(0)) return std::nullopt;
    const std::int64_t start = glonass_seconds(end, leap_seconds) - string_s;
    if (start < 0 || start % string_s != 0) return std::nullopt;
    return static_cast<int>(start % glonass_frame_s / string_s) + 1;
}

GlonassWords glonass_string(const GlonassEphemeris& record, int string, GpsTime end, const LeapSeconds& leap_seconds) {
    const std::int64_t sent = glonass_seconds(end, leap_seconds) - string_s;
    const StringFields fields{record, sent - sent % glonass_frame_s, glonass_seconds(record.toe, leap_seconds)};
    BitWriter content;
    using Part = void (StringFields::*)(BitWriter&) const;
    constexpr std::array<Part, 5> parts{&StringFields::first, &StringFields::second, &StringFields::third,
                                        &StringFields::fourth, &StringFields::fifth};
    (fields.*parts.at(static_cast<std::size_t>(string - 1)))(content);
    return whole_glonass_string(string, content, end, leap_seconds);
}

}  // namespace skyloop::inline world
