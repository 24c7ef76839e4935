#include <gtest/gtest.h>

#include "legacy_bench.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::string_view uart1_115200 = "01 00 0000 D0080000 00C20100 0100 0100 0000 0000";

TEST(LegacyPorts, SpeedFormatAndProtocolsAreItemsOfTheStore) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x00), hex(uart1_115200)), Verdict::acknowledge);
    EXPECT_EQ(m8.store.value(key::uart1_baudrate), 115200u);
    EXPECT_TRUE(m8.store.flag(key::in_protocol(PortId::uart1, 1)));
    EXPECT_FALSE(m8.store.flag(key::in_protocol(PortId::uart1, 2)));
    EXPECT_FALSE(m8.store.flag(key::out_protocol(PortId::uart1, 2)));
    EXPECT_EQ(m8.poll(cfg(0x00)), hex(uart1_115200));
    // 7 bits, odd parity, two stop bits.
    EXPECT_EQ(m8.set(cfg(0x00), hex("01 00 0000 80220000 80250000 0300 0300 0000 0000")), Verdict::acknowledge);
    EXPECT_EQ(m8.store.value(0x20520003), 1u);
    EXPECT_EQ(m8.store.value(0x20520004), 1u);
    EXPECT_EQ(m8.store.value(0x20520002), 3u);
    EXPECT_EQ(m8.poll(cfg(0x00)), hex("01 00 0000 80220000 80250000 0300 0300 0000 0000"));
}

TEST(LegacyPorts, SeveralInOneMessageGetOneAnswer) {
    LegacyBench m9(legacy_m9());
    const std::string two =
        "01 00 0000 D0080000 00960000 2100 0100 0000 0000"
        "03 00 0000 00000000 00000000 2100 0100 0000 0000";
    const ConfigOutcome outcome = m9.send(cfg(0x00), hex(two));
    EXPECT_EQ(outcome.verdict, Verdict::acknowledge);
    EXPECT_TRUE(outcome.answers.empty());
    EXPECT_FALSE(m9.store.flag(key::out_protocol(PortId::uart1, 2)));
    EXPECT_FALSE(m9.store.flag(key::out_protocol(PortId::usb, 2)));
    EXPECT_TRUE(m9.store.flag(key::in_protocol(PortId::usb, 4)));
}

TEST(LegacyPorts, WhatCannotBeIsRefusedAndChangesNothing) {
    LegacyBench m8(legacy_m8());
    const ConfigValues before = m8.store.values(ConfigLayer::ram);
    const std::string good(uart1_115200);
    for (const std::string_view bad : {
             "01 00 0000 D0080000 01C20100 0100 0100 0000 0000",  // 115201 Bd
             "01 00 0000 D0080000 00000000 0100 0100 0000 0000",  // 0 Bd
             "01 00 0000 10080000 00C20100 0100 0100 0000 0000",  // 5 bits
             "01 00 0000 D0040000 00C20100 0100 0100 0000 0000",  // no such parity
             "05 00 0000 D0080000 00C20100 0100 0100 0000 0000",  // no such port
         })
        EXPECT_EQ(m8.set(cfg(0x00), hex(good + std::string(bad))), Verdict::refuse) << bad;
    for (std::size_t size = 2; size < 60; ++size) {
        Bytes bytes = hex(good + good + good);
        bytes.resize(size);
        if (size % 20 != 0) {
            EXPECT_EQ(m8.set(cfg(0x00), bytes), Verdict::refuse) << size;
        }
    }
    EXPECT_EQ(m8.store.values(ConfigLayer::ram), before);
    EXPECT_EQ(m8.send(cfg(0x00), {5}).verdict, Verdict::refuse);
    BoardProfile narrow = legacy_m8();
    narrow.ports = {PortId::uart1};
    EXPECT_EQ(LegacyBench(narrow).send(cfg(0x00), {3}).verdict, Verdict::refuse);
    EXPECT_EQ(LegacyBench(narrow).set(cfg(0x00), hex("03 00 0000 00000000 00000000 0100 0100 0000 0000")),
              Verdict::refuse);
}

