// FlightGear, JSBSim, X-Plane, ArduPilot's JSON and Betaflight.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dialect_bytes.hpp"
#include "dialect_pose.hpp"
#include "feed_asides.hpp"
#include "run/feed/feed_dialect.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;
using Pose = NorthEastClimb;
constexpr double foot = 0.3048;

double radians(double degrees) { return Angle::degrees(degrees).rad(); }

// FGNetFDM by FEEDS.md 3.4. The rates of roll, pitch and yaw belong to body rates 0.1, 0.2, 0.3 (inverse of Stevens and
// Lewis, table 1.4-1).
struct FdmPacket {
    unsigned version = 24;
    std::size_t size = 408;
    double latitude = Pose::latitude;
    double north = Pose::north, east = Pose::east, up = Pose::up;
    std::uint32_t time = 1234567890;
    [[nodiscard]] Bytes bytes() const {
        const double sr = std::sin(radians(Pose::roll)), cr = std::cos(radians(Pose::roll));
        const double tp = std::tan(radians(Pose::pitch)), cp = std::cos(radians(Pose::pitch));
        const double p = 0.1, q = 0.2, r = 0.3;
        HandBytes packet(true);
        packet.i32(version).i32(0).f64(radians(Pose::longitude)).f64(radians(latitude)).f64(Pose::height).f32(33);
        packet.f32s({radians(Pose::roll), radians(Pose::pitch), radians(Pose::yaw), 0.1, 0.1});
        packet.f32s({p + (q * sr + r * cr) * tp, q * cr - r * sr, (q * sr + r * cr) / cp});
        packet.f32s({99, up / foot, north / foot, east / foot, -up / foot, 9, 9, 9, 1, 2, -32});
        packet.zeros_to(size == 408 ? 356 : 500).i32(time).zeros_to(size);
        return packet.bytes();
    }
};
const PoseTolerance fdm_tolerance{1e-9, 1e-6, 1e-5, 1e-4, 1e-6, true, true};

TEST(FlightgearDialect, ReadsBothVersions) {
    for (const auto& [version, size] : {std::pair{24u, std::size_t{408}}, std::pair{25u, std::size_t{552}}}) {
        const auto dialect = dialect_named("flightgear");
        FdmPacket packet;
        packet.version = version;
        packet.size = size;
        const FeedNews news = dialect->hear(packet.bytes(), 77);
        ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
        expect_pose(news.samples[0], fdm_tolerance);
        EXPECT_EQ(news.samples[0].received_ns, 77);
        EXPECT_FALSE(news.samples[0].source_time);  // 1234567890 is no clock
    }
}

TEST(FlightgearDialect, SecondsOfACalendarAreNoClockAndMicrosecondsAre) {
    const auto dialect = dialect_named("flightgear");
    FdmPacket packet;
    for (std::uint32_t second = 0; second < 6; ++second) {
        packet.time = 1700000000 + second;
        EXPECT_FALSE(dialect->hear(packet.bytes(), 0).samples.at(0).source_time);
    }
    packet.time = 0xFFFFFFFF - 40000;  // the 32 bits end on the way
    std::optional<Nanoseconds> before, now;
    for (int i = 0; i < 8; ++i) {
        before = now;
        now = dialect->hear(packet.bytes(), 0).samples.at(0).source_time;
        packet.time += 20000;
    }
    ASSERT_TRUE(before && now);
    EXPECT_EQ((*now - *before).count(), 20'000'000);
}

TEST(FlightgearDialect, ZeroVelocitiesOfAMovingVehicleAreReplaced) {
    const auto dialect = dialect_named("flightgear");
    FdmPacket packet;
    packet.north = packet.east = packet.up = 0;
    EXPECT_TRUE(dialect->hear(packet.bytes(), 0).samples.at(0).velocity->vector().isZero(0));  // it may stand
    // 10 m/s north on ArduPilot's grid of 1e-7°, 400 packets a second.
    TruthSample last;
    for (int i = 1; i <= 1200; ++i) {
        const double seconds = i / 400.0, north = 10 * seconds;
        packet.latitude = std::round((Pose::latitude + north / 111183) * 1e7) / 1e7;
        const FeedNews news = dialect->hear(packet.bytes(), std::llround(seconds * 1e9));
        ASSERT_EQ(news.samples.size(), 1u);
        last = news.samples[0];
    }
    const Eigen::Vector3d ned = ned_to_ecef(to_geodetic(last.position)).conjugate() * last.velocity->vector();
    EXPECT_NEAR(ned.x(), 10, 0.2);
    EXPECT_NEAR(ned.y(), 0, 0.2);
}

