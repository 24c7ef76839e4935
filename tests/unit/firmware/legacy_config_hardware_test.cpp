#include <gtest/gtest.h>

#include "legacy_bench.hpp"

namespace skyloop::firmware {
namespace {

TEST(LegacyTp5, PeriodsAndLengthsAreItemsOfTheStore) {
    LegacyBench m9(legacy_m9());
    // 5 s unlocked, 2 s locked; 10 ms and 20 ms; GPS grid; falling; delays.
    const Bytes pulse = hex("00 01 0000 1400 0000 404B4C00 80841E00 10270000 204E0000 9CFFFFFF B7000000");
    EXPECT_EQ(m9.set(cfg(0x31), pulse), Verdict::acknowledge);
    EXPECT_EQ(m9.poll(cfg(0x31)), pulse);
    EXPECT_EQ(m9.poll(cfg(0x31), {0}), pulse);
    EXPECT_EQ(m9.store.value(0x40050002), 5'000'000u);
    EXPECT_EQ(m9.store.value(0x40050005), 20'000u);
    EXPECT_EQ(m9.store.signed_value(0x40050006), -100);
    EXPECT_EQ(m9.store.value(0x2005000C), 1u);
    EXPECT_EQ(m9.store.value(0x30050001), 20u);
    EXPECT_FALSE(m9.store.flag(0x1005000B));
}

TEST(LegacyTp5, FrequenciesAndDutyCyclesToo) {
    LegacyBench m9(legacy_m9());
    // 10 Hz and 1000 Hz; half and a quarter of the period.
    const Bytes pulse = hex("00 01 0000 3200 0000 0A000000 E8030000 00000080 00000040 00000000 6F000000");
    EXPECT_EQ(m9.set(cfg(0x31), pulse), Verdict::acknowledge);
    EXPECT_EQ(m9.poll(cfg(0x31)), pulse);
    EXPECT_EQ(m9.store.value(0x40050024), 10u);
    EXPECT_EQ(m9.store.value(0x40050002), 1'000'000u);
    EXPECT_EQ(m9.store.value(0x5005002A), 0x4049'0000'0000'0000u);  // 50 %
    EXPECT_EQ(m9.store.value(0x5005002B), 0x4039'0000'0000'0000u);  // 25 %
    EXPECT_EQ(m9.store.value(0x20050023), 1u);
    EXPECT_EQ(m9.store.value(0x20050030), 0u);
}

TEST(LegacyTp5, OfM8HasTwoPulsesOfTheirOwn) {
    LegacyBench m8(legacy_m8());
    const Bytes first = m8.poll(cfg(0x31), {0});
    const Bytes second = hex("01 01 0000 3200 0500 40420F00 40420F00 E8030000 D0070000 01000000 77080000");
    EXPECT_EQ(m8.set(cfg(0x31), second), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x31), {1}), second);
    EXPECT_EQ(m8.poll(cfg(0x31), {0}), first);
}

// The configuration file of a NEO-6: 233 stands where later receivers have the version.
TEST(LegacyTp5, HasNoVersionOnUblox6) {
    BoardProfile board = legacy_m8();
    board.identity.generation = 6;
    board.identity.extensions.clear();
    LegacyBench old(board);
    const Bytes told = old.poll(cfg(0x31));
    EXPECT_EQ(told[1], 0);
    Bytes pulse = told;
    pulse[1] = 0xE9;
    pulse[2] = 0x03;
    pulse[28] = 0xF7;  // by GPS time
    EXPECT_EQ(old.set(cfg(0x31), pulse), Verdict::acknowledge);
    EXPECT_EQ(old.poll(cfg(0x31))[28], 0xF7);
}

TEST(LegacyTp5, RefusesPulsesThatDoNotExist) {
    LegacyBench m9(legacy_m9());
    EXPECT_EQ(m9.send(cfg(0x31), {2}).verdict, Verdict::refuse);
    Bytes pulse = m9.poll(cfg(0x31));
    pulse[0] = 2;
    EXPECT_EQ(m9.set(cfg(0x31), pulse), Verdict::refuse);
    pulse[0] = 0;
    pulse[1] = 2;  // no such version
    EXPECT_EQ(m9.set(cfg(0x31), pulse), Verdict::refuse);
    pulse[1] = 1;
    pulse[29] = 0x05;  // time grid 10
    EXPECT_EQ(m9.set(cfg(0x31), pulse), Verdict::refuse);
    BoardProfile single = legacy_m9();
    single.absent_keys.insert(0x10050012);
    EXPECT_EQ(LegacyBench(single).send(cfg(0x31), {1}).verdict, Verdict::refuse);
}

TEST(LegacyItfm, ReturnsTheFixedBitsWhateverCameIn) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x39), hex("F3AC62AD 1E230000")), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x39)), hex("F3AC62AD 1E230000"));
    EXPECT_TRUE(m8.store.flag(key::itfm_enable));
    EXPECT_EQ(m8.store.value(0x20410010), 2u);
    EXPECT_EQ(m8.set(cfg(0x39), hex("55000000 00400000")), Verdict::acknowledge);
    EXPECT_EQ(m8.store.value(0x20410001), 5u);
    EXPECT_EQ(m8.store.value(0x20410002), 5u);
    EXPECT_EQ(m8.poll(cfg(0x39)), hex("55AC622D 1E430000"));
    EXPECT_EQ(m8.set(cfg(0x39), hex("55000000 00300000")), Verdict::refuse);  // antenna 3
}

