#include "study/analysis/fix_series.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/core/middle.hpp"
#include "base/core/text_file.hpp"
#include "detail/fix_table.hpp"
#include "detail/nmea_log.hpp"
#include "detail/rtklib_solution.hpp"
#include "detail/satellites_table.hpp"
#include "detail/ubx_log.hpp"

namespace skyloop {
namespace {

constexpr std::string_view known_formats =
    "fixes.csv, a table of lat,lon,height, an NMEA log with GGA or GNS sentences, a UBX log or an RTKLIB solution "
    "(.pos)";

// The median of the times between neighbours, so that a pause in the log does not matter.
std::optional<Seconds> sampling_interval(const std::vector<FixSample>& samples) {
    std::vector<Nanoseconds> steps;
    for (std::size_t i = 1; i < samples.size(); ++i)
        if (samples[i].time && samples[i - 1].time && *samples[i].time > *samples[i - 1].time)
            steps.push_back(*samples[i].time - *samples[i - 1].time);
    if (steps.empty()) return std::nullopt;
    return to_seconds(middle_of(steps));
}

bool blank(std::string_view text) { return text.find_first_not_of(" \t\r\n") == std::string_view::npos; }

char quoted_letter(char c) { return c >= ' ' && c <= '~' ? c : '?'; }

// The label of the first line of a RINEX file, plain or in Hatanaka's compact form; empty where it is none.
std::string_view rinex_label(std::string_view text) {
    constexpr std::size_t label_column = 60;
    const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
    if (line.size() <= label_column) return {};
    const std::string_view label = line.substr(label_column);
    return label.starts_with("RINEX VERSION / TYPE") || label.starts_with("CRINEX VERS") ? label : std::string_view();
}

Error rinex_refusal(std::string_view text, const std::string& name) {
    constexpr std::size_t type_column = 20;
    if (rinex_label(text).starts_with("CRINEX"))
        return {
            ErrorCode::input,
            fmt::format("{}: is a compact RINEX observation file (Hatanaka), which holds measurements and no fixes; "
                        "crx2rnx unpacks it, and `skyloop solve` makes fixes of what it unpacks",
                        name)};
    if (text[type_column] != 'O')
        return {ErrorCode::input, fmt::format("{}: is a RINEX file without observations (type '{}'), which holds no "
                                              "fixes; expected {}",
                                              name, quoted_letter(text[type_column]), known_formats)};
    return {ErrorCode::input,
            fmt::format("{}: is a RINEX observation file, which holds measurements and no fixes; `skyloop solve {}` "
                        "makes fixes of them",
                        name, name)};
}

// The place of the first byte that no text file has, or nothing.
std::optional<std::size_t> first_binary_byte(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if ((byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r' && byte != 0x1A) || byte == 0x7F) return i;
    }
    return std::nullopt;
}

FixSeries without_samples(const FixSeries& series) {
    return {series.name, {}, series.dated, series.interval, series.warnings};
}

// Of a log that holds both: UBX, which tells more, unless a few polled messages stand in a log of NMEA. It is told.
FixSeries richer(FixSeries ubx, FixSeries nmea) {
    constexpr std::size_t many_more = 2;
    const bool of_nmea = nmea.fixes() > many_more * ubx.fixes();
    FixSeries& taken = of_nmea ? nmea : ubx;
    const std::size_t others = (of_nmea ? ubx : nmea).fixes();
    if (others > (of_nmea ? 0 : taken.fixes()))
        taken.warnings.push_back(fmt::format("{}: the {} fixes of {} are taken; {} tell {}", taken.name, taken.fixes(),
                                             of_nmea ? "NMEA" : "UBX", of_nmea ? "UBX messages" : "NMEA sentences",
                                             others));
    return std::move(taken);
}

Result<FixSeries> parse_by_content(std::string_view text, const std::string& name) {
    if (blank(text)) return fail(ErrorCode::input, fmt::format("{}: is empty; expected {}", name, known_formats));
    if (!rinex_label(text).empty()) return fail(rinex_refusal(text, name));
    std::size_t ubx_messages = 0;
    if (has_ubx_sync(text)) {
        UbxLog log = parse_ubx_log(text, name);
        if (!log.series.samples.empty())
            return has_nmea_sentence(text) ? richer(std::move(log.series), parse_nmea_log(text, name))
                                           : std::move(log.series);
        ubx_messages = log.messages;
    }
    if (has_nmea_sentence(text)) return parse_nmea_log(text, name);
    if (ubx_messages > 0 || text.starts_with("\xB5\x62"))
        return fail(ErrorCode::input,
                    fmt::format("{}: is a UBX log (bytes B5 62) without a position in its {} whole messages; expected "
                                "NAV-PVT, NAV-SOL or NAV-POSLLH",
                                name, ubx_messages));
    if (is_rtklib_solution(text)) return parse_rtklib_solution(text, name);
    if (const auto at = first_binary_byte(text))
        return fail(ErrorCode::input, fmt::format("{}: is not text: byte {:#04x} at offset {}; expected {}", name,
                                                  static_cast<unsigned char>(text[*at]), *at, known_formats));
    return parse_fix_table(text, name);
}

}  // namespace

std::size_t FixSeries::fixes() const {
    return static_cast<std::size_t>(
        std::count_if(samples.begin(), samples.end(), [](const FixSample& s) { return s.has_fix; }));
}

SignalStrengthByElevation FixSeries::signal_strength() const {
    SignalStrengthByElevation strengths;
    for (const FixSample& sample : samples)
        for (const SignalReport& report : sample.signals)
            strengths.add(report);
    return strengths;
}

Result<FixSeries> parse_fix_series(std::string_view text, const std::string& name) {
    Result<FixSeries> series = parse_by_content(text, name);
    if (!series) return series;
    if (series->fixes() == 0) {
        std::string message =
            fmt::format("{}: holds no fix in {} rows; expected at least one", name, series->samples.size());
        for (const std::string& warning : series->warnings)
            message += "; " + warning;
        return fail(ErrorCode::input, std::move(message));
    }
    series->interval = sampling_interval(series->samples);
    return series;
}

Result<FixSeries> read_fix_series(const std::filesystem::path& path) {
    const Result<std::string> text = read_text_file(path);
    if (!text) return fail(text.error());
    Result<FixSeries> series = parse_fix_series(*text, path.string());
    if (series) add_satellites_beside(path, *series);
    return series;
}

FixSeries without_truth(FixSeries series) {
    for (FixSample& sample : series.samples)
        sample.truth.reset();
    return series;
}

FixSeries slice(const FixSeries& series, const Slice& slice) {
    FixSeries part = without_samples(series);
    const std::size_t step = std::max<std::size_t>(slice.every, 1);
    std::size_t left_out = 0, fixes = 0, gaps = 0, kept = 0;
    for (const FixSample& sample : series.samples) {
        if (left_out < slice.offset) {
            if (sample.has_fix) ++left_out;
            continue;
        }
        if ((sample.has_fix ? fixes : gaps)++ % step != 0) continue;
        part.samples.push_back(sample);
        if (sample.has_fix && ++kept == slice.count) break;
    }
    if (part.interval) part.interval = *part.interval * static_cast<double>(step);
    return part;
}

std::vector<FixSeries> windows(const FixSeries& series, std::size_t length) {
    std::vector<FixSeries> parts;
    FixSeries part = without_samples(series);
    std::size_t fixes = 0;
    for (const FixSample& sample : series.samples) {
        part.samples.push_back(sample);
        if (!sample.has_fix || ++fixes < length) continue;
        part.name = fmt::format("{} window {}", series.name, parts.size() + 1);
        parts.push_back(std::move(part));
        part = without_samples(series);
        fixes = 0;
    }
    return parts;
}

}  // namespace skyloop
