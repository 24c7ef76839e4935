#include "run/feed/mavlink_component.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/core/random.hpp"
#include "receiver/protocol/mavlink.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

const MavlinkSource autopilot{1, 1, 0}, station{255, 190, 0};

MavlinkHeartbeat copter(std::uint32_t mode, bool armed) {
    MavlinkHeartbeat beat;
    beat.type = 2;
    beat.autopilot = mavlink_autopilot_ardupilot;
    beat.custom_mode = mode;
    beat.base_mode = static_cast<std::uint8_t>(mavlink_custom_mode_enabled | (armed ? mavlink_safety_armed : 0));
    return beat;
}

MavlinkCommandLong injection(float type) {
    MavlinkCommandLong command;
    command.command = mavlink_inject_failure;
    command.param1 = failure_unit_gps;
    command.param2 = type;
    command.target_system = mavlink_own_system;
    command.target_component = mavlink_own_component;
    return command;
}

class AMavlinkComponent : public testing::Test {
protected:
    MavlinkComponent::Heard hear(ByteSpan bytes) { return component.hear(bytes, now); }
    template <class Message>
    MavlinkComponent::Heard hear(const MavlinkSource& from, const Message& message) {
        return hear(encode_mavlink(from, message));
    }
    // What the only answer says.
    static MavlinkCommandAck acknowledged(const MavlinkComponent::Heard& heard) {
        EXPECT_THAT(heard.answers, SizeIs(1));
        const auto frame = parse_mavlink(heard.answers.at(0));
        EXPECT_TRUE(frame && frame->message == MavlinkCommandAck::message_id);
        EXPECT_EQ(frame->source.system, 245);
        return decode_mavlink<MavlinkCommandAck>(frame->payload);
    }

    std::vector<Command> taken;
    MavlinkComponent component{{"only"}, [this](Command command) {
                                   taken.push_back(std::move(command));
                                   return true;
                               }};
    MavlinkComponent::Time now{1h};
};

TEST_F(AMavlinkComponent, SaysThatItIsAlive) {
    const Bytes first = component.heartbeat(), second = component.heartbeat();
    const auto frame = parse_mavlink(first);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->source, (MavlinkSource{245, 191, 0}));
    const auto beat = decode_mavlink<MavlinkHeartbeat>(frame->payload);
    EXPECT_EQ(beat.type, 18);
    EXPECT_EQ(beat.autopilot, 8);
    EXPECT_EQ(parse_mavlink(second)->source.sequence, 1);
}

TEST_F(AMavlinkComponent, FollowsTheFirstVehicleAlone) {
    EXPECT_TRUE(hear(station, MavlinkHeartbeat{0, 6, 8}).any);
    EXPECT_THAT(taken, IsEmpty()) << "a ground station has no mode";
    hear(autopilot, copter(3, false));
    now += 1s;
    hear(autopilot, copter(3, false));
    now += 1s;
    hear({2, 1, 0}, copter(5, true));
    now += 1s;
    hear(autopilot, copter(6, true));
    ASSERT_THAT(taken, SizeIs(2));
    EXPECT_EQ(vehicle_state_of(taken[0].parameters), (VehicleState{"AUTO", 3, false}));
    EXPECT_EQ(vehicle_state_of(taken[1].parameters), (VehicleState{"RTL", 6, true}));
    EXPECT_EQ(taken[1].verb, CommandVerb::vehicle_state);
    EXPECT_EQ(taken[1].source, "mavlink");
}

TEST_F(AMavlinkComponent, TellsAFlickeringVehicleAtMostEvery50Milliseconds) {
    for (std::uint32_t i = 0; i < 1000; ++i) {
        hear(autopilot, copter(3 + i % 2, true));
        now += 1ms;
    }
    EXPECT_LE(taken.size(), 21u);
    EXPECT_GE(taken.size(), 10u);
    now += 1s;
    component.look(now);
    EXPECT_EQ(taken.back().parameters.text("mode"), "GUIDED") << "the last is told in the end";
}

TEST_F(AMavlinkComponent, InjectsWhatIsAskedOfIt) {
    EXPECT_EQ(acknowledged(hear(station, injection(1))).result, 0);
    ASSERT_THAT(taken, SizeIs(1));
    EXPECT_EQ(taken[0].parameters.text("kind"), "receiver_silent");
    MavlinkCommandInt place;
    place.command = mavlink_inject_failure;
    place.param1 = failure_unit_gps;
    place.target_system = mavlink_own_system;
    const MavlinkCommandAck ack = acknowledged(hear(station, place));
    EXPECT_EQ(ack.result, 0);
    EXPECT_EQ(ack.command, 420);
    EXPECT_EQ(ack.target_system, 255);
    EXPECT_EQ(ack.target_component, 190);
    EXPECT_EQ(taken.at(1).verb, CommandVerb::stop_fault);
}

TEST_F(AMavlinkComponent, AnswersOnlyWhatIsForIt) {
    MavlinkCommandLong command = injection(1);
    command.target_system = 1;
    EXPECT_THAT(hear(station, command).answers, IsEmpty()) << "the autopilot's own";
    command.target_system = mavlink_own_system;
    command.target_component = 1;
    EXPECT_THAT(hear(station, command).answers, IsEmpty());
    command.command = 400;
    command.target_component = 0;
    EXPECT_EQ(acknowledged(hear(station, command)).result, 3) << "arming is not for it";
    command.target_system = 0;
    EXPECT_THAT(hear(station, command).answers, IsEmpty()) << "others may know it";
    EXPECT_THAT(taken, IsEmpty());
}

TEST_F(AMavlinkComponent, HasEnoughOfAPeerGoneWild) {
    int refused = 0;
    for (int i = 0; i < 10'000; ++i) {
        refused += acknowledged(hear(station, injection(static_cast<float>(1 + i % 7)))).result == 1;
        now += 100us;
    }
    EXPECT_EQ(refused, 10'000 - 20);
    EXPECT_LE(taken.size(), 40u);
}

TEST_F(AMavlinkComponent, PassesOverWhatIsNoMavlink) {
    RandomStream random(1, "datagrams");
    for (int i = 0; i < 2000; ++i) {
        Bytes datagram(static_cast<std::size_t>(random.uniform() * 300));
        for (std::uint8_t& byte : datagram)
            byte = static_cast<std::uint8_t>(random.uniform() * 256);
        if (!datagram.empty() && i % 2 == 0) datagram[0] = 0xFD;
        EXPECT_THAT(hear(datagram).answers, IsEmpty());
    }
    Bytes broken = encode_mavlink(station, injection(1));
    broken[12] ^= 1;
    EXPECT_FALSE(hear(broken).any);
    Bytes cut = encode_mavlink(station, injection(1));
    cut.pop_back();
    EXPECT_FALSE(hear(cut).any);
    EXPECT_THAT(taken, IsEmpty());
}

}  // namespace
}  // namespace skyloop
