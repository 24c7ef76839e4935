#include "base/core/words.hpp"
#include "run/scenario/board_files.hpp"
#include "support/oracle_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace skyloop {
namespace {

namespace fs = std::filesystem;
using firmware::BoardProfile;
using firmware::NmeaSentence;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Optional;

const std::vector<fs::path> shipped_boards{fs::path(SKYLOOP_SOURCE_DIR) / "boards"};

// They speak another protocol.
const std::vector<std::string> boards_without_sentences{"dronecan-generic", "dronecan-heading", "mavlink-gps-input",
                                                        "msp-gps",          "quectel-lc29h-bs", "septentrio-sbf",
                                                        "unicore-um980",    "unicore-um982"};

std::string board_refusal(std::string_view text) {
    const auto board = read_board(text, "boards/receivers/test.toml");
    return board ? "accepted" : board.error().message;
}

std::vector<std::string> sentence_names(const BoardProfile& board) {
    std::vector<std::string> names;
    for (const auto& s : board.sentences)
        names.emplace_back(firmware::nmea_sentence_names[static_cast<std::size_t>(s.sentence)]);
    return names;
}

TEST(BoardFile, NamesTheBlocksOfASeptentrio) {
    const auto board = read_board("personality = \"sbf\"\n[sbf]\nblocks = [\"measepoch\", \"RawNavBits\"]\n", "a.toml");
    ASSERT_TRUE(board) << board.error().message;
    EXPECT_THAT(board->sbf_blocks, ElementsAre("MeasEpoch", "RawNavBits"));
    EXPECT_THAT(read_board("personality = \"sbf\"\n[sbf]\nblocks = []\n", "a.toml")->sbf_blocks, IsEmpty());
    EXPECT_THAT(find_board("septentrio-sbf", shipped_boards)->sbf_blocks, IsEmpty()) << "silent, as a mosaic is";
    const auto wrong = read_board("personality = \"sbf\"\n[sbf]\nblocks = [\"MeasEpoch\", \"Tea\"]\n", "a.toml");
    ASSERT_FALSE(wrong);
    EXPECT_THAT(wrong.error().message, HasSubstr("has 'Tea', which is no SBF block or group"));
}

TEST(BoardFile, TellsTheUsbPort) {
    const auto m8 = find_board("ublox-m8", shipped_boards);
    ASSERT_TRUE(m8 && m8->usb);
    EXPECT_EQ(m8->usb->vendor_id, 0x1546);
    EXPECT_EQ(m8->usb->product_id, 0x01a8);
    EXPECT_EQ(find_board("ublox-6", shipped_boards)->usb->product_id, 0x01a6);
    EXPECT_EQ(find_board("ublox-f9p", shipped_boards)->usb->product_id, 0x01a9);
    EXPECT_EQ(find_board("septentrio-sbf", shipped_boards)->usb->vendor_id, 0x152a);
    EXPECT_FALSE(find_board("ublox-m10", shipped_boards)->usb) << "it has no USB of its own";
    EXPECT_THAT(board_refusal("[usb]\nvendor_id = 1\n"),
                HasSubstr(":1:1: [usb] has not both vendor_id and product_id"));
    EXPECT_THAT(board_refusal("[usb]\nvendor_id = 1\nproduct_id = 65536\n"), HasSubstr(":3:14: usb.product_id"));
    EXPECT_THAT(board_refusal("[usb]\nvendor_id = 1\nproduct_id = 2\nproduct = \"" + std::string(32, 'x') + "\"\n"),
                HasSubstr("expected at most 31 characters of ASCII"));
}

TEST(BoardFile, EveryShippedBoardIsRead) {
    const auto names = list_boards(shipped_boards);
    EXPECT_EQ(names.size(), 41U);
    for (const std::string& name : names) {
        const auto board = find_board(name, shipped_boards);
        ASSERT_TRUE(board) << board.error().message;
        EXPECT_EQ(board->name, name);
        EXPECT_FALSE(board->description.empty());
        const auto& bare = boards_without_sentences;
        if (std::find(bare.begin(), bare.end(), name) != bare.end())
            EXPECT_TRUE(board->sentences.empty()) << name;
        else
            EXPECT_GE(board->sentences.size(), 5U) << name;
        EXPECT_GE(board->max_rate_hz, board->default_rate_hz);
    }
}

// RECEIVER.md 2.4.
TEST(BoardFile, ShippedBoardsHaveTheMakersFactorySettings) {
    const auto board = [](std::string_view name) { return find_board(name, shipped_boards).value(); };
    EXPECT_EQ(board("ublox-m8").baud, 9600U);
    EXPECT_EQ(board("ublox-m8").nmea_version, NmeaVersion::v4_0);
    EXPECT_THAT(sentence_names(board("ublox-m8")), ElementsAre("RMC", "VTG", "GGA", "GSA", "GSV", "GLL"));
    EXPECT_EQ(board("ublox-m9").baud, 38400U);
    EXPECT_EQ(board("ublox-m9").nmea_version, NmeaVersion::v4_10);
    EXPECT_EQ(board("ublox-m10").nmea_version, NmeaVersion::v4_11);
    const auto m10 = board("ublox-m10").constellations;
    EXPECT_EQ(std::count(m10.begin(), m10.end(), Constellation::glonass), 0);
    EXPECT_NEAR(board("ublox-f9p").elevation_mask.deg(), 10, 1e-12);
    EXPECT_EQ(board("msp-gps").maker, firmware::MakerKind::msp);
    EXPECT_EQ(board("mavlink-gps-input").maker, firmware::MakerKind::mavlink);
    EXPECT_EQ(board("septentrio-sbf").maker, firmware::MakerKind::sbf);
    EXPECT_EQ(board("unicore-um980").maker, firmware::MakerKind::unicore);
    EXPECT_EQ(board("unicore-um982").identity.hardware, "UM982");
    EXPECT_EQ(board("unicore-um982").ports.size(), 3u);
    EXPECT_EQ(board("casic-at6558").maker, firmware::MakerKind::casic);
    EXPECT_TRUE(board("casic-at6558").style.one_gsv_list);
    EXPECT_EQ(board("quectel-l76k").constellations.size(), 3u);
    EXPECT_EQ(board("quectel-lg290p").maker, firmware::MakerKind::quectel);
    EXPECT_EQ(board("quectel-lc29h-ea").baud, 460800U);
    EXPECT_EQ(board("unicore-uc6580").maker, firmware::MakerKind::ufirebird);
    EXPECT_EQ(board("airoha-ag3335").timing.command_sleep, Seconds(4));
    EXPECT_EQ(board("nmea-generic").baud, 9600U);
    EXPECT_EQ(board("nmea-generic").sentences.size(), 8U);
}

TEST(BoardFile, TheBuildTreeHoldsTheBoards) {
    const std::vector<fs::path> built{test::built_data() / "boards"};
    EXPECT_EQ(list_boards(built), list_boards(shipped_boards));
}

TEST(BoardFile, EveryKeyIsRead) {
    const auto board = read_board(R"(
description = "all"
[uart]
baud = 57600
transmit_buffer_bytes = 1234
[navigation]
constellations = ["galileo", "sbas"]
default_rate_hz = 4
max_rate_hz = 7.5
elevation_mask_deg = 12.5
solution_latency_s = 0.125
[nmea]
version = "2.3"
main_talker = "GL"
satellite_numbering = "extended"
coordinate_decimals = 7
time_decimals = 3
max_listed_satellites = 20
course_min_speed_mps = 0.5
overflow_notice = true
sentences = { ZDA = 5, RMC = 1, GSV = 0 }
)",
                                  "some/where/mine.toml");
    ASSERT_TRUE(board) << board.error().message;
    EXPECT_EQ(board->name, "mine");
    EXPECT_EQ(board->description, "all");
    EXPECT_EQ(board->baud, 57600U);
    EXPECT_EQ(board->transmit_buffer_bytes, 1234U);
    EXPECT_THAT(board->constellations, ElementsAre(Constellation::galileo, Constellation::sbas));
    EXPECT_EQ(board->default_rate_hz, 4);
    EXPECT_EQ(board->max_rate_hz, 7.5);
    EXPECT_NEAR(board->elevation_mask.deg(), 12.5, 1e-12);
    EXPECT_EQ(board->solution_latency, Seconds(0.125));
    EXPECT_EQ(board->nmea_version, NmeaVersion::v2_3);
    EXPECT_EQ(board->main_talker, "GL");
    EXPECT_EQ(board->satellite_numbering, NmeaNumbering::extended);
    EXPECT_EQ(board->coordinate_decimals, 7);
    EXPECT_EQ(board->time_decimals, 3);
    EXPECT_EQ(board->max_listed_satellites, 20);
    EXPECT_EQ(board->course_min_speed, MetresPerSecond(0.5));
    EXPECT_TRUE(board->quirks.overflow_notice);
    ASSERT_EQ(board->sentences.size(), 2U);
    EXPECT_EQ(board->sentences[1].sentence, NmeaSentence::zda);
    EXPECT_EQ(board->sentences[1].every_epochs, 5);
}

