#include "world/rinex/almanac_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/core/words.hpp"
#include "detail/fields.hpp"

namespace skyloop::inline world {
namespace rinex {
namespace {

bool contains_word(std::string_view line, std::string_view word) {
    return lower_case(line).find(word) != std::string::npos;
}

// Unlike the columns of RINEX what stands here may be set with tabs.
constexpr std::string_view almanac_blanks = " \t";

// What an almanac says of one number, and what can be.
struct AlmanacRange {
    std::string_view name;
    double least, most;
};

enum AlmanacField {
    prn,
    health,
    eccentricity,
    toa,
    inclination,
    node_rate,
    sqrt_a,
    node,
    perigee,
    anomaly,
    af0,
    af1,
    week,
    ignored
};
constexpr std::size_t almanac_field_count = ignored;
using AlmanacValues = std::array<double, almanac_field_count>;

// In the order of a YUMA record; angles in radians.
constexpr std::array<AlmanacRange, almanac_field_count> almanac_ranges{{
    {"ID", 1, 202},
    {"Health", 0, 511},
    {"Eccentricity", 0, 0.5},
    {"Time of Applicability", 0, static_cast<double>(seconds_per_week)},
    {"Orbital Inclination", -7, 7},
    {"Rate of Right Ascen", -1e-5, 1e-5},
    {"SQRT(A)", 4000, 8000},
    {"Right Ascen at Week", -7, 7},
    {"Argument of Perigee", -7, 7},
    {"Mean Anom", -7, 7},
    {"Af0", -1, 1},
    {"Af1", -1e-6, 1e-6},
    {"week", 0, 8191},  // 13 bits, as CNAV counts them
}};

// The words for the first value that cannot be, or nothing.
std::optional<std::string> impossible(const AlmanacValues& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        const AlmanacRange& r = almanac_ranges[i];
        if (!(values[i] >= r.least && values[i] <= r.most))
            return fmt::format("{} between {} and {}", r.name, r.least, r.most);
    }
    constexpr int last_gps = 63, first_qzss = 193;
    if (values[prn] > last_gps && values[prn] < first_qzss) return "a PRN of GPS (1 to 63) or QZSS (193 to 202)";
    return std::nullopt;
}

KeplerEphemeris almanac_record(const AlmanacValues& v, GpsTime near) {
    constexpr int qzss_offset = 192;
    KeplerEphemeris e;
    const int number = static_cast<int>(v[prn]);
    e.satellite = number > qzss_offset ? SatelliteId{Constellation::qzss, number - qzss_offset}
                                       : SatelliteId{Constellation::gps, number};
    e.message = NavigationMessage::almanac;
    const auto stated = static_cast<std::int64_t>(v[week]);
    e.toe = to_gps_time(stated < 1024 ? resolve_week(stated, week_and_tow(near).week) : stated, v[toa]);
    e.toc = e.toe;
    e.health = static_cast<int>(v[health]);
    e.e = v[eccentricity];
    e.i0 = v[inclination];
    e.omega_dot = v[node_rate];
    e.sqrt_a = v[sqrt_a];
    e.omega0 = v[node];
    e.omega = v[perigee];
    e.m0 = v[anomaly];
    e.af0 = v[af0];
    e.af1 = v[af1];
    e.accuracy_m = -1;
    return e;
}

// "******** Week 862 almanac for PRN-01 ********" and thirteen lines "name: value", in any order.
class YumaReading {
public:
    YumaReading(std::string_view text, std::string_view name, GpsTime near) : lines_(text), name_(name), near_(near) {}

    Result<std::vector<KeplerEphemeris>> read() {
        for (std::optional<Line> line = lines_.next_filled(almanac_blanks); line;
             line = lines_.next_filled(almanac_blanks)) {
            Result<void> taken;
            if (line->text.find("**") != std::string_view::npos) {
                taken = finish();
                first_line_ = line->number;
            } else {
                taken = take(*line);
            }
            if (!taken) return fail(taken.error());
        }
        if (const Result<void> finished = finish(); !finished) return fail(finished.error());
        if (records_.empty()) return refused(name_, lines_.number(), "no record", "records of satellites");
        return std::move(records_);
    }

private:
    Result<void> take(const Line& line) {
        const std::size_t colon = line.text.find(':');
        const std::string_view key = trimmed(line.text.substr(0, colon), almanac_blanks);
        std::size_t field = 0;
        while (field < almanac_field_count && !key.starts_with(almanac_ranges[field].name))
            ++field;
        if (colon == std::string_view::npos || field == almanac_field_count || first_line_ == 0)
            return refused(name_, line.number, in_quotes(line.text), "a line such as 'Eccentricity: 0.01'");
        if (given_[field])
            return refused(name_, line.number, fmt::format("'{}' for the second time", almanac_ranges[field].name),
                           "one of each in a record");
        const std::string_view text = trimmed(line.text.substr(colon + 1), almanac_blanks);
        const std::optional<double> value = real_field(text);
        if (!value || text.empty())
            return refused(name_, line.number, in_quotes(text),
                           fmt::format("a number, {}", almanac_ranges[field].name));
        given_[field] = true;
        values_[field] = *value;
        return {};
    }

    // Ends the record at hand.
    Result<void> finish() {
        if (first_line_ == 0) return {};
        for (std::size_t i = 0; i < given_.size(); ++i)
            if (!given_[i])
                return refused(name_, first_line_, fmt::format("a record without '{}'", almanac_ranges[i].name),
                               "a record of 13 lines");
        if (const auto words = impossible(values_))
            return refused(name_, first_line_, "a record that no satellite sends", *words);
        records_.push_back(almanac_record(values_, near_));
        given_ = {};
        return {};
    }

