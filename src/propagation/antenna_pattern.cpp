#include "skyloop/propagation/antenna_pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include "skyloop/base/text_file.hpp"

namespace skyloop {
namespace {

constexpr std::string_view pattern_header = "elevation_deg,gain_dbic";
constexpr std::string_view pattern_header_azimuth = "azimuth_deg,elevation_deg,gain_dbic";

std::string_view pattern_trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// Gains by azimuth, then elevation, degrees.
using PatternRows = std::map<double, std::map<double, double>>;

// Reads one line of numbers into the rows, or says what is wrong with it.
std::string pattern_line(std::string_view line, std::size_t columns, PatternRows& rows) {
    std::array<double, 3> numbers{};
    std::size_t count = 0;
    for (std::size_t at = 0; at <= line.size(); ++count) {
        const std::size_t comma = std::min(line.find(',', at), line.size());
        const std::string_view cell = pattern_trimmed(line.substr(at, comma - at));
        if (count == columns) return fmt::format("found more than {} columns", columns);
        const auto [stopped, error] = std::from_chars(cell.data(), cell.data() + cell.size(), numbers[count]);
        if (error != std::errc{} || stopped != cell.data() + cell.size() || !std::isfinite(numbers[count]))
            return fmt::format("found \"{}\"; expected a number", cell.substr(0, 40));
        at = comma + 1;
    }
    if (count != columns) return fmt::format("found {} columns; expected {}", count, columns);
    const double azimuth = columns == 3 ? std::fmod(std::fmod(numbers[0], 360) + 360, 360) : 0;
    const double elevation = numbers[columns - 2], gain = numbers[columns - 1];
    if (columns == 3 && std::abs(numbers[0]) > 360) return fmt::format("azimuth is {}; expected 0 to 360", numbers[0]);
    if (std::abs(elevation) > 90) return fmt::format("elevation is {}; expected -90 to 90", elevation);
    if (std::abs(gain) > 100) return fmt::format("gain is {} dBic; expected -100 to 100", gain);
    const auto [entry, added] = rows[azimuth].emplace(elevation, gain);
    // 0° and 360° are one azimuth and may both be given.
    if (!added && (columns == 2 || entry->second != gain)) return "this direction has a gain already";
    return {};
}

// Between two neighbours of an ascending table, or at its end.
struct PatternPlace {
    std::size_t below = 0, above = 0;
    double fraction = 0;
};

PatternPlace pattern_place(const std::vector<double>& table, double x) {
    const auto above = static_cast<std::size_t>(std::upper_bound(table.begin(), table.end(), x) - table.begin());
    if (above == 0) return {};
    if (above == table.size()) return {above - 1, above - 1, 0};
    return {above - 1, above, (x - table[above - 1]) / (table[above] - table[above - 1])};
}

PatternPlace pattern_compass_place(const std::vector<double>& azimuths, double degrees) {
    if (azimuths.size() == 1) return {};
    const double first = azimuths.front(), last = azimuths.back();
    if (degrees >= first && degrees < last) return pattern_place(azimuths, degrees);
    const double gap = first + 360 - last;
    return {azimuths.size() - 1, 0, (degrees >= last ? degrees - last : degrees + 360 - last) / gap};
}

}  // namespace

Result<AntennaPattern> AntennaPattern::parse(std::string_view text, std::string_view name) {
    PatternRows rows;
    std::size_t columns = 0;
    int number = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line = pattern_trimmed(text.substr(at, end - at));
        at = end + 1;
        ++number;
        if (line.empty() || line.front() == '#') continue;
        if (columns == 0) {
            columns = line == pattern_header ? 2 : line == pattern_header_azimuth ? 3 : 0;
            if (columns != 0) continue;
            return fail(ErrorCode::input, fmt::format("{}:{}: found \"{}\"; expected \"{}\" or \"{}\"", name, number,
                                                      line.substr(0, 60), pattern_header, pattern_header_azimuth));
        }
        const std::string wrong = pattern_line(line, columns, rows);
        if (!wrong.empty()) return fail(ErrorCode::input, fmt::format("{}:{}: {}", name, number, wrong));
    }
    if (rows.empty())
        return fail(ErrorCode::input,
                    fmt::format("{}:{}: found no gains; expected at least one line of numbers", name, number));
    AntennaPattern pattern;
    for (const auto& [elevation, gain] : rows.begin()->second)
        pattern.elevations_.push_back(elevation);
    for (const auto& [azimuth, gains] : rows) {
        pattern.azimuths_.push_back(azimuth);
        const auto same = [](const auto& gain, double elevation) { return gain.first == elevation; };
        if (!std::equal(gains.begin(), gains.end(), pattern.elevations_.begin(), pattern.elevations_.end(), same))
            return fail(ErrorCode::input, fmt::format("{}: azimuth {} has other elevations than azimuth {}; expected "
                                                      "the same",
                                                      name, azimuth, rows.begin()->first));
        for (const auto& [elevation, gain] : gains)
            pattern.gains_.push_back(gain);
    }
    return pattern;
}

Result<AntennaPattern> AntennaPattern::read(const std::filesystem::path& path) {
    const auto text = read_text_file(path);
    if (!text) return fail(text.error());
    return parse(*text, path.string());
}

Decibels AntennaPattern::gain(const SkyDirection& direction) const {
    if (azimuths_.empty()) {
        const double off_zenith = std::max(1 - std::sin(direction.elevation.rad()), 0.0);
        return peak_ - drop_ * std::pow(off_zenith, exponent_);
    }
    const double degrees = std::fmod(std::fmod(direction.azimuth.deg(), 360) + 360, 360);
    const PatternPlace around = pattern_compass_place(azimuths_, degrees);
    const PatternPlace up = pattern_place(elevations_, direction.elevation.deg());
    const auto at = [&](std::size_t azimuth) {
        const double* row = gains_.data() + azimuth * elevations_.size();
        return row[up.below] * (1 - up.fraction) + row[up.above] * up.fraction;
    };
    return Decibels(at(around.below) * (1 - around.fraction) + at(around.above) * around.fraction);
}

}  // namespace skyloop
