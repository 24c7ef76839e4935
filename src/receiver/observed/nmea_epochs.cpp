#include "receiver/observed/nmea_epochs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/core/number_text.hpp"
#include "detail/observed_parts.hpp"
#include "receiver/protocol/nmea_messages.hpp"
#include "receiver/protocol/nmea_satellites.hpp"

namespace skyloop::inline receiver {
namespace {

// Of the number hhmmss.ss.
std::optional<Nanoseconds> time_of_clock(std::optional<double> clock) {
    if (!clock || *clock < 0 || *clock >= 240000) return std::nullopt;
    const double hours = std::floor(*clock / 10000), minutes = std::floor(*clock / 100) - hours * 100;
    return to_nanoseconds(Seconds(hours * 3600 + minutes * 60 + (*clock - hours * 10000 - minutes * 100)));
}

Nanoseconds time_of_day(const NmeaTime& time) {
    return std::chrono::seconds(time.hour * 3600 + time.minute * 60 + time.second) + Nanoseconds(time.nanosecond);
}

// The climb and attitude of another sentence.
void add_words(ObservedMotion& motion, const ObservedMotion& told) {
    if (told.climb) motion.climb = told.climb;
    if (told.heading) motion.heading = told.heading;
    if (told.roll) motion.roll = told.roll;
    if (told.pitch) motion.pitch = told.pitch;
}

// NMEA 0183 v4.11, GGA, field 6; 3 is the precise service, 7 and 8 are set by hand and simulated.
constexpr std::array quality_types{FixType::none,           FixType::fix_3d,    FixType::dgnss,
                                   FixType::fix_3d,         FixType::rtk_fixed, FixType::rtk_float,
                                   FixType::dead_reckoning, FixType::fix_3d,    FixType::fix_3d};

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

NmeaEpochs::Taken NmeaEpochs::take(std::string_view sentence) {
    constexpr std::size_t address = 6;
    if (sentence.size() < address) return {};
    if (sentence[1] == 'P') {
        take_maker(sentence);
        return std::exchange(taken_, {});
    }
    const Result<NmeaMessage> message = decode_nmea(sentence);
    if (message) {
        take_message(*message);
        const std::string talker(sentence.substr(1, 2));
        const auto at = std::lower_bound(talkers_.begin(), talkers_.end(), talker);
        if (at == talkers_.end() || *at != talker) talkers_.insert(at, talker);
    } else {
        static constexpr std::string_view read[] = {"RMC", "GGA", "GNS", "GSA", "GSV", "ZDA"};
        if (std::find(std::begin(read), std::end(read), sentence.substr(3, 3)) != std::end(read))
            taken_.mistake = message.error();
    }
    return std::exchange(taken_, {});
}

void NmeaEpochs::take_message(const NmeaMessage& message) {
    if (const auto* rmc = std::get_if<Rmc>(&message)) take_rmc(*rmc);
    if (const auto* said = std::get_if<Gga>(&message)) {
        taken_.part = says_gga;
        take_fix({said->talker + "GGA", said->time, numbered_type(quality_types, said->quality), said->position,
                  said->altitude, said->geoid_separation, said->satellites_used, said->hdop, said->quality});
    }
    // A fix is made with any of the systems.
    if (const auto* said = std::get_if<Gns>(&message)) {
        taken_.part = says_gns;
        FixType best = FixType::none;
        for (const NmeaMode mode : said->modes)
            best = std::max(best, fix_type_of_mode(mode));
        take_fix({said->talker + "GNS", said->time, best, said->position, said->altitude, said->geoid_separation,
                  said->satellites_used, said->hdop});
    }
    if (const auto* gsv = std::get_if<Gsv>(&message)) take_gsv(*gsv);
    if (const auto* zda = std::get_if<Zda>(&message)) {
        take_time(zda->time);
        if (under_way_ && zda->time && zda->date) under_way_->epoch.date = zda->date;
    }
    const auto* gsa = std::get_if<Gsa>(&message);
    if (gsa) fix_mode_ = gsa->fix_mode;
    if (gsa && under_way_) {
        under_way_->two_dimensional |= gsa->fix_mode == 2;
        under_way_->listed_used += static_cast<int>(gsa->satellites.size());
    }
    take_motion(message);
}

// Sentences of one epoch may show different numbers of digits.
bool NmeaEpochs::is_under_way(Nanoseconds of_day) const {
    constexpr Nanoseconds same = std::chrono::milliseconds(1);
    return under_way_ && under_way_->epoch.of_day && std::chrono::abs(*under_way_->epoch.of_day - of_day) < same;
}

void NmeaEpochs::take_time(const std::optional<NmeaTime>& time) {
    if (time && !is_under_way(time_of_day(*time))) begin(time_of_day(*time));
}

// Words of a time without an epoch, as of a faster sensor, are of the epoch before them, the first ones first, where it
// has none of its own.
void NmeaEpochs::begin(std::optional<Nanoseconds> of_day) {
    constexpr Nanoseconds same = std::chrono::milliseconds(1);
    ObservedMotion of_next, left;
    for (auto word = words_.rbegin(); word != words_.rend(); ++word) {
        const bool is_of_next = of_day && std::chrono::abs(word->of_day - *of_day) < same;
        add_words(is_of_next ? of_next : left, word->motion);
    }
    words_.clear();
    if (under_way_) {
        ObservedMotion& own = under_way_->epoch.told.motion;
        if (own.climb) left.climb.reset();
        if (own.roll) left.heading.reset(), left.roll.reset(), left.pitch.reset();
        add_words(own, left);
    }
    taken_.ended = epoch();
    under_way_ = UnderWay{};
    under_way_->epoch.of_day = of_day;
    under_way_->epoch.told.timed = of_day.has_value();
    under_way_->epoch.told.motion = of_next;
    under_way_->epoch.told.lists_satellites = !early_.empty();
    under_way_->epoch.told.signals = std::exchange(early_, {});
}

void NmeaEpochs::take_rmc(const Rmc& said) {
    take_time(said.time);
    if (!under_way_ || (!said.time && under_way_->epoch.of_day)) return;
    taken_.part = says_rmc;
    ObservedEpoch& told = under_way_->epoch.told;
    if (said.date) under_way_->epoch.date = said.date;
    if (said.speed) told.motion.ground_speed = said.speed;
    if (said.course) told.motion.course = said.course;
    told.claims_fix = said.valid;
    if (under_way_->sources.empty())
        told.type = !said.valid ? FixType::none : said.mode ? fix_type_of_mode(*said.mode) : FixType::fix_3d;
    if (!said.position || (told.is_solution && told.motion.latitude)) return;
    told.motion.latitude = said.position->latitude;
    told.motion.longitude = said.position->longitude;
}

void NmeaEpochs::take_fix(const FixSentence& said) {
    const auto seen = [&] {
        const auto& sources = under_way_->sources;
        return std::find(sources.begin(), sources.end(), said.source) != sources.end();
    };
    const bool goes_on =
        under_way_ && !seen() && (!said.time || !under_way_->epoch.of_day || is_under_way(time_of_day(*said.time)));
    if (!goes_on) begin(said.time ? std::optional(time_of_day(*said.time)) : std::nullopt);
    UnderWay& now = *under_way_;
    ObservedEpoch& told = now.epoch.told;
    if (!now.epoch.of_day && said.time) now.epoch.of_day = time_of_day(*said.time), told.timed = true;
    const FixType type = said.position ? said.type : FixType::none;
    const bool better = std::pair(type != FixType::none, std::optional(said.satellites)) >
                        std::pair(told.type != FixType::none, told.satellites_used);
    const bool first = now.sources.empty();
    now.sources.push_back(said.source);
    told.is_solution = true;
    if (!first && !better) return;
    told.type = type;
    told.satellites_used = said.satellites;
    told.hdop = said.hdop;
    told.quality = said.quality;
    told.motion.altitude = said.altitude;
    told.motion.separation = said.separation;
    if (!said.position) return;
    told.motion.latitude = said.position->latitude;
    told.motion.longitude = said.position->longitude;
}

void NmeaEpochs::take_gsv(const Gsv& gsv) {
    std::vector<ObservedSignal>& signals = under_way_ ? under_way_->epoch.told.signals : early_;
    if (under_way_) under_way_->epoch.told.lists_satellites = true;
    for (const GsvSatellite& satellite : gsv.satellites) {
        if (!satellite.number || !satellite.cn0_dbhz) continue;
        if (const auto id = satellite_from_nmea(*satellite.number, gsv.talker))
            add_signal(signals, {*id, static_cast<double>(*satellite.cn0_dbhz), satellite.elevation_deg,
                                 every_signal_ ? gsv.signal_id.value_or(0) : 0});
    }
}

// Sentences without a time are of the epoch before them.
void NmeaEpochs::take_motion(const NmeaMessage& message) {
    if (!under_way_) return;
    ObservedMotion& motion = under_way_->epoch.told.motion;
    if (const auto* said = std::get_if<Vtg>(&message)) {
        taken_.part = says_vtg;
        if (said->speed && !motion.ground_speed) motion.ground_speed = said->speed;
        if (said->course && !motion.course) motion.course = said->course;
    }
    const auto* hdt = std::get_if<Hdt>(&message);
    const auto* ths = std::get_if<Ths>(&message);
    if (!hdt && !ths) return;
    taken_.part = says_heading;
    if (hdt && hdt->heading) motion.heading = hdt->heading;
    if (ths && ths->heading && ths->mode != 'V') motion.heading = ths->heading;
}

// PUBX,00 (u-blox M8 interface description, 31.3.2): field 1 is the time, field 12 the velocity downwards, m/s. PASHR
// (Trimble and others, "attitude data"): time, true heading, T, roll and pitch, degrees, the right side down and the
// bow up positive.
void NmeaEpochs::take_maker(std::string_view sentence) {
    const auto parts = parse_sentence(sentence);
    if (!parts) return;
    const auto number = [&](std::size_t field) -> std::optional<double> {
        if (field >= parts->fields.size()) return std::nullopt;
        return signed_number_in<double>(parts->fields[field]);
    };
    ObservedMotion motion;
    if (parts->address == "PUBX" && !parts->fields.empty() && parts->fields[0] == "00") {
        if (const auto down = number(12); down && std::abs(*down) < 12000) motion.climb = MetresPerSecond(-*down);
        keep(time_of_clock(number(1)), motion);
    } else if (parts->address == "PASHR" && parts->fields.size() > 4 && parts->fields[2] == "T") {
        const auto heading = number(1), roll = number(3), pitch = number(4);
        if (!heading || !roll || !pitch) return;
        motion.heading = Angle::degrees(*heading);
        motion.roll = Angle::degrees(*roll);
        motion.pitch = Angle::degrees(*pitch);
        keep(time_of_clock(number(0)), motion);
    }
}

// Receivers differ in the order of their sentences: it may be of the epoch that begins behind it. Without a time it is
// of the one before.
void NmeaEpochs::keep(std::optional<Nanoseconds> of_day, const ObservedMotion& told) {
    if (under_way_ && (!of_day || is_under_way(*of_day))) return add_words(under_way_->epoch.told.motion, told);
    constexpr std::size_t most_words = 10000;
    if (of_day && words_.size() < most_words) words_.push_back({*of_day, told});
}

std::optional<NmeaEpoch> NmeaEpochs::epoch() const {
    if (!under_way_) return std::nullopt;
    NmeaEpoch epoch = under_way_->epoch;
    FixType& type = epoch.told.type;
    if (under_way_->two_dimensional && (type == FixType::fix_3d || type == FixType::dgnss)) type = FixType::fix_2d;
    if (under_way_->listed_used > epoch.told.satellites_used.value_or(0))
        epoch.told.satellites_used = under_way_->listed_used;
    if (!epoch.date || !epoch.of_day) return epoch;
    const auto day =
        std::chrono::year(epoch.date->year) / std::chrono::month(epoch.date->month) / std::chrono::day(epoch.date->day);
    if (!day.ok()) return epoch;
    const Nanoseconds since_1970 = std::chrono::sys_days(day).time_since_epoch() + *epoch.of_day;
    epoch.told.utc_s = to_seconds(since_1970).value();
    return epoch;
}

std::optional<NmeaEpoch> NmeaEpochs::end() {
    begin(std::nullopt);
    under_way_.reset();
    return std::exchange(taken_, {}).ended;
}

}  // namespace skyloop::inline receiver
