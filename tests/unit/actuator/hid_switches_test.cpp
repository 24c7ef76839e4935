// The reports of relay boards and of the MCP2221A, byte by byte.
#include "wire/actuator/hid_switches.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skyloop {
namespace {

using Kind = RelayBoard::Kind;
using testing::ElementsAre;

TEST(RelayBoards, AreKnownByTheirProduct) {
    for (const auto& [product, relays] : {std::pair{"USBRelay1", 1}, {"USBRelay2", 2}, {"USBRelay8", 8}}) {
        const auto board = relay_board(product);
        ASSERT_TRUE(board) << product;
        EXPECT_EQ(board->kind, Kind::dcttech);
        EXPECT_EQ(board->relays, relays);
    }
    ASSERT_TRUE(relay_board("HIDRelay"));
    EXPECT_EQ(relay_board("HIDRelay")->kind, Kind::ucreate);
    // The pair 16c0:05df is anybody's.
    for (const char* product :
         {"", "USBRelay", "USBRelay0", "USBRelay9", "USBRelay12", "USBasp", "Joystick", "usbrelay2"})
        EXPECT_FALSE(relay_board(product)) << product;
}

TEST(RelayReports, DrawAndDrop) {
    EXPECT_THAT(relay_report(Kind::dcttech, 2, true), ElementsAre(0, 0xFF, 2, 0, 0, 0, 0, 0, 0));
    EXPECT_THAT(relay_report(Kind::dcttech, 8, false), ElementsAre(0, 0xFD, 8, 0, 0, 0, 0, 0, 0));
    EXPECT_THAT(relay_report(Kind::ucreate, 1, true), ElementsAre(0, 0xF1, 0, 0, 0, 0, 0, 0, 0));
    EXPECT_THAT(relay_report(Kind::ucreate, 4, false), ElementsAre(0, 0x04, 0, 0, 0, 0, 0, 0, 0));
}

TEST(RelayReports, BothAnswersTellTheSame) {
    const Bytes with_id{0, 'H', 'U', 'R', 'T', 'M', 0, 0, 0x82};
    const Bytes without{'H', 'U', 'R', 'T', 'M', 0, 0, 0x82};
    for (const Bytes& answer : {with_id, without}) {
        const auto states = relay_states(answer);
        ASSERT_TRUE(states);
        EXPECT_EQ(states->serial, "HURTM");
        EXPECT_EQ(states->drawn, 0x82);
    }
    EXPECT_EQ(relay_states(Bytes{'A', 'B', 0, 0, 0, 0, 0, 1})->serial, "AB");
    for (const std::size_t size : {0U, 1U, 7U, 10U, 64U})
        EXPECT_FALSE(relay_states(Bytes(size)));
}

TEST(Mcp2221, SetsOnePin) {
    const Bytes report = mcp2221::set_pin(2, true);
    ASSERT_EQ(report.size(), 65U);
    Bytes expected(65);
    expected[1] = 0x50;
    expected[11] = 1, expected[12] = 1, expected[13] = 1, expected[14] = 0;  // the third group of four
    EXPECT_EQ(report, expected);
    EXPECT_EQ(mcp2221::set_pin(0, false)[4], 0);
    EXPECT_EQ(mcp2221::set_pin(0, false)[3], 1);
    EXPECT_EQ(mcp2221::get_pins()[1], 0x51);
}

TEST(Mcp2221, GivesAPinToItsGpioAndKeepsTheOthers) {
    Bytes settings(64);
    settings[0] = 0x61;
    settings[22] = 0x02, settings[23] = 0x01, settings[24] = 0x0B, settings[25] = 0x11;
    Bytes pins(64);
    pins[0] = 0x51;
    for (std::size_t i = 2; i < 10; i += 2)
        pins[i] = 0xEE, pins[i + 1] = 0xEF;
    Bytes expected(65);
    expected[1] = 0x60;
    expected[4] = expected[6] = 0x80;
    expected[8] = 0x80;
    expected[9] = 0x02, expected[10] = 0x10, expected[11] = 0x0B, expected[12] = 0x11;
    EXPECT_EQ(mcp2221::give_to_gpio(settings, pins, 1, true), expected);
    expected[10] = 0;
    EXPECT_EQ(mcp2221::give_to_gpio(settings, pins, 1, false), expected);
}

TEST(Mcp2221, LeavesLevelsAndReferencesThatTheSettingsDoNotTell) {
    Bytes settings(64), pins(64);
    settings[0] = 0x61, pins[0] = 0x51;
    settings[6] = 0xA0 | 0x1F;                            // the DAC: 2.048 V of its own; 31 at power-up
    settings[7] = 0x60 | 0x1C;                            // the ADC: 4.096 V of its own; edges
    settings[22] = 0x00, pins[2] = 1, pins[3] = 0;        // set high since
    settings[23] = 0x10, pins[4] = 0, pins[5] = 0;        // set low since
    settings[24] = 0x10, pins[6] = 1, pins[7] = 1;        // made an input since
    settings[25] = 0x03, pins[8] = 0xEE, pins[9] = 0xEF;  // the one that is wanted
    const Bytes report = mcp2221::give_to_gpio(settings, pins, 3, true);
    EXPECT_EQ(Bytes(report.begin() + 9, report.begin() + 13), (Bytes{0x10, 0x00, 0x18, 0x10}));
    EXPECT_EQ(report[4], 0x85);
    EXPECT_EQ(report[6], 0x87);
    EXPECT_EQ(report[3], 0) << "the clock stays as it is";
    EXPECT_EQ(report[5], 0) << "and the value of the DAC";
}

TEST(Mcp2221, TellsLevelsOfOutputs) {
    Bytes answer(64);
    answer[0] = 0x51;
    answer[2] = 1, answer[3] = 0;        // high output
    answer[4] = 0, answer[5] = 0;        // low output
    answer[6] = 1, answer[7] = 1;        // an input
    answer[8] = 0xEE, answer[9] = 0xEF;  // something else
    EXPECT_EQ(mcp2221::output_level(answer, 0), true);
    EXPECT_EQ(mcp2221::output_level(answer, 1), false);
    EXPECT_EQ(mcp2221::output_level(answer, 2), std::nullopt);
    EXPECT_EQ(mcp2221::output_level(answer, 3), std::nullopt);
    answer[1] = 1;  // not carried out
    EXPECT_FALSE(mcp2221::is_answer(answer, 0x51));
    EXPECT_EQ(mcp2221::output_level(answer, 0), std::nullopt);
    EXPECT_FALSE(mcp2221::is_answer(Bytes{0x51, 0}, 0x51));
}

}  // namespace
}  // namespace skyloop
