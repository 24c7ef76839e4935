#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dialect_bytes.hpp"
#include "dialect_pose.hpp"
#include "mavlink_frames.hpp"
#include "run/feed/feed_dialect.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;
using Pose = NorthEastClimb;

TEST(MavlinkDialect, ReadsHilStateOfBothVersions) {
    for (const int version : {1, 2}) {
        const auto dialect = dialect_named("mavlink");
        const FeedNews news = dialect->hear(hil_state(1'700'000'000'000'000, 3, version), 9);
        ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
        expect_pose(news.samples[0], mavlink_tolerance);
        EXPECT_EQ(news.samples[0].vehicle, "3");
        EXPECT_EQ(news.samples[0].source_time, Nanoseconds(1'700'000'000'000'000'000));
        EXPECT_EQ(news.samples[0].received_ns, 9);
    }
}

TEST(MavlinkDialect, Px4sTimeOfZeroIsNone) {
    EXPECT_FALSE(dialect_named("mavlink")->hear(hil_state(0), 0).samples.at(0).source_time);
}

TEST(MavlinkDialect, VelocitiesAtTheEndOfTheirRangeAreNone) {
    EXPECT_FALSE(dialect_named("mavlink")->hear(hil_state(1, 1, 2, 32767), 0).samples.at(0).velocity);
}

TEST(MavlinkDialect, ReadsSimStateInDegreesAndInArdupilotsUnit) {
    const auto read = [](const Bytes& frame) { return dialect_named("mavlink")->hear(frame, 0).samples.at(0); };
    expect_pose(read(sim_state(Pose::latitude * 1e7, Pose::longitude * 1e7, true)), mavlink_tolerance);
    PoseTolerance coarse = mavlink_tolerance;
    coarse.degrees = 4e-6;  // a float's grid
    expect_pose(read(sim_state(Pose::latitude * 1e7, Pose::longitude * 1e7, false)), coarse);
    expect_pose(read(sim_state(Pose::latitude, Pose::longitude, false)), coarse);
    EXPECT_FALSE(read(sim_state(Pose::latitude, Pose::longitude, false)).source_time);
}

// East of SITL's own home, where the floats have steps of 1.16 m.
TEST(MavlinkDialect, SmoothsSimStateWithoutIntegersAndTellsSoOnce) {
    constexpr double latitude = -35.363262, longitude = 149.165237, speed_mps = 3;
    const Geodetic home = Geodetic::degrees(latitude, longitude, 510);
    const Eigen::Vector3d east = ned_to_ecef(home).toRotationMatrix().col(1);
    const double metres_per_degree =
        (to_ecef(Geodetic::degrees(latitude, longitude + 1e-3, 510)) - to_ecef(home)).vector().dot(east) * 1e3;
    const auto dialect = dialect_named("mavlink");
    double worst_m = 0;
    for (int i = 0; i < 500; ++i) {
        const double east_m = speed_mps * 0.02 * i;
        const Bytes frame =
            sim_state(latitude * 1e7, (longitude + east_m / metres_per_degree) * 1e7, false, {0, speed_mps, 0});
        const FeedNews news = dialect->hear(frame, std::int64_t{i} * 20'000'000);
        ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
        EXPECT_EQ(news.remark.find("SIM_STATE without lat_int") == 0, i == 0);
        const double told_m = (news.samples[0].position - to_ecef(home)).vector().dot(east);
        if (i > 100) worst_m = std::max(worst_m, std::abs(told_m - east_m));
        EXPECT_NEAR(news.samples[0].velocity->vector().dot(east), speed_mps, 0.1);
    }
    EXPECT_LT(worst_m, 0.1);
    EXPECT_EQ(dialect_named("mavlink")->hear(sim_state(Pose::latitude, Pose::longitude, true), 0).remark, "");
}

// SITL: SIM_STATE 50 times a second, GLOBAL_POSITION_INT four times, at a speed that need not be ours.
TEST(MavlinkDialect, LaysSimStateOnTheClockOfTheVehiclesOtherMessages) {
    constexpr std::int64_t ms = 1'000'000;
    for (const std::int64_t speedup : {1, 5}) {
        const auto dialect = dialect_named("mavlink");
        EXPECT_TRUE(dialect->hear(global_position(60'000), 0).samples.at(0).source_time);
        std::int64_t before_ns = 0;
        for (std::int64_t at_ms = 20; at_ms < 10'000; at_ms += 20) {
            const std::int64_t boot_ms = 60'000 + at_ms * speedup;
            if (at_ms % 260 == 0) dialect->hear(global_position(static_cast<std::uint32_t>(boot_ms)), at_ms * ms);
            const auto samples = dialect->hear(sim_state(Pose::latitude, Pose::longitude, true), at_ms * ms).samples;
            ASSERT_EQ(samples.size(), 1u);
            ASSERT_TRUE(samples[0].source_time);
            const std::int64_t time_ns = samples[0].source_time->count();
            if (at_ms > 1000) {
                EXPECT_LE(std::abs(time_ns - boot_ms * ms), 2 * ms * speedup) << at_ms;
                EXPECT_LE(std::abs(time_ns - before_ns - 20 * ms * speedup), ms * speedup) << at_ms;
            }
            before_ns = time_ns;
        }
    }
}

TEST(MavlinkDialect, AddsAttitudesToGlobalPositions) {
    for (const Bytes& attitude : {attitude_quaternion(), attitude_angles()}) {
        const auto dialect = dialect_named("mavlink");
        dialect->hear(attitude, 0);
        const FeedNews news = dialect->hear(global_position(1005), 100'000'000);
        ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
        expect_pose(news.samples[0], mavlink_tolerance);
        EXPECT_EQ(news.samples[0].source_time, Nanoseconds(1'005'000'000));
        EXPECT_FALSE(dialect->hear(global_position(2005), 1'000'000'000).samples.at(0).attitude);  // too old
    }
}

TEST(MavlinkDialect, LocalPositionsNeedAnOriginAndLieOnTheAutopilotsMap) {
    const auto dialect = dialect_named("mavlink");
    EXPECT_TRUE(dialect->hear(local_position(100, -10), 0).samples.empty());
    dialect->hear(hand_heartbeat(3), 0);  // ArduPilot
    dialect->hear(origin_message(Pose::latitude - 0.001, Pose::longitude, 500000), 0);
    dialect->hear(attitude_quaternion(), 0);
    const FeedNews news = dialect->hear(local_position(111.318845, -10), 0);
    ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
    expect_pose(news.samples[0], mavlink_tolerance);
    const auto px4 = dialect_named("mavlink");
    px4->hear(hand_heartbeat(12), 0);
    px4->hear(origin_message(Pose::latitude - 0.001, Pose::longitude, 500000), 0);
    px4->hear(attitude_quaternion(), 0);
    expect_pose(px4->hear(local_position(0.001 * std::numbers::pi / 180 * 6371000, -10), 0).samples.at(0),
                mavlink_tolerance);
}

struct Odometry {
    std::uint8_t frame = 1, child = 12, reset = 0;
    std::int8_t quality = 0;
    std::array<double, 3> position{0, 0, -10}, velocity{};
    std::array<double, 4> q = Pose::quaternion();
    [[nodiscard]] Bytes bytes() const {
        HandBytes payload;
        payload.u64(5'000'000).f32s({position[0], position[1], position[2], q[0], q[1], q[2], q[3]});
        payload.f32s({velocity[0], velocity[1], velocity[2], 0.1, 0.2, 0.3}).zeros_to(228);
        payload.u8(frame).u8(child).u8(reset).u8(0).u8(static_cast<std::uint8_t>(quality));
        return hand_mavlink(331, 91, payload.bytes());
    }
};

FeedContext with_origin() {
    FeedContext context;
    context.origin = Geodetic::degrees(Pose::latitude, Pose::longitude, 500);
    return context;
}

// The pose's velocity seen from its body: Rx(−roll) Ry(−pitch) Rz(−yaw) by hand.
std::array<double, 3> body_velocity() {
    const auto turn = [](double& a, double& b, double degrees) {
        const double c = std::cos(Angle::degrees(degrees).rad()), s = std::sin(Angle::degrees(degrees).rad());
        const double first = c * a + s * b;
        b = c * b - s * a;
        a = first;
    };
    double x = Pose::north, y = Pose::east, z = -Pose::up;
    turn(x, y, Pose::yaw);
    turn(z, x, Pose::pitch);
    turn(y, z, Pose::roll);
    return {x, y, z};
}

TEST(MavlinkDialect, ReadsOdometryWithVelocitiesOfTheBody) {
    Odometry odometry;
    odometry.velocity = body_velocity();
    const FeedNews news = dialect_named("mavlink", with_origin())->hear(odometry.bytes(), 0);
    ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
    expect_pose(news.samples[0], mavlink_tolerance);
    EXPECT_EQ(news.samples[0].source_time, Nanoseconds(5'000'000'000));
}

TEST(MavlinkDialect, ReadsOdometryInEastNorthUp) {
    Odometry odometry;
    odometry.frame = 4;
    odometry.position = {0, 0, 10};
    odometry.velocity = body_velocity();
    // The body (forward, right, down) in east, north, up: half a turn about the axis between north and east, before it.
    const Eigen::Quaterniond half_turn(0, std::sqrt(0.5), std::sqrt(0.5), 0);
    const auto q = Pose::quaternion();
    const Eigen::Quaterniond enu = half_turn.conjugate() * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    odometry.q = {enu.w(), enu.x(), enu.y(), enu.z()};
    const FeedNews news = dialect_named("mavlink", with_origin())->hear(odometry.bytes(), 0);
    ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
    expect_pose(news.samples[0], mavlink_tolerance);
}

TEST(MavlinkDialect, OdometryTellsJumpsAndItsLimits) {
    const auto dialect = dialect_named("mavlink", with_origin());
    Odometry odometry;
    EXPECT_FALSE(dialect->hear(odometry.bytes(), 0).samples.at(0).jump);
    odometry.reset = 1;
    EXPECT_TRUE(dialect->hear(odometry.bytes(), 0).samples.at(0).jump);
    EXPECT_FALSE(dialect->hear(odometry.bytes(), 0).samples.at(0).jump);
    odometry.frame = 20;
    EXPECT_THAT(dialect->hear(odometry.bytes(), 0).refusal, HasSubstr("vehicle 1: ODOMETRY in frame 20"));
    odometry.frame = 1;
    odometry.child = 21;
    EXPECT_THAT(dialect->hear(odometry.bytes(), 0).refusal, HasSubstr("child frame 21"));
    odometry.child = 12;
    odometry.quality = -1;
    EXPECT_THAT(dialect->hear(odometry.bytes(), 0).refusal, HasSubstr("failed"));
    odometry.quality = 0;
    odometry.position = {1e30, 0, 0};
    EXPECT_THAT(dialect->hear(odometry.bytes(), 0).refusal, HasSubstr("from the origin"));
    odometry.position = {std::nan(""), 0, 0};
    EXPECT_EQ(dialect->hear(odometry.bytes(), 0).refused, 1u);
}

TEST(MavlinkDialect, TheBestKindCountsAsLongAsItComes) {
    const auto dialect = dialect_named("mavlink");
    EXPECT_EQ(dialect->hear(global_position(1), 0).samples.size(), 1u);
    EXPECT_EQ(dialect->hear(hil_state(1), 0).samples.size(), 1u);
    EXPECT_TRUE(dialect->hear(global_position(2), 1'900'000'000).samples.empty());
    EXPECT_EQ(dialect->hear(global_position(3), 2'100'000'000).samples.size(), 1u);
}

TEST(MavlinkDialect, SeveralVehiclesShareOneClock) {
    const auto dialect = dialect_named("mavlink");
    const auto time = [&](std::uint8_t system, std::uint32_t boot_ms, std::int64_t received_ms) {
        return dialect->hear(global_position(boot_ms, system), received_ms * 1'000'000)
                   .samples.at(0)
                   .source_time->count() /
               1'000'000;
    };
    EXPECT_EQ(time(1, 50'000, 1000), 50'000);
    EXPECT_EQ(time(2, 7'000, 1100), 50'100);  // started 43 s later
    EXPECT_EQ(time(2, 7'200, 1350), 50'300);  // its own clock from here on
    EXPECT_EQ(time(1, 50'400, 1400), 50'400);
    EXPECT_EQ(time(2, 100, 1500), 50'500);  // begun anew
}

TEST(MavlinkDialect, MovesVehiclesOfOtherClocksOntoThatOfTheFirst) {
    constexpr std::int64_t since_1970_ms = 1'772'366'400'000;
    const auto time_ms = [](FeedDialect& dialect, std::uint8_t system, std::int64_t said_ms, std::int64_t received_ms) {
        return dialect.hear(hil_state(static_cast<std::uint64_t>(said_ms) * 1000, system), received_ms * 1'000'000)
                   .samples.at(0)
                   .source_time->count() /
               1'000'000;
    };
    const auto boot_first = dialect_named("mavlink");
    EXPECT_EQ(time_ms(*boot_first, 1, 30'000, 1000), 30'000);
    EXPECT_EQ(time_ms(*boot_first, 2, since_1970_ms, 1010), 30'010);
    EXPECT_EQ(time_ms(*boot_first, 1, 30'100, 1100), 30'100);
    EXPECT_EQ(time_ms(*boot_first, 2, since_1970_ms + 100, 1130), 30'110);  // its own clock from here on
    EXPECT_EQ(time_ms(*boot_first, 1, since_1970_ms + 9, 1200), since_1970_ms + 9);
    EXPECT_EQ(time_ms(*boot_first, 2, since_1970_ms + 200, 1210), since_1970_ms + 200);  // the first is there now, too
    const auto unix_first = dialect_named("mavlink");
    EXPECT_EQ(time_ms(*unix_first, 2, since_1970_ms, 1000), since_1970_ms);
    EXPECT_EQ(time_ms(*unix_first, 1, 30'000, 1010), since_1970_ms + 10);
    EXPECT_EQ(time_ms(*unix_first, 3, since_1970_ms + 50, 1020), since_1970_ms + 50);  // the same for all
    EXPECT_EQ(time_ms(*unix_first, 1, since_1970_ms + 90, 1100), since_1970_ms + 90);
}

TEST(MavlinkDialect, TellsVehiclesApartInOneDatagram) {
    const auto dialect = dialect_named("mavlink");
    Bytes both = global_position(1, 1);
    for (const std::uint8_t system : std::array<std::uint8_t, 3>{2, 0, 245}) {  // 0 is nobody, 245 is ourselves
        const Bytes more = global_position(1, system);
        both.insert(both.end(), more.begin(), more.end());
    }
    const FeedNews news = dialect->hear(both, 0);
    ASSERT_EQ(news.samples.size(), 2u);
    EXPECT_EQ(news.samples[0].vehicle, "1");
    EXPECT_EQ(news.samples[1].vehicle, "2");
}

// The messages that a COMMAND_LONG of ours asks for.
std::vector<int> asked(const std::vector<Bytes>& words) {
    std::vector<int> messages;
    for (const Bytes& word : words) {
        if (word.at(7) != 76) continue;
        Bytes payload(word.begin() + 10, word.end() - 2);
        payload.resize(33);
        EXPECT_EQ(payload[28] | payload[29] << 8, 511);
        float message = 0;
        std::memcpy(&message, payload.data(), 4);
        messages.push_back(static_cast<int>(message));
    }
    return messages;
}

TEST(MavlinkDialect, AsksAutopilotsForTheTruthAndThenForWhatTheyHave) {
    const auto dialect = dialect_named("mavlink");
    EXPECT_EQ(dialect->say().size(), 1u);                                   // alone: a heartbeat
    EXPECT_TRUE(dialect->hear(hand_heartbeat(8, 255), 0).answers.empty());  // a ground station
    const FeedNews met = dialect->hear(hand_heartbeat(3), 0);
    EXPECT_EQ(asked(met.answers), (std::vector{115, 108}));
    EXPECT_TRUE(dialect->hear(hand_heartbeat(3), 0).answers.empty());
    // 20 ms, to system 1, component 1; checked by hand.
    Bytes expected{0xFD, 32, 0, 0, 1, 245, 191, 76, 0, 0};
    HandBytes payload;
    payload.f32s({115, 20000, 0, 0, 0, 0, 0}).i16(511).u8(1).u8(1).u8(0);
    EXPECT_EQ(met.answers.at(0).size(), expected.size() + 32 + 2);
    EXPECT_EQ(Bytes(met.answers[0].begin() + 10, met.answers[0].end() - 2),
              Bytes(payload.bytes().begin(), payload.bytes().begin() + 32));
    dialect->say(), dialect->say();
    EXPECT_EQ(asked(dialect->say()), (std::vector{115, 108, 49, 31, 32, 33}));
    dialect->hear(sim_state(Pose::latitude, Pose::longitude, true), 0);
    EXPECT_TRUE(asked(dialect->say()).empty());
    EXPECT_FALSE(asked(dialect->say()).empty());  // silent again
}

TEST(MavlinkDialect, RefusesBrokenFramesAndPlacesThatAreNone) {
    const auto dialect = dialect_named("mavlink");
    Bytes broken = hil_state(1);
    broken[20] ^= 1;
    EXPECT_THAT(dialect->hear(broken, 0).refusal, HasSubstr("checksum"));
    EXPECT_THAT(dialect->hear(global_position(1, 1, 0), 0).refusal.empty() ? "none" : "some", HasSubstr("none"));
    HandBytes nowhere;
    nowhere.i32(1).zeros_to(28);
    EXPECT_THAT(dialect->hear(hand_mavlink(33, 104, nowhere.bytes()), 0).refusal, HasSubstr("knows no place"));
    EXPECT_THAT(dialect->hear(sim_state(NAN, 1, false), 0).refusal, HasSubstr("no place"));
    EXPECT_EQ(dialect->hear(to_bytes("not MAVLink at all"), 0).refused, 0u);
}

TEST(MavlinkDialect, ReadsStreamsInPieces) {
    Bytes stream = to_bytes("noise");
    Bytes unknown = hand_mavlink(107, 108, Bytes(64, 0xFD));  // HIL_SENSOR is none of ours; it is full of beginnings
    for (int i = 0; i < 3; ++i) {
        stream.insert(stream.end(), unknown.begin(), unknown.end());
        const Bytes frame = hil_state(1000 + static_cast<std::uint64_t>(i));
        stream.insert(stream.end(), frame.begin(), frame.end());
    }
    for (const std::size_t piece : {1u, 7u, 100u, 1000u}) {
        const auto dialect = dialect_named("px4");
        std::size_t samples = 0, refused = 0;
        for (std::size_t at = 0; at < stream.size(); at += piece) {
            const FeedNews news = dialect->hear(ByteSpan(stream).subspan(at, std::min(piece, stream.size() - at)), 0);
            samples += news.samples.size();
            refused += news.refused;
        }
        EXPECT_EQ(samples, 3u) << piece;
        EXPECT_EQ(refused, 0u) << piece;
    }
}

TEST(Px4Dialect, ReadsTheSimulatorAndNeverSpeaks) {
    const auto dialect = dialect_named("px4");
    EXPECT_TRUE(dialect->say().empty());
    const FeedNews alive = dialect->hear(hand_heartbeat(12), 0);
    EXPECT_TRUE(alive.answers.empty());
    const FeedNews news = dialect->hear(hil_state(123456), 0);
    ASSERT_EQ(news.samples.size(), 1u);
    expect_pose(news.samples[0], mavlink_tolerance);
    EXPECT_EQ(news.samples[0].source_time, Nanoseconds(123'456'000));
    EXPECT_TRUE(dialect->hear(global_position(5), 0).samples.empty());
}

// The remarks on messages that come each second for eight.
std::vector<std::string> remarks_on(std::string_view name, const std::vector<Bytes>& frames) {
    const auto dialect = dialect_named(name);
    std::vector<std::string> told;
    for (std::int64_t second = 0; second <= 8; ++second)
        for (const Bytes& frame : frames) {
            const FeedNews news = dialect->hear(frame, second * 1'000'000'000);
            if (!news.remark.empty()) told.push_back(fmt::format("{} s: {}", second, news.remark));
        }
    return told;
}

TEST(MavlinkDialect, TellsOnceThatALinkIsBusyAndTellsNoPlace) {
    const Bytes sensor = hand_mavlink(107, 108, Bytes(64, 1)), receiver = hand_mavlink(113, 124, Bytes(36, 1));
    EXPECT_THAT(remarks_on("px4", {sensor, receiver}),
                testing::ElementsAre("5 s: 11 messages, and none of them tells a place (HIL_STATE_QUATERNION)"));
    const auto none = testing::ElementsAre(
        testing::AllOf(HasSubstr("5 s: 6 messages, and none of them tells a place"), HasSubstr("SIM_STATE")));
    EXPECT_THAT(remarks_on("mavlink", {hand_heartbeat(3)}), none);
    EXPECT_THAT(remarks_on("mavlink", {local_position(100, -10)}), none);
    EXPECT_THAT(remarks_on("px4", {sensor, hil_state(1)}), testing::IsEmpty());
    EXPECT_THAT(remarks_on("mavlink", {hand_heartbeat(3), global_position(1)}), testing::IsEmpty());
    EXPECT_THAT(remarks_on("mavlink", {to_bytes("not MAVLink at all")}), testing::IsEmpty());
}

}  // namespace
}  // namespace skyloop
