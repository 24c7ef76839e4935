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

// GPST less the time of a file; UTC needs the table of leap seconds.
struct FileTimeSystem {
    std::string_view name;
    Nanoseconds lag;
    bool utc;
};
constexpr std::array<FileTimeSystem, 10> file_time_systems{{
    {"GPS", Nanoseconds(0), false},
    {"GAL", Nanoseconds(0), false},
    {"QZS", Nanoseconds(0), false},
    {"IRN", Nanoseconds(0), false},
    {"ccc", Nanoseconds(0), false},  // SP3-a does not tell: GPS
    {"", Nanoseconds(0), false},
    {"BDT", bdt_lag, false},
    {"TAI", std::chrono::seconds(-19), false},
    {"UTC", Nanoseconds(0), true},
    {"GLO", Nanoseconds(0), true},
}};

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
                                std::string(time_system_.name),
                                epochs_,
                                positions_,
                                without_position_,
                                other_vehicles_};
    }

private:
    [[nodiscard]] tl::unexpected<Error> failure(int line, std::string_view found, std::string_view expected) const {
        return fail(ErrorCode::input, fmt::format("{}:{}: found {}; expected {}", name_, line, found, expected));
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
        const auto found = std::find_if(file_time_systems.begin(), file_time_systems.end(),
                                        [&](const FileTimeSystem& s) { return s.name == name; });
        if (found == file_time_systems.end())
            return failure(line.number, fmt::format("time system {}", in_quotes(name)),
                           "GPS, GAL, QZS, IRN, BDT, TAI, UTC or GLO");
        time_system_ = *found;
        if (name.empty() || name == "ccc") time_system_.name = "GPS";
        return {};
    }

    Result<void> epoch(const Line& line) {
        const auto part = [&](std::size_t column, std::size_t width) {
            return whole_field(columns(line.text, column, width));
        };
        const auto year = part(3, 4), month = part(8, 2), day = part(11, 2), hour = part(14, 2), minute = part(17, 2);
        const auto second = real_field(columns(line.text, 20, 11));
        const bool good = year && month && day && hour && minute && second && is_epoch_year(*year) && *month >= 1 &&
                          *day >= 1 && (std::chrono::year(*year) / *month / *day).ok() && *hour >= 0 && *hour <= 24 &&
                          *minute >= 0 && *minute < 60 && *second >= 0 && *second < 61;
        if (!good) return failure(line.number, in_quotes(line.text), "an epoch from 1980 to 2269");
        GpsTime time = gps_calendar_time(*year, static_cast<unsigned>(*month), static_cast<unsigned>(*day),
                                         static_cast<unsigned>(*hour), static_cast<unsigned>(*minute), *second);
        const LeapSeconds& leap = LeapSeconds::announced();
        time += time_system_.utc
                    ? Nanoseconds(std::chrono::seconds(leap.offset(time + std::chrono::seconds(leap.offset(time)))))
                    : time_system_.lag;
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
    FileTimeSystem time_system_ = file_time_systems[0];
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
    const Result<std::string> text = read_text_file(path);
    if (!text) return fail(text.error());
    return read_precise_orbits(*text, path.string());
}

}  // namespace skyloop::inline world
