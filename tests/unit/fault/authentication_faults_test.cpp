// Galileo's authentication gone wrong, and what a client of OSNMA makes of it.
#include <gtest/gtest.h>

#include "signal_fault_run.hpp"
#include "support/osnma_listener.hpp"

namespace skyloop {
namespace {

const GpsTime osnma_begin = to_gps_time(2300, 3 * 86400.0 + 15 * 3600 + 600);

// Ten minutes, of which the fault is there from the fifth on; subframes of E1-B are a second late.
test::OsnmaVerdict verdict_with(const std::string& name, const test::FaultValues& values = {}) {
    test::OsnmaListener listener({5, osnma_begin});
    test::OsnmaClient client;
    client.public_keys[1] = test::octets_of(test::point_of(listener.keys->tree_xml(), 1));
    const Fault fault = test::signal_fault(name, values);
    listener.listen(client, osnma_begin, std::chrono::minutes(10), [&](Epoch& epoch) {
        if (epoch.subframes[0].end > osnma_begin + std::chrono::seconds(301)) fault.epoch(epoch, FaultMoment());
    });
    return client.judge();
}

TEST(AuthenticationFaults, WrongTagsAreTakenForNone) {
    test::OsnmaVerdict verdict = verdict_with("osnma_wrong_tags");
    EXPECT_EQ(verdict.wrong_roots, 0);
    EXPECT_EQ(verdict.wrong_keys, 0);
    EXPECT_EQ(verdict.wrong_sequences, 0);
    EXPECT_GT(verdict.tags[0], 50) << "before";
    EXPECT_GT(verdict.wrong_tags[0], 50);
    EXPECT_GT(verdict.wrong_tags[4], 10);
    EXPECT_NEAR(verdict.wrong_tags[0], verdict.tags[0], verdict.tags[0] / 5) << "half of the time";
}

TEST(AuthenticationFaults, OfNamedSatellitesAlone) {
    test::OsnmaVerdict verdict = verdict_with("osnma_wrong_tags", {{"satellites", std::vector<std::string>{"E03"}}});
    EXPECT_GT(verdict.wrong_tags[0], 10);
    EXPECT_LT(verdict.wrong_tags[0] * 5, verdict.tags[0]);
}

TEST(AuthenticationFaults, AStoppedChainAuthenticatesNothingMore) {
    const test::OsnmaVerdict verdict = verdict_with("osnma_stopped_chain");
    EXPECT_EQ(verdict.keys, 10 * 5) << "of ten of twenty subframes";
    EXPECT_EQ(verdict.wrong_keys, 0);
    EXPECT_EQ(verdict.sequences, 9 * 5);
    EXPECT_TRUE(verdict.wrong_tags.empty());
}

// The checksum of the changed pages is that of all pages.
TEST(AuthenticationFaults, PagesKeepARightChecksum) {
    KeplerEphemeris record;
    record.sqrt_a = 5440.6;
    record.satellite = {Constellation::galileo, 5};
    const BroadcastIonosphere none;
    InavData data{record, none, LeapSeconds::announced()};
    const InavWords plain = inav_pages(data, 1, osnma_begin);
    data.authentication = 0x123456789A;
    const InavWords authenticated = inav_pages(data, 1, osnma_begin);
    EXPECT_NE(plain, authenticated);
    EXPECT_EQ(inav_authentication(authenticated), 0x123456789Au);
    EXPECT_EQ(with_authentication(plain, 0x123456789A), authenticated);
    EXPECT_EQ(with_authentication(authenticated, 0), plain);
}

}  // namespace
}  // namespace skyloop
