// What the shipped boards answer to polls of their factory configuration, byte by byte (RECEIVER.md 2.4, 2.5).
#include <gtest/gtest.h>

#include <filesystem>

#include "firmware/ublox/config/config_handler.hpp"
#include "run/scenario/board_files.hpp"

namespace skyloop {
namespace {

using firmware::ConfigOutcome;
using firmware::Verdict;

/// A receiver as it leaves the factory, asked once; empty when it refused.
Bytes factory_answer(std::string_view name, std::uint8_t id, const Bytes& selector = {}) {
    const std::vector<std::filesystem::path> folders{std::filesystem::path(SKYLOOP_SOURCE_DIR) / "boards"};
    const auto board = find_board(name, folders);
    if (!board) return {};
    firmware::ConfigStore store(firmware::factory_config(*board));
    firmware::LegacyConfig config(*board, store);
    const ConfigOutcome outcome = config.handle({0x06, id}, selector, firmware::PortId::uart1);
    if (outcome.verdict != Verdict::acknowledge || outcome.answers.size() != 1) return {};
    const auto frame = parse_frame(outcome.answers.front());
    return frame ? Bytes(frame->payload.begin(), frame->payload.end()) : Bytes{};
}

/// What a receiver from the factory says to a setting.
Verdict verdict_on(std::string_view name, std::uint8_t id, const Bytes& payload) {
    const std::vector<std::filesystem::path> folders{std::filesystem::path(SKYLOOP_SOURCE_DIR) / "boards"};
    const auto board = find_board(name, folders);
    if (!board) return Verdict::silence;
    firmware::ConfigStore store(firmware::factory_config(*board));
    return firmware::LegacyConfig(*board, store).handle({0x06, id}, payload, firmware::PortId::usb).verdict;
}

TEST(BoardLegacyAnswers, OfM8) {
    EXPECT_EQ(factory_answer("ublox-m8", 0x3E),
              (Bytes{0,  32, 32, 7, 0, 8, 16, 0, 1, 0, 1, 1, 1, 1, 3, 0, 1, 0, 1, 1, 2, 4, 8, 0, 0,  0, 1, 1, 3, 8,
                     16, 0,  0,  0, 1, 1, 4,  0, 8, 0, 0, 0, 1, 3, 5, 0, 3, 0, 1, 0, 1, 5, 6, 8, 14, 0, 1, 0, 1, 1}));
    EXPECT_EQ(factory_answer("ublox-m8", 0x24),
              (Bytes{0xFF, 0xFF, 0,    3, 0, 0,    0, 0, 0x10, 0x27, 0, 0, 5, 0, 0xFA, 0, 0xFA, 0,
                     0x64, 0,    0x5E, 1, 0, 0x3C, 0, 0, 0,    0,    0, 0, 0, 0, 0,    0, 0,    0}));
    Bytes expert{2, 0, 0x4C, 0x66, 0xC0, 0, 0, 0, 0, 0, 3, 0x20, 6, 0, 0, 0, 0, 0, 0x4B, 7};
    expert.resize(40);
    expert[30] = 0x64;
    EXPECT_EQ(factory_answer("ublox-m8", 0x23), expert);
    EXPECT_EQ(factory_answer("ublox-m8", 0x31, {1}),
              (Bytes{1,    1,    0, 0, 0x32, 0,    0, 0, 4, 0, 0, 0, 1,    0, 0, 0,
                     0x48, 0xE8, 1, 0, 0xA0, 0x86, 1, 0, 0, 0, 0, 0, 0x7E, 0, 0, 0}));
    EXPECT_EQ(factory_answer("ublox-m8", 0x00),
              (Bytes{1, 0, 0, 0, 0xC0, 8, 0, 0, 0x80, 0x25, 0, 0, 7, 0, 3, 0, 0, 0, 0, 0}));
    EXPECT_EQ(factory_answer("ublox-m8", 0x39), (Bytes{0xF3, 0xAC, 0x62, 0x2D, 0x1E, 3, 0, 0}));
}

TEST(BoardLegacyAnswers, OfM9AndF9p) {
    EXPECT_EQ(factory_answer("ublox-m9", 0x3E),
              (Bytes{0, 42, 42, 6, 0, 8, 16, 0, 1, 0, 1, 1, 1, 3, 3, 0, 1, 0, 1, 1, 2,  8, 12, 0, 1, 0,
                     1, 1,  3,  2, 5, 0, 1,  0, 1, 1, 5, 3, 4, 0, 1, 0, 5, 1, 6, 8, 12, 0, 1,  0, 1, 1}));
    EXPECT_EQ(factory_answer("ublox-m9", 0x16), (Bytes{1, 3, 3, 0, 0x88, 0x2B, 7, 0}));
    EXPECT_EQ(factory_answer("ublox-f9p", 0x3E),
              (Bytes{0,  0, 60, 6, 0, 8, 16, 0, 1,  0, 17, 1, 1, 3, 3, 0, 1,  0, 1, 1, 2,  10, 18, 0, 1,  0,
                     33, 1, 3,  2, 5, 0, 1,  0, 17, 1, 5,  0, 4, 0, 1, 0, 17, 1, 6, 8, 12, 0,  1,  0, 17, 1}));
    Bytes expert{2, 0, 0x4C, 0x66, 0xC0, 0, 0, 0, 0, 0, 3, 0x20, 6, 0, 0, 0, 0, 0, 0xA0, 8};
    expert.resize(40);
    EXPECT_EQ(factory_answer("ublox-f9p", 0x23), expert);
}

TEST(BoardLegacyAnswers, OfM10) {
    EXPECT_EQ(factory_answer("ublox-m10", 0x00),
              (Bytes{1, 0, 0, 0, 0xC0, 8, 0, 0, 0, 0x96, 0, 0, 3, 0, 3, 0, 0, 0, 0, 0}));
    EXPECT_TRUE(factory_answer("ublox-m10", 0x3E).empty());
    EXPECT_TRUE(factory_answer("ublox-m10", 0x16).empty());
    EXPECT_EQ(factory_answer("ublox-m10", 0x31).size(), 32U);
}

// ArduPilot's 3DR-Ublox.txt; RECEIVER.md 2.4.
TEST(BoardLegacyAnswers, OfM8AndUblox6HaveTheirSecondUartOff) {
    const Bytes off{2, 0, 0, 0, 0xC0, 8, 0, 0, 0x80, 0x25, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(factory_answer("ublox-m8", 0x00, {2}), off);
    EXPECT_EQ(factory_answer("ublox-6", 0x00, {2}), off);
    Bytes on{2, 0, 0, 0, 0xC0, 8, 0, 0, 0, 0x96, 0, 0, 0x23, 0, 3, 0, 0, 0, 0, 0};
    EXPECT_EQ(factory_answer("ublox-m9", 0x00, {2}), on);
}

TEST(BoardLegacyAnswers, OfUblox6HaveTheShortFormOfCfgNmea) {
    EXPECT_EQ(factory_answer("ublox-6", 0x17), (Bytes{0, 0x23, 0, 2}));
}

// Configuration files that u-center wrote: of two NEO-6 with 7.03 (ArduPilot's 3DR-Ublox.txt is one), of a NEO-M8T with
// TIM 1.10 and of a ZED-F9P with HPG 1.11 (rtkbase, receiver_cfg).
TEST(BoardLegacyAnswers, AreThoseInConfigurationFilesOfUCenter) {
    EXPECT_EQ(factory_answer("ublox-6", 0x13), (Bytes{0x1B, 0, 0x8B, 0xA9}));
    EXPECT_EQ(factory_answer("ublox-6", 0x16), (Bytes{1, 3, 3, 0, 0x51, 0x62, 6, 0}));
    EXPECT_EQ(factory_answer("ublox-6", 0x02, {1}), (Bytes{1, 0, 0, 0, 0x87, 0x87, 0x87, 0x87, 0x87, 0}));
    EXPECT_EQ(factory_answer("ublox-6", 0x31, {1}),
              (Bytes{1,    0,    0, 0, 0x32, 0,    0, 0, 4, 0, 0, 0, 1,    0, 0, 0,
                     0x48, 0xE8, 1, 0, 0xA0, 0x86, 1, 0, 0, 0, 0, 0, 0xFE, 0, 0, 0}));
    EXPECT_EQ(factory_answer("ublox-m8", 0x13), (Bytes{0x1B, 0, 0xF0, 0xB9}));
    const Bytes odometer{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 10, 50, 0, 0, 153, 76, 0, 0};
    EXPECT_EQ(factory_answer("ublox-m8", 0x1E), odometer);
    EXPECT_EQ(factory_answer("ublox-f9p", 0x1E), odometer);
    EXPECT_EQ(factory_answer("ublox-f9p", 0x34).size(), 23U);
}

TEST(BoardLegacyAnswers, AcceptConfigurationFilesOfUCenter) {
    constexpr std::uint8_t cfg_msg = 0x01, cfg_inf = 0x02, cfg_dat = 0x06, cfg_tp = 0x07, cfg_fxn = 0x0E, cfg_pm = 0x32,
                           cfg_rinv = 0x34, cfg_pm2 = 0x3B;
    const Bytes label{0, 'N', 'o', 't', 'i', 'c', 'e'};
    for (const char* board : {"ublox-6", "ublox-m8", "ublox-m9", "ublox-f9p"}) {
        EXPECT_EQ(verdict_on(board, cfg_dat, {0, 0}), Verdict::acknowledge) << board;
        EXPECT_EQ(verdict_on(board, cfg_rinv, label), Verdict::acknowledge) << board;
    }
    EXPECT_EQ(verdict_on("ublox-f9p", cfg_inf, {15, 0, 0, 0, 0, 0, 0, 0, 0, 0}), Verdict::acknowledge);
    EXPECT_EQ(verdict_on("ublox-6", cfg_inf, {3, 0, 0, 0, 0, 0, 0, 0, 0, 0}), Verdict::acknowledge);
    EXPECT_EQ(verdict_on("ublox-6", cfg_fxn, Bytes(36)), Verdict::acknowledge);
    EXPECT_EQ(verdict_on("ublox-6", cfg_pm, Bytes(24)), Verdict::acknowledge);
    EXPECT_EQ(verdict_on("ublox-6", cfg_pm2, Bytes(44)), Verdict::acknowledge);
    EXPECT_EQ(verdict_on("ublox-6", cfg_tp, Bytes(20)), Verdict::acknowledge);
    EXPECT_EQ(verdict_on("ublox-6", cfg_msg, {0x0B, 0x32, 0, 0, 0, 0, 0, 0}), Verdict::acknowledge);
    EXPECT_EQ(verdict_on("ublox-6", cfg_msg, {0x0A, 0x21, 0, 0, 0, 0, 0, 0}), Verdict::acknowledge);
}

}  // namespace
}  // namespace skyloop