TEST(FlightgearDialect, StallsThatBunchThePacketsDoNotShakeTheVelocity) {
    const auto dialect = dialect_named("flightgear");
    FdmPacket packet;
    packet.north = packet.east = packet.up = 0;
    // 25 m/s north; twice a second what was sent within 20 ms comes at once.
    double stalls_until = 0, worst = 0;
    for (int i = 0; i < 400 * 8; ++i) {
        const double seconds = i / 400.0;
        packet.latitude = std::round((Pose::latitude + 25 * seconds / 111183) * 1e7) / 1e7;
        if (i % 200 == 199) stalls_until = seconds + 0.02;
        const auto received_ns = std::llround(std::max(seconds, stalls_until) * 1e9);
        const FeedNews news = dialect->hear(packet.bytes(), received_ns);
        ASSERT_EQ(news.samples.size(), 1u);
        const TruthSample& sample = news.samples[0];
        if (seconds < 3) continue;
        ASSERT_TRUE(sample.velocity);
        const Eigen::Vector3d ned = ned_to_ecef(to_geodetic(sample.position)).conjugate() * sample.velocity->vector();
        worst = std::max(worst, (ned - Eigen::Vector3d(25, 0, 0)).norm());
    }
    EXPECT_LT(worst, 0.3);
}

TEST(FlightgearDialect, RefusesWhatIsNoPacket) {
    const auto dialect = dialect_named("flightgear");
    FdmPacket packet;
    Bytes cut = packet.bytes();
    cut.pop_back();
    EXPECT_THAT(dialect->hear(cut, 0).refusal, HasSubstr("407 bytes of version 24"));
    packet.version = 25;
    EXPECT_EQ(dialect->hear(packet.bytes(), 0).refused, 1u);
    packet.version = 24;
    packet.latitude = std::nan("");
    EXPECT_THAT(dialect->hear(packet.bytes(), 0).refusal, HasSubstr("no place"));
    EXPECT_EQ(dialect->hear({}, 0).refused, 1u);
    // Little-endian: the version is not 24.
    Bytes turned = FdmPacket{}.bytes();
    std::reverse(turned.begin(), turned.begin() + 4);
    EXPECT_EQ(dialect->hear(turned, 0).refused, 1u);
}

std::string generic_line(double time, double latitude = Pose::latitude) {
    return fmt::format("{:.6f},{:.10f},{:.10f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f}\n", time, latitude,
                       Pose::longitude, Pose::height / foot, Pose::north / foot, Pose::east / foot, -Pose::up / foot,
                       Pose::roll, Pose::pitch, Pose::yaw);
}
const PoseTolerance line_tolerance{1e-9, 1e-5, 1e-5, 1e-4, 0, true, false};

