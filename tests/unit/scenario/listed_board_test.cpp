#include "run/scenario/listed_board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/core/json.hpp"
#include "run/scenario/board_files.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

const std::vector<fs::path> listed_boards{fs::path(SKYLOOP_SOURCE_DIR) / "boards"};

Json listed(const char* name) { return Json::parse(board_json(name, listed_boards).value()); }

TEST(ListedBoard, HasWhatTheBoardTakesFromOthersAndEveryDefault) {
    const Json board = listed("ublox-f9p-hpg150");
    EXPECT_EQ(board.at("name"), "ublox-f9p-hpg150");
    EXPECT_EQ(board.at("files").size(), 2U);
    EXPECT_EQ(board.at("personality"), "ublox");
    EXPECT_EQ(board.at("identity").at("software"), "EXT CORE 1.00 (5949d2)") << "its own";
    EXPECT_EQ(board.at("uart").at("baud"), 38400) << "its parent's";
    EXPECT_EQ(board.at("uart").at("ports"), Json::parse(R"(["i2c", "uart1", "uart2", "usb", "spi"])"));
    EXPECT_EQ(board.at("uart").at("generated_ahead_bytes"), 1024) << "the default";
    EXPECT_EQ(board.at("quirks").at("speed_change_answer"), "at_new_speed") << "the default";
    EXPECT_EQ(board.at("nmea").at("beidou_talker"), "GB") << "the default";
    EXPECT_EQ(board.at("navigation").at("dynamic_limits"), true) << "the default of its personality";
    EXPECT_EQ(board.at("identity").at("banner").at(2), "EXT CORE 1.00 (5949d2)");
    EXPECT_EQ(board.at("nmea.sentences").at("GGA"), 1);
    EXPECT_EQ(board.at("ubx.legacy").at("CFG-ITFM"), "refuse");
    EXPECT_EQ(board.at("ubx.legacy").at("CFG-PRT"), "apply");
    EXPECT_FALSE(board.at("ubx.legacy").contains("CFG-BATCH"));
    EXPECT_FALSE(listed("ublox-m10").contains("usb")) << "it has none";
}

TEST(ListedBoard, TellsRatesAndItemsThatDiffer) {
    const Json board = listed("ZED-F9P");
    const auto message = [&](std::string_view name) {
        for (const Json& each : board.at("messages"))
            if (each.at("name") == name) return each.at("rates");
        return Json();
    };
    EXPECT_EQ(message("GGA"), Json::parse(R"({"i2c": 1, "uart1": 1, "uart2": 1, "usb": 1, "spi": 1})"));
    EXPECT_EQ(message("NAV-PVT").at("uart1"), 0);
    const Json& items = board.at("items");
    EXPECT_EQ(items.at("items_of"), "HPG 1.32");
    EXPECT_EQ(items.at("interface_description"), "UBX-22008968");
    EXPECT_EQ(items.at("count"), 846);
    const auto has = [&](const Json& item) {
        const Json& differing = items.at("differing");
        return std::find(differing.begin(), differing.end(), item) != differing.end();
    };
    EXPECT_TRUE(has(Json::parse(R"({"name": "CFG-NAVSPG-WKNROLLOVER", "value": 2208, "default": 2117})")));
    EXPECT_TRUE(has(Json::parse(R"({"name": "CFG-SIGNAL-GPS_L2C_ENA", "value": true, "default": false})")));
    EXPECT_FALSE(has(Json::parse(R"({"name": "CFG-RATE-NAV", "value": 1, "default": 1})")));
}

TEST(ListedBoard, IsTablesForPeople) {
    const std::string text = board_text("ublox-max-m10s", listed_boards).value();
    EXPECT_THAT(text, HasSubstr("ublox-max-m10s\n  u-blox MAX-M10S,"));
    EXPECT_THAT(text, ContainsRegex("aliases +MAX-M10S\n"));
    EXPECT_THAT(text, ContainsRegex("\nuart\n  baud +9600\n"));
    EXPECT_THAT(text, ContainsRegex("\ntiming\n  boot_s +3 s\n"));
    EXPECT_THAT(text,
                ContainsRegex("\nmessages, every so many epochs\n  message +i2c +uart1 +spi\n  TIM-TP +- +- +-\n"));
    EXPECT_THAT(text, ContainsRegex("\n390 configuration items, of SPG 5.10 \\(UBX-21035062\\)\n"));
    EXPECT_THAT(text, ContainsRegex("\nsources\n  speed: from memory"));
    EXPECT_THAT(board_text("msp-gps", listed_boards).value(), Not(HasSubstr("message")));
}

TEST(ListedBoard, IsThereForEveryBoard) {
    for (const std::string& name : list_boards(listed_boards)) {
        const auto board = board_text(name, listed_boards);
        ASSERT_TRUE(board) << board.error().message;
        EXPECT_THAT(*board, HasSubstr(name + "\n  ")) << name;
    }
    EXPECT_EQ(board_json("nope", listed_boards).error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace skyloop
