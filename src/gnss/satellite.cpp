#include "skyloop/gnss/satellite.hpp"

#include <fmt/format.h>

#include <array>

namespace skyloop {
namespace {

struct ConstellationRow {
    Constellation constellation;
    char letter;
    std::string_view name;
};
constexpr std::array<ConstellationRow, 7> constellations{{
    {Constellation::gps, 'G', "gps"},
    {Constellation::sbas, 'S', "sbas"},
    {Constellation::galileo, 'E', "galileo"},
    {Constellation::beidou, 'C', "beidou"},
    {Constellation::qzss, 'J', "qzss"},
    {Constellation::glonass, 'R', "glonass"},
    {Constellation::navic, 'I', "navic"},
}};

const ConstellationRow& row(Constellation constellation) {
    return constellations[static_cast<std::size_t>(constellation)];
}

}  // namespace

char rinex_letter(Constellation constellation) { return row(constellation).letter; }
std::string_view constellation_name(Constellation constellation) { return row(constellation).name; }

std::optional<Constellation> constellation_from_letter(char letter) {
    for (const ConstellationRow& r : constellations)
        if (r.letter == letter) return r.constellation;
    return std::nullopt;
}

std::optional<Constellation> constellation_from_name(std::string_view name) {
    for (const ConstellationRow& r : constellations)
        if (r.name == name) return r.constellation;
    return std::nullopt;
}

std::string to_string(SatelliteId satellite) {
    return fmt::format("{}{:02}", rinex_letter(satellite.constellation), satellite.number);
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

}  // namespace skyloop
