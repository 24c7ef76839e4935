#include "wire/usb/serial_bridge.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

TEST(BridgeBuffers, GiveBytesOutInOrderAndNoMoreThanAsked) {
    BridgeBuffers buffers(9600);
    EXPECT_FALSE(buffers.next_output(10));
    EXPECT_EQ(buffers.offer(to_bytes("hello")), 5U);
    EXPECT_TRUE(buffers.output_waits());
    const auto first = buffers.next_output(2);
    ASSERT_TRUE(first);
    EXPECT_EQ(to_string(first->bytes), "he");
    EXPECT_EQ(first->baud, 9600U);
    EXPECT_EQ(to_string(buffers.next_output(10)->bytes), "llo");
    EXPECT_FALSE(buffers.output_waits());
    EXPECT_FALSE(buffers.next_output(10));
}

TEST(BridgeBuffers, KeepChangesOfSpeedInTheirPlace) {
    BridgeBuffers buffers(9600);
    buffers.offer(to_bytes("a"));
    buffers.ask_speed(38400);
    buffers.ask_speed(57600);  // nothing was to leave at the one before
    buffers.offer(to_bytes("b"));
    EXPECT_EQ(buffers.next_output(10)->baud, 9600U);
    const auto second = buffers.next_output(10);
    ASSERT_TRUE(second);
    EXPECT_EQ(second->baud, 57600U);
    EXPECT_EQ(to_string(second->bytes), "b");
    EXPECT_FALSE(buffers.next_output(10));
}

TEST(BridgeBuffers, GiveAChangeOfSpeedWithoutBytesOnce) {
    BridgeBuffers buffers(9600);
    buffers.ask_speed(38400);
    const auto change = buffers.next_output(10);
    ASSERT_TRUE(change);
    EXPECT_EQ(change->baud, 38400U);
    EXPECT_TRUE(change->bytes.empty());
    EXPECT_FALSE(buffers.next_output(10));
    buffers.ask_speed(38400);
    EXPECT_FALSE(buffers.next_output(10));
}

TEST(BridgeBuffers, TakeNoMoreThanTheyHold) {
    BridgeBuffers buffers(9600);
    EXPECT_EQ(buffers.offer(Bytes(20'000)), BridgeBuffers::most_output);
    EXPECT_EQ(buffers.offer(Bytes(1)), 0U);
    EXPECT_EQ(buffers.next_output(100)->bytes.size(), 100U);
    EXPECT_EQ(buffers.offer(Bytes(200)), 100U);
    EXPECT_FALSE(buffers.input_full());
    buffers.put_input(Bytes(BridgeBuffers::most_input));
    EXPECT_TRUE(buffers.input_full());
    EXPECT_EQ(buffers.take_input().size(), BridgeBuffers::most_input);
    EXPECT_FALSE(buffers.input_full());
}

TEST(BridgeBuffers, TellOnce) {
    BridgeBuffers buffers(9600);
    buffers.tell("one");
    EXPECT_EQ(buffers.take_news(), std::vector<std::string>{"one"});
    EXPECT_TRUE(buffers.take_news().empty());
    EXPECT_FALSE(buffers.gone());
    buffers.set_gone();
    EXPECT_TRUE(buffers.gone());
}

}  // namespace
}  // namespace skyloop
