/// Pages of Galileo's E1-B as satellites with OSNMA send them, and a client that hears them.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "support/four_systems.hpp"
#include "support/osnma_client.hpp"
#include "world/flow/epoch.hpp"
#include "world/gnss/broadcast_galileo.hpp"
#include "world/osnma/osnma_sender.hpp"

namespace skyloop::test {

/// The text between two tags of the file of keys.
inline std::string told_in(const std::string& xml, const std::string& before, const std::string& after) {
    const std::size_t at = xml.find(before);
    if (at == std::string::npos) return {};
    return xml.substr(at + before.size(), xml.find(after, at + before.size()) - at - before.size());
}

inline std::string root_of(const std::string& xml) {
    return told_in(xml, "<j>4</j><i>0</i><lengthInBits>256</lengthInBits><x_ji>", "<");
}
inline std::string point_of(const std::string& xml, int number) {
    return told_in(xml, "<PKID>" + std::to_string(number) + "</PKID><lengthInBits>264</lengthInBits><point>", "<");
}

class OsnmaListener {
public:
    explicit OsnmaListener(const OsnmaSettings& settings)
        : keys(std::make_shared<const OsnmaKeys>(settings)), sender_(keys) {}

    /// Some satellites for so long, as their signals come in.
    /// @param change of the pages on their way
    void listen(
        OsnmaClient& client, GpsTime from, std::chrono::seconds length,
        const std::function<void(Epoch&)>& change = [](Epoch&) {}) {
        for (GpsTime start = from + std::chrono::seconds(1); start < from + length; start += std::chrono::seconds(2))
            for (const int number : {2, 3, 5, 9, 11}) {
                const GpsTime end = start + std::chrono::seconds(2);
                const SatelliteId id{Constellation::galileo, number};
                const auto record = std::get<KeplerEphemeris>(*source_.ephemeris(id, end));
                InavData data{record, source_.ionosphere(), LeapSeconds::announced(), &source_};
                data.authentication = sender_.field(id, source_, LeapSeconds::announced(), start);
                const InavWords pages = inav_pages(data, inav_word_ending(Signal::l1, end).value(), end);
                Epoch epoch;
                epoch.subframes.push_back({id, Signal::l1, end, 0, {pages.begin(), pages.end()}});
                change(epoch);
                const WeekAndTow at = gst_week_and_tow(start);
                client.take(number, at.week, at.tow / std::chrono::seconds(1), epoch.subframes[0].words);
            }
    }

    std::shared_ptr<const OsnmaKeys> keys;

private:
    test::FourSystems source_;
    OsnmaSender sender_;
};

}  // namespace skyloop::test