TEST(BoardFile, AnEmptyFileIsADefaultReceiver) {
    const auto board = read_board("", "empty.toml");
    ASSERT_TRUE(board);
    EXPECT_THAT(board->constellations, ElementsAre(Constellation::gps));
    EXPECT_TRUE(board->sentences.empty());
}

TEST(BoardFile, RefusesTablesOfOtherMakers) {
    const auto refusal = [](const char* text) { return read_board(text, "mine.toml").error().message; };
    EXPECT_THAT(refusal("personality = \"mtk\"\n[config]\n\"CFG-RATE-MEAS\" = 200\n"),
                HasSubstr("mine.toml:2:1: config: has no effect: only receivers of the personality \"ublox\" have"));
    EXPECT_THAT(refusal("personality = \"ublox\"\n[sbf]\nblocks = [\"DOP\"]\n"),
                HasSubstr("\"sbf\" have streams of blocks"));
}

TEST(BoardFile, RefusesWithFileLineAndColumn) {
    EXPECT_EQ(board_refusal("[uart]\nbuad = 9600\n"),
              "boards/receivers/test.toml:2:1: uart.buad: unknown key; did you mean 'baud'?");
    EXPECT_EQ(board_refusal("nmaa = 1"), "boards/receivers/test.toml:1:1: nmaa: unknown key; did you mean 'nmea'?");
    EXPECT_EQ(board_refusal("[uart]\nbaud = 100\n"),
              "boards/receivers/test.toml:2:8: uart.baud: is 100; expected a whole number from 1200 to 8000000");
    EXPECT_THAT(board_refusal("[uart]\nbaud = 9600.5"),
                HasSubstr(":2:8: uart.baud: is a number; expected a whole number from 1200 to 8000000"));
    EXPECT_THAT(board_refusal("[uart]\nbaud = \"9600\""),
                HasSubstr("uart.baud: is a text; expected a whole number from 1200 to 8000000"));
    EXPECT_THAT(board_refusal("[navigation]\nelevation_mask_deg = nan"),
                HasSubstr("elevation_mask_deg: is nan; expected a number from 0 to 90"));
    EXPECT_THAT(board_refusal("[navigation]\nmax_rate_hz = 5\ndefault_rate_hz = 6"),
                HasSubstr(":3:19: navigation.default_rate_hz: is 6; expected a number from 0.1 to 5"));
    EXPECT_THAT(board_refusal("[nmea]\nversion = \"4.1\""),
                HasSubstr("nmea.version: is '4.1'; expected one of 2.1 2.3 3.0 4.0 4.10 4.11"));
    EXPECT_THAT(board_refusal("[nmea]\nversion = \"\""), HasSubstr("nmea.version: is ''; expected one of 2.1 2.3"));
    EXPECT_THAT(board_refusal("[nmea]\nversion = 4.1"),
                HasSubstr("nmea.version: is a number; expected a text in quotes"));
    EXPECT_THAT(board_refusal("[nmea]\nmain_talker = \"XX\""),
                HasSubstr("nmea.main_talker: is 'XX'; expected one of GP GL"));
    EXPECT_THAT(board_refusal("[nmea]\noverflow_notice = 1"),
                HasSubstr("nmea.overflow_notice: is a whole number; expected true or false"));
    EXPECT_THAT(board_refusal("[nmea.sentences]\nGAG = 1"),
                HasSubstr("nmea.sentences.GAG: unknown key; did you mean 'GGA'?"));
    EXPECT_THAT(board_refusal("[nmea]\nsentences = [\"GGA\"]"),
                HasSubstr("nmea.sentences: is a list; expected a table"));
    EXPECT_THAT(board_refusal("uart = 1"), HasSubstr(":1:8: uart: is a whole number; expected a table"));
}

