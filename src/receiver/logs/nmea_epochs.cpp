#include "detail/nmea_epochs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <type_traits>

#include "base/time/utc_time.hpp"
#include "receiver/protocol/nmea_decode.hpp"
#include "receiver/protocol/nmea_satellites.hpp"

namespace skyloop {
namespace {

constexpr double same_time_s = 1e-3;  // sentences of one epoch may show different numbers of digits

// Seconds of the day of the number hhmmss.ss.
std::optional<double> seconds_of_clock(std::optional<double> clock) {
    if (!clock || *clock < 0 || *clock >= 240000) return std::nullopt;
    const double hours = std::floor(*clock / 10000), minutes = std::floor(*clock / 100) - hours * 100;
    return hours * 3600 + minutes * 60 + (*clock - hours * 10000 - minutes * 100);
}

// The climb and attitude of another sentence.
void add_words(LogMotion& motion, const LogMotion& told) {
    if (told.climb) motion.climb = told.climb;
    if (told.heading) motion.heading = told.heading;
    if (told.roll) motion.roll = told.roll;
    if (told.pitch) motion.pitch = told.pitch;
}

double nmea_seconds(const NmeaTime& time) {
    return time.hour * 3600.0 + time.minute * 60.0 + time.second + time.nanosecond * 1e-9;
}

// NMEA 0183 v4.11, GGA, field 6; 3 is the precise service, 7 and 8 are set by hand and simulated.
FixType fix_type_of_quality(int quality) {
    switch (quality) {
        case 1:
        case 3:
        case 7:
        case 8:
            return FixType::fix_3d;
        case 2:
            return FixType::dgnss;
        case 4:
            return FixType::rtk_fixed;
        case 5:
            return FixType::rtk_float;
        case 6:
            return FixType::dead_reckoning;
        default:
            return FixType::none;
    }
}

FixType fix_type_of_mode(NmeaMode mode) {
    switch (mode) {
        case NmeaMode::none:
            return FixType::none;
        case NmeaMode::differential:
            return FixType::dgnss;
        case NmeaMode::estimated:
            return FixType::dead_reckoning;
        case NmeaMode::rtk_float:
            return FixType::rtk_float;
        case NmeaMode::rtk_fixed:
            return FixType::rtk_fixed;
        default:
            return FixType::fix_3d;
    }
}

}  // namespace

void NmeaEpochs::take(std::string_view sentence) {
    if (sentence.size() < 6) return;
    if (sentence[1] == 'P') return take_maker(sentence);
    const Result<NmeaMessage> message = decode_nmea(sentence);
    if (!message) {
        static constexpr std::string_view read[] = {"RMC", "GGA", "GNS", "GSA", "GSV", "ZDA"};
        const std::string_view kind = sentence.substr(3, 3);
        if (std::find(std::begin(read), std::end(read), kind) != std::end(read)) ++senseless_;
        return;
    }
    if (const auto* rmc = std::get_if<Rmc>(&*message)) take_rmc(*rmc);
    if (const auto* gga = std::get_if<Gga>(&*message)) take_gga(*gga);
    if (const auto* gns = std::get_if<Gns>(&*message)) take_gns(*gns);
    if (const auto* gsv = std::get_if<Gsv>(&*message)) take_gsv(*gsv);
    if (const auto* zda = std::get_if<Zda>(&*message)) {
        take_time(zda->time);
        if (row_ && zda->time && zda->date) row_->date = zda->date;
    }
    if (const auto* gsa = std::get_if<Gsa>(&*message); gsa && row_) {
        row_->two_dimensional |= gsa->fix_mode == 2;
        row_->listed_used += static_cast<int>(gsa->satellites.size());
    }
    take_motion(*message);
    const std::string talker(sentence.substr(1, 2));
    if (std::find(talkers_.begin(), talkers_.end(), talker) == talkers_.end()) talkers_.push_back(talker);
}

void NmeaEpochs::take_time(const std::optional<NmeaTime>& time) {
    if (!time) return;
    const double seconds = nmea_seconds(*time);
    if (row_ && std::abs(row_->seconds - seconds) < same_time_s) return;
    share_words(seconds);
}

// The next row begins, or none. Words of a time without a row, as of a faster sensor, are of the row before them, the
// first ones first, where it has none of its own.
void NmeaEpochs::share_words(std::optional<double> next_seconds) {
    LogMotion of_next, left;
    for (auto word = words_.rbegin(); word != words_.rend(); ++word) {
        const bool is_of_next = next_seconds && std::abs(word->seconds - *next_seconds) < same_time_s;
        add_words(is_of_next ? of_next : left, word->motion);
    }
    words_.clear();
    if (row_) {
        LogMotion& own = row_->epoch.motion;
        if (own.climb) left.climb.reset();
        if (own.roll) left.heading.reset(), left.roll.reset(), left.pitch.reset();
        add_words(own, left);
    }
    finish_row();
    if (!next_seconds) return;
    row_ = Row{};
    row_->seconds = *next_seconds;
    row_->epoch.motion = of_next;
}

void NmeaEpochs::take_rmc(const Rmc& rmc) {
    take_time(rmc.time);
    if (!row_ || !rmc.time) return;
    if (rmc.date) row_->date = rmc.date;
    if (rmc.speed) row_->epoch.motion.ground_speed = rmc.speed;
    if (rmc.course) row_->epoch.motion.course = rmc.course;
    take_ground(rmc.position);
    if (row_->has_gga) return;
    row_->position = rmc.position;
    row_->epoch.type = !rmc.valid ? FixType::none : rmc.mode ? fix_type_of_mode(*rmc.mode) : FixType::fix_3d;
}

void NmeaEpochs::take_gga(const Gga& gga) {
    take_time(gga.time);
    if (!row_ || !gga.time) return;
    row_->has_gga = true;
    take_ground(gga.position);
    row_->epoch.motion.altitude = gga.altitude;
    row_->epoch.motion.separation = gga.geoid_separation;
    row_->position = gga.position;
    row_->altitude = gga.altitude;
    row_->separation = gga.geoid_separation;
    row_->epoch.type = gga.position ? fix_type_of_quality(gga.quality) : FixType::none;
    row_->epoch.satellites_used = gga.satellites_used;
}

void NmeaEpochs::take_gns(const Gns& gns) {
    take_time(gns.time);
    if (!row_ || !gns.time || row_->has_gga) return;
    take_ground(gns.position);
    row_->epoch.motion.altitude = gns.altitude;
    row_->epoch.motion.separation = gns.geoid_separation;
    row_->position = gns.position;
    row_->altitude = gns.altitude;
    row_->separation = gns.geoid_separation;
    row_->epoch.satellites_used = gns.satellites_used;
    FixType best = FixType::none;
    for (const NmeaMode mode : gns.modes)
        best = std::max(best, fix_type_of_mode(mode));
    row_->epoch.type = gns.position ? best : FixType::none;
}

void NmeaEpochs::take_gsv(const Gsv& gsv) {
    if (!row_) return;
    row_->epoch.lists_satellites = true;
    for (const GsvSatellite& satellite : gsv.satellites) {
        if (!satellite.number || !satellite.cn0_dbhz) continue;
        const auto id = satellite_from_nmea(*satellite.number, gsv.talker);
        if (!id) continue;
        add_satellite(row_->epoch.satellites, {*id, static_cast<double>(*satellite.cn0_dbhz), satellite.elevation_deg});
    }
}

void NmeaEpochs::take_ground(const std::optional<NmeaPosition>& position) {
    if (!position) return;
    row_->epoch.motion.latitude = position->latitude;
    row_->epoch.motion.longitude = position->longitude;
}

// Sentences without a time are of the epoch before them.
void NmeaEpochs::take_motion(const NmeaMessage& message) {
    if (!row_) return;
    LogMotion& motion = row_->epoch.motion;
    if (const auto* vtg = std::get_if<Vtg>(&message)) {
        if (vtg->speed && !motion.ground_speed) motion.ground_speed = vtg->speed;
        if (vtg->course && !motion.course) motion.course = vtg->course;
    }
    if (const auto* hdt = std::get_if<Hdt>(&message); hdt && hdt->heading) motion.heading = hdt->heading;
    if (const auto* ths = std::get_if<Ths>(&message); ths && ths->heading && ths->mode != 'V')
        motion.heading = ths->heading;
}

// PUBX,00 (u-blox M8 interface description, 31.3.2): field 1 is the time, field 12 the velocity downwards, m/s. PASHR
// (Trimble and others, "attitude data"): time, true heading, T, roll and pitch, degrees, the right side down and the
// bow up positive.
void NmeaEpochs::take_maker(std::string_view sentence) {
    const auto parts = parse_sentence(sentence);
    if (!parts) return;
    const auto number = [&](std::size_t field) -> std::optional<double> {
        if (field >= parts->fields.size()) return std::nullopt;
        const std::string_view text = parts->fields[field];
        double value = 0;
        const std::size_t sign = text.starts_with('+') ? 1 : 0;
        const auto [end, status] = std::from_chars(text.data() + sign, text.data() + text.size(), value);
        const bool whole = status == std::errc() && end == text.data() + text.size() && std::isfinite(value);
        return whole ? std::optional(value) : std::nullopt;
    };
    LogMotion motion;
    if (parts->address == "PUBX" && !parts->fields.empty() && parts->fields[0] == "00") {
        if (const auto down = number(12); down && std::abs(*down) < 12000) motion.climb = MetresPerSecond(-*down);
        keep(seconds_of_clock(number(1)), motion);
    } else if (parts->address == "PASHR" && parts->fields.size() > 4 && parts->fields[2] == "T") {
        const auto heading = number(1), roll = number(3), pitch = number(4);
        if (!heading || !roll || !pitch) return;
        motion.heading = Angle::degrees(*heading);
        motion.roll = Angle::degrees(*roll);
        motion.pitch = Angle::degrees(*pitch);
        keep(seconds_of_clock(number(0)), motion);
    }
}

// Receivers differ in the order of their sentences: it may be of the epoch that begins behind it. Without a time it is
// of the one before.
void NmeaEpochs::keep(std::optional<double> seconds, const LogMotion& told) {
    const bool of_row = row_ && (!seconds || std::abs(row_->seconds - *seconds) < same_time_s);
    if (of_row) return add_words(row_->epoch.motion, told);
    if (seconds) words_.push_back({*seconds, told});
}

void NmeaEpochs::finish_row() {
    if (row_) rows_.push_back(std::move(*row_));
    row_.reset();
}

// Altitude and the sentence's own undulation undo what the receiver did (FEEDS.md 1.5).
void NmeaEpochs::place(Row& row) {
    LogEpoch& epoch = row.epoch;
    if (epoch.type == FixType::none || !row.position) return;
    if (row.two_dimensional && (epoch.type == FixType::fix_3d || epoch.type == FixType::dgnss))
        epoch.type = FixType::fix_2d;
    if (row.listed_used > epoch.satellites_used.value_or(0)) epoch.satellites_used = row.listed_used;
    if (!row.altitude) return static_cast<void>(++without_height_);
    const Angle latitude = row.position->latitude, longitude = row.position->longitude;
    if (!row.separation) ++without_separation_;
    const Metres undulation = row.separation ? *row.separation
                              : geoid_       ? geoid_->undulation(latitude, longitude)
                                             : Metres(0);
    epoch.place = logged_place(latitude.deg(), longitude.deg(), (*row.altitude + undulation).value());
    // Up is not told: two thirds of a velocity are none.
}

// Days of each row after the first one. The next day begins where the time of day falls by more than half a day
// (FEEDS.md 1.5). What a receiver says without a fix counts for those with one only where its clock runs on through it.
std::vector<int> NmeaEpochs::days_of_rows() const {
    constexpr double day = 86400, half_day = day / 2, late = 3600;  // a sentence may come late over midnight
    constexpr double longest_step = 3600;
    constexpr int most_days = 10000;  // more are nonsense, which finish_log() leaves out
    const auto days_from = [&](const Row& before, const Row& row) {
        const double step = row.seconds - before.seconds;
        return step < -half_day ? 1 : step > day - late ? -1 : 0;
    };
    std::vector<int> days(rows_.size(), 0);
    std::optional<std::size_t> placed;  // the last row with a fix
    bool runs_on = true;                // since then
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (i > 0) {
            const int change = days_from(rows_[i - 1], rows_[i]);
            days[i] = std::clamp(days[i - 1] + change, -most_days, most_days);
            const double step = rows_[i].seconds - rows_[i - 1].seconds + change * day;
            runs_on &= std::abs(step) <= longest_step;
        }
        if (!rows_[i].position || rows_[i].epoch.type == FixType::none) continue;
        if (placed && !runs_on) days[i] = days[*placed] + days_from(rows_[*placed], rows_[i]);
        placed = i;
        runs_on = true;
    }
    return days;
}

