#include "detail/nmea_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/time/utc_time.hpp"
#include "detail/fix_table.hpp"
#include "receiver/protocol/nmea_decode.hpp"
#include "receiver/protocol/nmea_satellites.hpp"

namespace skyloop {
namespace {

constexpr double half_day = 43200;
constexpr double day = 86400;

// The address of the sentence "$ttfff," that starts at a '$'; empty where none does.
std::string_view address_at(std::string_view text, std::size_t dollar) {
    constexpr std::size_t length = 5;
    if (dollar + length + 1 >= text.size() || text[dollar + length + 1] != ',') return {};
    const std::string_view address = text.substr(dollar + 1, length);
    const bool plain = std::all_of(address.begin(), address.end(),
                                   [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); });
    return plain ? address : std::string_view();
}

// Positions and dates; not a maker's own sentences, which begin with P.
bool wanted(std::string_view address) {
    return !address.starts_with('P') &&
           (address.ends_with("GGA") || address.ends_with("GNS") || address.ends_with("RMC"));
}

// Which satellites are used and how strong they are; a damaged one costs no fix.
bool of_satellites(std::string_view address) {
    return !address.starts_with('P') && (address.ends_with("GSV") || address.ends_with("GSA"));
}

std::size_t count_sentences(std::string_view text, bool (*kind)(std::string_view)) {
    std::size_t count = 0;
    for (std::size_t at = text.find('$'); at != std::string_view::npos; at = text.find('$', at + 1))
        if (kind(address_at(text, at))) ++count;
    return count;
}

double seconds_of_day(const NmeaTime& time) {
    return UtcTime{.hour = time.hour, .minute = time.minute, .second = time.second, .nanosecond = time.nanosecond}
        .seconds_of_day();
}

// A date and the time of day at which it was said.
struct DateMark {
    UtcTime midnight;
    double seconds = 0;
};

// The calendar knows which days end in a leap second.
UtcTime days_later(const UtcTime& midnight, int days) {
    return gps_calendar(gps_calendar_time(midnight.year, midnight.month, midnight.day, 0, 0, 0) +
                        std::chrono::days(days));
}

// What GGA and GNS say alike.
struct FixSentence {
    std::string source;  // talker and kind
    std::optional<double> seconds;
    bool valid = false;
    std::optional<NmeaPosition> position;
    std::optional<Metres> altitude, separation;
    int satellites = 0;
};

// GNS has a mode for each system; a fix is made with any of them.
std::optional<FixSentence> fix_sentence(const NmeaMessage& message) {
    const auto taken = [](const auto& said, const char* kind, bool valid) {
        return FixSentence{said.talker + kind,
                           said.time ? std::optional(seconds_of_day(*said.time)) : std::nullopt,
                           valid,
                           said.position,
                           said.altitude,
                           said.geoid_separation,
                           said.satellites_used};
    };
    if (const auto* gga = std::get_if<Gga>(&message)) return taken(*gga, "GGA", gga->quality != 0);
    if (const auto* gns = std::get_if<Gns>(&message))
        return taken(*gns, "GNS", std::any_of(gns->modes.begin(), gns->modes.end(), [](NmeaMode mode) {
            return mode != NmeaMode::none;
        }));
    return std::nullopt;
}

// One satellite of a GSV sentence. Since version 4.10 each of its signals has a list of its own.
struct ListedSignal {
    std::optional<Constellation> system;  // nothing: a number that no system has
    int signal_id = 0;                    // 0: not told
    SignalReport report;
};

// The signal of each system that tells its C/N0: the open one on L1 where the log has it, else the first by number, as
// BeiDou's B1C of receivers without B1I.
class FirstSignals {
public:
    void add(const ListedSignal& signal) {
        if (signal.signal_id == 0) return;
        const int on_l1 = signal.system ? nmea_system(*signal.system, NmeaVersion::v4_11).l1_signal_id : 1;
        int& first = ids_.try_emplace(signal.system, signal.signal_id).first->second;
        if (first != on_l1) first = signal.signal_id == on_l1 ? on_l1 : std::min(first, signal.signal_id);
    }
    [[nodiscard]] bool holds(const ListedSignal& signal) const {
        return signal.signal_id == 0 || ids_.at(signal.system) == signal.signal_id;
    }

private:
    std::map<std::optional<Constellation>, int> ids_;
};

// Takes a log line by line and keeps what the next one needs.
class NmeaLogReader {
public:
    explicit NmeaLogReader(const std::string& name) { series_.name = name; }
    FixSeries read(std::string_view text);

private:
    void take_line(std::string_view line);
    void take_sentence(std::string_view sentence);
    void take_fix(const FixSentence& said);
    bool is_of_last_epoch(const FixSentence& said) const;
    bool take_satellites(std::string_view sentence);
    void take_signals(const Gsv& gsv);
    void tell_signals();
    void finish_epoch();
    void take_rmc(const Rmc& rmc);
    void date_samples();
    void add_warnings();

