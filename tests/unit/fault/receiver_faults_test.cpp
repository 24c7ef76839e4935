// Each fault of the receiver's behaviour in the client's bytes, and its end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_hardware.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver_bench.hpp"

namespace skyloop {
namespace {

using fault_test::Given;
using fault_test::make_fault;
using fault_test::ReceiverBench;
using testing::HasSubstr;
using Texts = std::vector<std::string>;

constexpr UbxMessageId told_version{0x0A, 0x04}, told_ack{0x05, 0x01}, told_nak{0x05, 0x00}, told_pvt{0x01, 0x07};
constexpr std::uint32_t item_dynmodel = 0x20110021, item_min_elev = 0x201100A4;

CfgValset one_item(std::uint32_t item, std::uint64_t value) {
    CfgValset message;
    message.layers = 1;
    message.pairs = {{item, value}};
    return message;
}

// A sound receiver answers both questions, and sends its epochs.
void expect_sound(ReceiverBench& bench) {
    bench.forget();
    bench.poll(told_version);
    bench.send(one_item(item_min_elev, 7));
    bench.wait(2);
    EXPECT_EQ(bench.count(told_version), 1U);
    EXPECT_EQ(bench.count(told_ack), 1U);
    EXPECT_EQ(bench.count(told_nak), 0U);
    EXPECT_EQ(bench.count(told_pvt), 2U);
}

TEST(ReceiverFaults, IsSilent) {
    ReceiverBench bench;
    bench.wait(1);
    bench.begin("receiver_silent");
    bench.forget();
    bench.poll(told_version);
    bench.send(one_item(item_dynmodel, 8));
    bench.wait(3);
    EXPECT_EQ(bench.pieces(), 0U);
    EXPECT_EQ(bench.receiver().settings().dynamic_model, DynamicModel::airborne_4g) << "it has heard it";
    bench.end();
    expect_sound(bench);
}

TEST(ReceiverFaults, IsDeaf) {
    ReceiverBench bench;
    bench.begin("receiver_deaf");
    bench.forget();
    bench.poll(told_version);
    bench.send(one_item(item_dynmodel, 8));
    bench.wait(3);
    EXPECT_EQ(bench.count(told_version) + bench.count(told_ack), 0U);
    EXPECT_EQ(bench.count(told_pvt), 3U);
    EXPECT_EQ(bench.receiver().settings().dynamic_model, DynamicModel::portable);
    bench.end();
    expect_sound(bench);
}

TEST(ReceiverFaults, NeverAnswers) {
    ReceiverBench bench;
    bench.begin("never_answers");
    bench.forget();
    bench.poll(told_version);
    bench.send(one_item(item_dynmodel, 8));
    bench.send(one_item(0x20FF0001, 1));
    bench.wait(2);
    EXPECT_EQ(bench.count(told_version) + bench.count(told_ack) + bench.count(told_nak), 0U);
    EXPECT_EQ(bench.count(told_pvt), 2U);
    EXPECT_EQ(bench.receiver().settings().dynamic_model, DynamicModel::airborne_4g);
    bench.end();
    expect_sound(bench);
}

TEST(ReceiverFaults, AnswersSelectively) {
    for (const auto& [kind, given] : std::vector<std::pair<std::string, Given>>{
             {"answers_selectively", {{"messages", Texts{"MON-VER"}}}}, {"no_version", {}}}) {
        ReceiverBench bench;
        bench.begin(kind, given);
        bench.forget();
        bench.poll(told_version);
        bench.send(one_item(item_dynmodel, 8));
        bench.wait(2);
        EXPECT_EQ(bench.count(told_version), 0U) << kind;
        EXPECT_EQ(bench.count(told_ack), 1U) << kind;
        bench.end();
        expect_sound(bench);
    }
}

TEST(ReceiverFaults, RefusesKeys) {
    ReceiverBench bench;
    bench.begin("refuses_keys", {{"keys", Texts{"CFG-NAVSPG-DYNMODEL"}}});
    bench.forget();
    CfgValset both = one_item(item_dynmodel, 8);
    both.pairs.push_back({item_min_elev, 20});
    bench.send(both);
    bench.wait(1);
    EXPECT_EQ(bench.count(told_nak), 1U);
    EXPECT_EQ(bench.count(told_ack), 0U);
    EXPECT_EQ(bench.receiver().settings().dynamic_model, DynamicModel::portable);
    EXPECT_NEAR(bench.receiver().settings().elevation_mask.deg(), 5, 1e-9) << "nothing of it is taken";
    bench.send(one_item(item_min_elev, 20));
    bench.wait(1);
    EXPECT_EQ(bench.count(told_ack), 1U) << "others are";
    bench.end();
    bench.send(both);
    bench.wait(1);
    EXPECT_EQ(bench.receiver().settings().dynamic_model, DynamicModel::airborne_4g);
}

TEST(ReceiverFaults, RefusesMessages) {
    ReceiverBench bench;
    bench.begin("refuses_messages", {{"messages", Texts{"CFG-VALSET", "PUBX,41", "UBX-0A-04"}}});
    bench.forget();
    bench.send(one_item(item_dynmodel, 8));
    bench.say(
        to_bytes(Sentence("PUBX").text("41").text("1").text("0007").text("0003").text("9600").text("0").finish()));
    bench.poll(told_version);
    bench.wait(1);
    EXPECT_EQ(bench.count(told_nak), 2U);
    EXPECT_EQ(bench.count(told_version), 0U);
    EXPECT_EQ(bench.receiver().settings().dynamic_model, DynamicModel::portable);
    EXPECT_EQ(bench.receiver().baud(firmware::PortId::uart1), 115200U);
    bench.end();
    expect_sound(bench);
}

TEST(ReceiverFaults, SaysWhichNamesItKnows) {
    const auto said = [](const std::string& kind, const Given& given) {
        const auto made = make_fault(kind, given);
        EXPECT_FALSE(made);
        return made ? std::string() : made.error().message;
    };
    EXPECT_THAT(said("refuses_keys", {{"keys", Texts{"CFG-NAVSPG-DYNMODL"}}}),
                HasSubstr("did you mean 'CFG-NAVSPG-DYNMODEL'?"));
    EXPECT_THAT(said("answers_selectively", {{"messages", Texts{"MON-VR"}}}), HasSubstr("did you mean 'MON-VER'?"));
    EXPECT_THAT(said("refuses_messages", {{"messages", Texts{"UBX-0A-4"}}}), HasSubstr("'UBX-0A-4'"));
    EXPECT_THAT(said("wrong_version", {}), HasSubstr("neither software nor extensions"));
    EXPECT_THAT(said("wrong_version", {{"software", std::string(31, 'x')}}), HasSubstr("31 characters"));
}

TEST(ReceiverFaults, TakesNamesInLettersOfAnyCase) {
    for (const char* message : {"nav-pvt", "gga", "pubx,41", "ubx-0a-04", "rtcm-1005"})
        EXPECT_TRUE(make_fault("withheld_messages", {{"messages", Texts{message}}})) << message;
    EXPECT_TRUE(make_fault("refuses_messages", {{"messages", Texts{"cfg-valset"}}}));
    EXPECT_TRUE(make_fault("refuses_keys", {{"keys", Texts{"cfg-itfm-enable"}}}));
    ReceiverBench bench;
    bench.begin("withheld_messages", {{"messages", Texts{"nav-pvt"}}});
    bench.forget();
    bench.wait(2);
    EXPECT_EQ(bench.count(told_pvt), 0U);
}

TEST(ReceiverFaults, WithholdsMessages) {
    ReceiverBench bench;
    bench.begin("withheld_messages", {{"messages", Texts{"NAV-PVT", "GGA"}}});
    bench.forget();
    bench.wait(2);
    EXPECT_EQ(bench.count(told_pvt), 0U);
    EXPECT_EQ(bench.sentences(), 2U) << "RMC is left";
    bench.poll(told_pvt);
    bench.wait(0.5);
    EXPECT_EQ(bench.count(told_pvt), 1U) << "who asks gets it";
    bench.wait(0.5);
    bench.end();
    expect_sound(bench);
}

TEST(ReceiverFaults, TellsAnotherVersion) {
    ReceiverBench bench;
    bench.begin("wrong_version", {{"software", std::string("ROM CORE 3.01")}, {"extensions", Texts{"PROTVER=18.00"}}});
    bench.poll(told_version);
    bench.wait(1);
    const auto wrong = bench.last<MonVer>();
    EXPECT_EQ(std::string(wrong.sw_version.data()), "ROM CORE 3.01");
    ASSERT_EQ(wrong.extensions.size(), 1U);
    bench.end();
    bench.poll(told_version);
    bench.wait(1);
    EXPECT_EQ(std::string(bench.last<MonVer>().sw_version.data()), "EXT CORE 4.04 (7f89f7)");
    EXPECT_EQ(bench.last<MonVer>().extensions.size(), 2U);
}

TEST(ReceiverFaults, HidesTheJammingFlag) {
    ReceiverBench bench;
    bench.front_end().interference = Decibels(20);
    bench.wait(1);
    EXPECT_EQ(bench.last<MonRf>().blocks.at(0).flags & 3, 2);
    bench.begin("jamming_flag_hidden");
    bench.wait(1);
    EXPECT_EQ(bench.last<MonRf>().blocks.at(0).flags & 3, 0);
    EXPECT_EQ(bench.last<SecSig1>().jam_flags >> 1 & 3, 2) << "SEC-SIG still tells";
    bench.end();
    bench.wait(1);
    EXPECT_EQ(bench.last<MonRf>().blocks.at(0).flags & 3, 2);
}

TEST(ReceiverFaults, ForgetsItsConfigurationInFlight) {
    ReceiverBench bench;
    CfgValset stored = one_item(0x40520001, 57600);
    stored.layers = 7;
    bench.send(stored);
    bench.wait(2);
    EXPECT_EQ(bench.receiver().baud(firmware::PortId::uart1), 57600U);
    const std::uint64_t epochs = bench.receiver().counters().epochs;
    bench.forget();
    bench.begin("forgets_configuration");
    bench.wait(3);
    EXPECT_EQ(bench.receiver().baud(firmware::PortId::uart1), 115200U) << "the factory's speed";
    EXPECT_EQ(bench.pieces(), 0U) << "no message is configured, and there is no banner";
    EXPECT_EQ(bench.receiver().persistent_text(), "");
    EXPECT_EQ(bench.receiver().counters().epochs, epochs + 3) << "it navigates on";
    EXPECT_EQ(bench.receiver().settings().restarts, 0);
    bench.end();
    bench.send(one_item(*firmware::rate_key(told_pvt, firmware::PortId::uart1), 1));
    bench.wait(1);
    expect_sound(bench);
}

TEST(ReceiverFaults, RebootsWithAndWithoutABanner) {
    for (const bool banner : {true, false}) {
        ReceiverBench bench;
        bench.wait(1);
        bench.forget();
        bench.begin("reboots", {{"start", std::string("warm")}, {"banner", banner}});
        bench.wait(5);
        EXPECT_EQ(bench.sentences() > 0, banner);
        EXPECT_EQ(bench.count(told_pvt), 0U) << "the configuration was in RAM";
        EXPECT_EQ(bench.receiver().settings().start, StartKind::warm);
        EXPECT_EQ(bench.receiver().settings().restarts, 1);
        bench.end();
        bench.send(one_item(*firmware::rate_key(told_pvt, firmware::PortId::uart1), 1));
        bench.wait(1);
        expect_sound(bench);
    }
}

TEST(ReceiverFaults, TakesLongForAColdStart) {
    ReceiverBench bench;
    CfgValset stored = one_item(*firmware::rate_key(told_pvt, firmware::PortId::uart1), 1);
    stored.layers = 7;
    bench.send(stored);
    bench.wait(1);
    bench.begin("slow_cold_start", {{"without_fix_s", 60.0}});
    bench.forget();
    bench.wait(59);
    EXPECT_GT(bench.count(told_pvt), 50U);
    for (const NavPvt& pvt : bench.all<NavPvt>())
        EXPECT_EQ(pvt.fix_type, 0);
    EXPECT_EQ(bench.last<NavPvt>().lat, 0) << "it has forgotten its place";
    bench.wait(2);
    EXPECT_EQ(bench.last<NavPvt>().fix_type, 3);
    bench.end();
    expect_sound(bench);
}

TEST(ReceiverFaults, ChangesItsSpeedAndBack) {
    ReceiverBench bench;
    bench.begin("changed_baud", {{"baud", 19200.0}});
    bench.wait(1);
    EXPECT_EQ(bench.receiver().baud(firmware::PortId::uart1), 19200U);
    EXPECT_EQ(bench.bauds().back(), 19200U);
    bench.end();
    bench.wait(1);
    EXPECT_EQ(bench.receiver().baud(firmware::PortId::uart1), 115200U);
    expect_sound(bench);
    bench.begin("changed_baud", {{"baud", 19200.0}});
    bench.wait(1);
    bench.send(one_item(0x40520001, 38400));
    bench.wait(1);
    bench.end();
    bench.wait(1);
    EXPECT_EQ(bench.receiver().baud(firmware::PortId::uart1), 38400U) << "what the client has set since stays";
}

TEST(ReceiverFaults, AnswersSlowly) {
    ReceiverBench bench;
    bench.begin("slow_answers", {{"delay_s", 1.0}}, 0.5);
    bench.forget();
    bench.poll(told_version);
    bench.wait(0.48);
    EXPECT_EQ(bench.count(told_version), 0U);
    bench.wait(0.15);
    EXPECT_EQ(bench.count(told_version), 1U);
    bench.wait(0.37);
    bench.end();
    expect_sound(bench);
}

TEST(ReceiverFaults, SolvesLateAndLater) {
    ReceiverBench bench;
    bench.begin("solution_latency", {{"delay_s", 0.2}, {"growth_s_per_s", 0.1}});
    bench.forget();
    bench.wait(0.3);  // to 0.2 s after the epoch
    EXPECT_EQ(bench.count(told_pvt), 0U);
    bench.wait(0.15);
    EXPECT_EQ(bench.count(told_pvt), 1U);
    bench.wait(4.55);
    bench.forget();
    bench.wait(0.7);  // 0.2 s and 0.5 s of growth
    EXPECT_EQ(bench.count(told_pvt), 0U);
    bench.wait(0.3);
    EXPECT_EQ(bench.count(told_pvt), 1U);
    bench.end();
    expect_sound(bench);
}

TEST(ReceiverFaults, RunsByAnotherClock) {
    const auto made = make_fault("clock_drift", {{"ppm", 200.0}});
    ASSERT_TRUE(made);
    PaceConditions pace;
    made->pace(pace, {GpsTime{}, Seconds(1), 0.5, nullptr, nullptr});
    EXPECT_DOUBLE_EQ(pace.rate, 1.0001);
    made->pace(pace, {GpsTime{}, Seconds(2), 0, nullptr, nullptr});
    EXPECT_DOUBLE_EQ(pace.rate, 1.0001) << "nothing of it at no strength";
}

// What every kind of these layers promises to those who document it.
TEST(ReceiverFaults, KindsSayWhatTheyDoAndStandFor) {
    std::set<std::string_view> names;
    for (const FaultKind& kind : fault_kinds()) {
        EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
        EXPECT_TRUE(kind.effect.ends_with(".")) << kind.name;
        EXPECT_TRUE(kind.cause.ends_with(".")) << kind.name;
        EXPECT_TRUE(kind.make) << kind.name;
        EXPECT_EQ(find_fault_kind(kind.name), &kind);
    }
}

}  // namespace
}  // namespace skyloop