TEST(BoardFile, RefusesListsOfConstellationsAtTheEntryThatIsWrong) {
    const std::string key = "navigation.constellations: ";
    const auto refusal = [](const std::string& list) {
        return board_refusal("[navigation]\nconstellations = " + list);
    };
    EXPECT_THAT(refusal("[\"gps\", \"galilo\"]"),
                HasSubstr(":2:26: " + key +
                          "holds 'galilo'; expected a list of some of gps sbas galileo beidou qzss glonass navic; "
                          "did you mean 'galileo'?"));
    EXPECT_THAT(refusal("[\"gps\", \"gps\"]"), HasSubstr(":2:26: " + key + "holds 'gps' twice"));
    EXPECT_THAT(refusal("[]"), HasSubstr(":2:18: " + key + "is an empty list; expected a list of some of gps"));
    EXPECT_THAT(refusal("\"gps\""), HasSubstr(key + "is a text; expected a list of"));
    EXPECT_THAT(refusal("[1]"), HasSubstr(":2:19: " + key + "holds a whole number; expected a list of"));
}

TEST(BoardFile, TellsEveryMistakeOnALineOfItsOwn) {
    EXPECT_EQ(board_refusal("[nmea]\ntime_decimals = 4\n[uart]\nbaud = 1\n"),
              "boards/receivers/test.toml:2:17: nmea.time_decimals: is 4; expected a whole number from 0 to 3\n"
              "boards/receivers/test.toml:4:8: uart.baud: is 1; expected a whole number from 1200 to 8000000");
}

