#include "run/feed/mavlink_endpoint.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

TEST(MavlinkAddress, SaysWhoSpeaksFirst) {
    const auto port = parse_mavlink_address("udp:14550"), host = parse_mavlink_address("udp:0.0.0.0:1"),
               out = parse_mavlink_address("udpout:[::1]:14560");
    ASSERT_TRUE(port && host && out);
    EXPECT_FALSE(port->speaks_first);
    EXPECT_EQ(port->host, "127.0.0.1");
    EXPECT_EQ(port->port, 14550);
    EXPECT_EQ(host->host, "0.0.0.0");
    EXPECT_TRUE(out->speaks_first);
    EXPECT_EQ(out->host, "::1");
    EXPECT_EQ(out->port, 14560);
}

TEST(MavlinkAddress, RefusesWhatIsNone) {
    for (const char* text : {"", "udp", "udp:", "udp:x", "udp:70000", "udp:-1", "udp::14550", "udp:a:b:1", "tcp:1:2",
                             "udpout:14550", "udpout:host:0", "14550", "udp:14550x", "udp:[]:1"})
        EXPECT_FALSE(parse_mavlink_address(text)) << text;
}

TEST(MavlinkEndpoint, ListensWhereItSaysAndOnlyOnce) {
    const auto push = [](const Command&) { return true; };
    const auto first = MavlinkEndpoint::start({false, "127.0.0.1", 0}, {{"only"}, push, {}});
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_NE((*first)->port(), 0);
    EXPECT_EQ((*first)->description(),
              "udp:127.0.0.1:" + std::to_string((*first)->port()) + " (system 245, component 191)");
    const auto second = MavlinkEndpoint::start({false, "127.0.0.1", (*first)->port()}, {{"only"}, push, {}});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, ErrorCode::outside);
}

}  // namespace
}  // namespace skyloop