    LineReader lines_;
    std::string_view name_;
    GpsTime near_;
    int first_line_ = 0;  // of the record at hand
    AlmanacValues values_{};
    std::array<bool, almanac_field_count> given_{};
    std::vector<KeplerEphemeris> records_;
};

// What a line of a SEM record tells, and the fields that its numbers go into.
struct SemLine {
    std::string_view what;
    std::size_t count;
    std::array<AlmanacField, 3> fields;
};
constexpr std::array<SemLine, 8> sem_lines{{
    {"a PRN", 1, {prn}},
    {"a satellite's vehicle number", 1, {ignored}},
    {"an accuracy index", 1, {ignored}},
    {"three numbers: eccentricity, inclination and node rate", 3, {eccentricity, inclination, node_rate}},
    {"three numbers: root of the semi-major axis, node and perigee", 3, {sqrt_a, node, perigee}},
    {"three numbers: mean anomaly, af0 and af1", 3, {anomaly, af0, af1}},
    {"the health", 1, {health}},
    {"the satellite's configuration", 1, {ignored}},
}};

// Number of records and a name; week and time of applicability; then eight lines for each satellite. Angles in
// semicircles, the inclination as its difference from 0.3.
class SemReading {
public:
    SemReading(std::string_view text, std::string_view name, GpsTime near) : lines_(text), name_(name), near_(near) {}

    Result<std::vector<KeplerEphemeris>> read() {
        const auto count = numbers("the number of records", 1, 2);
        if (!count) return fail(count.error());
        const auto time = numbers("the week and the time of applicability", 2, 2);
        if (!time) return fail(time.error());
        values_[week] = (*time)[0];
        values_[toa] = (*time)[1];
        std::vector<KeplerEphemeris> records;
        while (const std::optional<Line> ahead = peek()) {
            if (const Result<void> taken = satellite(); !taken) return fail(taken.error());
            if (const auto words = impossible(values_))
                return refused(name_, ahead->number, "a record that no satellite sends", *words);
            records.push_back(almanac_record(values_, near_));
        }
        if (static_cast<double>(records.size()) != (*count)[0])
            return refused(name_, lines_.number(), fmt::format("{} records", records.size()),
                           fmt::format("{}, as the first line says", (*count)[0]));
        if (records.empty()) return refused(name_, 1, "no records", "one at least");
        return records;
    }

private:
    std::optional<Line> peek() {
        LineReader ahead = lines_;
        return ahead.next_filled(almanac_blanks);
    }

    // The next line that is not empty: `count` numbers, three at most, and at most `most` words in all.
    Result<std::array<double, 3>> numbers(std::string_view what, std::size_t count, std::size_t most) {
        const std::optional<Line> line = lines_.next_filled(almanac_blanks);
        if (!line) return refused(name_, lines_.number(), "the end of the file", what);
        const std::vector<std::string_view> words = words_of(line->text);
        std::array<double, 3> values{};
        bool good = words.size() >= count && words.size() <= most;
        for (std::size_t i = 0; good && i < count; ++i) {
            const std::optional<double> value = real_field(words[i]);
            good = value.has_value();
            values[i] = value.value_or(0);
        }
        if (!good) return refused(name_, line->number, in_quotes(line->text), what);
        return values;
    }

    Result<void> satellite() {
        for (const SemLine& line : sem_lines) {
            const auto given = numbers(line.what, line.count, line.count);
            if (!given) return fail(given.error());
            for (std::size_t i = 0; i < line.count; ++i)
                if (line.fields[i] != ignored) values_[line.fields[i]] = (*given)[i];
        }
        values_[inclination] += 0.3;
        for (const AlmanacField angle : {inclination, node_rate, node, perigee, anomaly})
            values_[angle] *= std::numbers::pi;
        return {};
    }

    LineReader lines_;
    std::string_view name_;
    GpsTime near_;
    AlmanacValues values_{};
};

bool is_yuma(std::string_view text) {
    LineReader lines(text);
    const std::optional<Line> first = lines.next_filled(almanac_blanks);
    return first && first->text.starts_with('*') && contains_word(first->text, "almanac");
}

bool is_whole(std::string_view word) {
    return !word.empty() && std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_sem(std::string_view text) {
    LineReader lines(text);
    const std::optional<Line> first = lines.next_filled(almanac_blanks);
    const std::optional<Line> second = lines.next_filled(almanac_blanks);
    if (!first || !second) return false;
    const auto head = words_of(first->text);
    const auto time = words_of(second->text);
    return head.size() <= 2 && is_whole(head[0]) && time.size() == 2 && is_whole(time[0]) && is_whole(time[1]);
}

}  // namespace
}  // namespace rinex

bool is_almanac(std::string_view text) {
    const std::string_view unmarked = rinex::without_byte_order_mark(text);
    return rinex::is_yuma(unmarked) || rinex::is_sem(unmarked);
}

Result<std::vector<KeplerEphemeris>> read_almanac(std::string_view text, std::string_view name, GpsTime near) {
    text = rinex::without_byte_order_mark(text);
    if (rinex::is_yuma(text)) return rinex::YumaReading(text, name, near).read();
    if (rinex::is_sem(text)) return rinex::SemReading(text, name, near).read();
    return fail(ErrorCode::input, fmt::format("{}:1: found no almanac; expected YUMA or SEM", name));
}

}  // namespace skyloop::inline world
