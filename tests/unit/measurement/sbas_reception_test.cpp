#include "receiver/measurement/sbas_reception.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace skyloop {
namespace {

using namespace std::chrono_literals;

const GpsTime heard_from = to_gps_time(2300, 3600.0 * 20);
constexpr SatelliteId geo{Constellation::sbas, 36}, silent{Constellation::sbas, 40};

// Sends the count of seconds as an issue of fast corrections.
class Sender : public SbasSource {
public:
    std::optional<SbasWords> message(SatelliteId satellite, GpsTime end) override {
        if (satellite == silent) return std::nullopt;
        EXPECT_GE(end, last_);
        last_ = end;
        SbasFastCorrections m;
        m.satellites[0].range_m = static_cast<double>((end - heard_from) / 1s);
        return encode_sbas(m, end - 1s);
    }

private:
    GpsTime last_;
};

Observations hearing(GpsTime time, std::optional<DbHz> cn0 = DbHz(40), bool unhealthy = false) {
    Observations all{time, false, {}};
    if (!cn0) return all;
    for (const SatelliteId id : {SatelliteId{Constellation::gps, 3}, geo, silent}) {
        Observation o;
        o.satellite = id;
        o.cn0 = *cn0;
        o.pseudorange = Metres(3.8e7);
        o.called_unhealthy = unhealthy;
        all.signals.push_back(o);
    }
    return all;
}

int issue_of(const Subframe& s) {
    return static_cast<int>(std::get<SbasFastCorrections>(*decode_sbas(s.words)).satellites[0].range_m);
}

TEST(SbasReception, HearsEverySecondOnce) {
    for (const auto period : {50ms, 200ms, 1000ms, 3000ms}) {
        SbasReception reception;
        Sender sender;
        std::vector<int> issues;
        for (GpsTime now = heard_from; now <= heard_from + 30s; now += period)
            for (const Subframe& s : reception.receive(hearing(now), sender, now)) {
                EXPECT_EQ(s.satellite, geo);
                EXPECT_EQ(s.words.size(), 8u);
                EXPECT_LE(s.end + 130ms, now);
                issues.push_back(issue_of(s));
            }
        // The first second began before the satellite was heard.
        ASSERT_FALSE(issues.empty());
        EXPECT_EQ(issues.front(), 1);
        for (std::size_t i = 1; i < issues.size(); ++i)
            EXPECT_EQ(issues[i], issues[i - 1] + 1);
        EXPECT_EQ(issues.back(), 29);
    }
}

TEST(SbasReception, NeedsTheSignalFromTheBeginning) {
    SbasReception reception;
    Sender sender;
    std::vector<int> issues;
    for (int tenth = 0; tenth <= 100; ++tenth) {
        const GpsTime now = heard_from + tenth * 100ms;
        const bool lost = tenth == 45, weak = tenth == 75;
        const auto cn0 = lost ? std::nullopt : std::optional(DbHz(weak ? 27 : 40));
        for (const Subframe& s : reception.receive(hearing(now, cn0), sender, now))
            issues.push_back(issue_of(s));
    }
    // A break at 4.5 s costs the second from 4.13 s on, one at 7.5 s the one from 7.13 s on.
    EXPECT_EQ(issues, (std::vector<int>{1, 2, 3, 4, 6, 7, 9}));
}

TEST(SbasReception, AGapBeginsAnew) {
    SbasReception reception;
    Sender sender;
    reception.receive(hearing(heard_from), sender, heard_from);
    EXPECT_TRUE(reception.receive(hearing(heard_from + 12s), sender, heard_from + 12s).empty());
    EXPECT_EQ(reception.receive(hearing(heard_from + 14s), sender, heard_from + 14s).size(), 1u);
}

TEST(SbasReception, SatellitesThatAreCalledUnhealthySayNotToUseThem) {
    SbasReception reception;
    Sender sender;
    reception.receive(hearing(heard_from), sender, heard_from);
    const GpsTime now = heard_from + 2500ms;
    const auto messages = reception.receive(hearing(now, DbHz(40), true), sender, now);
    ASSERT_EQ(messages.size(), 2u);
    for (const Subframe& s : messages)
        EXPECT_EQ(decode_sbas(s.words), SbasMessage(SbasDoNotUse{}));
}

}  // namespace
}  // namespace skyloop
