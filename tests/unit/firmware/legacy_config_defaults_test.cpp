// What receivers answer to polls of their factory configuration (RECEIVER.md 2.4).
#include <gtest/gtest.h>

#include "legacy_bench.hpp"

namespace skyloop::firmware {
namespace {

TEST(LegacyDefaults, OfM8) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.poll(cfg(0x3E)), hex("00 20 20 07  00 08 10 00 01000101  01 01 03 00 01000101  02 04 08 00 00000101"
                                      "03 08 10 00 00000101  04 00 08 00 00000103  05 00 03 00 01000105"
                                      "06 08 0E 00 01000101"));
    EXPECT_EQ(m8.poll(cfg(0x24)), hex("FFFF 00 03 00000000 10270000 05 00 FA00 FA00 6400 5E01 00 3C 00 00 0000 0000 00"
                                      "0000000000"));
    EXPECT_EQ(m8.poll(cfg(0x23)), hex("0200 4C66 C0000000 0000 03 20 06 00 00 0000 00 4B07 00 00 0000 0000 00 00 0000"
                                      "6400 00000000 000000 00"));
    EXPECT_EQ(m8.poll(cfg(0x31)), hex("00 01 0000 3200 0000 40420F00 40420F00 00000000 A0860100 00000000 77000000"));
    EXPECT_EQ(m8.poll(cfg(0x31), {1}),
              hex("01 01 0000 3200 0000 04000000 01000000 48E80100 A0860100 00000000 7E000000"));
    EXPECT_EQ(m8.poll(cfg(0x00)), hex("01 00 0000 C0080000 80250000 0700 0300 0000 0000"));
    EXPECT_EQ(m8.poll(cfg(0x00), {0}), hex("00 00 0000 84000000 00000000 0700 0300 0000 0000"));
    EXPECT_EQ(m8.poll(cfg(0x08)), hex("E803 0100 0100"));
    EXPECT_EQ(m8.poll(cfg(0x16)), hex("01 03 03 00 51080000"));
    EXPECT_EQ(m8.poll(cfg(0x39)), hex("F3AC622D 1E030000"));
    EXPECT_EQ(m8.poll(cfg(0x02), {1}), hex("01 000000 07 07 07 07 07 00"));
    EXPECT_EQ(m8.poll(cfg(0x02), {0}), hex("00 000000 00 00 00 00 00 00"));
    EXPECT_EQ(m8.poll(cfg(0x17)), hex("00 40 00 02 00000000 00 00 00 01 0000 000000000000"));
    EXPECT_EQ(m8.poll(cfg(0x11)), hex("08 00"));
    EXPECT_EQ(m8.poll(cfg(0x86)), hex("00 00 0000 0000 0000"));
}

// The USB port of a LEA-M8F and of another M8 of gpsd's logs (ublox-lea-m8f.log, ublox8-uniqid-monhw.log).
TEST(LegacyDefaults, OfTheUsbPortOfM8AsCaptured) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.poll(cfg(0x00), {3}), hex("0300000000000000000000000700030000000000"));
    EXPECT_EQ(m8.poll(cfg(0x00), {}, PortId::usb), hex("0300000000000000000000000700030000000000"));
}

TEST(LegacyDefaults, OfTheFirstFirmwareOfM8) {
    BoardProfile board = legacy_m8();
    board.identity.extensions = {"PROTVER 15.00"};
    LegacyBench m8(board);
    EXPECT_EQ(m8.poll(cfg(0x31)), hex("00 00 0000 3200 0000 40420F00 40420F00 00000000 A0860100 00000000 77000000"));
    EXPECT_EQ(m8.poll(cfg(0x23))[0], 0);
    board.gnss_blocks = {{0, 8, 16, 0x01010001},
                         {1, 1, 3, 0x01010001},
                         {3, 8, 16, 0x01010000},
                         {5, 0, 3, 0x01010001},
                         {6, 8, 14, 0x01010001}};
    LegacyBench older(board);
    EXPECT_EQ(older.poll(cfg(0x3E)), hex("00 20 20 05  00 08 10 00 01000101  01 01 03 00 01000101"
                                         "03 08 10 00 00000101  05 00 03 00 01000101  06 08 0E 00 01000101"));
}

