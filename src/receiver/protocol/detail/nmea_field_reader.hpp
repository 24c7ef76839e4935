/// Reads NMEA fields as values.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/core/result.hpp"
#include "receiver/protocol/nmea_decode.hpp"

namespace skyloop::nmea_decoding {

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
    template <class Message>
    Result<NmeaMessage> finish(Message message, std::size_t least_fields) const {
        if (const Result<void> good = verdict(least_fields); !good) return fail(good.error());
        return NmeaMessage(std::move(message));
    }

private:
    std::optional<double> coordinate(std::size_t i, std::string_view hemispheres, double limit);

    const SentenceView& sentence_;
    std::string error_;
};

// The sentences of nmea_supplements.hpp.
Result<NmeaMessage> decode_gns(FieldReader r);
Result<NmeaMessage> decode_gbs(FieldReader r);
Result<NmeaMessage> decode_grs(FieldReader r);
Result<NmeaMessage> decode_dtm(FieldReader r);
Result<NmeaMessage> decode_vlw(FieldReader r);
Result<NmeaMessage> decode_ths(FieldReader r);
Result<NmeaMessage> decode_hdt(FieldReader r);

}  // namespace skyloop::nmea_decoding
