#include "study/analysis/fix_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/core/files.hpp"
#include "base/core/std_additions.hpp"
#include "detail/run_tables.hpp"
#include "motion/tracks/read_track.hpp"
#include "receiver/observed/observed_log.hpp"
#include "receiver/protocol/nmea_satellites.hpp"

namespace skyloop::inline study {

void RunningStatistics::add(double value) {
    ++n_;
    const double from_old = value - mean_;
    mean_ += from_old / static_cast<double>(n_);
    squares_ += from_old * (value - mean_);
}

double RunningStatistics::std() const { return n_ < 2 ? 0 : std::sqrt(squares_ / static_cast<double>(n_ - 1)); }

void SignalStrengthByElevation::add(const SignalReport& report) {
    constexpr double rounding = 1e-9;  // degrees that the way through radians may cost
    const double degrees = report.elevation.deg() + rounding;
    const double cn0 = report.cn0.value();
    if (!(degrees >= 0 && degrees <= 90 + 2 * rounding) || !(cn0 > 0) || !std::isfinite(cn0)) return;
    bins_[std::min(static_cast<std::size_t>(degrees / bin_width_deg), bins - 1)].add(cn0);
}

bool SignalStrengthByElevation::empty() const {
    return std::all_of(bins_.begin(), bins_.end(), [](const RunningStatistics& bin) { return bin.n() == 0; });
}

namespace {

constexpr std::string_view known_formats =
    "fixes.csv, a table of lat,lon,height, a receiver's log (NMEA with GGA or GNS, UBX, SBF, ULog, DataFlash), an "
    "RTKLIB solution (.pos) or a track such as GPX";

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

// The signal of each system that tells its C/N0: the open one on L1 where the log has it, else the first by number, as
// BeiDou's B1C of receivers without B1I. Others differ from it in power by design.
class FirstSignals {
public:
    explicit FirstSignals(const ObservedLog& log) {
        for (const ObservedEpoch& epoch : log.epochs)
            for (const ObservedSignal& signal : epoch.signals)
                if (signal.number != 0) add(signal);
    }
    [[nodiscard]] bool holds(const ObservedSignal& signal) const {
        return signal.number == 0 || numbers_.at(signal.id.constellation) == signal.number;
    }

private:
    void add(const ObservedSignal& signal) {
        const int on_l1 = nmea_system(signal.id.constellation, NmeaVersion::v4_11).l1_signal_id;
        int& first = numbers_.try_emplace(signal.id.constellation, signal.number).first->second;
        if (first != on_l1) first = signal.number == on_l1 ? on_l1 : std::min(first, signal.number);
    }

    std::map<Constellation, int> numbers_;
};

FixSeries series_of(ObservedLog log) {
    const FirstSignals first(log);
    FixSeries series{log.name, {}, log.dated, std::nullopt, {}};
    for (const ObservedEpoch& epoch : log.epochs) {
        FixSample& sample = series.samples.emplace_back();
        if (epoch.timed) sample.time = epoch.time;
        sample.has_fix = epoch.place.has_value();
        if (epoch.place) sample.position = *epoch.place;
        sample.satellites_used = epoch.satellites_used;
        for (const ObservedSignal& signal : epoch.signals)
            if (signal.elevation_deg && first.holds(signal))
                sample.signals.push_back({Angle::degrees(*signal.elevation_deg), DbHz(signal.cn0_dbhz)});
    }
    for (const std::string& note : log.notes)
        series.warnings.push_back(fmt::format("{}: {}", log.name, note));
    return series;
}

FixSeries series_of(const Track& track) {
    FixSeries series{track.name, {}, track.origin.has_value(), std::nullopt, {}};
    for (const TrackRow& row : track.points) {
        FixSample& sample = series.samples.emplace_back();
        if (!track.route) sample.time = track.origin.value_or(GpsTime{}) + row.time;
        sample.has_fix = true;
        sample.position = to_geodetic(row.position);
    }
    for (const std::string& note : track.notes)
        series.warnings.push_back(fmt::format("{}: {}", track.name, note));
    return series;
}

// Something that a receiver may have sent, whole or not.
bool hints_at_receiver(std::string_view text) {
    if (text.find("\xB5\x62") != std::string_view::npos) return true;
    for (std::size_t at = text.find('$'); at != std::string_view::npos; at = text.find('$', at + 1))
        for (const std::string_view kind : {"GGA,", "GNS,", "RMC,", "GSV,", "GSA,"})
            if (text.substr(std::min(at + 3, text.size())).starts_with(kind)) return true;
    return false;
}

Result<FixSeries> series_of_table(std::string_view text, const std::string& name) {
    if (const auto at = first_binary_byte(text))
        return fail(ErrorCode::input, fmt::format("{}: is not text: byte {:#04x} at offset {}; expected {}", name,
                                                  static_cast<unsigned char>(text[*at]), *at, known_formats));
    return parse_fix_table(text, name);
}

Result<FixSeries> parse_by_content(std::string_view text, const std::string& name, const Geoid* geoid) {
    if (blank(text)) return fail(ErrorCode::input, fmt::format("{}: is empty; expected {}", name, known_formats));
    if (!rinex_label(text).empty()) return fail(rinex_refusal(text, name));
    const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    const auto observed = [&]() -> Result<FixSeries> {
        auto log = read_observed(bytes, name, {geoid, 0, ObservedUse::fixes});
        if (!log) return fail(log.error());
        return series_of(std::move(*log));
    };
    if (is_observed(bytes)) return observed();
    Result<FixSeries> table = series_of_table(text, name);
    if (table) return table;
    if (!is_track(bytes, name)) return hints_at_receiver(text) ? observed() : table;
    const auto track = read_track(bytes, name, {geoid, std::nullopt});
    if (!track) return fail(track.error());
    return series_of(*track);
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

Result<FixSeries> parse_fix_series(std::string_view text, const std::string& name, const Geoid* geoid) {
    Result<FixSeries> series = parse_by_content(text, name, geoid);
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

Result<FixSeries> read_fix_series(const std::filesystem::path& path, const Geoid* geoid) {
    const Result<std::string> text = read_text_file(path);
    if (!text) return fail(text.error());
    Result<FixSeries> series = parse_fix_series(*text, path.string(), geoid);
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

}  // namespace skyloop::inline study
