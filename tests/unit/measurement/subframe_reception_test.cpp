#include "receiver/measurement/subframe_reception.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "support/four_systems.hpp"
#include "world/gnss/broadcast_beidou.hpp"
#include "world/gnss/broadcast_lnav.hpp"

namespace skyloop {
namespace {

const SatelliteId gps_sent{Constellation::gps, 3}, galileo_sent{Constellation::galileo, 4},
    beidou_sent{Constellation::beidou, 15}, glonass_sent{Constellation::glonass, 5};

Observation locked_signal(SatelliteId satellite, Signal signal) {
    Observation o;
    o.satellite = satellite;
    o.signal = signal;
    o.pseudorange = Metres(2.2e7);
    return o;
}

Observations of_all(GpsTime time) {
    return {time,
            false,
            {locked_signal(gps_sent, Signal::l1), locked_signal(galileo_sent, Signal::l1),
             locked_signal(galileo_sent, Signal::e5b), locked_signal(beidou_sent, Signal::b1i),
             locked_signal(glonass_sent, Signal::g1)}};
}

// 30 s begin with a frame of GPS and of Galileo, 14 s later one of BeiDou.
const GpsTime frame_start = to_gps_time(2300, 3600.0 * 20);

TEST(SubframeReception, EverySubframeOfHalfAMinuteOnce) {
    const test::FourSystems sent;
    SubframeReception reception;
    std::map<std::pair<SatelliteId, Signal>, int> counts;
    std::map<int, int> gps_subframes;
    GpsTime last = frame_start;
    for (int i = -100; i <= 300; ++i) {
        const GpsTime now = frame_start + std::chrono::milliseconds(100 * i + 75);
        for (const Subframe& s : reception.receive(of_all(now), sent, now)) {
            if (i <= 0) continue;
            EXPECT_GE(s.end, last);
            last = s.end;
            ++counts[{s.satellite, s.signal}];
            if (s.satellite != gps_sent) continue;
            ++gps_subframes[static_cast<int>(s.words[1] >> 8 & 7)];
            // The hand-over word tells the start of the next subframe, which is the end of this one.
            EXPECT_EQ((s.words[1] >> 13 & 0x1FFFF) * std::chrono::seconds(6), week_and_tow(s.end).tow);
        }
    }
    EXPECT_EQ((counts[{gps_sent, Signal::l1}]), 5);
    EXPECT_EQ((counts[{galileo_sent, Signal::l1}]), 15);
    EXPECT_EQ((counts[{galileo_sent, Signal::e5b}]), 15);
    EXPECT_EQ((counts[{beidou_sent, Signal::b1i}]), 5);
    EXPECT_EQ((counts[{glonass_sent, Signal::g1}]), 15);
    for (int subframe = 1; subframe <= 5; ++subframe)
        EXPECT_EQ(gps_subframes[subframe], 1) << subframe;
}

TEST(SubframeReception, ARecordIsWholeWithItsLastPart) {
    const test::FourSystems sent;
    SubframeReception reception;
    std::map<std::pair<SatelliteId, Signal>, std::vector<double>> whole;
    // From 3 s after the frame on, when subframe 1 is under way, to the end of the second one.
    for (int i = 30; i <= 605; ++i) {
        const GpsTime now = frame_start + std::chrono::milliseconds(100 * i + 75);
        for (const Subframe& s : reception.receive(of_all(now), sent, now)) {
            if (!s.record) continue;
            EXPECT_EQ(satellite_of(*s.record), s.satellite);
            whole[{s.satellite, s.signal}].push_back(difference(s.end, frame_start).value());
        }
    }
    EXPECT_EQ((whole[{gps_sent, Signal::l1}]), std::vector<double>{48});
    EXPECT_EQ((whole[{beidou_sent, Signal::b1i}]), (std::vector<double>{32})) << "its frame is 14 s later";
    ASSERT_EQ((whole[{galileo_sent, Signal::l1}].size()), 1U);
    EXPECT_GE((whole[{galileo_sent, Signal::l1}][0]), 33) << "half a minute of words";
    EXPECT_FALSE((whole[{glonass_sent, Signal::g1}].empty()));
}

TEST(SubframeReception, SatellitesThatAreCalledUnhealthySendIt) {
    const test::FourSystems sent;
    SubframeReception sound, warned;
    std::set<std::pair<SatelliteId, Signal>> changed;
    std::set<SatelliteId> unhealthy;
    constexpr int last_call = 65;
    for (int i = 0; i <= last_call + 40; ++i) {
        const GpsTime now = frame_start + std::chrono::milliseconds(1000 * i + 100);
        Observations calls = of_all(now);
        for (Observation& o : calls.signals)
            o.called_unhealthy = i <= last_call;
        const auto usual = sound.receive(of_all(now), sent, now), received = warned.receive(calls, sent, now);
        ASSERT_EQ(received.size(), usual.size());
        for (std::size_t k = 0; k < received.size(); ++k) {
            const Subframe& s = received[k];
            if (i > last_call) {
                EXPECT_EQ(s.words, usual[k].words);
            }
            if (s.words != usual[k].words) changed.insert({s.satellite, s.signal});
            if (s.record && !is_healthy(*s.record)) unhealthy.insert(s.satellite);
            if (s.record) {
                EXPECT_EQ(is_healthy(*s.record), i > last_call);
            }
            if (s.satellite != gps_sent || (s.words[1] >> 8 & 7) != 1 || i > last_call) continue;
            auto record = std::get<KeplerEphemeris>(*sent.ephemeris(gps_sent, s.end));
            record.health = 0b111111;
            const LnavWords expected = lnav_ephemeris_subframe(record, 1, s.end);
            EXPECT_EQ(s.words, std::vector<std::uint32_t>(expected.begin(), expected.end()));
        }
    }
    EXPECT_EQ(changed.size(), 5u) << "of each signal";
    EXPECT_EQ(unhealthy, (std::set{gps_sent, galileo_sent, beidou_sent, glonass_sent}));
}

TEST(SubframeReception, DoesNotDependOnTheRate) {
    const test::FourSystems sent;
    SubframeReception slow, fast;
    std::vector<std::pair<GpsTime, std::vector<std::uint32_t>>> of_slow, of_fast;
    for (int i = 0; i <= 600; ++i) {
        const GpsTime now = frame_start + std::chrono::milliseconds(100 * i);
        for (const Subframe& s : fast.receive(of_all(now), sent, now))
            of_fast.emplace_back(s.end, s.words);
        if (i % 20 != 0) continue;
        for (const Subframe& s : slow.receive(of_all(now), sent, now))
            of_slow.emplace_back(s.end, s.words);
    }
    EXPECT_EQ(of_slow, of_fast);
    EXPECT_GT(of_slow.size(), 60u);
}

TEST(SubframeReception, NeedsTheCodeFromTheBeginning) {
    const test::FourSystems sent;
    SubframeReception reception;
    int received = 0;
    for (int i = 0; i <= 12; ++i) {
        const GpsTime now = frame_start + std::chrono::milliseconds(1000 * i + 100);
        Observations o{now, false, {locked_signal(gps_sent, Signal::l1)}};
        if (i == 3) o.signals[0].pseudorange.reset();
        const auto got = reception.receive(o, sent, now);
        // Ends at 6 s, broken at 3 s; and at 12 s, whole.
        received += static_cast<int>(got.size());
        if (i < 12) {
            EXPECT_TRUE(got.empty()) << i;
        }
    }
    EXPECT_EQ(received, 1);
}

TEST(SubframeReception, AGapBeginsAnew) {
    const test::FourSystems sent;
    SubframeReception reception;
    reception.receive(of_all(frame_start), sent, frame_start);
    const GpsTime later = frame_start + std::chrono::hours(1000);
    EXPECT_TRUE(reception.receive(of_all(later), sent, later).empty());
}

TEST(SubframeReception, QzssSendsItsOwnPages) {
    const test::FourSystems sent({Constellation::gps, Constellation::qzss});
    const SatelliteId qzss_sent{Constellation::qzss, 2};
    SubframeReception reception;
    int pages = 0;
    for (int i = 0; i <= 31; ++i) {
        const GpsTime now = frame_start + std::chrono::milliseconds(1000 * i + 100);
        const Observations o{now, false, {locked_signal(gps_sent, Signal::l1), locked_signal(qzss_sent, Signal::l1)}};
        for (const Subframe& s : reception.receive(o, sent, now)) {
            if ((s.words[1] >> 8 & 7) < 4) continue;
            EXPECT_EQ(s.words[2] >> 28 & 3, s.satellite == qzss_sent ? 3u : 1u);
            ++pages;
        }
    }
    EXPECT_EQ(pages, 4);
}

TEST(SubframeReception, SendsNothingOfSignalsWithOtherMessages) {
    const test::FourSystems sent;
    SubframeReception reception;
    for (int i = 0; i <= 30; ++i) {
        const GpsTime now = frame_start + std::chrono::seconds(i);
        const Observations o{
            now,
            false,
            {locked_signal(beidou_sent, Signal::b3i), locked_signal({Constellation::navic, 2}, Signal::l5)}};
        EXPECT_TRUE(reception.receive(o, sent, now).empty());
    }
}

// L2C has a message each 12 s, L5 and E5a-I each 6 and each 10 s.
TEST(SubframeReception, TheOtherFrequenciesHaveMessagesOfTheirOwn) {
    const test::FourSystems sent;
    SubframeReception reception;
    std::map<std::pair<SatelliteId, Signal>, std::vector<int>> types;
    for (int i = 0; i <= 60; ++i) {
        const GpsTime now = frame_start + std::chrono::milliseconds(1000 * i + 100);
        const Observations o{now,
                             false,
                             {locked_signal(gps_sent, Signal::l2), locked_signal(gps_sent, Signal::l5),
                              locked_signal(galileo_sent, Signal::l5)}};
        for (const Subframe& s : reception.receive(o, sent, now)) {
            EXPECT_FALSE(s.record) << "who has these has a record by L1";
            const bool page = s.satellite == galileo_sent;
            types[{s.satellite, s.signal}].push_back(static_cast<int>(s.words[0] >> (page ? 26 : 12) & 0x3F));
        }
    }
    // The first message was under way before the signal was.
    EXPECT_EQ((types[{gps_sent, Signal::l2}]), (std::vector{11, 30, 33, 10}));
    EXPECT_EQ((types[{gps_sent, Signal::l5}]), (std::vector{11, 30, 33, 10, 11, 30, 33, 10, 11}));
    EXPECT_EQ((types[{galileo_sent, Signal::l5}]).size(), 5u);
}

// A page of subframe 1 each third second; the record is whole with the tenth.
TEST(SubframeReception, GeostationarySatellitesSendD2) {
    class Geostationary : public test::FourSystems {
    public:
        [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId id, GpsTime time) const override {
            auto record = std::get<KeplerEphemeris>(*test::FourSystems::ephemeris(beidou_sent, time));
            record.satellite = id;
            return record;
        }
    } sent;
    const SatelliteId stationary{Constellation::beidou, 2};
    SubframeReception slow, fast;
    std::vector<std::uint32_t> pages;
    std::vector<double> whole;
    std::size_t of_fast = 0, of_slow = 0;
    for (int i = 0; i <= 700; ++i) {
        const GpsTime now = frame_start + std::chrono::milliseconds(100 * i + 50);
        const Observations o{now, false, {locked_signal(stationary, Signal::b1i)}};
        of_fast += fast.receive(o, sent, now).size();
        if (i % 10 != 0) continue;
        for (const Subframe& s : slow.receive(o, sent, now)) {
            ++of_slow;
            if ((s.words[0] >> 12 & 7) != 1) continue;  // almanacs
            EXPECT_EQ(bdt_week_and_tow(s.end).tow % std::chrono::seconds(3), d2_subframe_length);
            pages.push_back(s.words[1] >> 14 & 0xF);
            if (s.record) whole.push_back(difference(s.end, frame_start).value());
        }
    }
    ASSERT_EQ(pages.size(), 23u);
    EXPECT_EQ(of_fast, of_slow);
    for (std::size_t i = 1; i < pages.size(); ++i)
        EXPECT_EQ(pages[i], pages[i - 1] % 10 + 1);
    // BeiDou's half minutes begin 14 s later; the page that is the tenth ends 27.6 s after that.
    EXPECT_EQ(whole, std::vector<double>{41.6});
}

}  // namespace
}  // namespace skyloop