TEST(LegacyPower, SetupsAreOperateModes) {
    LegacyBench m8(legacy_m8());
    const auto mode = [&] { return m8.store.value(0x20D00001); };
    EXPECT_EQ(m8.set(cfg(0x86), hex("00 02 0A00 0300 0000")), Verdict::acknowledge);
    EXPECT_EQ(mode(), 1u);
    EXPECT_EQ(m8.store.value(0x40D00002), 10u);
    EXPECT_EQ(m8.store.value(0x30D00005), 3u);
    EXPECT_EQ(m8.poll(cfg(0x86)), hex("00 02 0A00 0300 0000"));
    EXPECT_EQ(m8.poll(cfg(0x11)), hex("08 01"));
    EXPECT_EQ(m8.set(cfg(0x86), hex("00 04 0000 0000 0000")), Verdict::acknowledge);
    EXPECT_EQ(mode(), 2u);
    EXPECT_EQ(m8.poll(cfg(0x86)), hex("00 04 0000 0000 0000"));
    EXPECT_EQ(m8.set(cfg(0x86), hex("00 01 0000 0000 0000")), Verdict::acknowledge);
    EXPECT_EQ(mode(), 0u);
    EXPECT_EQ(m8.poll(cfg(0x86)), hex("00 01 0000 0000 0000"));
    for (const std::string_view bad : {"00 06 0000 0000 0000", "00 FF 0000 0000 0000", "01 00 0000 0000 0000",
                                       "00 02 0500 0000 0000", "00 02 0A00 0A00 0000"})
        EXPECT_EQ(m8.set(cfg(0x86), hex(bad)), Verdict::refuse) << bad;
    EXPECT_EQ(mode(), 0u);
}

TEST(LegacyPower, SetupFollowsTheModeThatOthersChose) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x11), hex("08 01")), Verdict::acknowledge);
    EXPECT_EQ(m8.store.value(0x20D00001), 2u) << "CFG-PM2 says so at the factory";
    EXPECT_EQ(m8.poll(cfg(0x86))[1], 0xFF);  // no setup says so
    m8.store.set(in_ram, 0x20D00001, 1);
    EXPECT_EQ(m8.poll(cfg(0x86))[1], 2);
    m8.store.set(in_ram, 0x20D00001, 2);
    EXPECT_EQ(m8.set(cfg(0x11), hex("08 01")), Verdict::acknowledge);
    EXPECT_EQ(m8.store.value(0x20D00001), 2u);
    EXPECT_EQ(m8.set(cfg(0x11), hex("08 04")), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x86))[1], 0);
    EXPECT_EQ(m8.poll(cfg(0x11)), hex("08 00"));
    EXPECT_EQ(m8.set(cfg(0x11), hex("08 02")), Verdict::refuse);
}

TEST(LegacyAntenna, FlagsAndPinsAreItemsOfTheStore) {
    LegacyBench m9(legacy_m9());
    EXPECT_EQ(m9.set(cfg(0x13), hex("1B00 418C")), Verdict::acknowledge);
    EXPECT_EQ(m9.poll(cfg(0x13)), hex("1B00 418C"));
    EXPECT_TRUE(m9.store.flag(key::ant_voltage_control));
    EXPECT_FALSE(m9.store.flag(key::ant_open_detect));
    EXPECT_EQ(m9.store.value(0x20A30036), 1u);
    EXPECT_EQ(m9.store.value(0x20A30037), 2u);
    EXPECT_EQ(m9.store.value(0x20A30038), 3u);
    EXPECT_EQ(m9.set(cfg(0x13), hex("0100 FF7F")), Verdict::acknowledge);  // pins are not to be taken
    EXPECT_EQ(m9.poll(cfg(0x13)), hex("0100 418C"));
    // A supply that is not switched cannot be cut (RECEIVER.md 4.4).
    EXPECT_EQ(m9.set(cfg(0x13), hex("0800 418C")), Verdict::refuse);
}

TEST(LegacyLogfilter, IsKept) {
    LegacyBench m8(legacy_m8());
    const Bytes filter = hex("01 07 0A00 1400 0500 64000000");
    EXPECT_EQ(m8.set(cfg(0x47), filter), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x47)), filter);
    EXPECT_TRUE(m8.store.flag(0x10DE0002));
    EXPECT_EQ(m8.set(cfg(0x47), hex("00 07 0A00 1400 0500 64000000")), Verdict::refuse);
}

}  // namespace
}  // namespace skyloop::firmware
