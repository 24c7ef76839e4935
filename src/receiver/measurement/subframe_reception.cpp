// Subframes as they come in, also of satellites that say that they are not to be used.
#include "receiver/measurement/subframe_reception.hpp"

#include <algorithm>
#include <chrono>
#include <set>

#include "world/flow/observations.hpp"
#include "world/gnss/broadcast_beidou.hpp"
#include "world/gnss/broadcast_cnav.hpp"
#include "world/gnss/broadcast_galileo.hpp"
#include "world/gnss/broadcast_glonass.hpp"
#include "world/gnss/broadcast_lnav.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline receiver {

/// A source whose records are unhealthy for the satellites that are observed as called unhealthy, in the bits of their
/// own system: data and all signals bad (IS-GPS-200, 20.3.3.3.1.4, of QZSS likewise), all signals out of service
/// (Galileo OS SIS ICD, as RINEX 3.05, table A8, keeps it), SatH1 of BeiDou, the first bit of B_n of GLONASS.
class WarnedBroadcast : public NavigationSource {
public:
    /// @param sent must outlive this
    WarnedBroadcast(const NavigationSource& sent, const Observations& observations);

    [[nodiscard]] std::vector<SatelliteId> satellites() const override { return sent_.satellites(); }
    [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId satellite, GpsTime time) const override;
    [[nodiscard]] const BroadcastIonosphere& ionosphere() const override { return sent_.ionosphere(); }
    [[nodiscard]] std::optional<TimeSpan> span() const override { return sent_.span(); }
    [[nodiscard]] std::string description() const override { return sent_.description(); }

private:
    const NavigationSource& sent_;
    std::set<SatelliteId> called_unhealthy_;
};

namespace {

int unhealthy_bits(Constellation constellation) {
    switch (constellation) {
        case Constellation::gps:
        case Constellation::qzss:
            return 0b111111;
        case Constellation::galileo:
            return 0b010'010'010;
        case Constellation::glonass:
            return 0b100;
        default:
            return 1;
    }
}

}  // namespace

WarnedBroadcast::WarnedBroadcast(const NavigationSource& sent, const Observations& observations) : sent_(sent) {
    for (const Observation& o : observations.signals)
        if (o.called_unhealthy) called_unhealthy_.insert(o.satellite);
}

std::optional<Ephemeris> WarnedBroadcast::ephemeris(SatelliteId satellite, GpsTime time) const {
    std::optional<Ephemeris> record = sent_.ephemeris(satellite, time);
    if (record && called_unhealthy_.contains(satellite))
        std::visit([&](auto& r) { r.health = unhealthy_bits(satellite.constellation); }, *record);
    return record;
}

namespace {

constexpr std::chrono::milliseconds travel_time{70};  // a medium one; the true one lies within 20 ms of it
constexpr std::chrono::seconds longest_gap{10};
constexpr std::chrono::seconds subframe_length{6}, page_length{2}, fnav_length{10};
using MessageGrid = std::chrono::duration<std::int64_t, std::ratio<1, 5>>;  // all messages end on it

// The number 1 … 5 of the subframe that ends with an instant, in frames of 30 s from the start of the week on.
std::optional<int> subframe_ending(Nanoseconds tow) {
    if (tow % subframe_length != Nanoseconds(0)) return std::nullopt;
    const auto count = (tow / subframe_length + 4) % 5;
    return static_cast<int>(count) + 1;
}

template <class Words>
std::vector<std::uint32_t> as_vector(const Words& words) {
    return {words.begin(), words.end()};
}

Nanoseconds length_of(SatelliteId satellite, Signal signal) {
    switch (satellite.constellation) {
        case Constellation::galileo:
            return signal == Signal::l5 ? fnav_length : page_length;
        case Constellation::glonass:
            return page_length;
        case Constellation::beidou:
            return is_beidou_geo(satellite) ? Nanoseconds(d2_subframe_length) : subframe_length;
        default:
            return signal == Signal::l2 || signal == Signal::l5 ? cnav_length(signal) : subframe_length;
    }
}

// What is needed to make a message.
struct Sender {
    const NavigationSource& sent;
    const LeapSeconds& leap_seconds;
    GpsTime end;
    GlonassAlmanacStrings& glonass_almanacs;
    OsnmaSender* osnma;  // null: no authentication

