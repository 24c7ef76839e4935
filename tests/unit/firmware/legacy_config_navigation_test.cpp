#include <gtest/gtest.h>

#include "legacy_bench.hpp"

namespace skyloop::firmware {
namespace {

TEST(LegacyRate, IsStoredAndReadBack) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x08), hex("C800 0100 0000")), Verdict::acknowledge);
    EXPECT_EQ(m8.store.value(key::rate_meas), 200u);
    EXPECT_EQ(m8.store.value(key::rate_timeref), 0u);
    EXPECT_EQ(m8.poll(cfg(0x08)), hex("C800 0100 0000"));
}

// Taken, clamped, read back clamped (RECEIVER.md 2.6).
TEST(LegacyRate, TooShortAPeriodBecomesTheShortest) {
    LegacyBench m8(legacy_m8()), m9(legacy_m9());
    EXPECT_EQ(m8.set(cfg(0x08), hex("0A00 0100 0100")), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x08)), hex("3200 0100 0100"));
    EXPECT_EQ(m9.set(cfg(0x08), hex("0000 0100 0100")), Verdict::acknowledge);
    EXPECT_EQ(m9.poll(cfg(0x08)), hex("1900 0100 0100"));
}

TEST(LegacyRate, RefusesCyclesAndTimesThatDoNotExist) {
    LegacyBench m8(legacy_m8()), m9(legacy_m9());
    EXPECT_EQ(m8.set(cfg(0x08), hex("C800 0000 0100")), Verdict::refuse);
    EXPECT_EQ(m8.set(cfg(0x08), hex("C800 8100 0100")), Verdict::refuse);
    EXPECT_EQ(m8.set(cfg(0x08), hex("C800 8000 0100")), Verdict::acknowledge);
    EXPECT_EQ(m9.set(cfg(0x08), hex("C800 8000 0100")), Verdict::refuse);
    EXPECT_EQ(m9.set(cfg(0x08), hex("C800 7F00 0100")), Verdict::acknowledge);
    EXPECT_EQ(m9.set(cfg(0x08), hex("C800 0100 0700")), Verdict::refuse);
    EXPECT_EQ(m9.set(cfg(0x08), hex("C800 0100 0001")), Verdict::refuse);
    EXPECT_EQ(m9.set(cfg(0x08), hex("C800 0100 01")), Verdict::refuse);
    EXPECT_EQ(m9.poll(cfg(0x08)), hex("C800 7F00 0100"));
}

/// Every field of CFG-NAV5 other than at the factory, under a mask.
Bytes other_nav5(std::string_view mask) {
    return hex(std::string(mask) +
               "08 02 01020304 20300000 0A 02 6400 6500 3200 3300 19 1E 04 23 0000 0A00 03 0000000000");
}

TEST(LegacyNav5, AppliesOnlyTheGroupsOfItsMask) {
    struct Group {
        std::string_view mask;
        std::string_view answer;
    };
    const Group groups[] = {
        {"0100", "08 03 00000000 10270000 05 00 FA00 FA00 6400 5E01 00 3C 00 00 0000 0000 00"},
        {"0200", "00 03 00000000 10270000 0A 00 FA00 FA00 6400 5E01 00 3C 00 00 0000 0000 00"},
        {"0400", "00 02 01020304 20300000 05 00 FA00 FA00 6400 5E01 00 3C 00 00 0000 0000 00"},
        {"0800", "00 03 00000000 10270000 05 02 FA00 FA00 6400 5E01 00 3C 00 00 0000 0000 00"},
        {"1000", "00 03 00000000 10270000 05 00 6400 FA00 3200 5E01 00 3C 00 00 0000 0000 00"},
        {"2000", "00 03 00000000 10270000 05 00 FA00 6500 6400 3300 00 3C 00 00 0000 0000 00"},
        {"4000", "00 03 00000000 10270000 05 00 FA00 FA00 6400 5E01 19 3C 00 00 0000 0A00 00"},
        {"8000", "00 03 00000000 10270000 05 00 FA00 FA00 6400 5E01 00 1E 00 00 0000 0000 00"},
        {"0001", "00 03 00000000 10270000 05 00 FA00 FA00 6400 5E01 00 3C 04 23 0000 0000 00"},
        {"0004", "00 03 00000000 10270000 05 00 FA00 FA00 6400 5E01 00 3C 00 00 0000 0000 03"},
        {"0000", "00 03 00000000 10270000 05 00 FA00 FA00 6400 5E01 00 3C 00 00 0000 0000 00"},
        {"FFFF", "08 02 01020304 20300000 0A 02 6400 6500 3200 3300 19 1E 04 23 0000 0A00 03"},
    };
    for (const Group& group : groups) {
        LegacyBench m8(legacy_m8());
        EXPECT_EQ(m8.set(cfg(0x24), other_nav5(group.mask)), Verdict::acknowledge) << group.mask;
        EXPECT_EQ(m8.poll(cfg(0x24)), hex("FFFF" + std::string(group.answer) + "0000000000")) << group.mask;
    }
}

