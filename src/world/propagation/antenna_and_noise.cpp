// Tables of numbers under a header line: antenna patterns.
#include "world/propagation/antenna_and_noise.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/core/files.hpp"
#include "base/core/number_text.hpp"
#include "base/core/result.hpp"
#include "base/core/words.hpp"

namespace skyloop::inline world {
namespace {

/// One line of numbers; a table has at most three columns.
struct NumberRow {
    int line = 0;
    std::array<double, 3> values{};
};

/// A table and which of the headers it has.
struct NumberTable {
    std::size_t header = 0;  ///< index among those that were allowed
    std::vector<NumberRow> rows;
};

constexpr std::string_view table_blanks = " \t\r";

// Reads the cells of one line, or says what is wrong with it.
std::string read_cells(std::string_view line, std::size_t columns, std::array<double, 3>& values) {
    std::size_t count = 0;
    for (std::size_t at = 0; at <= line.size(); ++count) {
        const std::size_t comma = std::min(line.find(',', at), line.size());
        const std::string_view cell = trimmed(line.substr(at, comma - at), table_blanks);
        if (count == columns) return fmt::format("found more than {} columns", columns);
        const auto number = number_in<double>(cell);
        if (!number) return fmt::format("found \"{}\"; expected a number", cell.substr(0, 40));
        values[count] = *number;
        at = comma + 1;
    }
    return count == columns ? std::string() : fmt::format("found {} columns; expected {}", count, columns);
}

/// Reads comma-separated numbers under one of `headers`. Empty lines and those that start with # are passed over. Fails
/// with `input` and FILE:LINE for another header, a cell that is no number, a line of another width, or no rows.
Result<NumberTable> read_number_table(std::string_view text, std::string_view name,
                                      std::span<const std::string_view> headers) {
    NumberTable table;
    std::optional<std::size_t> columns;
    int number = 0;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // as spreadsheets put it before UTF-8
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line = trimmed(text.substr(at, end - at), table_blanks);
        at = end + 1;
        ++number;
        if (line.empty() || line.front() == '#') continue;
        if (!columns) {
            const auto known = std::find(headers.begin(), headers.end(), line);
            if (known == headers.end())
                return fail(ErrorCode::input, fmt::format("{}:{}: found \"{}\"; expected \"{}\"", name, number,
                                                          line.substr(0, 60), fmt::join(headers, "\" or \"")));
            table.header = static_cast<std::size_t>(known - headers.begin());
            columns = 1 + static_cast<std::size_t>(std::count(known->begin(), known->end(), ','));
            continue;
        }
        NumberRow row{number, {}};
        if (const std::string wrong = read_cells(line, *columns, row.values); !wrong.empty())
            return fail(ErrorCode::input, fmt::format("{}:{}: {}", name, number, wrong));
        table.rows.push_back(row);
    }
    if (table.rows.empty())
        return fail(ErrorCode::input,
                    fmt::format("{}:{}: found no rows; expected at least one line of numbers", name, number));
    return table;
}

// Gains by azimuth, then elevation, degrees.
using PatternRows = std::map<double, std::map<double, double>>;

// Adds one line of a table to the rows, or says what is wrong with it.
std::string add_gain(std::span<const double> cells, PatternRows& rows) {
    const bool has_azimuth = cells.size() == 3;
    const double elevation = cells[cells.size() - 2], gain = cells[cells.size() - 1];
    if (has_azimuth && std::abs(cells[0]) > 360) return fmt::format("azimuth is {}; expected 0 to 360", cells[0]);
    if (std::abs(elevation) > 90) return fmt::format("elevation is {}; expected -90 to 90", elevation);
    if (std::abs(gain) > 100) return fmt::format("gain is {} dBic; expected -100 to 100", gain);
    const double azimuth = has_azimuth ? std::fmod(std::fmod(cells[0], 360) + 360, 360) : 0;
    const auto [entry, added] = rows[azimuth].emplace(elevation, gain);
    // 0° and 360° are one azimuth and may both be given.
    if (!added && (!has_azimuth || entry->second != gain)) return "this direction has a gain already";
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
    static constexpr std::array<std::string_view, 2> headers{"elevation_deg,gain_dbic",
                                                             "azimuth_deg,elevation_deg,gain_dbic"};
    const auto table = read_number_table(text, name, headers);
    if (!table) return fail(table.error());
    PatternRows rows;
    for (const NumberRow& row : table->rows) {
        const std::string wrong = add_gain(std::span(row.values).first(table->header + 2), rows);
        if (!wrong.empty()) return fail(ErrorCode::input, fmt::format("{}:{}: {}", name, row.line, wrong));
    }
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

AntennaPattern AntennaPattern::scaled(double factor) const {
    AntennaPattern pattern = *this;
    pattern.peak_ = peak_ * factor;
    pattern.drop_ = drop_ * factor;
    for (double& gain : pattern.gains_)
        gain *= factor;
    return pattern;
}

Result<std::vector<SatellitePowerPoint>> read_satellite_pattern(std::string_view text, std::string_view name) {
    static constexpr std::array<std::string_view, 1> headers{"off_boresight_deg,eirp_dbw"};
    const auto table = read_number_table(text, name, headers);
    if (!table) return fail(table.error());
    std::vector<SatellitePowerPoint> points;
    for (const NumberRow& row : table->rows) {
        const Angle angle = Angle::degrees(row.values[0]);
        if (!(row.values[0] >= 0 && row.values[0] <= 90) || (!points.empty() && angle <= points.back().off_boresight))
            return fail(ErrorCode::input,
                        fmt::format("{}:{}: angle is {}; expected 0 to 90, ascending", name, row.line, row.values[0]));
        if (std::abs(row.values[1]) > 200)
            return fail(ErrorCode::input,
                        fmt::format("{}:{}: EIRP is {} dBW; expected -200 to 200", name, row.line, row.values[1]));
        points.push_back({angle, DecibelWatts(row.values[1])});
    }
    return points;
}

Result<std::vector<SatellitePowerPoint>> read_satellite_pattern_file(const std::filesystem::path& path) {
    const auto text = read_text_file(path);
    if (!text) return fail(text.error());
    return read_satellite_pattern(*text, path.string());
}

namespace {

constexpr double boltzmann_constant = 1.380649e-23;  // J/K, exact since 2019
constexpr double noise_reference_temperature = 290;  // K

double power_ratio(Decibels ratio) { return std::pow(10, ratio.value() / 10); }

}  // namespace

Decibels man_made_noise_p372(NoiseEnvironment environment, Hertz carrier) {
    const double decades = std::log10(carrier.value() / 1e6);
    switch (environment) {
        case NoiseEnvironment::city:
            return Decibels(76.8 - 27.7 * decades);
        case NoiseEnvironment::residential:
            return Decibels(72.5 - 27.7 * decades);
        case NoiseEnvironment::rural:
            return Decibels(67.2 - 27.7 * decades);
        case NoiseEnvironment::quiet_rural:
            break;
    }
    return Decibels(53.6 - 28.6 * decades);
}

Kelvin system_temperature(const ReceiverNoise& noise) {
    const double through = 1 / power_ratio(noise.line_loss);
    return noise.antenna_temperature * through +
           Kelvin(noise_reference_temperature * (1 - through + power_ratio(noise.noise_figure) - 1));
}

DecibelWattsPerHertz noise_density(Kelvin temperature) {
    return DecibelWattsPerHertz(10 * std::log10(boltzmann_constant * temperature.value()));
}

}  // namespace skyloop::inline world