    [[nodiscard]] std::vector<std::uint32_t> lnav(const KeplerEphemeris& record) const {
        const auto subframe = subframe_ending(week_and_tow(end).tow);
        if (!subframe) return {};
        if (*subframe <= 3) return as_vector(lnav_ephemeris_subframe(record, *subframe, end));
        return as_vector(lnav_system_subframe({&sent, leap_seconds, record.satellite.constellation}, *subframe, end));
    }
    [[nodiscard]] std::vector<std::uint32_t> d1(const KeplerEphemeris& record) const {
        const auto subframe = subframe_ending(bdt_week_and_tow(end).tow);
        if (!subframe) return {};
        if (*subframe > 3) return as_vector(d1_system_subframe({&sent, leap_seconds}, *subframe, end));
        return as_vector(d1_subframe(record, sent.ionosphere().beidou, *subframe, end));
    }
    [[nodiscard]] std::vector<std::uint32_t> d2(const KeplerEphemeris& record) const {
        const auto page = d2_page_ending(end);
        if (!page) {
            const auto system = d2_system_subframe_ending({&sent, leap_seconds}, end);
            return system ? as_vector(*system) : std::vector<std::uint32_t>();
        }
        return as_vector(d2_page(record, sent.ionosphere().beidou, *page, end));
    }
    [[nodiscard]] std::vector<std::uint32_t> cnav(const KeplerEphemeris& record, Signal signal) const {
        const auto type = cnav_type_ending(signal, end);
        if (!type) return {};
        return as_vector(cnav_message({record, sent.ionosphere(), leap_seconds}, *type, signal, end));
    }
    [[nodiscard]] std::vector<std::uint32_t> fnav(const KeplerEphemeris& record) const {
        const auto page = fnav_page_ending(record.satellite, end);
        if (!page) return {};
        return as_vector(fnav_page({record, sent.ionosphere(), leap_seconds, &sent}, *page, end));
    }
    [[nodiscard]] std::vector<std::uint32_t> inav(const KeplerEphemeris& record, Signal signal) const {
        const auto word = inav_word_ending(signal, end);
        if (!word) return {};
        InavData data{record, sent.ionosphere(), leap_seconds, &sent};
        if (osnma != nullptr && signal == Signal::l1)
            data.authentication = osnma->field(record.satellite, sent, leap_seconds, end - page_length);
        return as_vector(inav_pages(data, *word, end));
    }
    [[nodiscard]] std::vector<std::uint32_t> words(const KeplerEphemeris& record, Signal signal) const {
        const std::vector<std::uint32_t> nothing;
        if (record.message == NavigationMessage::almanac) return nothing;
        switch (record.satellite.constellation) {
            case Constellation::gps:
            case Constellation::qzss:
                if (signal == Signal::l1) return lnav(record);
                return signal == Signal::l2 || signal == Signal::l5 ? cnav(record, signal) : nothing;
            case Constellation::galileo:
                if (signal == Signal::l5) return fnav(record);
                return signal == Signal::l1 || signal == Signal::e5b ? inav(record, signal) : nothing;
            case Constellation::beidou:
                if (signal != Signal::b1i) return nothing;
                return is_beidou_geo(record.satellite) ? d2(record) : d1(record);
            default:
                return nothing;
        }
    }
    [[nodiscard]] std::vector<std::uint32_t> words(const GlonassEphemeris& record, Signal signal) const {
        const auto string = glonass_string_ending(end, leap_seconds);
        constexpr int last_of_record = 5;
        if (signal != Signal::g1 || !string) return {};
        if (*string > last_of_record) return as_vector(glonass_almanacs.at(sent, record, *string, end, leap_seconds));
        return as_vector(glonass_string(record, *string, end, leap_seconds));
    }
    [[nodiscard]] static std::vector<std::uint32_t> words(const SbasEphemeris&, Signal) { return {}; }
};

// How long a receiver listens until a message ends by which it has a whole record; nothing for other messages. LNAV and
// D1: subframes 1 to 3; D2: pages 1 to 10; I/NAV: words 1 to 5, of E1-B from word 2 to word 5, of E5b-I from word 1 to
// word 4 (OS SIS ICD 2.1, tables 40 and 41); GLONASS: strings 1 to 5. CNAV and F/NAV bring none: who has them has a
// record by L1 or E1.
std::optional<std::chrono::seconds> record_length(SatelliteId satellite, Signal signal, GpsTime end,
                                                  const LeapSeconds& leap_seconds) {
    const auto when = [](bool whole, int seconds) {
        return whole ? std::optional(std::chrono::seconds(seconds)) : std::nullopt;
    };
    switch (satellite.constellation) {
        case Constellation::gps:
        case Constellation::qzss:
            return when(signal == Signal::l1 && subframe_ending(week_and_tow(end).tow) == 3, 18);
        case Constellation::beidou:
            if (is_beidou_geo(satellite)) return when(d2_page_ending(end) == d2_page_count, 30);
            return when(subframe_ending(bdt_week_and_tow(end).tow) == 3, 18);
        case Constellation::galileo:
            if (signal == Signal::l5) return std::nullopt;
            return when(inav_word_ending(signal, end) == (signal == Signal::l1 ? 5 : 4), 30);
        case Constellation::glonass:
            return when(glonass_string_ending(end, leap_seconds) == 5, 10);
        default:
            return std::nullopt;
    }
}

}  // namespace

