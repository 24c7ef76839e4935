#include "receiver/protocol/rtcm3_descriptors.hpp"

#include <gtest/gtest.h>

#include "base/core/bytes.hpp"

namespace skyloop {
namespace {

Bytes descriptors_from_hex(std::string_view hex) {
    Bytes bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        bytes.push_back(static_cast<std::uint8_t>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
    return bytes;
}

// Of gpsd's rtcm3.2.log (1007) and rtcm3.bndm.log.
const Bytes real_1007 = descriptors_from_hex("d300053ef2790000de08a8");
const Bytes real_1008 = descriptors_from_hex("d300143f01160e4750504e554c4c414e54454e4e410000299adc");
const Bytes real_1033 = descriptors_from_hex(
    "d300334091160e4750504e554c4c414e54454e4e410000124c4549434120475258313230302b474e535304392e323006343936373130bedb9"
    "e");

TEST(Rtcm3Descriptors, ReadsRealOnesAndWritesThemAgain) {
    const auto bare = decode_descriptors(*parse_rtcm3(real_1007));
    ASSERT_TRUE(bare);
    EXPECT_EQ(*bare, (Rtcm3Descriptors{1007, 633, "", 0, "", "", "", ""}));
    const auto antenna = decode_descriptors(*parse_rtcm3(real_1008));
    ASSERT_TRUE(antenna);
    EXPECT_EQ(*antenna, (Rtcm3Descriptors{1008, 278, "GPPNULLANTENNA", 0, "", "", "", ""}));
    const auto receiver = decode_descriptors(*parse_rtcm3(real_1033));
    ASSERT_TRUE(receiver);
    EXPECT_EQ(*receiver,
              (Rtcm3Descriptors{1033, 278, "GPPNULLANTENNA", 0, "", "LEICA GRX1200+GNSS", "9.20", "496710"}));
    EXPECT_EQ(encode(*bare), real_1007);
    EXPECT_EQ(encode(*antenna), real_1008);
    EXPECT_EQ(encode(*receiver), real_1033);
}

TEST(Rtcm3Descriptors, TextsAreCutToWhatTheirCountersMaySay) {
    Rtcm3Descriptors long_ones{1033, 1,  std::string(40, 'A'), 255, std::string(31, 'B'),
                               "C",  "", std::string(300, 'D')};
    const Bytes frame = encode(long_ones);
    long_ones.antenna.resize(31);
    long_ones.receiver_serial.resize(31);
    EXPECT_EQ(decode_descriptors(*parse_rtcm3(frame)), long_ones);
}

TEST(Rtcm3Descriptors, RefusesWhatIsNone) {
    EXPECT_TRUE(encode(Rtcm3Descriptors{1009, 0, "", 0, "", "", "", ""}).empty());
    const auto whole = parse_rtcm3(real_1033);
    EXPECT_FALSE(decode_descriptors({1005, {}, 0, whole->payload}));
    for (std::size_t size = 0; size < whole->payload.size(); ++size)
        EXPECT_FALSE(decode_descriptors({1033, {}, 0, whole->payload.first(size)})) << size;
}

}  // namespace
}  // namespace skyloop
