// CFG-CFG (RECEIVER.md 3.3, 4.2, 4.3).
#include <gtest/gtest.h>

#include "legacy_bench.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::string_view everything = "FFFFFFFF", nothing = "00000000";

Bytes masks(std::string_view clear, std::string_view save, std::string_view load, std::string_view devices = "") {
    return hex(std::string(clear) + std::string(save) + std::string(load) + std::string(devices));
}

/// One item of each section of the masks, with another value than the factory's.
struct SectionItem {
    std::string_view mask;
    std::uint32_t key;
    std::uint64_t value;
};
constexpr SectionItem section_items[] = {
    {"01000000", 0x40520001, 115200}, {"01000000", 0x10740002, 0},   {"01000000", 0x30FD0002, 7},
    {"02000000", 0x20910007, 3},      {"02000000", 0x20FE0011, 2},   {"04000000", 0x20920002, 0x1F},
    {"08000000", 0x20110021, 8},      {"08000000", 0x30210001, 200}, {"08000000", 0x20930001, 41},
    {"08000000", 0x10360003, 0},      {"08000000", 0x20FD0301, 1},   {"10000000", 0x10310021, 1},
    {"10000000", 0x40050003, 500000}, {"10000000", 0x1041000D, 1},   {"10000000", 0x20D00001, 1},
    {"00040000", 0x20A30036, 3},      {"00080000", 0x10DE0002, 1},
};

TEST(LegacyStorage, SavesClearsAndLoadsTheSectionsOfM8) {
    for (const SectionItem& item : section_items) {
        LegacyBench m8(legacy_m8());
        for (const SectionItem& each : section_items)
            m8.store.set(in_ram, each.key, each.value);
        ASSERT_EQ(m8.store.value(item.key), item.value) << std::hex << item.key;
        EXPECT_EQ(m8.set(cfg(0x09), masks(nothing, item.mask, nothing)), Verdict::acknowledge);
        for (const SectionItem& each : section_items) {
            EXPECT_EQ(m8.store.stored(ConfigLayer::battery, each.key).has_value(), each.mask == item.mask)
                << std::hex << item.key << " " << each.key;
            EXPECT_EQ(m8.store.stored(ConfigLayer::flash, each.key).has_value(), each.mask == item.mask);
        }
        // Loading what was not saved gives the factory's value; of other sections nothing changes.
        EXPECT_EQ(m8.set(cfg(0x09), masks(item.mask, nothing, item.mask)), Verdict::acknowledge);
        for (const SectionItem& each : section_items) {
            const auto factory = m8.store.stored(ConfigLayer::factory, each.key);
            EXPECT_EQ(m8.store.value(each.key), each.mask == item.mask ? *factory : each.value) << std::hex << each.key;
        }
    }
}

TEST(LegacyStorage, ClearsThenSavesThenLoads) {
    LegacyBench m8(legacy_m8());
    m8.store.set(in_ram, key::navspg_dynmodel, 8);
    EXPECT_EQ(m8.set(cfg(0x09), masks(everything, everything, everything)), Verdict::acknowledge);
    EXPECT_EQ(m8.store.value(key::navspg_dynmodel), 8u);
    m8.store.set(in_ram, key::navspg_dynmodel, 4);
    EXPECT_EQ(m8.set(cfg(0x09), masks(nothing, nothing, everything)), Verdict::acknowledge);
    EXPECT_EQ(m8.store.value(key::navspg_dynmodel), 8u);
    EXPECT_EQ(m8.set(cfg(0x09), masks(everything, nothing, everything)), Verdict::acknowledge);
    EXPECT_EQ(m8.store.values(ConfigLayer::ram), factory_config(m8.board));
}

TEST(LegacyStorage, WritesTheMemoriesThatAreNamed) {
    LegacyBench m8(legacy_m8());
    const auto saved = [&](ConfigLayer layer) { return m8.store.stored(layer, key::rate_meas).has_value(); };
    EXPECT_EQ(m8.send(cfg(0x09), masks(nothing, everything, nothing, "01")).work, Seconds(0));
    EXPECT_TRUE(saved(ConfigLayer::battery));
    EXPECT_FALSE(saved(ConfigLayer::flash));
    EXPECT_EQ(m8.send(cfg(0x09), masks(nothing, everything, nothing, "02")).work, m8.board.timing.flash_write);
    EXPECT_TRUE(saved(ConfigLayer::flash));
    EXPECT_EQ(m8.set(cfg(0x09), masks(everything, nothing, nothing, "01")), Verdict::acknowledge);
    EXPECT_FALSE(saved(ConfigLayer::battery));
    EXPECT_TRUE(saved(ConfigLayer::flash));
    EXPECT_EQ(m8.send(cfg(0x09), masks(nothing, nothing, everything)).work, Seconds(0));
}

