#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <variant>

#include "run/fault/fault_kind.hpp"
#include "run/fault/wire_damage.hpp"
#include "wire_stream.hpp"

namespace skyloop {
namespace {

using test::append_bytes;
using test::heard_stream;
using test::wire_message;
using test::wire_start;
using test::wire_time;

using Given = std::map<std::string, ParameterValue, std::less<>>;

Result<Fault> try_wire_fault(std::string_view name, const Given& given = {}) {
    const FaultKind* kind = find_fault_kind(name);
    if (kind == nullptr) return fail(ErrorCode::usage, "no such kind");
    const CheckedParameters checked = check_parameters(kind->parameters, given);
    for (const ParameterMistake& mistake : checked.mistakes)
        return fail(ErrorCode::usage, mistake.name + " " + mistake.sentence);
    return kind->make(checked.parameters, {1, std::string(name)});
}

Fault wire_fault(std::string_view name, const Given& given = {}) {
    auto fault = try_wire_fault(name, given);
    EXPECT_TRUE(fault) << name << ": " << (fault ? "" : fault.error().message);
    return fault ? *fault : Fault{};
}

FaultMoment moment_of(double since_start, double strength = 1) {
    FaultMoment moment;
    moment.now = wire_time(since_start);
    moment.since_start = Seconds(since_start);
    moment.strength = strength;
    return moment;
}

WireConditions conditions_of(const Fault& fault, double since_start = 0, double strength = 1) {
    WireConditions conditions;
    if (fault.wire) fault.wire(conditions, moment_of(since_start, strength));
    return conditions;
}

struct WireRun {
    Bytes sent, heard;
    std::vector<std::size_t> by_tenths;  ///< bytes heard by each tenth of a second
    std::vector<std::size_t> sent_by_tenths;
};

// Ten messages a second to the client, `seconds` with the fault, then ten without it.
WireRun run_with(const Fault& fault, int seconds) {
    WireDamage wire(7, "wire 0 to client");
    WireRun run;
    for (int hundredth = 0; hundredth < (seconds + 10) * 100; ++hundredth) {
        const double t = 0.01 * hundredth;
        WireConditions conditions;
        if (hundredth < seconds * 100 && fault.wire) fault.wire(conditions, moment_of(t));
        wire.set(conditions.to_client, wire_time(t));
        if (hundredth % 10 == 0) {
            const Bytes message = wire_message(hundredth / 10);
            wire.put(message, wire_time(t));
            append_bytes(run.sent, message);
        }
        append_bytes(run.heard, wire.take(wire_time(t)));
        if (hundredth % 10 != 0) continue;
        run.by_tenths.push_back(run.heard.size());
        run.sent_by_tenths.push_back(run.sent.size());
    }
    EXPECT_EQ(wire.waiting(), 0U);
    return run;
}

std::size_t whole_messages(const WireRun& run) { return heard_stream(run.heard).messages.size(); }

const std::vector<std::string> wire_names = {
    "byte_loss",   "bit_flips",       "checksum_errors", "truncated_messages", "merged_messages",    "inserted_garbage",
    "wire_delay",  "wire_jitter",     "stall",           "duplicate_messages", "reordered_messages", "saturated_uart",
    "line_break",  "unplugged",       "power_cut",       "speed_mismatch",     "one_direction_dead", "can_bus_off",
    "lost_frames", "reordered_frames"};

TEST(WireFaults, AreAllListedAndExplained) {
    std::vector<std::string> names;
    for (const FaultKind& kind : fault_kinds()) {
        if (kind.layer != FaultLayer::wire) continue;
        names.emplace_back(kind.name);
        for (const std::string_view sentence : {kind.effect, kind.cause}) {
            EXPECT_GT(sentence.size(), 15U) << kind.name;
            EXPECT_EQ(sentence.back(), '.') << kind.name;
        }
        EXPECT_FALSE(kind.measuring_receivers_only);
    }
    EXPECT_EQ(names, wire_names);
}

// Each with its standards: something is other than it should be while it lasts, and nothing is afterwards.
TEST(WireFaults, ShowInTheBytesAndEndWithoutResidue) {
    const std::set<std::string> of_the_whole_wire = {"line_break", "unplugged", "speed_mismatch"};
    for (const std::string& name : wire_names) {
        SCOPED_TRACE(name);
        const Fault fault = wire_fault(name);
        EXPECT_NE(conditions_of(fault), WireConditions{});
        EXPECT_EQ(conditions_of(fault, 0, 0), WireConditions{});  // at the beginning of a ramp
        if (of_the_whole_wire.contains(name)) continue;           // the link acts on these
        // More than fits through 9600 baud needs a lower limit here.
        const WireRun run = run_with(name == "saturated_uart" ? wire_fault(name, {{"bytes_per_s", 100.0}}) : fault, 60);
        EXPECT_TRUE(run.by_tenths != run.sent_by_tenths || run.heard != run.sent);
        Bytes after;
        for (int i = 600; i < 700; ++i)
            append_bytes(after, wire_message(i));
        ASSERT_GE(run.heard.size(), after.size());
        EXPECT_TRUE(std::equal(after.rbegin(), after.rend(), run.heard.rbegin()));
        // One to one from the first message after the end on.
        const std::size_t shift = run.by_tenths[600] - run.sent_by_tenths[600];
        for (std::size_t tenth = 600; tenth < 700; ++tenth)
            ASSERT_EQ(run.by_tenths[tenth] - run.sent_by_tenths[tenth], shift);
    }
}

TEST(WireFaults, SpoilMessagesAtTheirRates) {
    // 100 s: 1000 messages of which 0.3 are hit, and 100 that are sound.
    const Given often = {{"probability", 0.3}};
    EXPECT_NEAR(static_cast<double>(whole_messages(run_with(wire_fault("checksum_errors", often), 100))), 800, 90);
    EXPECT_NEAR(static_cast<double>(whole_messages(run_with(wire_fault("truncated_messages", often), 100))), 800, 150);
    // A message is whole when neither it nor the one before it is hit: 0.7 squared.
    EXPECT_NEAR(static_cast<double>(whole_messages(run_with(wire_fault("merged_messages", often), 100))), 590, 150);
    EXPECT_NEAR(static_cast<double>(whole_messages(run_with(wire_fault("duplicate_messages", often), 100))), 1400, 90);
    const auto reordered = heard_stream(run_with(wire_fault("reordered_messages", often), 100).heard).messages;
    ASSERT_EQ(reordered.size(), 1100U);
    int late = 0;
    for (std::size_t i = 0; i + 1 < reordered.size(); ++i)
        late += reordered[i] == wire_message(static_cast<int>(i) + 1) ? 1 : 0;
    EXPECT_NEAR(late, 1000 * 0.3 / 1.3, 90);  // none while another one is late
}

TEST(WireFaults, LoseAndTurnBytesAtTheirRates) {
    const WireRun loss = run_with(wire_fault("byte_loss", {{"probability", 0.05}}), 100);
    EXPECT_NEAR(static_cast<double>(loss.sent.size() - loss.heard.size()), 0.05 * 36'000, 300);
    const WireRun flips = run_with(wire_fault("bit_flips", {{"probability", 0.01}}), 100);
    ASSERT_EQ(flips.heard.size(), flips.sent.size());
    EXPECT_NEAR(static_cast<double>(whole_messages(flips)), 100 + 1000 * std::pow(0.99, 8 * 36), 90);
    const WireRun garbage =
        run_with(wire_fault("inserted_garbage", {{"bursts_per_s", 3.0}, {"burst_bytes", 4.0}}), 100);
    EXPECT_NEAR(static_cast<double>(garbage.heard.size() - garbage.sent.size()), 1200, 420);
}

TEST(WireFaults, DelayEveryMessage) {
    const WireRun run = run_with(wire_fault("wire_delay", {{"delay_s", 0.5}}), 20);
    EXPECT_EQ(run.heard, run.sent);
    for (std::size_t tenth = 5; tenth < 200; ++tenth)
        EXPECT_EQ(run.by_tenths[tenth], run.sent_by_tenths[tenth - 5]);
}

TEST(WireFaults, JitterKeepsTheOrder) {
    const WireRun run = run_with(wire_fault("wire_jitter", {{"sigma_s", 0.2}}), 60);
    EXPECT_EQ(run.heard, run.sent);
    int late = 0;
    for (std::size_t tenth = 0; tenth < 600; ++tenth)
        late += run.by_tenths[tenth] < run.sent_by_tenths[tenth] ? 1 : 0;
    EXPECT_GT(late, 200);
    EXPECT_LT(late, 590);
}

TEST(WireFaults, StallsComeAgainAndEndInABurst) {
    const WireRun run = run_with(wire_fault("stall", {{"hold_s", 2.0}, {"period_s", 5.0}}), 60);
    EXPECT_EQ(run.heard, run.sent);
    for (std::size_t tenth = 0; tenth < 600; ++tenth) {
        const std::size_t held_since = tenth - tenth % 50;
        if (tenth % 50 < 20)
            EXPECT_EQ(run.by_tenths[tenth], held_since == 0 ? 0 : run.sent_by_tenths[held_since - 1]) << tenth;
        else
            EXPECT_EQ(run.by_tenths[tenth], run.sent_by_tenths[tenth]) << tenth;
    }
    const auto impossible = try_wire_fault("stall", {{"hold_s", 5.0}, {"period_s", 5.0}});
    ASSERT_FALSE(impossible);
    EXPECT_EQ(impossible.error().code, ErrorCode::usage);
}

// The lag of a saturated UART grows for as long as it lasts (ArduPilot issue 14400).
TEST(WireFaults, SaturationMakesALagThatGrows) {
    const WireRun run = run_with(wire_fault("saturated_uart", {{"baud", 1000.0}}), 60);
    EXPECT_EQ(run.heard, run.sent);
    std::size_t lag = 0;
    for (std::size_t tenth = 100; tenth < 600; tenth += 100) {
        const std::size_t behind = run.sent_by_tenths[tenth] - run.by_tenths[tenth];
        EXPECT_GT(behind, lag + 1000) << tenth;
        EXPECT_NEAR(static_cast<double>(run.by_tenths[tenth]), static_cast<double>(tenth) * 10, 2);
        lag = behind;
    }
    EXPECT_EQ(conditions_of(wire_fault("saturated_uart")).to_client.bytes_per_s, 960);
    EXPECT_EQ(conditions_of(wire_fault("saturated_uart", {{"baud", 1000.0}}), 0, 0.5).to_client.bytes_per_s, 200);
    const auto both = try_wire_fault("saturated_uart", {{"baud", 9600.0}, {"bytes_per_s", 100.0}});
    ASSERT_FALSE(both);
    EXPECT_EQ(both.error().code, ErrorCode::usage);
}

TEST(WireFaults, WorkInTheDirectionTheyAreTold) {
    for (const std::string& name : wire_names) {
        const FaultKind* kind = find_fault_kind(name);
        ASSERT_NE(kind, nullptr);
        for (const ParameterSpec& parameter : kind->parameters) {
            if (parameter.name != "direction") continue;
            for (const std::string_view choice : parameter.choices) {
                const std::string direction(choice);
                SCOPED_TRACE(name + " " + direction);
                const WireConditions conditions = conditions_of(wire_fault(name, {{"direction", direction}}));
                EXPECT_EQ(conditions.to_client != WireDirection{}, direction != "to_receiver");
                EXPECT_EQ(conditions.to_receiver != WireDirection{}, direction != "to_client");
            }
        }
    }
    EXPECT_FALSE(try_wire_fault("byte_loss", {{"direction", std::string("up")}}));
    EXPECT_FALSE(try_wire_fault("byte_loss", {{"probability", 1.5}}));
}

TEST(WireFaults, CombineWithEachOther) {
    WireConditions conditions;
    const auto add = [&](std::string_view name, const Given& given, double strength = 1) {
        wire_fault(name, given).wire(conditions, moment_of(0, strength));
    };
    add("byte_loss", {{"probability", 0.5}});
    add("byte_loss", {{"probability", 1.0}}, 0.2);
    EXPECT_DOUBLE_EQ(conditions.to_client.byte_loss, 0.6);
    add("wire_delay", {{"delay_s", 1.0}});
    add("wire_delay", {{"delay_s", 2.0}}, 0.5);
    EXPECT_DOUBLE_EQ(conditions.to_client.delay.value(), 2);
    add("wire_jitter", {{"sigma_s", 0.3}});
    add("wire_jitter", {{"sigma_s", 0.4}});
    EXPECT_DOUBLE_EQ(conditions.to_client.jitter.value(), 0.5);
    add("saturated_uart", {{"bytes_per_s", 500.0}});
    add("saturated_uart", {{"bytes_per_s", 400.0}});
    add("saturated_uart", {{"bytes_per_s", 600.0}});
    EXPECT_EQ(conditions.to_client.bytes_per_s, 400);
    add("inserted_garbage", {{"bursts_per_s", 2.0}, {"burst_bytes", 30.0}});
    add("inserted_garbage", {{"bursts_per_s", 3.0}, {"burst_bytes", 20.0}});
    EXPECT_EQ(conditions.to_client.garbage, (std::vector<GarbageBursts>{{2, 30}, {3, 20}}));
    EXPECT_EQ(conditions.to_receiver, WireDirection{});
}

TEST(WireFaults, CutTheWholeWire) {
    EXPECT_TRUE(conditions_of(wire_fault("line_break")).line_break);
    EXPECT_TRUE(conditions_of(wire_fault("unplugged")).unplugged);
    EXPECT_EQ(conditions_of(wire_fault("speed_mismatch")).receiver_baud, 9600U);
    EXPECT_EQ(conditions_of(wire_fault("speed_mismatch", {{"baud", 57600.0}})).receiver_baud, 57600U);
}

TEST(WireFaults, APowerCutSilencesTheReceiverAndRestartsIt) {
    const Fault fault = wire_fault("power_cut", {{"start", std::string("warm")}});
    const WireConditions conditions = conditions_of(fault);
    EXPECT_TRUE(conditions.to_client.dead);
    EXPECT_TRUE(conditions.to_receiver.dead);
    EXPECT_TRUE(conditions.power_cut) << "a real one behind it is cut too";
    firmware::FirmwareFaults faults;
    ASSERT_TRUE(fault.firmware);
    fault.firmware(faults, moment_of(1));
    EXPECT_TRUE(faults.deaf);
    EXPECT_TRUE(faults.mute);
    EXPECT_TRUE(fault.at_start.empty());
    ASSERT_EQ(fault.at_end.size(), 1U);
    const auto* reboot = std::get_if<firmware::Reboot>(&fault.at_end[0]);
    ASSERT_NE(reboot, nullptr);
    EXPECT_EQ(reboot->kind, StartKind::warm);
    EXPECT_TRUE(reboot->banner);
    EXPECT_FALSE(reboot->loses_battery) << "what it still knows the battery has kept, and settings with it";
}

TEST(WireFaults, APowerCutWithoutABatteryLosesWhatItKept) {
    const Fault fault = wire_fault("power_cut");
    ASSERT_EQ(fault.at_end.size(), 1U);
    const auto* reboot = std::get_if<firmware::Reboot>(&fault.at_end[0]);
    ASSERT_NE(reboot, nullptr);
    EXPECT_EQ(reboot->kind, StartKind::cold);
    EXPECT_TRUE(reboot->loses_battery);
}

}  // namespace
}  // namespace skyloop