TEST(LegacyPorts, PortsWithoutSpeedIgnoreIt) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x00), hex("03 00 0000 D0080000 01000000 0300 0100 0000 0000")), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x00), {3}), hex("03 00 0000 00000000 00000000 0300 0100 0000 0000"));
    EXPECT_EQ(m8.set(cfg(0x00), hex("00 00 0000 86000000 00000000 0300 0100 0200 0000")), Verdict::acknowledge);
    EXPECT_EQ(m8.store.value(0x20510001), 0x86u);
    EXPECT_EQ(m8.poll(cfg(0x00), {0}), hex("00 00 0000 86000000 00000000 0300 0100 0200 0000"));
    EXPECT_EQ(m8.set(cfg(0x00), hex("04 00 3F00 06320000 00000000 0300 0100 0000 0000")), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x00), {4}), hex("04 00 3F00 06320000 00000000 0300 0100 0000 0000"));
}

TEST(LegacyPorts, ProtocolsThatTheBoardLacksStayOff) {
    LegacyBench m8(legacy_m8());  // gpsd's set: RTCM3 in and out, which M8 does not have
    EXPECT_EQ(m8.set(cfg(0x00), hex("01 00 0000 C0080000 80250000 2700 2300 0000 0000")), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x00)), hex("01 00 0000 C0080000 80250000 0700 0300 0000 0000"));
    LegacyBench m9(legacy_m9());  // no RTCM2 from generation 9 on
    EXPECT_EQ(m9.set(cfg(0x00), hex("01 00 0000 C0080000 00960000 2700 2300 0000 0000")), Verdict::acknowledge);
    EXPECT_EQ(m9.poll(cfg(0x00)), hex("01 00 0000 C0080000 00960000 2300 0300 0000 0000"));
}

TEST(LegacyMessages, RatesInThreeForms) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x01), hex("01 07 01")), Verdict::acknowledge);
    EXPECT_EQ(m8.store.rate(nav(0x07), PortId::uart1), 1);
    EXPECT_EQ(m8.store.rate(nav(0x07), PortId::usb), 0);
    EXPECT_EQ(m8.set(cfg(0x01), hex("01 07 05"), PortId::usb), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x01), hex("01 07")), hex("01 07 00 01 00 05 00 00"));
    EXPECT_EQ(m8.set(cfg(0x01), hex("01 07 01 02 03 04 FF 09")), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x01), hex("01 07")), hex("01 07 01 02 03 04 FF 00"));
    EXPECT_EQ(m8.set(cfg(0x01), hex("F0 02 00")), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x01), hex("F0 02")), hex("F0 02 01 00 01 01 01 00"));
}

TEST(LegacyMessages, UnknownOnesAreRefused) {
    LegacyBench m9(legacy_m9());
    const std::uint64_t before = m9.store.revision();
    EXPECT_EQ(m9.set(cfg(0x01), hex("01 06 01")), Verdict::refuse);  // NAV-SOL: how ArduPilot tells generations apart
    EXPECT_EQ(m9.set(cfg(0x01), hex("01 06 01 01 01 01 01 01")), Verdict::refuse);
    EXPECT_EQ(m9.send(cfg(0x01), hex("01 06")).verdict, Verdict::refuse);
    for (const std::size_t size : {0u, 1u, 4u, 5u, 6u, 7u, 9u})
        EXPECT_EQ(m9.send(cfg(0x01), Bytes(size, 1)).verdict, Verdict::refuse) << size;
    EXPECT_EQ(m9.store.revision(), before);
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x01), hex("01 06 01")), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x01), hex("01 06")), hex("01 06 00 01 00 00 00 00"));
}

TEST(LegacyMessages, PolledOnesAreTakenButNotSent) {
    LegacyBench m9(legacy_m9());
    EXPECT_EQ(m9.set(cfg(0x01), hex("0A 04 01")), Verdict::acknowledge);
    EXPECT_EQ(m9.poll(cfg(0x01), hex("0A 04")), hex("0A 04 00 00 00 00 00 00"));
}

TEST(LegacyTexts, MasksPerProtocolAndPort) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x02), hex("00 000000 01 02 03 04 05 00   01 000000 00 1F 00 00 00 00")),
              Verdict::acknowledge);
    EXPECT_EQ(m8.store.value(key::inf_ubx(PortId::usb)), 4u);
    EXPECT_EQ(m8.store.value(key::inf_nmea(PortId::uart1)), 0x1Fu);
    EXPECT_EQ(m8.poll(cfg(0x02), {0}), hex("00 000000 01 02 03 04 05 00"));
    EXPECT_EQ(m8.send(cfg(0x02), {2}).verdict, Verdict::refuse);
    EXPECT_EQ(m8.send(cfg(0x02), {}).verdict, Verdict::refuse);
    EXPECT_EQ(m8.set(cfg(0x02), hex("00 000000 00 00 00 00 00 00   07 000000 00 00 00 00 00 00")), Verdict::refuse);
    EXPECT_EQ(m8.store.value(key::inf_ubx(PortId::usb)), 4u);
}

