// Every dialect under bytes that are nearly right.
#include <gtest/gtest.h>

#include <random>

#include "dialect_pose.hpp"
#include "receiver/protocol/mavlink_vehicle.hpp"
#include "run/feed/feed_dialect.hpp"

namespace skyloop {
namespace {

constexpr std::string_view every_dialect[] = {"ardupilot-json",
                                              "betaflight",
                                              "flightgear",
                                              "flightgear-generic",
                                              "gpsd",
                                              "jsbsim",
                                              "mavlink",
                                              "nmea",
                                              "px4",
                                              "ubx",
                                              "xplane"};

std::vector<Bytes> seeds() {
    Bytes fdm(408);
    fdm[3] = 24, fdm[8] = 0x3F, fdm[16] = 0x3F;
    Bytes rpos = to_bytes("RPOS4");
    rpos.resize(69, 0x40);
    return {
        fdm,
        rpos,
        to_bytes("1,47,8,1000,1,2,3,4,5,6\n2,47,8,1000,1,2,3,4,5,6\n"),
        to_bytes("<LABELS> ,Time,position/lat-geod-deg,position/long-gc-deg,position/h-sl-ft,"
                 "velocities/v-north-fps,velocities/v-east-fps,velocities/v-down-fps,attitude/phi-rad,"
                 "attitude/theta-rad,attitude/psi-rad\n1,2,3,4,5,6,7,8,9,10\n"),
        to_bytes("{\"timestamp\":1,\"position\":[1,2,3],\"velocity\":[1,2,3],\"quaternion\":[1,0,0,0]}\n"),
        to_bytes(
            "{\"class\":\"TPV\",\"mode\":3,\"lat\":1,\"lon\":2,\"altHAE\":3,\"speed\":1,\"track\":2,\"climb\":1}\n"),
        to_bytes("$GPGGA,000000.00,4723.862,N,00832.736,E,1,08,0.9,462.5,M,47.5,M,,*55\r\n"),
        encode_mavlink({}, MavlinkHilStateQuaternion{.time_usec = 1, .q = {1, 0, 0, 0}, .lat = 1, .lon = 1}),
        encode_mavlink({}, MavlinkOdometry{.q = {1, 0, 0, 0}}),
        encode_mavlink({}, MavlinkSimState{.q = {1, 0, 0, 0}, .lat = 47e7F, .lon = 8e7F}),
        Bytes(144, 0x40)};
}

// What a dialect gives must be fit for use, whatever it was given.
void expect_sound(const FeedNews& news) {
    for (const TruthSample& sample : news.samples) {
        const double radius = sample.position.vector().norm();
        ASSERT_TRUE(radius > 5.3e6 && radius < 7.5e6) << radius;
        const Eigen::Vector3d none = Eigen::Vector3d::Zero();
        // A filter may overshoot what the source said, 12 km/s at the most.
        ASSERT_LE((sample.velocity ? sample.velocity->vector() : none).norm(), 50000);
        ASSERT_TRUE(sample.turn_rate.value_or(none).allFinite());
        ASSERT_NEAR(sample.attitude.value_or(Attitude()).body_to_ned().norm(), 1, 1e-6);
    }
    ASSERT_EQ(news.refused > 0, !news.refusal.empty());
}

TEST(Dialects, StandMutatedBytes) {
    std::mt19937 random(8);
    const std::vector<Bytes> whole = seeds();
    FeedContext context;
    context.origin = Geodetic::degrees(47, 8, 500);
    context.smooth = true;
    for (const std::string_view name : every_dialect) {
        const auto dialect = dialect_named(name, context);
        std::int64_t now = 0;
        for (int round = 0; round < 3000; ++round) {
            Bytes bytes = whole[random() % whole.size()];
            if (random() % 3 == 0) bytes.resize(random() % (bytes.size() + 8));
            for (unsigned flips = random() % 4; flips > 0 && !bytes.empty(); --flips)
                bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
            now += static_cast<std::int64_t>(random() % 100'000'000);
            expect_sound(dialect->hear(bytes, now));
            if (HasFatalFailure()) FAIL() << name;
            if (round % 500 == 0) dialect->reconnected();
            if (round % 100 == 0) dialect->say();
        }
    }
}

// Streams may be cut anywhere: what comes of them is the same.
TEST(Dialects, StreamsMayBeCutAnywhere) {
    const std::pair<std::string_view, std::string_view> streams[] = {
        {"gpsd", "{\"class\":\"TPV\",\"mode\":3,\"lat\":1,\"lon\":2,\"altHAE\":3,\"time\":\"2026-11-20T12:00:00Z\"}\n"},
        {"flightgear-generic", "1,47,8,1000,1,2,3,4,5,6\n"},
        {"ardupilot-json", "\n{\"timestamp\":1,\"position\":[1,2,3]}\n"}};
    FeedContext context;
    context.origin = Geodetic::degrees(47, 8, 500);
    for (const auto& [name, text] : streams)
        for (std::size_t cut = 0; cut <= text.size(); ++cut) {
            const auto dialect = dialect_named(name, context);
            const std::size_t before = hear_text(*dialect, text.substr(0, cut)).samples.size();
            const std::size_t after = hear_text(*dialect, text.substr(cut)).samples.size();
            EXPECT_EQ(before + after, 1u) << name << " cut at " << cut;
        }
}

TEST(Dialects, AreKnownByTheirNames) {
    for (const std::string_view name : every_dialect)
        EXPECT_TRUE(make_dialect(name, {})) << name;
    EXPECT_FALSE(make_dialect("airsim", {}));
}

}  // namespace
}  // namespace skyloop
