#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include "base/core/number_text.hpp"
#include "receiver/protocol/field_lister.hpp"

namespace skyloop::inline receiver {
namespace {

// The fields of a sentence by name. A name may end in /t time of day, /d date, /c coordinate (two fields), /k a speed
// in knots, /s text even where it looks like a number; `name{12}` is a list of so many fields, `name[a b]` groups as
// often as they fit, `-name` not shown.
struct SentenceNames {
    std::string_view formatter;  // of PUBX with its number
    std::string_view names;
};

// One line a sentence (NMEA 0183 version 4.11; PUBX: u-blox M8 interface description, 31.3).
constexpr auto sentence_table = std::to_array<SentenceNames>({
    {"RMC",
     "time/t status/s lat_deg/c lon_deg/c speed_mps/k course_deg date/d variation_deg variation_side/s mode/s "
     "navigation_status/s"},
    {"VTG", "course_deg -t course_magnetic_deg -m speed_mps/k -n speed_kmph -k mode/s"},
    {"GGA",
     "time/t lat_deg/c lon_deg/c quality satellites hdop msl_m -m geoid_separation_m -m correction_age_s "
     "station/s"},
    {"GNS",
     "time/t lat_deg/c lon_deg/c mode/s satellites hdop msl_m geoid_separation_m correction_age_s station/s "
     "navigation_status/s"},
    {"GSA", "mode/s fix_mode satellites{12} pdop hdop vdop system_id"},
    {"GSV", "pages page satellites_in_view satellites[number elevation_deg azimuth_deg cno_dbhz] signal_id/s"},
    {"GLL", "lat_deg/c lon_deg/c time/t status/s mode/s"},
    {"GST",
     "time/t range_rms_m semi_major_m semi_minor_m orientation_deg lat_deviation_m lon_deviation_m "
     "altitude_deviation_m"},
    {"ZDA", "time/t day month year zone_hours zone_minutes"},
    {"GBS",
     "time/t lat_error_m lon_error_m altitude_error_m failed_satellite missed_probability bias_m "
     "bias_deviation_m system_id signal_id/s"},
    {"DTM", "datum/s subdatum/s lat_offset_min lat_side/s lon_offset_min lon_side/s altitude_offset_m reference/s"},
    {"GRS", "time/t mode residuals_m{12} system_id signal_id/s"},
    {"VLW", "water_total_nmi -n water_nmi -n ground_total_nmi -n ground_nmi -n"},
    {"THS", "heading_deg mode/s"},
    {"HDT", "heading_deg -t"},
    {"HDG", "magnetic_heading_deg deviation_deg deviation_side/s variation_deg variation_side/s"},
    {"ROT", "rate_dpm status/s"},
    {"TXT", "count index type text/s"},
    {"PUBX-00",
     "-number time/t lat_deg/c lon_deg/c height_m status/s h_acc_m v_acc_m speed_kmph course_deg "
     "vel_down_mps correction_age_s hdop vdop tdop satellites -reserved dead_reckoning"},
    {"PUBX-03", "-number satellites_in_view satellites[sv_id status/s azimuth_deg elevation_deg cno_dbhz lock_time_s]"},
    {"PUBX-04", "-number time/t date/d tow_s week leap_seconds/s bias_ns drift_nsps pulse_granularity_ns"},
    {"PUBX-40", "-number message/s rates{6}"},
    {"PUBX-41", "-number port in_protocols/s out_protocols/s baud autobaud"},
});

bool all_digits(std::string_view text) { return text.find_first_not_of("0123456789") == text.npos; }

// No exponent: 1E5 is a name.
std::optional<double> decimal_number(std::string_view text) {
    const bool is_signed = text.starts_with('+') || text.starts_with('-');
    if (text.find_first_not_of(".0123456789", is_signed ? 1 : 0) != text.npos) return std::nullopt;
    return number_in<double>(text.starts_with('+') ? text.substr(1) : text);
}

DecodedValue plain_value(std::string_view text) {
    if (const auto whole = number_in<std::int64_t>(text)) return {*whole};
    if (const auto number = decimal_number(text)) return {*number};
    return {std::string(text)};
}

DecodedValue time_value(std::string_view text) {
    if (text.size() < 6 || !all_digits(text.substr(0, 6))) return {std::string(text)};
    return {fmt::format("{}:{}:{}", text.substr(0, 2), text.substr(2, 2), text.substr(4))};
}

DecodedValue date_value(std::string_view text) {
    if (text.size() != 6 || !all_digits(text)) return {std::string(text)};
    return {
        fmt::format("{}{}-{}-{}", text[4] >= '8' ? "19" : "20", text.substr(4), text.substr(2, 2), text.substr(0, 2))};
}

DecodedValue coordinate_value(std::string_view text, std::string_view side) {
    const auto number = decimal_number(text);
    if (!number || side.size() != 1) return {std::string(text)};
    const double whole = std::trunc(*number / 100);
    const double value = whole + (*number - 100 * whole) / 60;
    // Ten digits are more than any receiver sends; the rest would be dust of the division.
    const double rounded = std::round(value * 1e10) / 1e10;
    return {side[0] == 'S' || side[0] == 'W' ? -rounded : rounded};
}

DecodedValue knots_value(std::string_view text) {
    const auto number = decimal_number(text);
    if (!number) return {std::string(text)};
    return {std::round(*number * 1852.0 / 3600.0 * 1e6) / 1e6};
}

// A word of the names and what is behind it in brackets.
struct SentenceName {
    std::string_view name;
    char kind = 0;
    bool hidden = false;
    std::size_t list = 0;
    std::string_view group;
};

// Takes the next one off the front.
SentenceName sentence_name(std::string_view& names) {
    std::size_t end = std::min(names.find_first_of(" ["), names.size());
    if (end < names.size() && names[end] == '[') end = names.find(']') + 1;
    std::string_view word = names.substr(0, end);
    names.remove_prefix(std::min(end + 1, names.size()));
    SentenceName name;
    name.hidden = word.starts_with('-');
    if (name.hidden) word.remove_prefix(1);
    const std::size_t mark = word.find_first_of("/{[");
    name.name = word.substr(0, mark);
    if (mark == word.npos) return name;
    const std::string_view rest = word.substr(mark + 1);
    if (word[mark] == '/') name.kind = rest[0];
    if (word[mark] == '{') std::from_chars(rest.data(), rest.data() + rest.size(), name.list);
    if (word[mark] == '[') name.group = rest.substr(0, rest.size() - 1);
    return name;
}

// Takes a sentence's fields one after the other.
class SentenceLister {
public:
    explicit SentenceLister(const SentenceView& sentence) : sentence_(sentence) {}

