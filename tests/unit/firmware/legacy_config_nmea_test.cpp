#include <gtest/gtest.h>

#include "legacy_bench.hpp"

namespace skyloop::firmware {
namespace {

TEST(LegacyNmea, IsItemsOfTheStore) {
    LegacyBench m9(legacy_m9());
    const Bytes all = hex("3F 4B 0C 0D 77000000 01 03 01 01 4244 000000000000");
    EXPECT_EQ(m9.set(cfg(0x17), all), Verdict::acknowledge);
    EXPECT_EQ(m9.poll(cfg(0x17)), all);
    EXPECT_EQ(m9.store.value(key::nmea_protver), 42u);
    EXPECT_EQ(m9.store.value(key::nmea_maxsvs), 12u);
    EXPECT_TRUE(m9.store.flag(key::nmea_out_frozencog));
    EXPECT_FALSE(m9.store.flag(key::nmea_consider));
    EXPECT_TRUE(m9.store.flag(key::nmea_highprec));
    EXPECT_TRUE(m9.store.flag(key::nmea_filt_bds));
    EXPECT_EQ(m9.store.value(key::nmea_main_talker), 3u);
    EXPECT_EQ(m9.store.value(key::nmea_bds_talker), 0x4442u);
}

// Each bit of the three fields is its own item.
TEST(LegacyNmea, KeepsEveryBitApart) {
    LegacyBench m9(legacy_m9());
    for (const unsigned bit : {0u, 1u, 2u, 3u, 4u, 5u}) {
        Bytes message = hex("00 41 00 02 00000000 00 00 00 01 0000 000000000000");
        message[0] = static_cast<std::uint8_t>(1u << bit);
        message[3] = static_cast<std::uint8_t>(1u << bit & 0xF);
        message[4] = static_cast<std::uint8_t>(bit == 3 ? 0x40 : 1u << bit);
        EXPECT_EQ(m9.set(cfg(0x17), message), Verdict::acknowledge);
        EXPECT_EQ(m9.poll(cfg(0x17)), message);
    }
}

TEST(LegacyNmea, ShorterFormsLeaveTheRestAlone) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x17), hex("00 40 00 02 10000000 01 01 01 01 4742 000000000000")), Verdict::acknowledge);
    EXPECT_EQ(m8.set(cfg(0x17), hex("01 23 08 01")), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x17)), hex("01 23 08 01 10000000 01 01 01 01 4742 000000000000"));
    EXPECT_EQ(m8.set(cfg(0x17), hex("00 41 10 02 20000000 00 02 00 00")), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x17)), hex("00 41 10 02 20000000 00 02 00 01 4742 000000000000"));
}

TEST(LegacyNmea, RefusesFormsVersionsAndValuesThatDoNotExist) {
    LegacyBench m8(legacy_m8());
    BoardProfile old_board = legacy_m8();
    old_board.identity.generation = 6;
    LegacyBench u6(old_board);
    const std::uint64_t before = m8.store.revision();
    for (const std::string_view bad :
         {"00 42 00 02", "00 40 09 02", "00 40 00 02 00000000 00 00 00 01",
          "00 40 00 02 00000000 00 00 00 00 0000 000000000000", "00 40 00 02 00000000 02 00 00 01 0000 000000000000",
          "00 40 00 02 00000000 00 08 00 01 0000 000000000000", "00 40 00"})
        EXPECT_EQ(m8.set(cfg(0x17), hex(bad)), Verdict::refuse) << bad;
    EXPECT_EQ(m8.store.revision(), before);
    EXPECT_EQ(u6.set(cfg(0x17), hex("00 23 00 02")), Verdict::acknowledge);
    EXPECT_EQ(u6.set(cfg(0x17), hex("00 23 00 02 00000000 00 00 00 00")), Verdict::refuse);
}

}  // namespace
}  // namespace skyloop::firmware
