#include <gtest/gtest.h>

#include "legacy_bench.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::uint32_t gps_on = 0x1031001F, sbas_on = 0x10310020, galileo_on = 0x10310021, beidou_on = 0x10310022,
                        qzss_on = 0x10310024, glonass_on = 0x10310025;

TEST(LegacyGnss, SwitchesSystemsAndLeavesOthersAlone) {
    LegacyBench m8(legacy_m8());
    // Galileo on; BeiDou and the rest are not named.
    const ConfigOutcome outcome = m8.send(cfg(0x3E), hex("00 00 20 01  02 04 08 00 01000101"));
    EXPECT_EQ(outcome.verdict, Verdict::acknowledge);
    EXPECT_GE(outcome.work.value(), 0.020);
    EXPECT_LE(outcome.work.value(), 0.100);
    EXPECT_TRUE(m8.store.flag(galileo_on));
    EXPECT_TRUE(m8.store.flag(gps_on));
    EXPECT_TRUE(m8.store.flag(glonass_on));
    EXPECT_FALSE(m8.store.flag(beidou_on));
    EXPECT_EQ(m8.poll(cfg(0x3E)), hex("00 20 20 07  00 08 10 00 01000101  01 01 03 00 01000101  02 04 08 00 01000101"
                                      "03 08 10 00 00000101  04 00 08 00 00000103  05 00 03 00 01000105"
                                      "06 08 0E 00 01000101"));
}

TEST(LegacyGnss, GivesTheTopByteAsTheBoardHasItWhateverCameIn) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x3E), hex("00 20 20 01  05 01 03 00 010001FF")), Verdict::acknowledge);
    const Bytes answer = m8.poll(cfg(0x3E));
    ASSERT_EQ(answer.size(), 60u);
    EXPECT_EQ(Bytes(answer.begin() + 44, answer.begin() + 52), hex("05 01 03 00 01000105"));
}

TEST(LegacyGnss, SignalsAreItemsOfTheStore) {
    LegacyBench f9p(legacy_f9p());
    EXPECT_TRUE(f9p.store.flag(0x10310003));
    EXPECT_EQ(f9p.set(cfg(0x3E), hex("00 00 3C 02  00 08 10 00 01000101  02 0A 12 00 01000101")), Verdict::acknowledge);
    EXPECT_FALSE(f9p.store.flag(0x10310003));
    EXPECT_TRUE(f9p.store.flag(0x10310001));
    EXPECT_FALSE(f9p.store.flag(0x1031000A));
    EXPECT_TRUE(f9p.store.flag(0x1031000E));
    const Bytes answer = f9p.poll(cfg(0x3E));
    EXPECT_EQ(Bytes(answer.begin() + 8, answer.begin() + 12), hex("01000101"));
    // An empty mask says nothing of the signals.
    EXPECT_EQ(f9p.set(cfg(0x3E), hex("00 00 3C 01  03 02 05 00 01000001")), Verdict::acknowledge);
    EXPECT_TRUE(f9p.store.flag(0x1031000D));
    EXPECT_TRUE(f9p.store.flag(0x1031000E));
}

TEST(LegacyGnss, RefusesWhatCannotBe) {
    LegacyBench m8(legacy_m8());
    const std::uint64_t before = m8.store.revision();
    for (const std::string_view bad : {
             "00 20 20 02  00 08 10 00 00000101  06 08 0E 00 00000101",  // SBAS and QZSS alone
             "00 20 20 01  00 18 18 00 01000101",                        // more reserved than there are
             "00 20 10 01  00 08 10 00 01000101",                        // more than are to be used
             "00 20 20 01  00 08 07 00 01000101",                        // more reserved than at most
             "00 20 20 01  00 02 03 00 01000101",                        // a major system needs four
             "00 20 20 01  07 02 04 00 01000101",                        // no such system
             "00 20 20 02  02 04 08 00 01000101  03 04 10 00 01000101",  // four systems on M8
             "01 20 20 01  00 08 10 00 01000101",                        // no such version
             "00 20 20 02  00 08 10 00 01000101",                        // fewer blocks than it says
             "00 20 20 01  00 08 10 00 01001001",                        // a signal that M8 does not track
         })
        EXPECT_EQ(m8.set(cfg(0x3E), hex(bad)), Verdict::refuse) << bad;
    EXPECT_EQ(m8.store.revision(), before);
}

