/// NMEA 0183 sentences as text: building and checking them. StreamSplitter finds them in a stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"

namespace skyloop::inline receiver {

/// The exclusive or of the characters between `$` and `*` (NMEA 0183, 5.3).
std::uint8_t nmea_checksum(std::string_view body);

/// `value` with exactly `decimals` digits after the point, correctly rounded; never "-0.00". Empty when not finite.
std::string fixed_decimals(double value, int decimals);

/// Builds one sentence field by field.
class Sentence {
public:
    /// @param address talker and formatter, "GNGGA"
    explicit Sentence(std::string_view address) : body_(address) {}

    Sentence& text(std::string_view field);
    Sentence& letter(char field) { return text({&field, 1}); }
    /// Padded with zeros to at least `digits`.
    Sentence& number(int value, int digits = 1);
    /// An empty field for nothing.
    Sentence& number(std::optional<int> value, int digits = 1) { return value ? number(*value, digits) : empty(); }
    Sentence& decimal(double value, int decimals) { return text(fixed_decimals(value, decimals)); }
    /// `count` fields without content.
    Sentence& empty(int count = 1);
    /// "$…*hh\r\n", the checksum in upper case.
    [[nodiscard]] std::string finish() const;

private:
    std::string body_;
};

/// One checked sentence; its views live as long as the line that was parsed.
struct SentenceView {
    std::string_view address;  ///< "GNGGA", "PUBX"
    std::vector<std::string_view> fields;
    /// "GN"; "P" for proprietary sentences.
    [[nodiscard]] std::string_view talker() const;
    /// "GGA"; what follows the P of proprietary sentences.
    [[nodiscard]] std::string_view formatter() const;
    /// A field, empty where the sentence has fewer.
    [[nodiscard]] std::string_view field(std::size_t index) const;
};

/// Reads one line, with or without its line end; before that may stand the blanks with which loggers fill up lines.
/// Fails with `input` when it does not start with `$` or `!`, has a character that is not printable, no checksum or a
/// wrong one (either letter case is accepted).
Result<SentenceView> parse_sentence(std::string_view line);

}  // namespace skyloop::inline receiver
