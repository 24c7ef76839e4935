#include <gtest/gtest.h>

#include <random>
#include <string>

#include "run/feed/truth_feed.hpp"

namespace skyloop {
namespace {

FeedAddress good_address(std::string_view text) {
    const auto address = parse_feed_address(text);
    EXPECT_TRUE(address) << text << ": " << address.error().message;
    return address ? *address : FeedAddress();
}

TEST(FeedAddress, ListensOnLoopbackUnlessAHostIsGiven) {
    const FeedAddress port = good_address("udp-json:5000");
    EXPECT_EQ(port.dialect, "json");
    EXPECT_EQ(port.wire, FeedWire::udp_listen);
    EXPECT_EQ(port.host, "127.0.0.1");
    EXPECT_EQ(port.port, 5000);
    EXPECT_EQ(good_address("udp-json").port, 29990);
    EXPECT_EQ(good_address("tcp-json:0.0.0.0:7").host, "0.0.0.0");
    EXPECT_EQ(good_address("tcp-json:0").port, 0);
    const FeedAddress six = good_address("flightgear:[::1]:5503");
    EXPECT_EQ(six.host, "::1");
    EXPECT_EQ(six.port, 5503);
    EXPECT_EQ(good_address("jsbsim").wire, FeedWire::tcp_listen);
}

TEST(FeedAddress, ConnectsWhereItIsTold) {
    EXPECT_EQ(good_address("gpsd:localhost").port, 2947);
    EXPECT_EQ(good_address("gpsd:[fe80::1%eth0]").host, "fe80::1%eth0");
    EXPECT_EQ(good_address("xplane:10.0.0.2").port, 49000);
    EXPECT_EQ(good_address("xplane:10.0.0.2").wire, FeedWire::udp_request);
    EXPECT_EQ(good_address("xplane:10.0.0.2").own_port, 49005);
    EXPECT_EQ(good_address("mavlink-udpout:10.0.0.2:14550").wire, FeedWire::udp_connect);
    EXPECT_EQ(good_address("json-to:sim.example:99").wire, FeedWire::tcp_connect);
    EXPECT_EQ(good_address("mavlink-udpout:h:14540").port, 14540);
}

TEST(FeedAddress, KnowsSerialLinesAndRelays) {
    const FeedAddress line = good_address("mavlink-serial:/dev/ttyACM0@921600");
    EXPECT_EQ(line.wire, FeedWire::serial);
    EXPECT_EQ(line.host, "/dev/ttyACM0");
    EXPECT_EQ(line.baud, 921600u);
    EXPECT_EQ(good_address("mavlink-serial:/dev/ttyACM0").baud, 57600u);
    const FeedAddress relay = good_address("ardupilot-json:9002,127.0.0.1:9012");
    EXPECT_EQ(relay.wire, FeedWire::udp_relay);
    EXPECT_EQ(relay.port, 9002);
    EXPECT_EQ(relay.to_host, "127.0.0.1");
    EXPECT_EQ(relay.to_port, 9012);
    EXPECT_TRUE(relay.hears_target);
    EXPECT_FALSE(good_address("betaflight:9003,h:9013").hears_target);
    EXPECT_EQ(good_address("px4:[::]:4560,[::1]:4561").to_host, "::1");
}

TEST(FeedAddress, RefusesWhatIsNoneInOneLine) {
    for (const char* text : {"",
                             ":",
                             "udp",
                             "udp-json:x",
                             "udp-json:70000",
                             "udp-json:-1",
                             "udp-json:a:b:1",
                             "udp-json::1",
                             "json-to:5000",
                             "json-to:h:0",
                             "json-to:",
                             "gpsd:",
                             "gpsd",
                             "nmea-serial:/dev/ttyS0",
                             "nmea-serial:@9600",
                             "nmea-serial:/dev/ttyS0@1",
                             "nmea-udp:",
                             "px4:4560",
                             "px4:4560,h",
                             "px4:4560,h:0",
                             "px4:,h:1",
                             "udp-json:[::1:5",
                             "udp-json:[::1]x5",
                             "udp-json:a b:5",
                             "udp-json:\n:5"}) {
        const auto address = parse_feed_address(text);
        ASSERT_FALSE(address) << text;
        EXPECT_EQ(address.error().code, ErrorCode::usage) << text;
        EXPECT_EQ(address.error().message.find('\n'), std::string::npos) << text;
        EXPECT_NE(address.error().message.find("expected"), std::string::npos) << text;
    }
}

TEST(FeedAddress, RefusesRelaysToThemselves) {
    for (const char* text :
         {"px4:4560,127.0.0.1:4560", "betaflight:9003,localhost:9003", "ardupilot-json:9002,127.0.0.1:9002",
          "px4:0.0.0.0:4560,127.0.0.1:4560", "px4:0.0.0.0:4560,127.0.1.1:4560", "px4:4560,0.0.0.0:4560",
          "px4:localhost:4560,[::1]:4560", "px4:[::1]:4560,[::1]:4560", "px4:[::]:4560,LocalHost:4560",
          "px4:[::1]:4560,[::]:4560", "px4:sim.example:4560,SIM.example:4560", "px4:10.0.0.2:4560,10.0.0.2:4560"}) {
        const auto address = parse_feed_address(text);
        ASSERT_FALSE(address) << text;
        EXPECT_EQ(address.error().code, ErrorCode::usage);
        EXPECT_NE(address.error().message.find("relays to itself"), std::string::npos) << address.error().message;
        EXPECT_NE(address.error().message.find("expected another port"), std::string::npos) << address.error().message;
    }
    for (const char* text : {"px4:4560,127.0.0.1:4561", "px4:4560,10.0.0.2:4560", "px4:4560,127.0.0.2:4560",
                             "px4:4560,[::1]:4560", "px4:0.0.0.0:4560,sim:4560", "px4:10.0.0.2:4560,localhost:4560"})
        good_address(text);
}

TEST(FeedAddress, SuggestsWhatWasMeant) {
    EXPECT_NE(parse_feed_address("udp_json:5000").error().message.find("did you mean 'udp-json'"), std::string::npos);
    EXPECT_NE(parse_feed_address("flightgaer:5503").error().message.find("did you mean 'flightgear'"),
              std::string::npos);
    EXPECT_NE(parse_feed_address("gpsd:").error().message.find("expected gpsd:HOST[:PORT]"), std::string::npos);
}

TEST(FeedAddress, SurvivesAnyText) {
    std::mt19937 random(13);
    const std::string letters = "udp-jsonx4gt:,[]@/0129 .\n%\xff";
    for (int i = 0; i < 50000; ++i) {
        std::string text = i % 2 == 0 ? "udp-json:" : i % 3 == 0 ? "px4:" : "";
        for (auto length = random() % 20; length > 0; --length)
            text += letters[random() % letters.size()];
        const auto address = parse_feed_address(text);
        ASSERT_TRUE(address || address.error().message.find('\n') == std::string::npos);
    }
}

}  // namespace
}  // namespace skyloop