TEST(LegacyGnss, TakesFewerChannelsAndAllOfThem) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x3E), hex("00 00 18 01  00 06 0A 00 01000101")), Verdict::acknowledge);
    Bytes answer = m8.poll(cfg(0x3E));
    EXPECT_EQ(Bytes(answer.begin(), answer.begin() + 8), hex("00 20 18 07 00 06 0A 00"));
    EXPECT_EQ(m8.set(cfg(0x3E), hex("00 00 FF 00")), Verdict::acknowledge);
    answer = m8.poll(cfg(0x3E));
    EXPECT_EQ(answer[2], 32);
}

TEST(LegacyGnss, LeavesReadOnlyChannelsUnreadFromGeneration9On) {
    LegacyBench f9p(legacy_f9p());
    const Bytes before = f9p.poll(cfg(0x3E));
    for (const std::string_view taken : {
             "00 3C 3C 02  00 0E 3C 00 01001101  06 0E 3C 00 01001101",  // reserved for two, more than there are for
                                                                         // one
             "00 00 14 01  00 3C 3C 00 01001101",                        // more reserved than are to be used
             "00 00 3C 01  00 10 00 00 01001101",                        // more reserved than at most
             "00 00 00 01  02 00 00 00 01002101",                        // none at all
         }) {
        EXPECT_EQ(f9p.set(cfg(0x3E), hex(taken)), Verdict::acknowledge) << taken;
        EXPECT_EQ(f9p.poll(cfg(0x3E)), before) << taken;
    }
    // What has to do with systems is still refused.
    EXPECT_EQ(f9p.set(cfg(0x3E), hex("00 00 3C 01  07 02 04 00 01000101")), Verdict::refuse);
    EXPECT_EQ(f9p.set(cfg(0x3E), hex("00 00 3C 04  00 08 10 00 00001101  02 0A 12 00 00002101"
                                     "03 02 05 00 00001101  06 08 0C 00 00000101")),
              Verdict::refuse);
    LegacyBench m9(legacy_m9());
    EXPECT_EQ(m9.set(cfg(0x3E), hex("00 2A 2A 01  00 2B 2A 00 01000101")), Verdict::acknowledge);
    EXPECT_EQ(m9.poll(cfg(0x3E))[5], 8);
}

TEST(LegacyGnss, ABoardWithoutBlocksRefuses) {
    BoardProfile board = legacy_m9();
    board.gnss_blocks.clear();
    LegacyBench bench(board);
    EXPECT_EQ(bench.send(cfg(0x3E), {}).verdict, Verdict::refuse);
    EXPECT_EQ(bench.set(cfg(0x3E), hex("00 00 FF 01 00 08 10 00 01000101")), Verdict::refuse);
}

TEST(LegacySbas, IsItemsOfTheStore) {
    LegacyBench m9(legacy_m9());
    EXPECT_EQ(m9.set(cfg(0x16), hex("03 05 02 41 51080080")), Verdict::acknowledge);
    EXPECT_TRUE(m9.store.flag(0x10360002));
    EXPECT_TRUE(m9.store.flag(0x10360003));
    EXPECT_FALSE(m9.store.flag(0x10360004));
    EXPECT_TRUE(m9.store.flag(0x10360005));
    EXPECT_EQ(m9.store.value(0x50360006), 0x41'8000'0851u);
    EXPECT_EQ(m9.poll(cfg(0x16)), hex("03 05 02 41 51080080"));
    const ConfigOutcome off = m9.send(cfg(0x16), hex("00 03 03 00 00000000"));
    EXPECT_EQ(off.verdict, Verdict::acknowledge);
    EXPECT_GE(off.work.value(), 0.020);
    EXPECT_FALSE(m9.store.flag(sbas_on));
    EXPECT_TRUE(m9.store.flag(qzss_on));
    EXPECT_EQ(m9.poll(cfg(0x16)), hex("00 03 03 00 00000000"));
    EXPECT_EQ(m9.poll(cfg(0x3E))[16], 0);  // the same item as SBAS of CFG-GNSS
    EXPECT_EQ(m9.set(cfg(0x16), Bytes(7)), Verdict::refuse);
}

}  // namespace
}  // namespace skyloop::firmware