    FixSeries series_;
    SentenceSplitter splitter_;
    std::size_t line_ = 1;
    std::size_t damaged_ = 0, without_checksum_ = 0, damaged_of_satellites_ = 0, senseless_ = 0;
    std::string first_senseless_;             // and where it stands
    int listed_used_ = 0;                     // by the GSA sentences of the last sample
    std::vector<ListedSignal> before_first_;  // before the first sample
    FirstSignals first_signals_;
    // For each sample its time of day, the number of dates said before it, what its position lacks, and its signals.
    struct Epoch {
        std::optional<double> seconds;
        std::size_t dates_before = 0;
        bool without_altitude = false, without_separation = false;
        std::vector<ListedSignal> signals{};
    };
    std::vector<Epoch> epochs_;
    std::vector<std::string> sources_;  // of the last sample
    std::vector<DateMark> dates_;
};

FixSeries NmeaLogReader::read(std::string_view text) {
    while (!text.empty()) {
        // Loggers end lines in LF, CR, CR LF and even CR CR LF.
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        take_line(text.substr(0, end));
        if (end < text.size() && text[end] == '\n') ++line_;
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    finish_epoch();
    date_samples();
    tell_signals();
    add_warnings();
    return std::move(series_);
}

void NmeaLogReader::take_line(std::string_view line) {
    std::size_t begun = count_sentences(line, wanted);
    std::size_t begun_of_satellites = count_sentences(line, of_satellites);
    if (begun + begun_of_satellites == 0) return;
    for (const std::string& sentence : splitter_.feed(to_bytes(std::string(line) + '\n'))) {
        if (of_satellites(address_at(sentence, 0))) {
            if (take_satellites(sentence)) --begun_of_satellites;
            continue;
        }
        if (!wanted(address_at(sentence, 0))) continue;
        --begun;
        take_sentence(sentence);
    }
    damaged_ += begun;  // what the splitter has thrown away
    damaged_of_satellites_ += begun_of_satellites;
}

void NmeaLogReader::take_sentence(std::string_view sentence) {
    const std::size_t star = sentence.find('*');
    // Loggers may write something of their own behind the checksum.
    const Result<SentenceView> view =
        parse_sentence(sentence.substr(0, star == std::string_view::npos ? star : star + 3));
    if (!view) {
        ++(star == std::string_view::npos ? without_checksum_ : damaged_);
        return;
    }
    const Result<NmeaMessage> message = decode_nmea(*view);
    if (!message) {
        if (senseless_++ == 0) first_senseless_ = fmt::format("line {}: {}", line_, message.error().message);
        return;
    }
    if (const auto said = fix_sentence(*message)) take_fix(*said);
    if (const auto* rmc = std::get_if<Rmc>(&*message)) take_rmc(*rmc);
}

// False for a sentence that is damaged or makes no sense. GSA and GSV follow GGA or GNS.
bool NmeaLogReader::take_satellites(std::string_view sentence) {
    const std::size_t star = sentence.find('*');
    const Result<NmeaMessage> message =
        decode_nmea(sentence.substr(0, star == std::string_view::npos ? star : star + 3));
    if (!message) return false;
    if (const auto* gsa = std::get_if<Gsa>(&*message)) listed_used_ += static_cast<int>(gsa->satellites.size());
    if (const auto* gsv = std::get_if<Gsv>(&*message)) take_signals(*gsv);
    return true;
}

void NmeaLogReader::take_signals(const Gsv& gsv) {
    std::vector<ListedSignal>& signals = epochs_.empty() ? before_first_ : epochs_.back().signals;
    for (const GsvSatellite& satellite : gsv.satellites) {
        if (!satellite.elevation_deg || !satellite.cn0_dbhz) continue;
        const auto id = satellite_from_nmea(satellite.number.value_or(0), gsv.talker);
        signals.push_back({id ? std::optional(id->constellation) : std::nullopt, gsv.signal_id.value_or(0),
                           SignalReport{Angle::degrees(*satellite.elevation_deg), DbHz(*satellite.cn0_dbhz)}});
        first_signals_.add(signals.back());
    }
}

// A satellite counts once, with the first signal of its system: the others differ from it in power by design.
void NmeaLogReader::tell_signals() {
    for (std::size_t i = 0; i < epochs_.size(); ++i)
        for (const ListedSignal& signal : epochs_[i].signals)
            if (first_signals_.holds(signal)) series_.samples[i].signals.push_back(signal.report);
}

// GGA of older versions shows at most 12 satellites; GSA of all systems together tell more.
void NmeaLogReader::finish_epoch() {
    if (!series_.samples.empty() && series_.samples.back().satellites_used)
        series_.samples.back().satellites_used = std::max(*series_.samples.back().satellites_used, listed_used_);
    listed_used_ = 0;
}

// Another talker or kind of sentence that tells the same time, or none; of one source each sentence is an epoch, even
// while the receiver's clock stands.
bool NmeaLogReader::is_of_last_epoch(const FixSentence& said) const {
    constexpr double same = 1e-3;  // s; sentences of one epoch may show different numbers of digits
    if (epochs_.empty() || std::find(sources_.begin(), sources_.end(), said.source) != sources_.end()) return false;
    const std::optional<double> before = epochs_.back().seconds;
    return !said.seconds || !before || std::abs(*said.seconds - *before) < same;
}

// Of several sentences of an epoch that is taken which has a fix, and the most satellites.
void NmeaLogReader::take_fix(const FixSentence& said) {
    FixSample sample;
    Epoch epoch{said.seconds, dates_.size()};
    sample.satellites_used = said.satellites;
    if (said.valid && said.position) {
        const Metres height = said.altitude.value_or(Metres(0)) + said.separation.value_or(Metres(0));
        const auto position =
            checked_position(said.position->latitude.deg(), said.position->longitude.deg(), height.value());
        if (!position && senseless_++ == 0)
            first_senseless_ = fmt::format("line {}: {} {}", line_, said.source.substr(2), position.error());
        sample.has_fix = position && said.altitude;
        epoch.without_altitude = position && !said.altitude;
        epoch.without_separation = sample.has_fix && !said.separation;
        if (sample.has_fix) sample.position = *position;
    }
    if (!is_of_last_epoch(said)) {
        finish_epoch();
        sources_ = {said.source};
        epoch.signals = std::exchange(before_first_, {});
        series_.samples.push_back(std::move(sample));
        epochs_.push_back(std::move(epoch));
        return;
    }
    sources_.push_back(said.source);
    FixSample& last = series_.samples.back();
    if (!epochs_.back().seconds) epochs_.back().seconds = said.seconds;
    if (std::pair(last.has_fix, last.satellites_used) >= std::pair(sample.has_fix, sample.satellites_used)) return;
    last = std::move(sample);
    epochs_.back().without_altitude = epoch.without_altitude;
    epochs_.back().without_separation = epoch.without_separation;
}

void NmeaLogReader::take_rmc(const Rmc& rmc) {
    if (!rmc.valid || !rmc.time || !rmc.date) return;
    dates_.push_back(
        {UtcTime{.year = rmc.date->year, .month = rmc.date->month, .day = rmc.date->day}, seconds_of_day(*rmc.time)});
}

// A sample belongs to the day that puts it within half a day of the last date said, or of the first one that follows.
// Without any date, days are counted from the start of the log.
void NmeaLogReader::date_samples() {
    series_.dated = !dates_.empty();
    double days = 0;
    double before = std::numeric_limits<double>::lowest();
    for (std::size_t i = 0; i < epochs_.size(); ++i) {
        if (!epochs_[i].seconds) continue;
        const double seconds = *epochs_[i].seconds;
        if (!series_.dated) {
            if (seconds < before - half_day) ++days;
            before = seconds;
            series_.samples[i].time = GpsTime(to_nanoseconds(Seconds(days * day + seconds)));
            continue;
        }
        const DateMark& mark = dates_[epochs_[i].dates_before == 0 ? 0 : epochs_[i].dates_before - 1];
        const int shift = seconds - mark.seconds > half_day ? -1 : mark.seconds - seconds > half_day ? 1 : 0;
        series_.samples[i].time =
            advanced(to_gps_time(days_later(mark.midnight, shift), LeapSeconds::announced()), Seconds(seconds));
    }
}

void NmeaLogReader::add_warnings() {
    const auto without = [&](bool Epoch::*what) {
        return std::count_if(epochs_.begin(), epochs_.end(), [&](const Epoch& epoch) { return epoch.*what; });
    };
    const auto without_altitude = without(&Epoch::without_altitude);
    const auto without_separation = without(&Epoch::without_separation);
    if (damaged_ > 0)
        series_.warnings.push_back(
            fmt::format("{}: {} GGA, GNS or RMC sentences with a wrong checksum or stray bytes were skipped",
                        series_.name, damaged_));
    if (without_checksum_ > 0)
        series_.warnings.push_back(fmt::format("{}: {} GGA, GNS or RMC sentences without a checksum were skipped",
                                               series_.name, without_checksum_));
    if (damaged_of_satellites_ > 0)
        series_.warnings.push_back(
            fmt::format("{}: {} damaged GSA or GSV sentences were skipped", series_.name, damaged_of_satellites_));
    if (senseless_ > 0)
        series_.warnings.push_back(fmt::format(
            "{}: {} GGA, GNS or RMC sentences with a right checksum that make no sense were skipped, the first in {}",
            series_.name, senseless_, first_senseless_));
    if (without_altitude > 0)
        series_.warnings.push_back(fmt::format("{}: {} positions without an altitude are not counted as fixes",
                                               series_.name, without_altitude));
    if (without_separation > 0)
        series_.warnings.push_back(
            fmt::format("{}: {} fixes without geoid separation; their heights are above sea level, "
                        "not above the ellipsoid",
                        series_.name, without_separation));
}

}  // namespace

bool has_nmea_sentence(std::string_view text) {
    constexpr std::size_t far_enough = std::size_t{1} << 16;
    const std::string_view start = text.substr(0, far_enough);
    for (std::size_t at = start.find('$'); at != std::string_view::npos; at = start.find('$', at + 1))
        if (!address_at(start, at).empty()) return true;
    return false;
}

FixSeries parse_nmea_log(std::string_view text, const std::string& name) { return NmeaLogReader(name).read(text); }

}  // namespace skyloop
