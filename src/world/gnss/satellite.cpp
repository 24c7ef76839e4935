#include "world/gnss/satellite.hpp"

#include <algorithm>

#include "base/core/number_text.hpp"

namespace skyloop::inline world {
namespace {

// All in the order of Constellation.
constexpr std::string_view rinex_letters = "GSECJRI";
constexpr std::array<std::string_view, 7> constellation_titles{"GPS",  "SBAS",    "Galileo", "BeiDou",
                                                               "QZSS", "GLONASS", "NavIC"};

std::optional<Constellation> constellation_at(std::size_t index) {
    return index < constellation_names.size() ? std::optional(static_cast<Constellation>(index)) : std::nullopt;
}

}  // namespace

char rinex_letter(Constellation constellation) { return rinex_letters[static_cast<std::size_t>(constellation)]; }

std::string_view constellation_name(Constellation constellation) {
    return constellation_names[static_cast<std::size_t>(constellation)];
}

std::string_view constellation_title(Constellation constellation) {
    return constellation_titles[static_cast<std::size_t>(constellation)];
}

std::optional<Constellation> constellation_from_letter(char letter) {
    return constellation_at(rinex_letters.find(letter));
}

std::optional<Constellation> constellation_from_name(std::string_view name) {
    const auto found = std::find(constellation_names.begin(), constellation_names.end(), name);
    return constellation_at(static_cast<std::size_t>(found - constellation_names.begin()));
}

std::string to_string(SatelliteId satellite) {
    std::string text(1, rinex_letter(satellite.constellation));
    append_padded(text, satellite.number, 2);
    return text;
}

std::optional<SatelliteId> parse_satellite(std::string_view text) {
    if (text.size() != 3) return std::nullopt;
    const auto constellation = constellation_from_letter(text[0]);
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    if (!constellation || !(digit(text[1]) || text[1] == ' ') || !digit(text[2])) return std::nullopt;
    const int number = (text[1] == ' ' ? 0 : text[1] - '0') * 10 + (text[2] - '0');
    if (number == 0) return std::nullopt;
    return SatelliteId{*constellation, number};
}

}  // namespace skyloop::inline world