std::optional<Subframe> SubframeReception::message(const Tracked& tracked, const NavigationSource& sent, GpsTime end) {
    const auto& [satellite, signal] = tracked;
    const std::optional<Ephemeris> record = sent.ephemeris(satellite, end);
    if (!record) return std::nullopt;
    const Sender sender{sent, leap_seconds_, end, glonass_almanacs_, osnma_ ? &*osnma_ : nullptr};
    Subframe result{satellite, signal, end, 0, {}};
    result.words = std::visit([&](const auto& r) { return sender.words(r, tracked.second); }, *record);
    if (result.words.empty()) return std::nullopt;
    if (const auto* glonass = std::get_if<GlonassEphemeris>(&*record))
        result.frequency_channel = glonass->frequency_channel;
    return result;
}

void SubframeReception::follow(const Observations& observations, GpsTime time) {
    std::map<Tracked, GpsTime> now;
    for (const Observation& o : observations.signals) {
        if (!o.pseudorange) continue;
        const Tracked tracked{o.satellite, o.signal};
        const auto before = tracked_since_.find(tracked);
        now.emplace(tracked, before == tracked_since_.end() ? time : before->second);
    }
    tracked_since_ = std::move(now);
}

std::vector<Subframe> SubframeReception::receive(const Observations& observations, const NavigationSource& sent,
                                                 GpsTime time) {
    if (last_ && (time - *last_ > longest_gap || time < *last_)) {
        last_.reset();
        tracked_since_.clear();
    }
    follow(observations, time);
    const WarnedBroadcast broadcast(sent, observations);
    std::vector<Subframe> result;
    if (last_) {
        for (GpsTime end = std::chrono::ceil<MessageGrid>(*last_ - travel_time); end + travel_time <= time;
             end += MessageGrid(1)) {
            if (end + travel_time <= *last_) continue;
            const bool whole_second = end.time_since_epoch() % std::chrono::seconds(1) == Nanoseconds(0);
            for (const auto& [tracked, since] : tracked_since_) {
                if (!whole_second && !is_beidou_geo(tracked.first)) continue;
                if (end - length_of(tracked.first, tracked.second) + travel_time < since) continue;
                auto received = message(tracked, broadcast, end);
                if (!received) continue;
                const auto length = record_length(tracked.first, tracked.second, end, leap_seconds_);
                if (length && end - *length + travel_time >= since)
                    received->record = broadcast.ephemeris(tracked.first, end);
                result.push_back(std::move(*received));
            }
        }
    }
    last_ = time;
    return result;
}

}  // namespace skyloop::inline receiver
