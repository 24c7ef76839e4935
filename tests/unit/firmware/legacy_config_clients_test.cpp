// The legacy messages of known clients, in their order (RECEIVER.md 6 and 11).
#include <gtest/gtest.h>

#include "legacy_bench.hpp"
#include "receiver/protocol/ubx_cfg.hpp"

namespace skyloop::firmware {
namespace {

constexpr auto ack = Verdict::acknowledge, nak = Verdict::refuse;

std::string prt_of_px4(std::string_view baud) {
    std::string both;
    for (const std::string_view port : {"01", "03"})
        both += std::string(port) + "00 0000 D0080000" + std::string(baud) + "2100 0100 0000 0000";
    return both;
}

// RECEIVER.md 6.1, steps 3 to 11.
TEST(LegacyClients, Px4OnM8) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x09), hex("FFFFFFFF 00000000 FFFFFFFF")), ack);
    EXPECT_EQ(m8.set(cfg(0x00), hex(prt_of_px4("80250000"))), ack);
    EXPECT_EQ(m8.set(cfg(0x00), hex(prt_of_px4("00960000"))), ack);
    EXPECT_EQ(m8.store.value(key::uart1_baudrate), 38400u);
    EXPECT_EQ(m8.set(cfg(0x00), hex(prt_of_px4("00C20100"))), ack);
    EXPECT_EQ(m8.store.value(key::uart1_baudrate), 115200u);
    EXPECT_FALSE(m8.store.flag(key::out_protocol(PortId::uart1, 2)));
    EXPECT_FALSE(m8.store.flag(key::out_protocol(PortId::usb, 2)));
    EXPECT_EQ(m8.set(cfg(0x08), hex("C800 0100 0000")), ack);
    Bytes nav5 = hex("0500 07 02");
    nav5.resize(36);
    EXPECT_EQ(m8.set(cfg(0x24), nav5), ack);
    EXPECT_EQ(m8.store.value(key::navspg_dynmodel), 7u);
    EXPECT_EQ(m8.store.value(key::navspg_fixmode), 2u);
    EXPECT_EQ(m8.store.value(key::navspg_pacc), 100u);
    EXPECT_EQ(m8.set(cfg(0x3E), hex("00 00 20 07  00 08 10 00 01000100  01 01 03 00 01000100  02 04 08 00 01000100"
                                    "03 08 10 00 00000100  04 00 08 00 00000100  05 00 03 00 01000100"
                                    "06 08 0E 00 01000100")),
              ack);
    for (const std::string_view message : {"01 07 01", "01 03 01", "01 04 01", "01 30 05", "01 30 00", "0A 09 01"})
        EXPECT_EQ(m8.set(cfg(0x01), hex(message)), ack) << message;
    EXPECT_EQ(m8.store.rate(nav(0x07), PortId::uart1), 1);
    EXPECT_EQ(m8.store.rate({0x0A, 0x09}, PortId::uart1), 1);
}

// 6.2: every poll is answered, rates are set by three bytes and read back, all of it is saved.
TEST(LegacyClients, ArdupilotOnM9) {
    LegacyBench m9(legacy_m9());
    EXPECT_EQ(m9.set(cfg(0x01), hex("01 06 01")), nak);
    for (const int id : {0x00, 0x08, 0x16, 0x24, 0x3E, 0x31})
        EXPECT_FALSE(m9.poll(cfg(id)).empty()) << id;
    EXPECT_EQ(m9.poll(cfg(0x00)).size(), 20u);
    EXPECT_EQ(m9.poll(cfg(0x00))[0], 1);
    for (const std::string_view known : {"01 07", "01 03", "01 02", "01 12", "01 20", "01 04", "0A 09"}) {
        EXPECT_EQ(m9.poll(cfg(0x01), hex(known)).size(), 8u) << known;
        EXPECT_EQ(m9.set(cfg(0x01), hex(std::string(known) + "05")), ack) << known;
        EXPECT_EQ(m9.poll(cfg(0x01), hex(known)), hex(std::string(known) + "00 05 00 00 00 00")) << known;
    }
    for (const std::string_view unknown : {"01 06", "01 30", "02 10", "02 15"})
        EXPECT_EQ(m9.send(cfg(0x01), hex(unknown)).verdict, nak) << unknown;
    EXPECT_EQ(m9.set(cfg(0x08), hex("C800 0100 0000")), ack);
    EXPECT_EQ(m9.poll(cfg(0x08)), hex("C800 0100 0000"));
    Bytes nav5 = m9.poll(cfg(0x24));  // as polled, with model and elevation replaced
    nav5[0] = 0x03;
    nav5[1] = 0;
    nav5[2] = 8;
    nav5[12] = 10;
    EXPECT_EQ(m9.set(cfg(0x24), nav5), ack);
    nav5[0] = nav5[1] = 0xFF;
    EXPECT_EQ(m9.poll(cfg(0x24)), nav5);
    Bytes sbas = m9.poll(cfg(0x16));
    sbas[0] = 0;
    EXPECT_EQ(m9.set(cfg(0x16), sbas), ack);
    EXPECT_EQ(m9.poll(cfg(0x16)), sbas);
    EXPECT_EQ(m9.set(cfg(0x09), hex("00000000 1F060000 00000000")), ack);
    EXPECT_EQ(m9.store.stored(ConfigLayer::battery, key::navspg_dynmodel), 8u);
    EXPECT_EQ(m9.store.stored(ConfigLayer::flash, key::rate_meas), 200u);
    m9.store.reload();
    EXPECT_EQ(m9.poll(cfg(0x24)), nav5);
}

