#include "client_bench.hpp"
#include "run/client/configuration_dialogue.hpp"

namespace skyloop::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A careful client that trusts a sound receiver after 15 s.
class CarefulUbx : public ::testing::Test {
protected:
    CarefulUbx() { receiver.run(seconds(15)); }
    ClientBench bench{"careful-ubx"};
    BenchReceiver receiver{bench};
};

TEST_F(CarefulUbx, FindsConfiguresAndTrustsASoundReceiver) {
    EXPECT_TRUE(bench.trusts()) << bench.reason();
    EXPECT_EQ(bench.speed(), 115200u);
    EXPECT_EQ(receiver.speed, 115200u);
    EXPECT_EQ(receiver.period_ms, 200);
    EXPECT_EQ(receiver.solution_rate, 1);
    ASSERT_EQ(bench.beliefs.size(), 2u);
    EXPECT_FALSE(bench.beliefs[0].trusts);
    EXPECT_EQ(bench.beliefs[0].reason, "nothing heard yet");
}

TEST_F(CarefulUbx, DistrustsAfterTwoSecondsOfSilenceAndComesBack) {
    receiver.mute = true;
    receiver.run(milliseconds(1600));
    EXPECT_TRUE(bench.trusts());
    receiver.run(milliseconds(800));
    EXPECT_FALSE(bench.trusts());
    EXPECT_EQ(bench.reason(), "no message for 2 s");
    receiver.run(seconds(3));
    receiver.mute = false;
    receiver.run(seconds(20));
    EXPECT_TRUE(bench.trusts()) << bench.reason();
}

TEST_F(CarefulUbx, ConfiguresAgainAfterAResetToFactorySpeed) {
    receiver.speed = 9600;
    receiver.solution_rate = 0;
    receiver.period_ms = 1000;
    receiver.settings = 0;
    receiver.run(seconds(25));
    EXPECT_GT(receiver.settings, 5);
    EXPECT_EQ(receiver.speed, 115200u);
    EXPECT_TRUE(bench.trusts()) << bench.reason();
}

TEST_F(CarefulUbx, ConfiguresAgainWhenSentencesCome) {
    receiver.settings = 0;
    bench.say(ByteSpan(to_bytes("$GNGLL,,,,,,V,N*7A\r\n")));
    EXPECT_FALSE(bench.trusts());
    receiver.run(seconds(3));
    EXPECT_GT(receiver.settings, 5);
}

struct WrongSolution {
    const char* name;
    std::function<void(NavPvt&)> edit;
    const char* reason;
    int seconds = 2;
};

class CarefulUbxDoubts : public ::testing::TestWithParam<WrongSolution> {};

TEST_P(CarefulUbxDoubts, OnceAndUntilItIsOver) {
    ClientBench bench("careful-ubx");
    BenchReceiver receiver(bench);
    receiver.run(seconds(15));
    ASSERT_TRUE(bench.trusts()) << bench.reason();
    receiver.edit = GetParam().edit;
    const std::size_t before = bench.beliefs.size();
    receiver.run(seconds(GetParam().seconds));
    ASSERT_GT(bench.beliefs.size(), before);
    EXPECT_FALSE(bench.beliefs.at(before).trusts);
    EXPECT_NE(bench.beliefs.at(before).reason.find(GetParam().reason), std::string::npos)
        << bench.beliefs.at(before).reason;
    receiver.edit = nullptr;
    receiver.run(seconds(4));
    EXPECT_FALSE(bench.trusts()) << "trusted again before five good seconds";
    receiver.run(seconds(21));
    EXPECT_TRUE(bench.trusts()) << bench.reason();
}