// Blocks of the configuration files that u-center wrote of a NEO-6 and of a ZED-F9P.
TEST(LegacyTexts, HaveEmptyMasksOfOtherProtocols) {
    LegacyBench f9p(legacy_f9p());
    const std::uint64_t before = f9p.store.revision();
    for (const std::uint8_t protocol : Bytes{3, 12, 13, 14, 15}) {
        Bytes block(10);
        block[0] = protocol;
        EXPECT_EQ(f9p.poll(cfg(0x02), {protocol}), block);
        EXPECT_EQ(f9p.set(cfg(0x02), block), Verdict::acknowledge) << int{protocol};
    }
    EXPECT_EQ(f9p.store.revision(), before);
    for (const std::uint8_t protocol : Bytes{2, 4, 11, 16})
        EXPECT_EQ(f9p.send(cfg(0x02), {protocol}).verdict, Verdict::refuse) << int{protocol};
    EXPECT_EQ(LegacyBench(legacy_m8()).send(cfg(0x02), {3}).verdict, Verdict::refuse);
    BoardProfile old = legacy_m8();
    old.identity.generation = 6;
    EXPECT_EQ(LegacyBench(old).send(cfg(0x02), {3}).verdict, Verdict::acknowledge);
}

TEST(LegacyUsb, KeepsItsTexts) {
    LegacyBench m9(legacy_m9());
    Bytes usb = m9.poll(cfg(0x1B));
    ASSERT_EQ(usb.size(), 108u);
    for (std::size_t i = 76; i < 108; ++i)
        usb[i] = static_cast<std::uint8_t>('A' + (i - 76) % 26);
    usb[10] = 0;
    EXPECT_EQ(m9.set(cfg(0x1B), usb), Verdict::acknowledge);
    EXPECT_EQ(m9.poll(cfg(0x1B)), usb);
    EXPECT_FALSE(m9.store.flag(0x10650002));
    EXPECT_EQ(m9.send(cfg(0x1B), Bytes(107)).verdict, Verdict::refuse);
}

// What the board says of each message (RECEIVER.md 2.5).
TEST(LegacyConfig, DoesWhatTheBoardSays) {
    BoardProfile board = legacy_m9();
    board.legacy[cfg(0x3E)] = LegacyAnswer::refuse;
    board.legacy[cfg(0x16)] = LegacyAnswer::silence;
    board.legacy[cfg(0x08)] = LegacyAnswer::ignore;
    board.legacy.erase(cfg(0x24));
    LegacyBench bench(board);
    EXPECT_EQ(bench.send(cfg(0x3E), {}).verdict, Verdict::refuse);
    EXPECT_EQ(bench.send(cfg(0x16), {}).verdict, Verdict::silence);
    const std::uint64_t before = bench.store.revision();
    EXPECT_EQ(bench.set(cfg(0x08), hex("C800 0100 0100")), Verdict::acknowledge);
    EXPECT_EQ(bench.store.revision(), before);
    EXPECT_EQ(bench.send(cfg(0x24), {}).verdict, Verdict::refuse);
    EXPECT_EQ(bench.send(cfg(0x7F), {}).verdict, Verdict::refuse);
    board.legacy[cfg(0x7F)] = LegacyAnswer::apply;  // a message that nobody has written
    EXPECT_EQ(LegacyBench(board).send(cfg(0x7F), {}).verdict, Verdict::refuse);
}

TEST(LegacyConfig, AnyLengthIsAnsweredAndOnlyGoodOnesAreTaken) {
    for (const BoardProfile& board : {legacy_m8(), legacy_m9(), legacy_f9p()}) {
        LegacyBench bench(board);
        for (const auto& [message, answer] : board.legacy)
            for (std::size_t size = 0; size < 110; ++size) {
                const std::uint64_t before = bench.store.revision();
                const Verdict verdict = bench.send(message, Bytes(size, 0xFF)).verdict;
                EXPECT_NE(verdict, Verdict::silence);
                if (verdict == Verdict::refuse) {
                    EXPECT_EQ(bench.store.revision(), before) << int{message.id} << " " << size;
                } else if (bench.store.revision() != before) {
                    EXPECT_TRUE(is_consistent(board, bench.store.values(ConfigLayer::ram))) << int{message.id};
                }
            }
    }
}

}  // namespace
}  // namespace skyloop::firmware