// 6.2, step 8: GPS and GLONASS alone, channels shared out, others without any.
TEST(LegacyClients, ArdupilotSetsItsSystemsOnM8) {
    LegacyBench m8(legacy_m8());
    const Bytes wanted =
        hex("00 20 20 07  00 07 20 00 01000101  01 00 00 00 00000101  02 00 00 00 00000101"
            "03 00 00 00 00000101  04 00 00 00 00000103  05 00 00 00 00000105  06 07 20 00 01000101");
    EXPECT_EQ(m8.set(cfg(0x3E), wanted), ack);
    EXPECT_EQ(m8.poll(cfg(0x3E)), wanted);
}

// 6.3, steps 4 to 9 on M8.
TEST(LegacyClients, InavOnM8) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x24), hex("FFFF 08 03 00000000 10270000 05 00 FA00 FA00 6400 2C01 00 00 00 00 0000 0000"
                                    "00 0000000000")),
              ack);
    for (const std::string_view sentence : {"F0 00 00", "F0 01 00", "F0 02 00", "F0 03 00", "F0 04 00", "F0 05 00"})
        EXPECT_EQ(m8.set(cfg(0x01), hex(sentence)), ack) << sentence;
    for (const std::string_view message :
         {"01 02 00", "01 03 00", "01 06 00", "01 12 00", "01 21 00", "01 30 00", "01 07 01", "01 35 01"})
        EXPECT_EQ(m8.set(cfg(0x01), hex(message)), ack) << message;
    EXPECT_EQ(m8.set(cfg(0x08), hex("6400 0100 0100")), ack);
    EXPECT_EQ(m8.set(cfg(0x16), hex("01 03 03 00 51080000")), ack);
    EXPECT_EQ(m8.set(cfg(0x3E), hex("00 00 20 03  02 08 0A 00 01000100  03 00 00 00 00000100  01 01 03 00 01000100")),
              ack);
    for (std::uint8_t id = 0; id < 6; ++id)
        EXPECT_EQ(m8.store.rate({0xF0, id}, PortId::uart1), 0) << int{id};
    EXPECT_TRUE(m8.store.flag(0x10310021));
}

// 6.4, steps 5 to 13 on M8.
TEST(LegacyClients, BetaflightOnM8) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x08), hex("E803 0100 0100")), ack);
    EXPECT_EQ(m8.set(cfg(0x24), hex("FFFF 03 03 00000000 10270000 05 00 FA00 FA00 6400 2C01 00 3C 00 00 0000 C800 00"
                                    "0000000000")),
              ack);
    EXPECT_EQ(m8.set(cfg(0x23), hex("0200 0040 00000000 0000 00 00 00 00 00 0000 00 0000 00 00 0000 0000 00 01 0000"
                                    "0000 00000000 000000 00")),
              ack);
    EXPECT_TRUE(m8.store.flag(0x10230001));
    EXPECT_EQ(m8.store.value(key::navspg_min_svs), 3u);
    EXPECT_EQ(m8.set(cfg(0x16), hex("01 03 03 00 00000000")), ack);
    EXPECT_EQ(m8.set(cfg(0x86), hex("00 00 0000 0000 0000")), ack);
    for (const std::string_view message :
         {"01 07 01", "01 06 00", "01 02 00", "01 03 00", "01 12 00", "01 04 00", "01 35 05"})
        EXPECT_EQ(m8.set(cfg(0x01), hex(message)), ack) << message;
    EXPECT_EQ(m8.set(cfg(0x08), hex("6400 0100 0100")), ack);
    Bytes systems = m8.poll(cfg(0x3E));
    ASSERT_EQ(systems.size(), 60u);
    EXPECT_EQ(m8.set(cfg(0x3E), systems), ack);
    EXPECT_EQ(m8.poll(cfg(0x3E)), systems);
    systems[4 + 8 * 2 + 4] = 1;  // Galileo
    systems[4 + 8 * 1 + 4] = 0;  // SBAS
    EXPECT_EQ(m8.set(cfg(0x3E), systems), ack);
    EXPECT_EQ(m8.poll(cfg(0x3E)), systems);
}