const WrongSolution wrong_solutions[] = {
    {"NoFixFlag", [](NavPvt& p) { p.flags = 0; }, "no fix"},
    {"OnlyTwoDimensions", [](NavPvt& p) { p.fix_type = 2; }, "no 3D fix"},
    {"FewSatellites", [](NavPvt& p) { p.num_sv = 5; }, "5 satellites"},
    {"HorizontalAccuracy", [](NavPvt& p) { p.h_acc = 5100; }, "horizontal accuracy 5.1 m"},
    {"VerticalAccuracy", [](NavPvt& p) { p.v_acc = 7600; }, "vertical accuracy 7.6 m"},
    {"SpeedAccuracy", [](NavPvt& p) { p.s_acc = 1100; }, "speed accuracy 1.1 m/s"},
    {"NowhereWithFix", [](NavPvt& p) { p.lat = p.lon = 0; }, "latitude 0, longitude 0"},
    {"InvalidPosition", [](NavPvt& p) { p.flags3 = 1; }, "without a position"},
    {"TimeStandsStill", [](NavPvt& p) { p.i_tow = 1000; }, "time"},
    {"PositionStep", [](NavPvt& p) { p.lon += 4000; }, "positions moved"},
    {"HeightStep", [](NavPvt& p) { p.height += 12'000; }, "heights moved"},
    {"VelocityOff", [](NavPvt& p) { p.vel_e = 3000; }, "positions moved", 6},
    {"Frozen", [](NavPvt& p) { p.lat = 474'000'000; }, "positions moved", 2},
    {"Leap", [](NavPvt& p) { p.second = static_cast<std::uint8_t>(p.second < 58 ? p.second + 2 : p.second - 2); },
     "UTC lies"},
    {"OldDate", [](NavPvt& p) { p.year = 2006; }, "date before"},
    {"Acceleration", [](NavPvt& p) { p.vel_e = 20'000; }, "velocity changed"},
};

INSTANTIATE_TEST_SUITE_P(Each, CarefulUbxDoubts, ::testing::ValuesIn(wrong_solutions),
                         [](const auto& tested) { return std::string(tested.param.name); });

// Runs of any year: what a client knows of dates is of its own time.
TEST(CarefulUbxDates, FollowTheRun) {
    for (const int week : {1600, 1915, 2045, 2407, 2900}) {
        ClientBench bench("careful-ubx", to_gps_time(week, 100000));
        BenchReceiver receiver(bench);
        receiver.run(seconds(15));
        EXPECT_TRUE(bench.trusts()) << week << ": " << bench.reason();
        receiver.edit = [](NavPvt& p) { p.year = static_cast<std::uint16_t>(p.year - 2); };
        receiver.run(seconds(2));
        EXPECT_FALSE(bench.trusts()) << week;
        EXPECT_NE(bench.beliefs.back().reason.find("date before"), std::string::npos) << bench.reason();
    }
}

// The leap second at the end of 2016, which makes 17 s of difference 18.
TEST(CarefulUbxDates, FollowALeapSecond) {
    const GpsTime leap = to_gps_time(1930, 18);
    ClientBench bench("careful-ubx", leap - seconds(16));
    BenchReceiver receiver(bench);
    receiver.run(seconds(14));
    ASSERT_TRUE(bench.trusts()) << bench.reason();
    const std::size_t before = bench.beliefs.size();
    receiver.run(seconds(10));
    EXPECT_EQ(bench.beliefs.size(), before) << bench.reason();
}

TEST_F(CarefulUbx, DoubtsLateSolutions) {
    int late_ms = 0;  // a line that carries less than is sent: each solution comes later than the one before
    receiver.edit = [&](NavPvt& p) {
        late_ms = std::min(late_ms + 50, 600);
        p = BenchSolution(bench.now - milliseconds(late_ms)).pvt;
    };
    receiver.run(seconds(1));
    EXPECT_TRUE(bench.trusts()) << bench.reason();
    receiver.run(seconds(1));
    EXPECT_FALSE(bench.trusts());
    EXPECT_NE(bench.reason().find("later than at first"), std::string::npos) << bench.reason();
    receiver.run(seconds(20));
    EXPECT_FALSE(bench.trusts()) << "lateness must not become the rule";
}

TEST_F(CarefulUbx, DoubtsAClockThatGains) {
    const GpsTime from = bench.now;
    receiver.edit = [&](NavPvt& p) {
        p.i_tow += static_cast<std::uint32_t>(difference(bench.now, from).value() * 10);  // 1 %
    };
    receiver.run(seconds(6));
    EXPECT_TRUE(bench.trusts()) << bench.reason();
    receiver.run(seconds(8));
    EXPECT_FALSE(bench.trusts());
    EXPECT_NE(bench.reason().find("off what our clock expects"), std::string::npos) << bench.reason();
}

TEST_F(CarefulUbx, RemembersInterferenceAndSpoofingForFiveSeconds) {
    NavStatus status;
    status.flags2 = 2u << 3;
    bench.say(status);
    EXPECT_FALSE(bench.trusts());
    EXPECT_EQ(bench.reason(), "spoofing (NAV-STATUS)");
    receiver.run(seconds(9));
    EXPECT_FALSE(bench.trusts());
    receiver.run(seconds(3));
    EXPECT_TRUE(bench.trusts()) << bench.reason();
    Bytes hardware(60, 0);
    hardware[22] = 2u << 2;  // a warning alone is no reason
    bench.say(ByteSpan(encode_frame({0x0A, 0x09}, hardware)));
    EXPECT_TRUE(bench.trusts());
    hardware[22] = 3u << 2;
    bench.say(ByteSpan(encode_frame({0x0A, 0x09}, hardware)));
    EXPECT_FALSE(bench.trusts());
}

TEST_F(CarefulUbx, DoubtsAWeekThatDoesNotFollow) {
    NavTimegps time;
    time.i_tow = static_cast<std::uint32_t>(week_and_tow(bench.now).tow.count() / 1'000'000);
    time.week = 2406;
    time.valid = 3;
    bench.say(time);
    receiver.run(milliseconds(400));
    EXPECT_FALSE(bench.trusts());
    EXPECT_NE(bench.reason().find("week"), std::string::npos) << bench.reason();
}

TEST_F(CarefulUbx, CountsDamagedMessages) {
    for (int i = 0; i < 2; ++i) {
        Bytes broken = encode_frame(BenchSolution(bench.now).pvt);
        broken[20] ^= 1;
        bench.say(ByteSpan(broken));
        receiver.run(milliseconds(200));
    }
    EXPECT_TRUE(bench.trusts()) << "two are a spark";
    for (int i = 0; i < 4; ++i) {
        Bytes broken = encode_frame(BenchSolution(bench.now).pvt);
        broken[20] ^= 1;
        bench.say(ByteSpan(broken));
        receiver.run(milliseconds(200));
    }
    EXPECT_FALSE(bench.trusts());
    EXPECT_NE(bench.reason().find("damaged messages"), std::string::npos) << bench.reason();
}

TEST(CarefulUbxConfiguration, GoesOnWithoutAVersion) {
    ClientBench bench("careful-ubx");
    BenchReceiver receiver(bench);
    receiver.answers_version = false;
    bench.say(ByteSpan(to_bytes("$GNGLL,,,,,,V,N*7A\r\n")));  // shows the speed
    receiver.run(seconds(15));
    EXPECT_TRUE(bench.trusts()) << bench.reason();
}

TEST(CarefulUbxConfiguration, GoesOnWithoutAcknowledgements) {
    ClientBench bench("careful-ubx");
    BenchReceiver receiver(bench);
    receiver.acknowledges = false;
    receiver.run(seconds(25));
    EXPECT_EQ(receiver.solution_rate, 1);
    EXPECT_TRUE(bench.trusts()) << bench.reason();
}

TEST(CarefulUbxConfiguration, HuntsTheSpeed) {
    ClientBench bench("careful-ubx");
    BenchReceiver receiver(bench);
    receiver.speed = 57600;
    receiver.run(seconds(20));
    EXPECT_TRUE(bench.trusts()) << bench.reason();
}

/// Of a receiver that refuses NAV-PVT, after 15 s.
class CarefulUbxOfOldReceivers : public ::testing::Test {
protected:
    CarefulUbxOfOldReceivers() {
        receiver.has_pvt = false;
        receiver.run(seconds(15));
    }
    ClientBench bench{"careful-ubx"};
    BenchReceiver receiver{bench};
};

TEST_F(CarefulUbxOfOldReceivers, TakesTheMessagesBeforeNavPvtAndTrustsThem) {
    EXPECT_TRUE(bench.trusts()) << bench.reason();
    for (const UbxMessageId id :
         {NavPosllh::message_id, NavSol::message_id, NavVelned::message_id, NavTimeutc::message_id})
        EXPECT_TRUE(receiver.old_messages.contains(id));
    const int settings = receiver.settings;
    receiver.run(seconds(60));
    EXPECT_TRUE(bench.trusts()) << bench.reason();
    EXPECT_EQ(receiver.settings, settings) << "it configures again what it has configured";
}

TEST_F(CarefulUbxOfOldReceivers, SeesInEachMessageWhatIsWrong) {
    struct Wrong {
        std::function<void(NavPvt&)> edit;
        const char* reason;
    };
    const Wrong wrongs[] = {
        {[](NavPvt& p) { p.flags = 0; }, "no fix"},                                          // NAV-SOL
        {[](NavPvt& p) { p.num_sv = 5; }, "5 satellites"},                                   // NAV-SOL
        {[](NavPvt& p) { p.h_acc = 5100; }, "horizontal accuracy 5.1 m"},                    // NAV-POSLLH
        {[](NavPvt& p) { p.height += 12'000; }, "heights moved"},                            // NAV-POSLLH
        {[](NavPvt& p) { p.s_acc = 1100; }, "speed accuracy 1.1 m/s"},                       // NAV-VELNED
        {[](NavPvt& p) { p.vel_e = std::numeric_limits<int>::min(); }, "velocity changed"},  // NAV-VELNED
        {[](NavPvt& p) { p.year = 2006; }, "date before"},                                   // NAV-TIMEUTC
    };
    for (const Wrong& wrong : wrongs) {
        const std::size_t before = bench.beliefs.size();
        receiver.edit = wrong.edit;
        receiver.run(seconds(1));
        ASSERT_GT(bench.beliefs.size(), before) << wrong.reason;
        EXPECT_NE(bench.beliefs.at(before).reason.find(wrong.reason), std::string::npos)
            << bench.beliefs.at(before).reason;
        receiver.edit = nullptr;
        receiver.run(seconds(25));
        EXPECT_TRUE(bench.trusts()) << bench.reason();
    }
}

TEST_F(CarefulUbxOfOldReceivers, ConfiguresAgainWhenOneOfThemStops) {
    receiver.settings = 0;
    receiver.old_messages.erase(NavVelned::message_id);
    receiver.run(seconds(30));
    EXPECT_GT(receiver.settings, 5);
    EXPECT_TRUE(receiver.old_messages.contains(NavVelned::message_id));
    EXPECT_TRUE(bench.trusts()) << bench.reason();
}

TEST(NaiveUbx, WaitsForTheVersionForEver) {
    ClientBench bench("naive-ubx");
    bench.pass(milliseconds(200));
    ASSERT_EQ(bench.take(MonVer::message_id).size(), 1u);
    bench.pass(seconds(60));
    bench.say(BenchSolution(bench.now).pvt);
    EXPECT_FALSE(bench.trusts());
    EXPECT_TRUE(bench.heard.empty()) << "it asked again";
    bench.say(MonVer{});
    EXPECT_EQ(bench.take(CfgMsg::message_id).size(), 1u);
    bench.say(BenchSolution(bench.now).pvt);
    EXPECT_TRUE(bench.trusts());
}

TEST(NaiveUbx, BelievesWhatHasAFixType) {
    ClientBench bench("naive-ubx");
    bench.say(MonVer{});
    NavPvt pvt = BenchSolution(bench.now).pvt;
    pvt.lat = pvt.lon = 0;
    pvt.h_acc = 99'999;
    bench.say(pvt);
    EXPECT_TRUE(bench.trusts());
    bench.pass(seconds(60));
    EXPECT_TRUE(bench.trusts()) << "silence is nothing to it";
    pvt.fix_type = 0;
    bench.say(pvt);
    EXPECT_FALSE(bench.trusts());
}

TEST(OpenClient, ListsTheNames) {
    const auto opened = open_client("carefull-ubx");
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, ErrorCode::usage);
    EXPECT_NE(opened.error().message.find("port 'client:carefull-ubx': no such client"), std::string::npos);
    EXPECT_NE(opened.error().message.find("careful-ubx, naive-ubx, careful-nmea, naive-nmea"), std::string::npos);
    for (const std::string_view name : client_names())
        EXPECT_TRUE(open_client(name)) << name;
    EXPECT_EQ(client_of_uri("client:x"), "x");
    EXPECT_FALSE(client_of_uri("pty:client:x"));
}

}  // namespace
}  // namespace skyloop::test