// Battery-backed RAM goes before flash (RECEIVER.md 4.3).
TEST(LegacyStorage, LoadsTheUppermostLayer) {
    LegacyBench m8(legacy_m8());
    m8.store.set(in_battery, key::navspg_dynmodel, 7);
    m8.store.set(in_flash, key::navspg_dynmodel, 6);
    m8.store.set(in_flash, key::rate_meas, 250);
    EXPECT_EQ(m8.set(cfg(0x09), masks(nothing, nothing, "08000000")), Verdict::acknowledge);
    EXPECT_EQ(m8.store.value(key::navspg_dynmodel), 7u);
    EXPECT_EQ(m8.store.value(key::rate_meas), 250u);
}

TEST(LegacyStorage, WithoutFlashItIsTakenAllTheSame) {
    BoardProfile board = legacy_m8();
    board.identity.software = "ROM CORE 3.01 (107888)";
    LegacyBench rom(board);
    const ConfigOutcome outcome = rom.send(cfg(0x09), masks(nothing, everything, nothing));
    EXPECT_EQ(outcome.verdict, Verdict::acknowledge);
    EXPECT_EQ(outcome.work, Seconds(0));
    EXPECT_TRUE(rom.store.stored(ConfigLayer::battery, key::rate_meas).has_value());
    EXPECT_TRUE(rom.store.values(ConfigLayer::flash).empty());
    EXPECT_EQ(rom.set(cfg(0x09), masks(nothing, everything, nothing, "02")), Verdict::acknowledge);
    EXPECT_TRUE(rom.store.values(ConfigLayer::flash).empty());
    board.identity.generation = 6;
    board.identity.software = "7.03 (45969)";
    LegacyBench u6(board);
    EXPECT_EQ(u6.set(cfg(0x09), masks(nothing, everything, nothing)), Verdict::acknowledge);
    EXPECT_TRUE(u6.store.values(ConfigLayer::flash).empty());
}

// From generation 9 on any bit stands for everything (RECEIVER.md 3.3).
TEST(LegacyStorage, OfGeneration9TakesWholeLayers) {
    LegacyBench m9(legacy_m9());
    m9.store.set(in_ram, key::navspg_dynmodel, 8);
    m9.store.set(in_ram, key::uart1_baudrate, 9600);
    m9.store.set(in_battery | in_flash, key::navspg_dynmodel, 7);
    EXPECT_EQ(m9.set(cfg(0x09), masks("01000000", nothing, nothing, "01")), Verdict::acknowledge);
    EXPECT_TRUE(m9.store.values(ConfigLayer::battery).empty());
    EXPECT_EQ(m9.store.stored(ConfigLayer::flash, key::navspg_dynmodel), 7u);
    EXPECT_EQ(m9.set(cfg(0x09), masks(nothing, nothing, "01000000")), Verdict::acknowledge);
    EXPECT_EQ(m9.store.value(key::navspg_dynmodel), 7u);
    EXPECT_EQ(m9.store.value(key::uart1_baudrate), 38400u);
}

TEST(LegacyStorage, RefusesOtherLengthsAndALockedConfiguration) {
    LegacyBench m9(legacy_m9());
    for (const std::size_t size : {0u, 1u, 11u, 14u})
        EXPECT_EQ(m9.send(cfg(0x09), Bytes(size)).verdict, Verdict::refuse) << size;
    m9.store.set(in_ram, 0x10F60009, 1);
    EXPECT_EQ(m9.set(cfg(0x09), masks(everything, nothing, everything)), Verdict::refuse);
    EXPECT_EQ(m9.set(cfg(0x08), hex("C800 0100 0100")), Verdict::refuse);
    m9.store.set(in_ram, 0x30F6000A, 0x21);  // leaves CFG-RATE open
    EXPECT_EQ(m9.set(cfg(0x08), hex("C800 0100 0100")), Verdict::acknowledge);
    EXPECT_EQ(m9.poll(cfg(0x08)), hex("C800 0100 0100"));
}

}  // namespace
}  // namespace skyloop::firmware