// 6.4, step 11: Betaflight says some of it by CFG-MSG even to an M10, which refuses CFG-GNSS and CFG-SBAS (2.5).
TEST(LegacyClients, BetaflightOnM10) {
    BoardProfile board = legacy_m9();
    board.identity.generation = 10;
    board.identity.software = "ROM SPG 5.10 (7b202e)";
    board.ports = {PortId::i2c, PortId::uart1, PortId::spi};
    board.legacy = {{cfg(0x00), LegacyAnswer::apply},
                    {cfg(0x01), LegacyAnswer::apply},
                    {cfg(0x08), LegacyAnswer::apply},
                    {cfg(0x24), LegacyAnswer::apply},
                    {cfg(0x3E), LegacyAnswer::refuse}};
    LegacyBench m10(board);
    for (const std::string_view message : {"01 02 00", "01 03 00", "01 12 00", "01 04 00", "01 35 05"})
        EXPECT_EQ(m10.set(cfg(0x01), hex(message)), ack) << message;
    EXPECT_EQ(m10.set(cfg(0x01), hex("01 06 00")), nak);
    EXPECT_EQ(m10.send(cfg(0x3E), {}).verdict, nak);
    EXPECT_EQ(m10.send(cfg(0x16), {}).verdict, nak);
    Bytes nav5 = hex("0500 08 02");
    nav5.resize(36);
    EXPECT_EQ(m10.set(cfg(0x24), nav5), ack);
    EXPECT_EQ(m10.store.value(key::navspg_dynmodel), 8u);
    // All ports at once: what the board does not have stays 0.
    EXPECT_EQ(m10.set(cfg(0x01), hex("01 07 01 01 01 01 01 01")), ack);
    EXPECT_EQ(m10.poll(cfg(0x01), hex("01 07")), hex("01 07 01 01 00 00 01 00"));
}

// 6.5 and 11.
TEST(LegacyClients, GpsdOnM8) {
    LegacyBench m8(legacy_m8());
    Bytes port = m8.poll(cfg(0x00));
    ASSERT_EQ(port.size(), 20u);
    port[12] = 0x27;
    port[14] = 0x23;
    EXPECT_EQ(m8.set(cfg(0x00), port), ack);
    EXPECT_EQ(m8.store.value(key::uart1_baudrate), 9600u);
    for (const std::string_view message :
         {"01 04 01", "01 20 01", "01 30 01", "01 07 01", "01 11 01", "01 35 01", "01 61 01", "01 26 FF", "F0 00 00"})
        EXPECT_EQ(m8.set(cfg(0x01), hex(message)), ack) << message;
    EXPECT_EQ(m8.store.rate(nav(0x26), PortId::uart1), 255);
}

// 6.6: the node dies of any message that is not acknowledged.
TEST(LegacyClients, KumarOnM8) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.set(cfg(0x00), hex("01 00 0000 C0080000 00C20100 0700 0100 0000 0000")), ack);
    EXPECT_EQ(m8.set(cfg(0x08), hex("FA00 0100 0100")), ack);
    EXPECT_EQ(m8.set(cfg(0x16), hex("01 03 03 00 00000000")), ack);
    Bytes precise = hex("0200 0020");
    precise.resize(40);
    precise[26] = 1;
    EXPECT_EQ(m8.set(cfg(0x23), precise), ack);
    EXPECT_TRUE(m8.store.flag(0x10110019));
    for (const std::string_view part : {"0100 00 00", "0400 00 03", "0800 00 00"}) {  // model, mode, dead reckoning
        Bytes nav5 = hex(part);
        nav5.resize(36);
        EXPECT_EQ(m8.set(cfg(0x24), nav5), ack) << part;
    }
    EXPECT_EQ(m8.poll(cfg(0x3E)).size(), 60u);
    EXPECT_EQ(m8.set(cfg(0x02), hex("00 000000 00 07 00 07 00 00")), ack);
    EXPECT_EQ(m8.set(cfg(0x09), hex("00000000 1F1F0000 00000000 17")), ack);
}

// The frames of RECEIVER.md 1.1 that set something here.
TEST(LegacyClients, KnownFrames) {
    LegacyBench m8(legacy_m8());
    for (const std::string_view bytes :
         {"B5 62 06 00 14 00 01 00 00 00 D0 08 00 00 00 C2 01 00 01 00 01 00 00 00 00 00 B8 42",
          "B5 62 06 01 03 00 01 07 01 13 51", "B5 62 06 08 06 00 C8 00 01 00 00 00 DD 68", "B5 62 06 00 00 00 06 18",
          "B5 62 06 00 01 00 01 08 22"}) {
        const Bytes frame = hex(bytes);
        const auto read = parse_frame(frame);
        ASSERT_TRUE(read) << bytes;
        EXPECT_EQ(m8.config.handle(read->id, read->payload, PortId::uart1).verdict, ack) << bytes;
    }
    EXPECT_EQ(m8.store.value(key::uart1_baudrate), 115200u);
    EXPECT_EQ(m8.store.rate(nav(0x07), PortId::uart1), 1);
    EXPECT_EQ(m8.store.value(key::rate_meas), 200u);
    EXPECT_EQ(m8.send(cfg(0x00), {}).answers, m8.send(cfg(0x00), {1}).answers);
}

}  // namespace
}  // namespace skyloop::firmware
