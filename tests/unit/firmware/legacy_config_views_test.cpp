// One store, two views: what a legacy message sets, CFG-VALGET reads, and the other way round (RECEIVER.md 4.3).
#include <gtest/gtest.h>

#include <random>

#include "legacy_bench.hpp"
#include "receiver/protocol/ubx_cfg.hpp"

namespace skyloop::firmware {
namespace {

/// By CFG-VALGET from RAM; nothing when refused.
std::optional<std::uint64_t> valget(LegacyBench& bench, std::uint32_t key) {
    CfgValgetPoll poll;
    poll.keys = {key};
    const ConfigOutcome outcome = bench.values.valget(encode_payload(poll));
    if (outcome.verdict != Verdict::acknowledge || outcome.answers.size() != 1) return std::nullopt;
    const auto frame = parse_frame(outcome.answers.front());
    const auto answer = frame ? decode_payload<CfgValget>(frame->payload) : std::nullopt;
    if (!answer || answer->pairs.size() != 1) return std::nullopt;
    return answer->pairs.front().value;
}

Verdict valset_one(LegacyBench& bench, std::uint32_t key, std::uint64_t value) {
    CfgValset set;
    set.layers = in_ram;
    set.pairs = {{key, value}};
    return bench.values.valset(encode_payload(set)).verdict;
}

/// A message that sets one item, and the same item as CFG-VALGET gives it.
struct Pairing {
    std::uint8_t id;
    std::string_view selector, payload;
    std::uint32_t key;
    std::uint64_t value;
};

constexpr Pairing pairings[] = {
    {0x00, "01", "01 00 0000 C0080000 00C20100 2300 0300 0000 0000", 0x40520001, 115200},
    {0x00, "01", "01 00 0000 C0080000 00960000 2100 0300 0000 0000", 0x10730002, 0},
    {0x00, "01", "01 00 0000 C0080000 00960000 2300 0100 0000 0000", 0x10740002, 0},
    {0x00, "02", "02 00 0000 C0080000 00960000 0300 0300 0000 0000", 0x10750004, 0},
    {0x00, "03", "03 00 0000 00000000 00000000 2300 0200 0000 0000", 0x10780001, 0},
    {0x00, "01", "01 00 0000 C0040000 00960000 2300 0300 0000 0000", 0, 0},  // refused: no such parity
    {0x01, "01 07", "01 07 00 01 00 00 00 00", 0x20910007, 1},
    {0x01, "F0 00", "F0 00 01 01 01 00 01 00", 0x209100BD, 0},
    {0x02, "01", "01 000000 07 1F 07 07 07 00", 0x20920007, 0x1F},
    {0x08, "", "7D00 0100 0100", 0x30210001, 125},
    {0x08, "", "E803 0200 0100", 0x30210002, 2},
    {0x08, "", "E803 0100 0400", 0x20210003, 4},
    {0x13, "", "0100 F0A1", 0x10A3002E, 1},
    {0x16, "", "00 03 03 00 882B0700", 0x10310020, 0},
    {0x16, "", "01 03 03 40 00000000", 0x50360006, 0x40'0000'0000},
    {0x17, "", "00 23 00 02 00000000 00 00 00 01 0000 000000000000", 0x20930001, 23},
    {0x17, "", "00 41 00 0A 00000000 00 00 00 01 0000 000000000000", 0x10930006, 1},
    {0x1E, "", "00 000000 01 00 000000000000 0A 32 0000 99 4C 0000", 0x10220001, 1},
    {0x24, "", "FFFF 08 03 00000000 10270000 05 00 FA00 FA00 6400 5E01 00 3C 00 00 0000 0000 00 0000000000", 0x20110021,
     8},
    {0x24, "", "FFFF 00 02 00000000 10270000 05 00 FA00 FA00 6400 5E01 00 3C 00 00 0000 0000 00 0000000000", 0x20110011,
     2},
    {0x24, "", "FFFF 00 03 00000000 10270000 F6 00 FA00 FA00 6400 5E01 00 3C 00 00 0000 0000 00 0000000000", 0x201100A4,
     0xF6},
    {0x31, "00", "00 01 0000 3200 0000 40420F00 80841E00 00000000 A0860100 00000000 77000000", 0x40050003, 2000000},
    {0x39, "", "F3AC62AD 1E030000", 0x1041000D, 1},
    {0x3E, "",
     "00 2A 2A 06  00 08 10 00 01000101  01 03 03 00 01000101  02 08 0C 00 01000101"
     "03 02 05 00 01000101  05 03 04 00 01000501  06 08 0C 00 00000101",
     0x10310025, 0},
};

TEST(LegacyViews, WhatAMessageSetsCanBeReadByKey) {
    for (const Pairing& one : pairings) {
        LegacyBench m9(legacy_m9());
        const Verdict verdict = m9.set(cfg(one.id), hex(one.payload));
        if (one.key == 0) {
            EXPECT_EQ(verdict, Verdict::refuse) << one.payload;
            continue;
        }
        EXPECT_EQ(verdict, Verdict::acknowledge) << one.payload;
        EXPECT_EQ(valget(m9, one.key), one.value) << int{one.id} << " " << one.payload;
    }
}

TEST(LegacyViews, WhatAKeySetsCanBePolled) {
    for (const Pairing& one : pairings) {
        if (one.key == 0) continue;
        LegacyBench m9(legacy_m9());
        EXPECT_NE(m9.poll(cfg(one.id), hex(one.selector)), hex(one.payload)) << one.payload;
        EXPECT_EQ(valset_one(m9, one.key, one.value), Verdict::acknowledge) << std::hex << one.key;
        EXPECT_EQ(m9.poll(cfg(one.id), hex(one.selector)), hex(one.payload)) << int{one.id} << " " << one.payload;
    }
}

// Whatever keys are set, each legacy message tells the whole of its part: what one receiver answers, written to
// another, makes their public items equal.
TEST(LegacyViews, PollsCarryEveryItemToAnotherReceiver) {
    std::mt19937_64 random(20261121);
    const BoardProfile board = legacy_f9p();
    // The groups that one message tells as a whole; CFG-ODO, -RATE, -SBAS, -ITFM, protocols, -INFMSG.
    const std::set<std::uint32_t> groups{0x21, 0x22, 0x36, 0x41, 0x71, 0x72, 0x73, 0x74,
                                         0x75, 0x76, 0x77, 0x78, 0x79, 0x7A, 0x92};
    for (int round = 0; round < 8; ++round) {
        LegacyBench one(board), other(board);
        for (const auto& [key, factory] : one.store.values(ConfigLayer::factory))
            if (groups.contains(key >> 16 & 0xFF) && key != 0x50360006)  // the mask has bits that no satellite has
                static_cast<void>(valset_one(one, key, random() % (key >> 28 == 1 ? 2 : 16)));
        ASSERT_NE(one.store.values(ConfigLayer::ram), other.store.values(ConfigLayer::ram));
        for (const int id : {0x08, 0x16, 0x1E, 0x39})
            EXPECT_EQ(other.set(cfg(id), one.poll(cfg(id))), Verdict::acknowledge) << id;
        for (std::uint8_t port = 0; port < ublox_port_count; ++port)
            EXPECT_EQ(other.set(cfg(0x00), one.poll(cfg(0x00), {port})), Verdict::acknowledge) << int{port};
        for (std::uint8_t protocol = 0; protocol < 2; ++protocol)
            EXPECT_EQ(other.set(cfg(0x02), one.poll(cfg(0x02), {protocol})), Verdict::acknowledge);
        for (const auto& [key, value] : one.store.values(ConfigLayer::ram))
            if (groups.contains(key >> 16 & 0xFF)) {
                EXPECT_EQ(other.store.value(key), value) << std::hex << key;
            }
    }
}

// A poll answer can be written back, and changes nothing; that of CFG-DAT alone has a name and number besides.
TEST(LegacyViews, AnswersCanBeWrittenBack) {
    for (const BoardProfile& board : {legacy_m8(), legacy_m9(), legacy_f9p()}) {
        LegacyBench bench(board);
        for (const auto& [message, answer] : board.legacy) {
            if (message == cfg(0x01) || message == cfg(0x09)) continue;  // need a selector; cannot be polled
            if (message == cfg(0x06)) continue;
            const Bytes selector = message == cfg(0x02) ? Bytes{1} : Bytes{};
            const Bytes told = bench.poll(message, selector);
            ASSERT_FALSE(told.empty()) << int{message.id};
            EXPECT_EQ(bench.set(message, told), Verdict::acknowledge) << int{message.id};
            EXPECT_EQ(bench.poll(message, selector), told) << int{message.id};
        }
        ConfigValues expected = factory_config(board), found = bench.store.values(ConfigLayer::ram);
        std::erase_if(expected, [](const auto& item) { return !is_of_ublox(item.first); });
        std::erase_if(found, [](const auto& item) { return !is_of_ublox(item.first); });
        EXPECT_EQ(found, expected);
    }
}

}  // namespace
}  // namespace skyloop::firmware