// A row without a date is dated by the one before that has one, those before the first date by that.
bool NmeaEpochs::date_rows() {
    const auto dated = std::find_if(rows_.begin(), rows_.end(), [](const Row& row) { return row.date.has_value(); });
    log_.dated = dated != rows_.end();
    if (!log_.dated && !for_track_) return false;
    const std::vector<int> days = days_of_rows();
    NmeaDate date = log_.dated ? *dated->date : NmeaDate{};
    int days_of_date = log_.dated ? days[static_cast<std::size_t>(dated - rows_.begin())] : 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        Row& row = rows_[i];
        if (row.date) date = *row.date, days_of_date = days[i];
        const UtcTime midnight = midnight_of({date.year, date.month, date.day}, days[i] - days_of_date);
        row.epoch.time = advanced(to_gps_time(midnight, LeapSeconds::announced()), Seconds(row.seconds));
    }
    return true;
}

Result<ReceiverLog> NmeaEpochs::finish(const std::string& name) {
    share_words(std::nullopt);
    if (!rows_.empty() && !date_rows())
        return fail(ErrorCode::input,
                    fmt::format("{}: {} epochs and no date in them; expected RMC or ZDA sentences with one", name,
                                rows_.size()));
    for (Row& row : rows_) {
        place(row);
        log_.epochs.push_back(std::move(row.epoch));
    }
    log_.format = "NMEA";
    if (!talkers_.empty()) {
        std::sort(talkers_.begin(), talkers_.end());
        log_.receiver = fmt::format("talkers {}", fmt::join(talkers_, ", "));
        log_.board = "nmea-generic";
    }
    add_note(log_, senseless_, "sentences with fields that make no sense were left out");
    if (for_track_) return std::move(log_);
    add_note(log_, without_height_, "fixes without an altitude have no place");
    add_note(log_, without_separation_,
             geoid_ ? "fixes without a geoid separation took it from EGM96"
                    : "fixes without a geoid separation: their heights above sea level stand for heights above the "
                      "ellipsoid, the geoid's grid not being there");
    return std::move(log_);
}

}  // namespace skyloop