TEST(FlightgearGenericDialect, ReadsTheLinesOfSkyloopXml) {
    const auto dialect = dialect_named("flightgear-generic");
    const std::string line = generic_line(12.5);
    const FeedNews first = hear_text(*dialect, line.substr(0, 20));
    EXPECT_TRUE(first.samples.empty());
    const FeedNews news = hear_text(*dialect, line.substr(20), 5);
    ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
    expect_pose(news.samples[0], line_tolerance);
    EXPECT_EQ(news.samples[0].source_time, Nanoseconds(12'500'000'000));
}

TEST(FlightgearGenericDialect, ATimeThatStandsIsAPause) {
    const auto dialect = dialect_named("flightgear-generic");
    constexpr std::int64_t milli_ns = 1'000'000;
    EXPECT_FALSE(pause_told(hear_text(*dialect, generic_line(1), 0)));
    const FeedNews repeated = hear_text(*dialect, generic_line(1), milli_ns);
    EXPECT_FALSE(pause_told(repeated)) << "it makes up for a stall";
    EXPECT_TRUE(repeated.samples.empty());
    EXPECT_EQ(repeated.others, 1u) << "the simulator is there";
    EXPECT_EQ(pause_told(hear_text(*dialect, generic_line(1), 250 * milli_ns)), true);
    EXPECT_FALSE(pause_told(hear_text(*dialect, generic_line(1), 300 * milli_ns)));
    const FeedNews goes_on = hear_text(*dialect, generic_line(1.1), 320 * milli_ns);
    EXPECT_EQ(pause_told(goes_on), false);
    EXPECT_EQ(goes_on.samples.size(), 1u);
}

TEST(FlightgearGenericDialect, ALineEndsWithItsDatagram) {
    const auto bare = [](std::string line) { return line.substr(0, line.find('\n')); };
    EXPECT_TRUE(hear_text(*dialect_named("flightgear-generic"), bare(generic_line(1))).samples.empty());
    FeedContext context;
    context.datagrams = true;
    const auto dialect = dialect_named("flightgear-generic", context);
    EXPECT_EQ(hear_text(*dialect, bare(generic_line(1))).samples.size(), 1u);
    EXPECT_EQ(hear_text(*dialect, generic_line(2)).samples.size(), 1u);
}

TEST(FlightgearGenericDialect, RefusesOtherLines) {
    const auto dialect = dialect_named("flightgear-generic");
    EXPECT_THAT(hear_text(*dialect, "1,2,3\n").refusal, HasSubstr("3 cells"));
    EXPECT_THAT(hear_text(*dialect, "1,x,3,4,5,6,7,8,9,10\n").refusal, HasSubstr("cell 2"));
    EXPECT_THAT(hear_text(*dialect, "1,nan,3,4,5,6,7,8,9,10\n").refusal, HasSubstr("cell 2"));
    EXPECT_THAT(hear_text(*dialect, "1e300,2,3,4,5,6,7,8,9,10\n").refusal, HasSubstr("time"));
    EXPECT_THAT(hear_text(*dialect, std::string(70000, '1') + "\n").refusal, HasSubstr("65536"));
    EXPECT_EQ(hear_text(*dialect, generic_line(1)).samples.size(), 1u);
    EXPECT_EQ(hear_text(*dialect, generic_line(2, 91)).refused, 1u);
}

// As JSBSim 2020.3.16 of Debian writes them, with the last parts of the properties alone, and as newer ones do.
const std::string jsbsim_labels =
    "<LABELS> ,Time,sim-time-sec,lat-geod-deg,long-gc-deg,h-sl-ft,v-north-fps,v-east-fps,v-down-fps,phi-rad,theta-rad,"
    "psi-rad\n";
const std::string whole_jsbsim_labels =
    "<LABELS> ,Time,simulation/sim-time-sec,/fdm/jsbsim/position/lat-geod-deg,/fdm/jsbsim/position/long-gc-deg,"
    "position/h-sl-ft,velocities/v-north-fps,velocities/v-east-fps,velocities/v-down-fps,attitude/phi-rad,"
    "attitude/theta-rad,attitude/psi-rad\n";
std::string jsbsim_line(double time) {
    return fmt::format(
        "  {0:.4f} , {0:.4f},    {1:.10f},{2:.10f} ,{3:.7f},{4:.7f},{5:.7f},{6:.7f},{7:.9f},{8:.9f},{9:.9f}\n", time,
        Pose::latitude, Pose::longitude, Pose::height / foot, Pose::north / foot, Pose::east / foot, -Pose::up / foot,
        radians(Pose::roll), radians(Pose::pitch), radians(Pose::yaw));
}

TEST(JsbsimDialect, ReadsTheColumnsByTheirNames) {
    for (const std::string& labels : {jsbsim_labels, whole_jsbsim_labels}) {
        const FeedNews news = hear_text(*dialect_named("jsbsim"), labels + jsbsim_line(3.25));
        ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
        expect_pose(news.samples[0], line_tolerance);
        EXPECT_EQ(news.samples[0].source_time, Nanoseconds(3'250'000'000));
    }
}

// Seven digits of a latitude are a grid of a metre; the velocities lead across it.
TEST(JsbsimDialect, SevenDigitsAreSmoothed) {
    const auto dialect = dialect_named("jsbsim");
    hear_text(*dialect, jsbsim_labels);
    double worst = 0;
    for (int i = 0; i < 500; ++i) {
        const double time = i * 0.02, latitude = Pose::latitude + time * 20 / 111183;
        const auto news = hear_text(*dialect, fmt::format("{0:.7g},{0:.7g},{1:.7g},8.5456,1000,{2:.7g},0,0,0,0,0\n",
                                                          time, latitude, 20 / foot));
        if (i < 100) continue;
        const Geodetic place = to_geodetic(news.samples.at(0).position);
        worst = std::max(worst, std::abs(place.latitude.deg() - latitude) * 111183);
    }
    EXPECT_LT(worst, 0.3);
}

TEST(JsbsimDialect, RefusesGeocentricLatitudesAndNumbersWithoutNames) {
    const auto dialect = dialect_named("jsbsim");
    EXPECT_THAT(hear_text(*dialect, jsbsim_line(1)).refusal, HasSubstr("before the <LABELS>"));
    EXPECT_THAT(hear_text(*dialect, "<LABELS> ,Time,Latitude (deg),Longitude (deg)\n").refusal,
                HasSubstr("geocentric"));
    EXPECT_THAT(hear_text(*dialect, jsbsim_line(1)).refusal, HasSubstr("geocentric"));
    EXPECT_EQ(hear_text(*dialect, jsbsim_labels + jsbsim_line(1)).samples.size(), 1u);
    EXPECT_THAT(hear_text(*dialect, "1,2\n").refusal, HasSubstr("without a number for position/lat-geod-deg"));
    dialect->reconnected();
    EXPECT_EQ(hear_text(*dialect, jsbsim_line(2)).refused, 1u);
}

TEST(ArdupilotJsonDialect, ReadsThePhysicsAnswer) {
    FeedContext context;
    context.origin = Geodetic::degrees(Pose::latitude - 0.001, Pose::longitude, 500);
    const auto dialect = dialect_named("ardupilot-json", context);
    const auto q = Pose::quaternion();
    const FeedNews news = hear_text(
        *dialect, fmt::format("\n{{\"timestamp\":4.125,\"imu\":{{\"gyro\":[0.1,0.2,0.3],\"accel_body\":[0,0,-9.8]}},"
                              "\"position\":[111.318845,0,-10],\"quaternion\":[{},{},{},{}],\"velocity\":[3,4,-2]}}\n",
                              q[0], q[1], q[2], q[3]));
    ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
    expect_pose(news.samples[0], {1e-9, 1e-6, 1e-9, 1e-9, 1e-12, true, true});
    EXPECT_EQ(news.samples[0].source_time, Nanoseconds(4'125'000'000));
    const FeedNews angles =
        hear_text(*dialect, fmt::format("{{\"timestamp\":5,\"position\":[111.318845,0,-10],\"attitude\":[{},{},{}],"
                                        "\"velocity\":[3,4,-2]}}\n",
                                        radians(Pose::roll), radians(Pose::pitch), radians(Pose::yaw)));
    ASSERT_EQ(angles.samples.size(), 1u);
    expect_pose(angles.samples[0], {1e-9, 1e-6, 1e-9, 1e-9, 0, true, false});
}

TEST(ArdupilotJsonDialect, TakesThePlaceOnTheEarthWhereTheAnswerHasOne) {
    const auto dialect = dialect_named("ardupilot-json");
    const auto answer = [&](const std::string& more) {
        return hear_text(*dialect, fmt::format("{{\"timestamp\":4.125,\"latitude\":{},\"longitude\":{},\"altitude\":{},"
                                               "\"imu\":{{\"gyro\":[0.1,0.2,0.3]}},\"attitude\":[{},{},{}],"
                                               "\"velocity\":[3,4,-2]{}}}\n",
                                               Pose::latitude, Pose::longitude, Pose::height, radians(Pose::roll),
                                               radians(Pose::pitch), radians(Pose::yaw), more));
    };
    for (const char* more : {"", ",\"position\":[1000,2000,-30]"}) {
        const FeedNews news = answer(more);
        ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
        expect_pose(news.samples[0], {1e-9, 1e-6, 1e-9, 1e-9, 1e-12, true, true});
    }
    EXPECT_THAT(hear_text(*dialect, "{\"timestamp\":1,\"latitude\":48,\"longitude\":11}\n").refusal,
                HasSubstr("\"altitude\""));
}

TEST(ArdupilotJsonDialect, OfAnglesAndAQuaternionTheQuaternionCounts) {
    FeedContext context;
    context.origin = Geodetic::degrees(Pose::latitude, Pose::longitude, 500);
    const auto sample = hear_text(*dialect_named("ardupilot-json", context),
                                  "{\"timestamp\":1,\"position\":[0,0,0],\"attitude\":[0,0,0],"
                                  "\"quaternion\":[0.7071067811865476,0,0,0.7071067811865476]}\n")
                            .samples.at(0);
    ASSERT_TRUE(sample.attitude);
    EXPECT_NEAR(sample.attitude->yaw().deg(), 90, 1e-9);
}

TEST(ArdupilotJsonDialect, TheMapIsTheScenariosToChoose) {
    FeedContext context;
    context.origin = Geodetic::degrees(Pose::latitude, Pose::longitude, 500);
    const std::string line = "{\"timestamp\":1,\"position\":[1000,0,0]}\n";
    const auto flat = hear_text(*dialect_named("ardupilot-json", context), line).samples.at(0);
    context.map = LocalMap::tangent;
    const auto tangent = hear_text(*dialect_named("ardupilot-json", context), line).samples.at(0);
    EXPECT_GT((flat.position - tangent.position).length().value(), 0.5);
    EXPECT_FALSE(flat.velocity);
    EXPECT_FALSE(flat.attitude);
}

TEST(ArdupilotJsonDialect, RefusesWhatItCannotPlace) {
    const auto homeless = dialect_named("ardupilot-json");
    EXPECT_THAT(hear_text(*homeless, "{\"timestamp\":1,\"position\":[1,2,3]}\n").refusal, HasSubstr("origin"));
    FeedContext context;
    context.origin = Geodetic::degrees(1, 2, 3);
    const auto dialect = dialect_named("ardupilot-json", context);
    EXPECT_THAT(hear_text(*dialect, "[1]\n").refusal, HasSubstr("no JSON object"));
    EXPECT_THAT(hear_text(*dialect, "{\"timestamp\":\"1\"}\n").refusal, HasSubstr("timestamp"));
    EXPECT_THAT(hear_text(*dialect, "{\"timestamp\":1,\"position\":[1,2]}\n").refusal, HasSubstr("position"));
    EXPECT_THAT(hear_text(*dialect, "{\"timestamp\":1,\"position\":[1e9,2,0]}\n").refusal,
                HasSubstr("from the origin"));
    EXPECT_EQ(hear_text(*dialect, std::string(60000, '[') + "\n").refused, 1u);
}

TEST(BetaflightDialect, ReadsTheEighteenDoubles) {
    const auto dialect = dialect_named("betaflight");
    HandBytes packet;
    packet.f64(7.5).f64s({0.1, 0.2, 0.3}).f64s({0, 0, -9.8}).f64s({1, 0, 0, 0});
    packet.f64s({Pose::east, Pose::north, Pose::up}).f64s({Pose::longitude, Pose::latitude, Pose::height}).f64(95000);
    ASSERT_EQ(packet.bytes().size(), 144u);
    const FeedNews news = dialect->hear(packet.bytes(), 0);
    ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
    expect_pose(news.samples[0], {1e-9, 1e-6, 1e-9, 0, 0, false, false});
    EXPECT_EQ(news.samples[0].source_time, Nanoseconds(7'500'000'000));
    EXPECT_THAT(dialect->hear(ByteSpan(packet.bytes()).first(143), 0).refusal, HasSubstr("143 bytes"));
    Bytes timeless = packet.bytes();
    timeless[6] = 0xF8, timeless[7] = 0x7F;
    EXPECT_THAT(dialect->hear(timeless, 0).refusal, HasSubstr("time"));
}

}  // namespace
}  // namespace skyloop