    std::vector<DecodedField> list(std::string_view names) {
        std::vector<DecodedField> fields;
        while (!names.empty() && left() > 0) {
            const SentenceName name = sentence_name(names);
            if (!name.group.empty())
                fields.push_back({std::string(name.name), groups(name.group)});
            else if (name.list > 0)
                fields.push_back({std::string(name.name), several(name.list)});
            else if (DecodedValue value = one(name.kind); !name.hidden)
                fields.push_back({std::string(name.name), std::move(value)});
        }
        return fields;
    }
    /// Fields that no name told of.
    std::vector<DecodedValue> more() {
        std::vector<DecodedValue> values;
        while (left() > 0)
            values.push_back({std::string(take())});
        return values;
    }

private:
    [[nodiscard]] std::size_t left() const { return sentence_.fields.size() - at_; }
    std::string_view take() { return left() > 0 ? sentence_.fields[at_++] : std::string_view(); }
    DecodedValue one(char kind) {
        const std::string_view text = take();
        const std::string_view side = kind == 'c' ? take() : std::string_view();
        if (text.empty()) return {};
        if (kind == 't') return time_value(text);
        if (kind == 'd') return date_value(text);
        if (kind == 'c') return coordinate_value(text, side);
        if (kind == 'k') return knots_value(text);
        if (kind == 's') return {std::string(text)};
        return plain_value(text);
    }
    // Empty fields at the end are left out: the list is filled up with them. Those before a value keep its place, since
    // the n-th residual of GRS is that of the n-th satellite of GSA.
    DecodedValue several(std::size_t count) {
        std::vector<DecodedValue> values;
        for (; count > 0 && left() > 0; --count)
            values.push_back(one(0));
        while (!values.empty() && values.back().content.index() == 0)
            values.pop_back();
        return {std::move(values)};
    }
    DecodedValue groups(std::string_view names) {
        std::size_t size = 1;
        for (const char c : names)
            size += c == ' ' ? 1 : 0;
        std::vector<DecodedValue> values;
        while (left() >= size)
            values.push_back({group(names)});
        return {std::move(values)};
    }
    std::vector<DecodedField> group(std::string_view names) {
        std::vector<DecodedField> fields;
        while (!names.empty()) {
            const SentenceName name = sentence_name(names);
            fields.push_back({std::string(name.name), one(name.kind)});
        }
        return fields;
    }

    const SentenceView& sentence_;
    std::size_t at_ = 0;
};

}  // namespace

void list_nmea(const SentenceView& sentence, DecodedMessage& message) {
    message.id = std::string(sentence.address);
    const bool pubx = sentence.address == "PUBX";
    const std::string key = pubx ? "PUBX-" + std::string(sentence.field(0)) : std::string(sentence.formatter());
    SentenceLister lister(sentence);
    for (const SentenceNames& known : sentence_table) {
        if (known.formatter != key || (sentence.talker() == "P" && !pubx)) continue;
        message.name = pubx ? key : message.id;
        message.fields = lister.list(known.names);
    }
    std::vector<DecodedValue> more = lister.more();
    if (!more.empty()) message.fields.push_back({message.name.empty() ? "fields" : "more", {std::move(more)}});
}

}  // namespace skyloop::inline receiver