TEST(BoardFile, ABoardSlowerThanTheUsualRateStartsAtItsOwn) {
    EXPECT_EQ(read_board("[navigation]\nmax_rate_hz = 0.5", "slow.toml").value().default_rate_hz, 0.5);
}

TEST(BoardFile, RefusesWhatIsNotToml) {
    EXPECT_THAT(board_refusal("[uart\nbaud = 1"), HasSubstr("boards/receivers/test.toml:1:"));
    EXPECT_THAT(board_refusal("baud = \n"), HasSubstr("test.toml:1:"));
    EXPECT_THAT(board_refusal(std::string_view("\x00\xff\x01", 3)), HasSubstr("test.toml:1:"));
    EXPECT_THAT(board_refusal("a = 1\na = 2"), HasSubstr("test.toml:2:"));
}

TEST(FindBoard, RefusesUnknownNames) {
    const auto board = find_board("ublox-m88", shipped_boards);
    ASSERT_FALSE(board);
    EXPECT_EQ(board.error().code, ErrorCode::usage);
    EXPECT_EQ(board.error().message, "board 'ublox-m88' is not known; did you mean 'ublox-m8'?");
    EXPECT_THAT(find_board("nope", shipped_boards).error().message,
                AllOf(HasSubstr("board 'nope' is not known; expected one of airoha-ag3335, airoha-ag33xx, "
                                "casic-at6558, dronecan-generic, dronecan-heading, "
                                "mavlink-gps-input, msp-gps"),
                      HasSubstr(", ublox-m9, ublox-m9-spg450, ublox-max-m10s, ")));
    EXPECT_FALSE(find_board("../receivers/ublox-m8", shipped_boards));
    const std::vector<fs::path> nowhere{"/no/such/folder"};
    EXPECT_THAT(find_board("ublox-m8", nowhere).error().message, HasSubstr("searched: /no/such/folder"));
    EXPECT_EQ(find_board("/no/such/file.toml", shipped_boards).error().code, ErrorCode::outside);
}