TEST(LegacyNav5, RefusesModelsAndModesThatDoNotExist) {
    LegacyBench m8(legacy_m8());
    const std::uint64_t before = m8.store.revision();
    for (const std::string_view bad : {"FFFF 01 03", "FFFF 0D 03", "FFFF 00 00", "FFFF 00 04", "0100 FF 03"}) {
        Bytes bytes = hex(bad);
        bytes.resize(36);
        EXPECT_EQ(m8.set(cfg(0x24), bytes), Verdict::refuse) << bad;
    }
    EXPECT_EQ(m8.store.revision(), before);
    Bytes unmasked = hex("0000 FF FF");  // says nothing
    unmasked.resize(36);
    EXPECT_EQ(m8.set(cfg(0x24), unmasked), Verdict::acknowledge);
    EXPECT_EQ(m8.store.revision(), before);
}

Bytes navx5(std::string_view version, std::string_view mask1, std::string_view mask2) {
    return hex(std::string(version) + std::string(mask1) + std::string(mask2) +
               "0000 04 10 09 00 01 0000 01 D007 02 00 0000 0000 01 01 0000 3200 00000000 000000 01");
}

TEST(LegacyNavx5, WantsTheVersionOfTheFirmware) {
    LegacyBench m8(legacy_m8());
    BoardProfile old_board = legacy_m8();
    old_board.identity.extensions = {"PROTVER 15.00"};
    LegacyBench old_m8(old_board);
    EXPECT_EQ(m8.set(cfg(0x23), navx5("0000", "0400", "00000000")), Verdict::refuse);
    EXPECT_EQ(m8.store.value(key::navspg_min_svs), 3u);
    EXPECT_EQ(m8.set(cfg(0x23), navx5("0200", "0400", "00000000")), Verdict::acknowledge);
    EXPECT_EQ(m8.store.value(key::navspg_min_svs), 4u);
    EXPECT_EQ(old_m8.set(cfg(0x23), navx5("0200", "0400", "00000000")), Verdict::refuse);
    EXPECT_EQ(old_m8.set(cfg(0x23), navx5("0000", "0400", "00000000")), Verdict::acknowledge);
}

TEST(LegacyNavx5, AppliesOnlyTheGroupsOfItsMasks) {
    struct Group {
        std::string_view mask1, mask2;
        std::string_view answer;
    };
    const Group groups[] = {
        {"0400", "00000000", "04 10 06 00 00 0000 00 4B07 00 00 0000 0000 00 00 0000 6400 00000000 000000 00"},
        {"0800", "00000000", "03 20 09 00 00 0000 00 4B07 00 00 0000 0000 00 00 0000 6400 00000000 000000 00"},
        {"4000", "00000000", "03 20 06 00 01 0000 00 4B07 00 00 0000 0000 00 00 0000 6400 00000000 000000 00"},
        {"0002", "00000000", "03 20 06 00 00 0000 00 D007 00 00 0000 0000 00 00 0000 6400 00000000 000000 00"},
        {"0004", "00000000", "03 20 06 00 00 0000 01 4B07 00 00 0000 0000 00 00 0000 6400 00000000 000000 00"},
        {"0020", "00000000", "03 20 06 00 00 0000 00 4B07 00 00 0000 0000 01 00 0000 6400 00000000 000000 00"},
        {"0040", "00000000", "03 20 06 00 00 0000 00 4B07 00 00 0000 0000 00 01 0000 3200 00000000 000000 00"},
        {"0000", "40000000", "03 20 06 00 00 0000 00 4B07 00 00 0000 0000 00 00 0000 6400 00000000 000000 01"},
        {"0000", "80000000", "03 20 06 00 00 0000 00 4B07 02 00 0000 0000 00 00 0000 6400 00000000 000000 00"},
    };
    for (const Group& group : groups) {
        LegacyBench m8(legacy_m8());
        EXPECT_EQ(m8.set(cfg(0x23), navx5("0200", group.mask1, group.mask2)), Verdict::acknowledge);
        EXPECT_EQ(m8.poll(cfg(0x23)), hex("0200 4C66 C0000000 0000" + std::string(group.answer)))
            << group.mask1 << group.mask2;
    }
}

