#include "receiver/measurement/sbas_reception.hpp"

#include <chrono>
#include <utility>

namespace skyloop::inline receiver {
namespace {

// From a geostationary orbit it takes 119 to 140 ms.
constexpr std::chrono::milliseconds sbas_travel_time{130};
constexpr std::chrono::seconds sbas_longest_gap{10}, sbas_message_length{1};
// Of 250 bit/s behind a code of rate 1/2 errors are rare from here on (RTCA DO-229 asks for less than one message in a
// thousand at the lowest power); ours.
constexpr DbHz sbas_readable{28};

}  // namespace

void SbasReception::follow(const Observations& observations, GpsTime time) {
    std::map<SatelliteId, Heard> now;
    for (const Observation& o : observations.signals) {
        if (o.satellite.constellation != Constellation::sbas || o.signal != Signal::l1) continue;
        if (!o.pseudorange || o.cn0 < sbas_readable) continue;
        const auto before = heard_.find(o.satellite);
        now.emplace(o.satellite, Heard{before == heard_.end() ? time : before->second.since, o.called_unhealthy});
    }
    heard_ = std::move(now);
}

std::vector<Subframe> SbasReception::receive(const Observations& observations, SbasSource& sent, GpsTime time) {
    if (last_ && (time - *last_ > sbas_longest_gap || time < *last_)) {
        last_.reset();
        heard_.clear();
    }
    follow(observations, time);
    std::vector<Subframe> result;
    if (last_) {
        for (GpsTime end = std::chrono::ceil<std::chrono::seconds>(*last_ - sbas_travel_time);
             end + sbas_travel_time <= time; end += std::chrono::seconds(1)) {
            if (end + sbas_travel_time <= *last_) continue;
            for (const auto& [satellite, heard] : heard_) {
                if (end - sbas_message_length + sbas_travel_time < heard.since) continue;
                std::optional<SbasWords> words = sent.message(satellite, end);
                if (!words) continue;
                if (heard.unhealthy) words = encode_sbas(SbasDoNotUse{}, end - sbas_message_length);
                result.push_back({satellite, Signal::l1, end, 0, {words->begin(), words->end()}});
            }
        }
    }
    last_ = time;
    return result;
}

}  // namespace skyloop::inline receiver