TEST(LegacyDefaults, OfM9) {
    LegacyBench m9(legacy_m9());
    EXPECT_EQ(m9.poll(cfg(0x3E)), hex("00 2A 2A 06  00 08 10 00 01000101  01 03 03 00 01000101  02 08 0C 00 01000101"
                                      "03 02 05 00 01000101  05 03 04 00 01000501  06 08 0C 00 01000101"));
    EXPECT_EQ(m9.poll(cfg(0x00)), hex("01 00 0000 C0080000 00960000 2300 0300 0000 0000"));
    EXPECT_EQ(m9.poll(cfg(0x16)), hex("01 03 03 00 882B0700"));
    EXPECT_EQ(m9.poll(cfg(0x17)), hex("00 41 00 02 00000000 00 00 00 01 0000 000000000000"));
    EXPECT_EQ(m9.poll(cfg(0x24)), hex("FFFF 00 03 00000000 10270000 05 00 FA00 FA00 6400 5E01 00 3C 00 00 0000 0000 00"
                                      "0000000000"));
}

TEST(LegacyDefaults, OfF9p) {
    LegacyBench f9p(legacy_f9p());
    EXPECT_EQ(f9p.poll(cfg(0x3E)), hex("00 00 3C 06  00 08 10 00 01001101  01 03 03 00 01000101  02 0A 12 00 01002101"
                                       "03 02 05 00 01001101  05 00 04 00 01001101  06 08 0C 00 01001101"));
    EXPECT_EQ(f9p.poll(cfg(0x23)), hex("02 00 4C 66 C0 00 00 00 00 00 03 20 06 00 00 00 00 00 32 08"
                                       "0000000000000000000000000000000000000000"));
    EXPECT_EQ(f9p.poll(cfg(0x70)), hex("03 000000"));
    EXPECT_EQ(f9p.poll(cfg(0x71)), Bytes(40));
}

// NMEA forms of older generations (RECEIVER.md 3.3).
TEST(LegacyDefaults, OfCfgNmeaByGeneration) {
    BoardProfile board = legacy_m8();
    board.nmea_version = NmeaVersion::v2_3;
    board.identity.generation = 6;
    EXPECT_EQ(LegacyBench(board).poll(cfg(0x17)), hex("00 23 00 02"));
    board.identity.generation = 7;
    EXPECT_EQ(LegacyBench(board).poll(cfg(0x17)), hex("00 23 00 02 00000000 00 00 00 00"));
}

TEST(LegacyDefaults, OfCfgUsbAndTheOthers) {
    LegacyBench m9(legacy_m9());
    const Bytes usb = m9.poll(cfg(0x1B));
    ASSERT_EQ(usb.size(), 108u);
    EXPECT_EQ(Bytes(usb.begin(), usb.begin() + 12), hex("4615 A901 00000000 0000 0200"));
    EXPECT_EQ(to_string(ByteSpan(usb).subspan(12, 27)), "u-blox AG - www.u-blox.com" + std::string(1, '\0'));
    EXPECT_EQ(to_string(ByteSpan(usb).subspan(44, 21)), "u-blox GNSS receiver" + std::string(1, '\0'));
    EXPECT_EQ(m9.poll(cfg(0x13)), hex("0000 F0A1"));
    EXPECT_EQ(m9.poll(cfg(0x1E)), hex("00 000000 00 00 000000000000 0A 32 0000 99 4C 0000"));
    EXPECT_EQ(m9.poll(cfg(0x47)), hex("01 00 0000 0000 0000 00000000"));
}

}  // namespace
}  // namespace skyloop::firmware
