// What goes wrong on a CAN bus: frames as lines of SLCAN, and a node's flags.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/core/can_frame.hpp"
#include "receiver/protocol/dronecan_transfer.hpp"
#include "run/fault/fault_kind.hpp"
#include "run/fault/receiver_needs.hpp"
#include "run/fault/wire_damage.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using testing::IsEmpty;

using CanGiven = std::map<std::string, ParameterValue, std::less<>>;

Fault can_fault(std::string_view name, const CanGiven& given = {}) {
    const FaultKind* kind = find_fault_kind(name);
    EXPECT_NE(kind, nullptr) << name;
    if (kind == nullptr) return {};
    EXPECT_EQ(kind->need, &can_node) << name;
    auto fault = kind->make(check_parameters(kind->parameters, given).parameters, {1, std::string(name)});
    EXPECT_TRUE(fault) << name;
    return fault ? *fault : Fault{};
}

FaultMoment can_moment(double strength = 1) {
    FaultMoment moment;
    moment.strength = strength;
    return moment;
}

firmware::FirmwareFaults node_with(const Fault& fault) {
    firmware::FirmwareFaults faults;
    if (fault.firmware) fault.firmware(faults, can_moment());
    return faults;
}

// A hundred transfers of ten frames each, and what arrives of them.
struct CanRun {
    std::vector<CanFrame> sent, heard;
    DronecanCounts counts;
};

CanRun can_run(const Fault& fault) {
    CanRun run;
    WireConditions conditions;
    if (fault.wire) fault.wire(conditions, can_moment());
    WireDamage wire(5, "wire 0 to client");
    GpsTime now{1000s};
    wire.set(conditions.to_client, now);
    SlcanLines lines;
    TransferReceiver receiver;
    const auto take = [&] {
        for (const std::string& line : lines.feed(wire.take(now))) {
            const auto frame = parse_slcan_line(line);
            ASSERT_TRUE(frame) << line << ": frames stay whole";
            run.heard.push_back(*frame);
            static_cast<void>(receiver.take(*frame, now));
        }
    };
    for (std::uint8_t i = 0; i < 100; ++i) {
        DronecanTransfer fix{DronecanKind::message, 1063, 24, 42, 0, static_cast<std::uint8_t>(i % 32), Bytes(62, i)};
        for (const CanFrame& frame : dronecan_frames(fix, DronecanFix2::type.signature)) {
            run.sent.push_back(frame);
            wire.put(to_bytes(slcan_line(frame)), now);
        }
        now += 100ms;
        take();
    }
    wire.set({}, now += 5s);
    take();
    run.counts = receiver.counts();
    return run;
}

TEST(CanFaults, LoseWholeFramesAndWithThemTransfers) {
    const CanRun sound = can_run({});
    EXPECT_EQ(sound.heard, sound.sent);
    EXPECT_EQ(sound.counts.transfers, 100U);
    const CanRun run = can_run(can_fault("lost_frames", {{"probability", 0.05}}));
    EXPECT_NEAR(static_cast<double>(run.heard.size()), 950, 30);
    EXPECT_NEAR(static_cast<double>(run.counts.transfers), 100 * std::pow(0.95, 10), 16);
    EXPECT_THAT(can_run(can_fault("lost_frames", {{"probability", 1.0}})).heard, IsEmpty());
}

TEST(CanFaults, LetFramesChangePlaces) {
    const CanRun run = can_run(can_fault("reordered_frames", {{"probability", 0.05}}));
    EXPECT_EQ(run.heard.size(), run.sent.size()) << "none is lost";
    EXPECT_NE(run.heard, run.sent);
    EXPECT_TRUE(std::is_permutation(run.heard.begin(), run.heard.end(), run.sent.begin(),
                                    [](const CanFrame& a, const CanFrame& b) { return a == b; }));
    EXPECT_LT(run.counts.transfers, 75U);
    EXPECT_GT(run.counts.out_of_order, 20U);
}

TEST(CanFaults, TakeAControllerOffTheBus) {
    const Fault fault = can_fault("can_bus_off");
    WireConditions conditions;
    fault.wire(conditions, can_moment());
    EXPECT_TRUE(conditions.to_client.dead && conditions.to_receiver.dead);
    EXPECT_THAT(can_run(fault).heard, IsEmpty());
    EXPECT_FALSE(node_with(fault).mute) << "its receiver goes on";
}

TEST(CanFaults, SilenceANode) {
    EXPECT_FALSE(node_with(can_fault("node_silent")).mute);
    EXPECT_TRUE(node_with(can_fault("node_silent")).no_node_status);
    EXPECT_TRUE(node_with(can_fault("node_id_collision")).shares_node_id);
}

TEST(CanFaults, SpoilDataThatTheCrcOfATransferCovers) {
    WireDirection direction;
    direction.checksum_errors = 1;
    WireDamage wire(5, "wire 0 to client");
    wire.set(direction, GpsTime{1000s});
    const CanFrame frame = *can_frame(0x18042A0A, true, Bytes{1, 2, 3, 0xC0});
    wire.put(to_bytes(slcan_line(frame)), GpsTime{1000s});
    std::string line = to_string(wire.take(GpsTime{1001s}));
    ASSERT_FALSE(line.empty());
    line.pop_back();
    const auto heard = parse_slcan_line(line);
    ASSERT_TRUE(heard);
    EXPECT_NE(*heard, frame);
    EXPECT_EQ(heard->id, frame.id);
    EXPECT_EQ(heard->data[3], 0xC0) << "the tail stays";
}

}  // namespace
}  // namespace skyloop
