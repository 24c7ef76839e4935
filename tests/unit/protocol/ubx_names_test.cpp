#include "receiver/protocol/ubx_messages.hpp"

#include <gtest/gtest.h>

#include <set>

namespace skyloop {
namespace {

TEST(UbxNames, LeadBothWays) {
    EXPECT_EQ(ubx_message_name({0x01, 0x07}), "NAV-PVT");
    EXPECT_EQ(ubx_message_name({0x06, 0x8A}), "CFG-VALSET");
    EXPECT_EQ(ubx_message_from_name("MON-VER"), (UbxMessageId{0x0A, 0x04}));
    EXPECT_EQ(ubx_message_from_name("GGA"), (UbxMessageId{0xF0, 0x00}));
    EXPECT_EQ(ubx_message_from_name("RTCM-1230"), (UbxMessageId{0xF5, 0xE6}));
    EXPECT_FALSE(ubx_message_from_name("nav-pvt"));
    EXPECT_FALSE(ubx_message_name({0x01, 0xFF}));
    EXPECT_EQ(to_string(UbxMessageId{0x01, 0x35}), "NAV-SAT");
    EXPECT_EQ(to_string(UbxMessageId{0xAB, 0x0C}), "AB-0C");
    std::set<std::string_view> seen;
    for (const UbxMessage& message : ubx_messages()) {
        EXPECT_EQ(ubx_message_name(message.id), message.name);
        EXPECT_EQ(ubx_message_from_name(message.name), message.id);
        EXPECT_TRUE(seen.insert(message.name).second) << message.name;
    }
}

}  // namespace
}  // namespace skyloop