TEST(LegacyOdo, IsItemsOfTheStore) {
    LegacyBench m9(legacy_m9());
    const Bytes odo = hex("00 000000 0B 03 000000000000 0A 32 0000 99 4C 0000");
    EXPECT_EQ(m9.set(cfg(0x1E), odo), Verdict::acknowledge);
    EXPECT_EQ(m9.poll(cfg(0x1E)), odo);
    EXPECT_TRUE(m9.store.flag(0x10220001));
    EXPECT_FALSE(m9.store.flag(0x10220003));
    EXPECT_EQ(m9.store.value(0x20220021), 10u);
    EXPECT_EQ(m9.set(cfg(0x1E), hex("01 000000 0B 03 000000000000 0A 32 0000 99 4C 0000")), Verdict::refuse);
}

TEST(LegacyDgnss, KnowsFloatAndFixed) {
    LegacyBench f9p(legacy_f9p());
    EXPECT_EQ(f9p.set(cfg(0x70), hex("02 000000")), Verdict::acknowledge);
    EXPECT_EQ(f9p.poll(cfg(0x70)), hex("02 000000"));
    EXPECT_EQ(f9p.set(cfg(0x70), hex("01 000000")), Verdict::refuse);
    EXPECT_EQ(f9p.store.value(key::navhpg_dgnssmode), 2u);
}

TEST(LegacyTmode3, KeepsBothKindsOfPosition) {
    LegacyBench f9p(legacy_f9p());
    const Bytes ecef =
        hex("00 00 0200 01000000 02000000 FFFFFFFF 63 00 9D 00 10270000 3C000000 50C30000 0000000000000000");
    EXPECT_EQ(f9p.set(cfg(0x71), ecef), Verdict::acknowledge);
    EXPECT_EQ(f9p.poll(cfg(0x71)), ecef);
    EXPECT_EQ(f9p.store.value(key::tmode_mode), 2u);
    EXPECT_EQ(f9p.store.signed_value(0x40030005), -1);
    EXPECT_EQ(f9p.store.signed_value(0x20030008), -99);
    const Bytes lla =
        hex("00 00 0201 40420F00 80841E00 E8030000 01 02 03 00 10270000 3C000000 50C30000 0000000000000000");
    EXPECT_EQ(f9p.set(cfg(0x71), lla), Verdict::acknowledge);
    EXPECT_EQ(f9p.poll(cfg(0x71)), lla);
    EXPECT_EQ(f9p.store.value(0x40030009), 1'000'000u);
    EXPECT_EQ(f9p.store.signed_value(0x40030005), -1);
    Bytes bad = ecef;
    bad[2] = 3;  // no such mode
    EXPECT_EQ(f9p.set(cfg(0x71), bad), Verdict::refuse);
    bad = ecef;
    bad[16] = 100;  // more than a unit of the coarse part
    EXPECT_EQ(f9p.set(cfg(0x71), bad), Verdict::refuse);
    bad = ecef;
    bad[0] = 1;
    EXPECT_EQ(f9p.set(cfg(0x71), bad), Verdict::refuse);
    EXPECT_EQ(f9p.poll(cfg(0x71)), lla);
}

TEST(LegacyTmode3, RefusesPlacesThatAreNotOnTheEarth) {
    LegacyBench f9(legacy_f9p());
    // Fixed, geodetic; latitude and longitude in 1e-7 degrees.
    const auto place = [&](const char* latitude, const char* longitude) {
        return f9.set(cfg(0x71), hex("00 00 0201 " + std::string(latitude) + longitude + "00000000 000000 00 10270000" +
                                     "00000000 00000000 0000000000000000"));
    };
    EXPECT_EQ(place("00CA9A3B", "00000000"), Verdict::refuse) << "100 degrees north";
    EXPECT_EQ(place("00000000", "01D2496B"), Verdict::refuse) << "beyond 180 degrees east";
    EXPECT_EQ(f9.store.value(key::tmode_mode), 0U);
    EXPECT_EQ(place("00E9A435", "00D2496B"), Verdict::acknowledge) << "the pole";
    EXPECT_EQ(f9.valset("09 00 03 40 00CA9A3B"), Verdict::refuse);
}

}  // namespace
}  // namespace skyloop::firmware
