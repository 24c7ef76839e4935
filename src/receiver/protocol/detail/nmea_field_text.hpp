/// Fields that several NMEA sentences have.
/// Reads NMEA fields as values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/result.hpp"
#include "receiver/protocol/nmea_fields.hpp"
#include "receiver/protocol/nmea_messages.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop::inline receiver::nmea_encoding {

inline constexpr std::size_t longest_sentence = 82;  // NMEA 0183, 5.3: with "$" and line end

/// 10 to the power of 0 … 9 decimals.
std::int64_t power_of_ten(int decimals);
std::string time_text(const NmeaTime& time, int decimals);
void add_time(Sentence& sentence, const std::optional<NmeaTime>& time, const NmeaFormat& format);
/// "ddmmyy".
std::string date_text(const NmeaDate& date);
/// Latitude, N or S, longitude, E or W; four empty fields without a position.
void add_position(Sentence& sentence, const std::optional<NmeaPosition>& position, int decimals);
void add_decimal(Sentence& sentence, const std::optional<double>& value, int decimals);
void add_metres(Sentence& sentence, const std::optional<Metres>& value, int decimals);
/// @param most what larger ones, and what is not a number, are shown as
void add_dop(Sentence& sentence, const std::optional<double>& dop, int decimals, double most = 99.99);
/// Degrees with `decimals` digits in 0 ≤ course < 360: 359.996 is 0.00.
std::string course_text(Angle course, int decimals);
/// Two to three digits that mean something: 0.049, 0.98, 3.1, 228650 (captures of F9R and M9N).
std::string deviation_text(Metres deviation);
void add_station(Sentence& sentence, const std::optional<int>& station, std::string_view without);
std::string hex_text(int value);

inline bool since_2_3(const NmeaFormat& format) { return format.version >= NmeaVersion::v2_3; }
inline bool since_4_10(const NmeaFormat& format) { return format.version >= NmeaVersion::v4_10; }
inline double in_knots(MetresPerSecond speed) { return speed.value() * 3600.0 / 1852.0; }
inline double in_kmh(MetresPerSecond speed) { return speed.value() * 3.6; }

/// The text with as many of its decimals as 82 characters hold, where the format asks for that.
/// @param make_text the whole sentence with so many decimals
template <class MakeText>
std::string within_limit(const NmeaFormat& format, int decimals, MakeText make_text) {
    std::string text = make_text(decimals);
    while (format.limit_82 && text.size() > longest_sentence && decimals > 0)
        text = make_text(--decimals);
    return text;
}

}  // namespace skyloop::inline receiver::nmea_encoding

namespace skyloop::inline receiver::nmea_decoding {

/// Reads the fields of one sentence; remembers the first that is not what its place demands.
class FieldReader {
public:
    explicit FieldReader(const SentenceView& sentence) : sentence_(sentence) {}

    [[nodiscard]] std::size_t size() const { return sentence_.fields.size(); }
    [[nodiscard]] std::string_view text(std::size_t i) const { return sentence_.field(i); }
    [[nodiscard]] std::string talker() const { return std::string(sentence_.talker()); }

    std::optional<double> number(std::size_t i, std::string_view what);
    /// Not negative.
    std::optional<int> integer(std::size_t i, std::string_view what, int base = 10);

    std::optional<Metres> metres(std::size_t i, std::string_view what) {
        const auto value = number(i, what);
        return value ? std::optional(Metres(*value)) : std::nullopt;
    }

    std::optional<Angle> degrees(std::size_t i, std::string_view what) {
        const auto value = number(i, what);
        return value ? std::optional(Angle::degrees(*value)) : std::nullopt;
    }

    // One of two letters; true for the first.
    bool either(std::size_t i, std::string_view letters, std::string_view what) {
        const std::string_view field = text(i);
        if (field.size() != 1 || letters.find(field[0]) == std::string_view::npos) refuse(i, what);
        return !field.empty() && field[0] == letters[0];
    }

    std::optional<NmeaTime> time(std::size_t i);
    std::optional<NmeaDate> date(std::size_t day_at, std::size_t month_at, std::size_t year_at);
    std::optional<NmeaDate> packed_date(std::size_t i);
    std::optional<NmeaPosition> position(std::size_t i);
    std::optional<NmeaMode> mode(std::size_t i);

    std::nullopt_t refuse(std::size_t i, std::string_view what);

    /// Nothing, or why the sentence is not what it should be.
    [[nodiscard]] Result<void> verdict(std::size_t least_fields) const;

private:
    std::optional<double> coordinate(std::size_t i, std::string_view hemispheres, double limit);

    const SentenceView& sentence_;
    std::string error_;
};

}  // namespace skyloop::inline receiver::nmea_decoding
