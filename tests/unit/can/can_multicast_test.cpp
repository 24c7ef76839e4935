#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "wire/can/can_sockets.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

TEST(CanMulticast, HasAFrameInADatagram) {
    const CanFrame frame = *base::can_frame(0x18042A0A, true, Bytes{0x01, 0x7D});
    const Bytes datagram = multicast_datagram(frame);
    ASSERT_EQ(datagram.size(), 12U);
    EXPECT_EQ(Bytes(datagram.begin(), datagram.begin() + 2), (Bytes{0x34, 0x29}));
    EXPECT_EQ(Bytes(datagram.begin() + 4, datagram.end()), (Bytes{0, 0, 0x0A, 0x2A, 0x04, 0x98, 0x01, 0x7D}));
    EXPECT_EQ(parse_multicast_datagram(datagram), frame);
    const CanFrame standard = *base::can_frame(0x7FF, false, {});
    EXPECT_EQ(parse_multicast_datagram(multicast_datagram(standard)), standard);
}

TEST(CanMulticast, TakesNoOtherDatagrams) {
    const Bytes good = multicast_datagram(*base::can_frame(0x18042A0A, true, Bytes{0x01, 0x7D}));
    for (std::size_t i = 0; i < good.size(); ++i) {
        Bytes bad = good;
        bad[i] ^= 1U;
        EXPECT_FALSE(parse_multicast_datagram(bad)) << i;
    }
    for (std::size_t size = 0; size < good.size(); ++size)
        EXPECT_FALSE(parse_multicast_datagram(ByteSpan(good).first(size))) << size;
}

TEST(SocketCan, NamesAnInterfaceThatIsNotThere) {
    const auto socket = open_socketcan("nocan77");
    ASSERT_FALSE(socket);
    EXPECT_EQ(socket.error().code, ErrorCode::outside);
    EXPECT_THAT(socket.error().message, HasSubstr("CAN interface 'nocan77'"));
}

}  // namespace
}  // namespace skyloop
