#include "wire/usb/usb_device.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

const UsbDeviceInfo ublox{{0x1546, 0x01a8}, "u-blox AG", "u-blox GNSS receiver", "A1", "1-1.2"};

TEST(UsbAddress, NamesByIdsBySerialNumberOrByPort) {
    const auto ids = parse_usb_address("1546:01A8");
    ASSERT_TRUE(ids);
    EXPECT_EQ(to_string(*ids), "1546:01a8");
    EXPECT_TRUE(ids->matches(ublox));
    const auto serial = parse_usb_address("1546:01a8:A1");
    ASSERT_TRUE(serial);
    EXPECT_TRUE(serial->matches(ublox));
    EXPECT_EQ(to_string(*serial), "1546:01a8:A1");
    const auto port = parse_usb_address("1546:01a8@1-1.2");
    ASSERT_TRUE(port);
    EXPECT_TRUE(port->matches(ublox));
    EXPECT_EQ(to_string(*port), "1546:01a8@1-1.2");
}

TEST(UsbAddress, MatchesNothingElse) {
    EXPECT_FALSE(parse_usb_address("1546:01a9")->matches(ublox));
    EXPECT_FALSE(parse_usb_address("1546:01a8:A2")->matches(ublox));
    EXPECT_FALSE(parse_usb_address("1546:01a8@1-1.20")->matches(ublox));
}

// A serial number may hold anything that the maker likes, colons too.
TEST(UsbAddress, TakesTheRestAsTheSerialNumber) {
    EXPECT_EQ(parse_usb_address("16c0:05df:a:b@1-1")->serial, "a:b@1-1");
}

TEST(UsbAddress, RefusesWhatNamesNoDevice) {
    for (const char* text :
         {"", "1546", "1546:", "1546:1a8", "1546:01a8:", "1546:01a8@", "1546:01a8@1", "1546:01a8@1-", "1546:01a8@-1",
          "1546:01a8@1-1.", "1546:01a8@1-1..2", "1546:01a8x", "+546:01a8", "0x15:01a8", "g546:01a8"}) {
        const auto address = parse_usb_address(text);
        ASSERT_FALSE(address) << text;
        EXPECT_EQ(address.error().code, ErrorCode::usage);
        EXPECT_NE(address.error().message.find("'" + std::string(text) + "'"), std::string::npos);
    }
}

}  // namespace
}  // namespace skyloop
