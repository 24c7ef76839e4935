// What hubs say of the power of their ports.
#include "wire/usb/hub_port_power.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skyloop {
namespace {

TEST(HubPorts, AreReadFromTheDescriptor) {
    const auto single = hub_ports(Bytes{9, 0x29, 4, 0xA9, 0x00, 50, 100, 0, 0xFF});
    ASSERT_TRUE(single);
    EXPECT_EQ(single->count, 4);
    EXPECT_TRUE(single->switched_one_by_one);
    const auto superspeed = hub_ports(Bytes{12, 0x2A, 2, 0x09, 0x00, 50, 0, 0, 0, 0, 0, 0});
    ASSERT_TRUE(superspeed);
    EXPECT_EQ(superspeed->count, 2);
    EXPECT_TRUE(superspeed->switched_one_by_one);
    // All together; and the two values that say not at all.
    for (const Bytes& mode : {Bytes{0xA8}, Bytes{0xAA}, Bytes{0xAB}})
        EXPECT_FALSE(hub_ports(Bytes{9, 0x29, 4, mode[0], 0x00, 50, 100, 0, 0xFF})->switched_one_by_one);
    for (const Bytes& other : {Bytes{}, Bytes{9, 0x29, 4}, Bytes{9, 0x22, 4, 0xA9, 0, 50, 100, 0, 0xFF},
                               Bytes{3, 0x29, 4, 0xA9, 0, 50, 100, 0, 0xFF}})
        EXPECT_FALSE(hub_ports(other));
}

TEST(HubPort, RefusesWhatIsNoPort) {
    for (const char* text : {"", "1", "usb1", "1-", "1-1.", "1-0", "1-1.999", "1-99999999999"}) {
        const auto port = HubPort::open(text);
        ASSERT_FALSE(port) << text;
        EXPECT_EQ(port.error().code, ErrorCode::usage) << text;
    }
}

}  // namespace
}  // namespace skyloop
