#include "world/rinex/ionex_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "base/core/files.hpp"
#include "detail/fields.hpp"

namespace skyloop::inline world {
namespace rinex {
namespace {

constexpr int ionex_no_value = 9999;
constexpr std::size_t ionex_values_per_line = 16;
constexpr std::size_t ionex_most_values = 1u << 20;  // of one map: a grid of 0.25° by 0.25°

class IonexReading {
public:
    IonexReading(std::string_view text, std::string_view name, const LeapSeconds& leap_seconds)
        : lines_(text), name_(name), leap_seconds_(leap_seconds) {}

    Result<IonosphereMaps> read() {
        for (auto stage : {&IonexReading::header, &IonexReading::body})
            if (auto done = (this->*stage)(); !done) return fail(done.error());
        if (result_.maps.empty()) return wrong("no TEC map", "at least one");
        return std::move(result_);
    }

private:
    using Done = Result<bool>;

    [[nodiscard]] tl::unexpected<Error> wrong(std::string_view found, std::string_view expected) const {
        return refused(name_, lines_.number(), found, expected);
    }
    // Moves to the next line; false at the end of the text.
    bool advance() {
        const auto line = lines_.next();
        line_ = line ? line->text : std::string_view{};
        return line.has_value();
    }
    [[nodiscard]] std::string_view label() const { return trimmed(columns(line_, 60, 20)); }

    Done header() {
        if (!advance() || label() != "IONEX VERSION / TYPE")
            return wrong(in_quotes(line_), "the line IONEX VERSION / TYPE");
        const auto version = real_field(columns(line_, 0, 8));
        if (!version || *version < 1 || *version >= 2 || columns(line_, 20, 1) != "I")
            return wrong(in_quotes(columns(line_, 0, 60)), "version 1 of type I (ionosphere maps)");
        while (advance()) {
            if (label() == "END OF HEADER") return grid_is_whole();
            if (auto done = header_line(); !done) return done;
        }
        return wrong("the end of the file", "END OF HEADER");
    }

    Done header_line() {
        if (label() == "MAP DIMENSION") {
            const auto dimension = whole_field(columns(line_, 0, 6));
            if (dimension != 2) return wrong(in_quotes(columns(line_, 0, 6)), "maps of 2 dimensions");
        } else if (label() == "BASE RADIUS") {
            const auto radius = real_field(columns(line_, 0, 8));
            if (!radius || *radius < 6000 || *radius > 7000)
                return wrong(in_quotes(columns(line_, 0, 8)), "a base radius of 6000 to 7000 km");
            result_.shell.earth_radius = Metres(*radius * 1000);
        } else if (label() == "HGT1 / HGT2 / DHGT") {
            const auto first = real_field(columns(line_, 2, 6)), last = real_field(columns(line_, 8, 6));
            if (!first || first != last || *first < 100 || *first > 2000)
                return wrong(in_quotes(columns(line_, 0, 20)), "one height of 100 to 2000 km");
            result_.shell.height = Metres(*first * 1000);
        } else if (label() == "LAT1 / LAT2 / DLAT") {
            return axis(result_.latitude, 90);
        } else if (label() == "LON1 / LON2 / DLON") {
            return axis(result_.longitude, 360);
        } else if (label() == "EXPONENT") {
            return exponent();
        }
        return true;
    }

    Done exponent() {
        const auto value = whole_field(columns(line_, 0, 6));
        if (!value || *value < -9 || *value > 9) return wrong(in_quotes(columns(line_, 0, 6)), "an exponent −9 … 9");
        unit_tecu_ = std::pow(10, *value);
        return true;
    }

    Done axis(GridAxis& axis, double limit) {
        const auto first = real_field(columns(line_, 2, 6)), last = real_field(columns(line_, 8, 6)),
                   step = real_field(columns(line_, 14, 6));
        if (first && last && step && *step != 0 && std::abs(*first) <= limit && std::abs(*last) <= limit) {
            const double steps = (*last - *first) / *step;
            if (steps >= 1 && steps < 10000 && std::abs(steps - std::round(steps)) < 1e-6) {
                axis = {Angle::degrees(*first), Angle::degrees(*step),
                        static_cast<std::size_t>(std::lround(steps)) + 1};
                return true;
            }
        }
        return wrong(in_quotes(columns(line_, 0, 20)), fmt::format("first, last and step within {}°", limit));
    }

    Done grid_is_whole() {
        if (result_.latitude.count == 0 || result_.longitude.count == 0)
            return wrong("a header without a grid", "LAT1 / LAT2 / DLAT and LON1 / LON2 / DLON");
        if (result_.latitude.count * result_.longitude.count > ionex_most_values)
            return wrong("a grid too fine to read", fmt::format("at most {} values a map", ionex_most_values));
        return true;
    }

