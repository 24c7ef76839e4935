#include "world/rinex/precise_orbit_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "base/core/files.hpp"
#include "base/time/utc_time.hpp"
#include "detail/fields.hpp"

namespace skyloop::inline world {
namespace rinex {
namespace {

// SP3-a does not tell its own: "ccc" or blank is GPS.
constexpr std::array<std::string_view, 10> file_time_systems{"GPS", "GAL", "QZS", "IRN", "ccc",
                                                             "",    "BDT", "TAI", "UTC", "GLO"};

class PreciseOrbitReading {
public:
    PreciseOrbitReading(std::string_view text, std::string_view name) : lines_(text), name_(name) {}

    Result<PreciseOrbitFile> read() {
        const std::optional<Line> first = lines_.next();
        if (!first || first->text.size() < 3 || first->text[0] != '#' || first->text[1] < 'a' || first->text[1] > 'd')
            return failure(lines_.number(), first ? in_quotes(first->text) : "an empty file",
                           "an SP3 file, its first line beginning with '#a' to '#d'");
        version_ = first->text[1];
        for (std::optional<Line> line = lines_.next(); line && !line->text.starts_with("EOF"); line = lines_.next())
            if (const Result<void> taken = take(*line); !taken) return fail(taken.error());
        if (epochs_ < 2) return failure(lines_.number(), fmt::format("{} epochs", epochs_), "at least two epochs");
        if (positions_ == 0) return failure(lines_.number(), "no position", "positions of satellites");
        return PreciseOrbitFile{PreciseOrbits(std::move(samples_), spacing_),
                                version_,
                                std::string(time_system_),
                                epochs_,
                                positions_,
                                without_position_,
                                other_vehicles_};
    }

private:
    [[nodiscard]] tl::unexpected<Error> failure(int line, std::string_view found, std::string_view expected) const {
        return refused(name_, line, found, expected);
    }

    Result<void> take(const Line& line) {
        if (line.text.starts_with('*')) return epoch(line);
        if (line.text.starts_with('P')) return position(line);
        if (line.text.starts_with("%c") && !time_system_read_) return time_system(line);
        constexpr std::array<std::string_view, 8> passed_over{"#", "+", "%", "/", "V", "EP", "EV", " "};
        const bool known = line.text.empty() || std::any_of(passed_over.begin(), passed_over.end(),
                                                            [&](auto start) { return line.text.starts_with(start); });
        if (!known) return failure(line.number, in_quotes(line.text), "a line of SP3");
        return {};
    }

    Result<void> time_system(const Line& line) {
        time_system_read_ = true;
        const std::string_view name = trimmed(columns(line.text, 9, 3));
        if (std::find(file_time_systems.begin(), file_time_systems.end(), name) == file_time_systems.end())
            return failure(line.number, fmt::format("time system {}", in_quotes(name)),
                           "GPS, GAL, QZS, IRN, BDT, TAI, UTC or GLO");
        time_system_ = name.empty() || name == "ccc" ? "GPS" : name;
        return {};
    }

    Result<void> epoch(const Line& line) {
        const auto part = [&](std::size_t column, std::size_t width) {
            return whole_field(columns(line.text, column, width));
        };
        constexpr ClockLimits most{24, 59, 60.99999999};  // of leap seconds, too, which are written with 8 decimals
        const auto written = calendar_epoch(
            {part(3, 4), part(8, 2), part(11, 2), part(14, 2), part(17, 2), real_field(columns(line.text, 20, 11))},
            most);
        if (!written) return failure(line.number, in_quotes(line.text), "an epoch from 1980 to 2269");
        const GpsTime time = epoch_in_gpst(*written, time_system_);
        if (epochs_ > 0 && time <= time_)
            return failure(line.number, in_quotes(line.text), "an epoch later than the one before");
        if (epochs_ > 0) spacing_ = epochs_ == 1 ? time - time_ : std::min(spacing_, time - time_);
        time_ = time;
        ++epochs_;
        return {};
    }

    // "PG01  13294.139155 -16851.109420  15098.239689    230.219510": kilometres and microseconds.
    Result<void> position(const Line& line) {
        if (epochs_ == 0) return failure(line.number, in_quotes(line.text), "an epoch line before the first position");
        const std::optional<SatelliteId> satellite = vehicle(columns(line.text, 1, 3));
        if (!satellite) {
            ++other_vehicles_;
            return {};
        }
        std::array<double, 4> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::string_view field = columns(line.text, 4 + 14 * i, 14);
            const std::optional<double> value = real_field(field);
            constexpr double furthest_km = 1e6;
            if (!value || (i < 3 && (is_blank(field) || std::abs(*value) > furthest_km)))
                return fail(ErrorCode::input,
                            fmt::format("{}:{}:{}: found {}; expected {}", name_, line.number, 5 + 14 * i,
                                        in_quotes(field), i < 3 ? "kilometres, up to 1e6" : "microseconds"));
            values[i] = *value;
        }
        if (values[0] == 0 && values[1] == 0 && values[2] == 0) {
            ++without_position_;
            return {};
        }
        return add(*satellite, line, values);
    }

    Result<void> add(SatelliteId satellite, const Line& line, const std::array<double, 4>& values) {
        std::vector<PreciseSample>& own = samples_[satellite];
        if (!own.empty() && own.back().time == time_)
            return failure(line.number, fmt::format("{} twice in one epoch", to_string(satellite)),
                           "one position of each satellite");
        PreciseSample sample{time_, Position<Ecef>(values[0] * 1e3, values[1] * 1e3, values[2] * 1e3), std::nullopt};
        // 999999.999999 stands for an unknown clock.
        constexpr double unknown_us = 999999;
        const bool given = !is_blank(columns(line.text, 46, 14)) && std::abs(values[3]) < unknown_us;
        if (given) sample.clock = values[3] * 1e-6;
        own.push_back(sample);
        ++positions_;
        return {};
    }

    // SP3-a writes the number alone, and means GPS.
    static std::optional<SatelliteId> vehicle(std::string_view text) {
        if (text.size() == 3 && text[0] == ' ') {
            const std::optional<int> number = whole_field(text);
            if (number && *number > 0) return SatelliteId{Constellation::gps, *number};
        }
        return parse_satellite(text);
    }

    LineReader lines_;
    std::string_view name_;
    char version_ = 'c';
    bool time_system_read_ = false;
    std::string_view time_system_ = "GPS";
    GpsTime time_;
    Nanoseconds spacing_{0};
    std::map<SatelliteId, std::vector<PreciseSample>> samples_;
    int epochs_ = 0, positions_ = 0, without_position_ = 0, other_vehicles_ = 0;
};

}  // namespace
}  // namespace rinex

Result<PreciseOrbitFile> read_precise_orbits(std::string_view text, std::string_view name) {
    return rinex::PreciseOrbitReading(text, name).read();
}

Result<PreciseOrbitFile> read_precise_orbit_file(const std::filesystem::path& path) {
    return read_text_with(path, read_precise_orbits);
}

}  // namespace skyloop::inline world
