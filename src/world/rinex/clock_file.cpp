#include "world/rinex/clock_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/core/files.hpp"
#include "detail/fields.hpp"

namespace skyloop::inline world {
namespace rinex {
namespace {

// The columns of versions 3.00 and 3.04 differ by five; in both, words are apart.
class ClockFileReading {
public:
    ClockFileReading(std::string_view text, std::string_view name) : lines_(text), name_(name) {}

    Result<PreciseClocks> read() {
        if (const Result<void> done = header(); !done) return fail(done.error());
        while (const std::optional<Line> line = lines_.next())
            if (const Result<void> taken = take(*line); !taken) return fail(taken.error());
        Nanoseconds spacing{0};
        for (const auto& [satellite, rows] : samples_)
            spacing = std::max(spacing, usual_spacing(rows));
        if (spacing == Nanoseconds(0))
            return refused(name_, lines_.number(), "no two clocks of a satellite", "records AS");
        return PreciseClocks(std::move(samples_), spacing);
    }

private:
    Result<void> header() {
        const std::optional<Line> first = lines_.next_filled();
        const auto words = first ? words_of(first->text) : std::vector<std::string_view>();
        const bool clocks = words.size() > 2 && words[1].starts_with('C') &&
                            first->text.find("RINEX VERSION / TYPE") != std::string_view::npos;
        const double version = clocks ? real_field(words[0]).value_or(0) : 0;
        if (!(version >= 2 && version < 4))
            return refused(name_, lines_.number(), first ? in_quotes(first->text) : "an empty file",
                           "a RINEX clock file of version 2 or 3");
        while (const std::optional<Line> line = lines_.next()) {
            if (line->text.find("END OF HEADER") != std::string_view::npos) return {};
            if (line->text.find("TIME SYSTEM ID") != std::string_view::npos)
                time_system_ = words_of(line->text).front();
        }
        return refused(name_, lines_.number(), "the end of the file", "END OF HEADER");
    }

    Result<void> take(const Line& line) {
        constexpr std::array<std::string_view, 5> passed_over{"AR", "CR", "DR", "MS", " "};
        if (is_blank(line.text) || std::any_of(passed_over.begin(), passed_over.end(),
                                               [&](auto start) { return line.text.starts_with(start); }))
            return {};
        const std::vector<std::string_view> words = words_of(line.text);
        // AS, the satellite, six words of the epoch, the number of values, the values.
        constexpr std::size_t least_words = 10;
        if (words.front() != "AS" || words.size() < least_words)
            return refused(name_, line.number, in_quotes(line.text),
                           "a clock: AS, a satellite, an epoch, the number of values, values");
        const auto time = calendar_epoch({whole_field(words[2]), whole_field(words[3]), whole_field(words[4]),
                                          whole_field(words[5]), whole_field(words[6]), real_field(words[7])},
                                         {});
        const auto clock = real_field(words[9]);
        if (!time) return refused(name_, line.number, in_quotes(line.text), "an epoch from 1980 to 2269");
        constexpr double largest_s = 1;
        if (!clock || std::abs(*clock) > largest_s)
            return refused(name_, line.number, in_quotes(words[9]), "a clock bias in seconds, up to 1");
        if (const auto satellite = parse_satellite(words[1])) return add(*satellite, *time, *clock, line);
        return {};
    }

    Result<void> add(SatelliteId satellite, GpsTime written, double clock, const Line& line) {
        const GpsTime time = epoch_in_gpst(written, time_system_);
        std::vector<ClockSample>& own = samples_[satellite];
        if (!own.empty() && own.back().time >= time)
            return refused(name_, line.number, in_quotes(line.text),
                           fmt::format("a later epoch of {} than the one before", to_string(satellite)));
        own.push_back({time, clock});
        return {};
    }

    // The shortest step: gaps are wider.
    static Nanoseconds usual_spacing(const std::vector<ClockSample>& rows) {
        Nanoseconds spacing{0};
        for (std::size_t i = 1; i < rows.size(); ++i) {
            const Nanoseconds step = rows[i].time - rows[i - 1].time;
            spacing = i == 1 ? step : std::min(spacing, step);
        }
        return spacing;
    }

    LineReader lines_;
    std::string_view name_;
    std::string_view time_system_ = "GPS";
    std::map<SatelliteId, std::vector<ClockSample>> samples_;
};

}  // namespace
}  // namespace rinex

Result<PreciseClocks> read_clocks(std::string_view text, std::string_view name) {
    return rinex::ClockFileReading(text, name).read();
}

Result<PreciseClocks> read_clock_file(const std::filesystem::path& path) { return read_text_with(path, read_clocks); }

}  // namespace skyloop::inline world