    Done body() {
        while (advance()) {
            if (label() == "START OF TEC MAP") {
                if (auto done = map(); !done) return done;
            } else if (label() == "START OF RMS MAP" || label() == "START OF HEIGHT MAP") {
                if (auto done = pass_over(); !done) return done;
            } else if (label() == "END OF FILE") {
                return true;
            } else if (label() == "EXPONENT") {
                if (auto done = exponent(); !done) return done;
            } else if (!is_blank(line_) && label() != "COMMENT") {
                return wrong(in_quotes(line_), "START OF TEC MAP or END OF FILE");
            }
        }
        return wrong("the end of the text", "END OF FILE");
    }

    Done pass_over() {
        const bool rms = label() == "START OF RMS MAP";
        const std::string_view end = rms ? "END OF RMS MAP" : "END OF HEIGHT MAP";
        while (advance())
            if (label() == end) return true;
        return wrong("the end of the file", end);
    }

    Done map() {
        IonosphereMap map;
        bool has_epoch = false;
        std::size_t row = 0;
        map.content_tecu.reserve(result_.latitude.count * result_.longitude.count);
        while (advance()) {
            Done done = true;
            if (label() == "EPOCH OF CURRENT MAP") {
                done = epoch(map);
                has_epoch = true;
            } else if (label() == "EXPONENT") {
                done = exponent();
            } else if (label() == "LAT/LON1/LON2/DLON/H") {
                done = parallel(map, row++);
            } else if (label() == "END OF TEC MAP") {
                if (row != result_.latitude.count || !has_epoch)
                    return wrong(fmt::format("a map {} an epoch, of {} parallels", has_epoch ? "with" : "without", row),
                                 fmt::format("an epoch and {} parallels", result_.latitude.count));
                result_.maps.push_back(std::move(map));
                return true;
            } else if (label() != "COMMENT") {
                done = wrong(in_quotes(line_), "an epoch, a parallel or END OF TEC MAP");
            }
            if (!done) return done;
        }
        return wrong("the end of the file", "END OF TEC MAP");
    }

    Done epoch(IonosphereMap& map) {
        std::array<int, 6> parts{};
        bool good = true;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const auto part = whole_field(columns(line_, 6 * i, 6));
            good = good && part;
            parts[i] = part.value_or(0);
        }
        const auto [year, month, day, hour, minute, second] = parts;
        // Midnight may be written as hour 24 of the day that it ends.
        if (hour == 24 && minute == 0 && second == 0) parts[3] = 0;
        const Result<UtcTime> utc = good ? parse_utc(fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", year, month,
                                                                 day, parts[3], minute, second))
                                         : Result<UtcTime>(fail(ErrorCode::input, ""));
        if (!utc) return wrong(in_quotes(columns(line_, 0, 36)), "year, month, day, hour, minute and second");
        // A day may have a leap second.
        map.time = to_gps_time(hour == 24 ? midnight_of(*utc, 1) : *utc, leap_seconds_);
        if (!result_.maps.empty() && map.time <= result_.maps.back().time)
            return wrong(in_quotes(columns(line_, 0, 36)), "an epoch after that of the map before");
        return true;
    }

    // The line that begins a parallel is at hand; its values follow.
    Done parallel(IonosphereMap& map, std::size_t row) {
        const auto latitude = real_field(columns(line_, 2, 6)), first = real_field(columns(line_, 8, 6)),
                   step = real_field(columns(line_, 20, 6));
        const double wanted = result_.latitude.first.deg() + static_cast<double>(row) * result_.latitude.step.deg();
        if (!latitude || !first || !step || row >= result_.latitude.count || std::abs(*latitude - wanted) > 1e-6 ||
            std::abs(*first - result_.longitude.first.deg()) > 1e-6 ||
            std::abs(*step - result_.longitude.step.deg()) > 1e-6)
            return wrong(in_quotes(columns(line_, 0, 32)), "the next parallel of the header's grid");
        for (std::size_t j = 0; j < result_.longitude.count; ++j) {
            if (j % ionex_values_per_line == 0 && !advance()) return wrong("the end of the file", "values of a map");
            const std::string_view field = columns(line_, 5 * (j % ionex_values_per_line), 5);
            const auto value = is_blank(field) ? std::nullopt : whole_field(field);
            if (!value) return wrong(in_quotes(field), "a whole number in each five columns");
            map.content_tecu.push_back(*value == ionex_no_value ? std::numeric_limits<double>::quiet_NaN()
                                                                : *value * unit_tecu_);
        }
        return true;
    }

    LineReader lines_;
    std::string_view name_;
    const LeapSeconds& leap_seconds_;
    std::string_view line_;
    double unit_tecu_ = 0.1;
    IonosphereMaps result_;
};

}  // namespace
}  // namespace rinex

Result<IonosphereMaps> read_ionex(std::string_view text, std::string_view name, const LeapSeconds& leap_seconds) {
    return rinex::IonexReading(text, name, leap_seconds).read();
}

Result<IonosphereMaps> read_ionex_file(const std::filesystem::path& path) {
    return read_text_with(path, [](std::string_view text, std::string_view name) { return read_ionex(text, name); });
}

}  // namespace skyloop::inline world
