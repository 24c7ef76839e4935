#include "wire/hid/cp2110.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

TEST(Cp2110, SaysSpeedAndFormatAsTheBridgeWantsThem) {
    EXPECT_EQ(cp2110_uart_config({115200, {8, Parity::none, 1, false}}),
              (Bytes{0x50, 0x00, 0x01, 0xc2, 0x00, 0, 0, 3, 0}));
    EXPECT_EQ(cp2110_uart_config({9600, {7, Parity::even, 2, true}}), (Bytes{0x50, 0, 0, 0x25, 0x80, 2, 1, 2, 1}));
    EXPECT_EQ(cp2110_uart_config({300, {8, Parity::odd, 1, false}}), (Bytes{0x50, 0, 0, 0x01, 0x2c, 1, 0, 3, 0}));
}

}  // namespace
}  // namespace skyloop