TEST(FindBoard, TakesTheNamesOfModules) {
    const std::pair<const char*, const char*> aliases[] = {
        {"NEO-M8N", "ublox-m8"},         {"neo-m8n", "ublox-m8"},
        {"SAM-M8Q", "ublox-m8"},         {"NEO-M8P", "ublox-m8p"},
        {"NEO-M9N", "ublox-m9"},         {"MAX-M10S", "ublox-max-m10s"},
        {"SAM-M10Q", "ublox-sam-m10q"},  {"ZED-F9P", "ublox-f9p"},
        {"ZED-F9P-04B", "ublox-f9p"},    {"ZED-F9P-15B", "ublox-f9p-15b"},
        {"ZED-X20P", "ublox-x20p"},      {"NEO-F10N", "ublox-f10"},
        {"DAN-F10N", "ublox-f10"},       {"NEO-6M", "ublox-6"},
        {"mosaic-X5", "septentrio-sbf"}, {"PA6H", "mtk3339"},
        {"MT3339", "mtk3339"},           {"AG3335", "airoha-ag3335"},
        {"ATGM336H", "casic-at6558"},    {"L76K", "quectel-l76k"},
        {"lg290p", "quectel-lg290p"},    {"UC6580", "unicore-uc6580"},
    };
    for (const auto& [alias, name] : aliases) {
        const auto board = find_board(alias, shipped_boards);
        ASSERT_TRUE(board) << board.error().message;
        EXPECT_EQ(board->name, name) << alias;
    }
}

TEST(FindBoard, NoTwoShippedBoardsShareAName) {
    std::vector<std::string> names;
    for (const std::string& name : list_boards(shipped_boards)) {
        names.push_back(name);
        const BoardProfile board = find_board(name, shipped_boards).value();
        for (const std::string& alias : board.aliases)
            names.push_back(lower_case(alias));
    }
    std::sort(names.begin(), names.end());
    EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

TEST(FindBoard, KnowsTheBoardThatAModuleHas) {
    const std::pair<const char*, const char*> meant[] = {
        {"m8", "ublox-m8"},           {"M8N", "ublox-m8"},
        {"NEO-M8N-0-10", "ublox-m8"}, {"neom8n", "ublox-m8"},
        {"u-blox-m8", "ublox-m8"},    {"ublox_m9", "ublox-m9"},
        {"m10", "ublox-m10"},         {"f9p", "ublox-f9p"},
        {"ZED-F9P-04", "ublox-f9p"},  {"NEO-M9", "ublox-m9"},
        {"x20p", "ublox-x20p"},       {"mosaic", "septentrio-sbf"},
        {"AG33", "airoha-ag33xx"},    {"septentrio", "septentrio-sbf"},
    };
    for (const auto& [name, board] : meant)
        EXPECT_EQ(find_board(name, shipped_boards).error().message,
                  std::string("board '") + name + "' is not known; did you mean '" + board + "'?");
    for (const char* unknown : {"nope", "m80", "42", "x", "", "ublox", "NEO"})
        EXPECT_THAT(find_board(unknown, shipped_boards).error().message, HasSubstr("; expected one of ")) << unknown;
}

TEST(FindBoard, ReadsAFileByItsPath) {
    const auto board = find_board((shipped_boards[0] / "receivers/ublox-m9.toml").string(), {});
    ASSERT_TRUE(board) << board.error().message;
    EXPECT_EQ(board->name, "ublox-m9");
}

}  // namespace
}  // namespace skyloop
