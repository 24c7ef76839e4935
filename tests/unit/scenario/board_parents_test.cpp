// Boards that extend others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "firmware/ublox/config/config_handler.hpp"
#include "run/scenario/board_files.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

// A folder of boards of its own.
class BoardParents : public testing::Test {
protected:
    BoardParents() { fs::create_directories(root_ / "receivers"); }
    ~BoardParents() override { fs::remove_all(root_); }
    fs::path write(const std::string& name, std::string_view text) const {
        const fs::path path = root_ / "receivers" / (name + ".toml");
        std::ofstream(path) << text;
        return path;
    }
    [[nodiscard]] Result<firmware::BoardProfile> find(const std::string& name) const {
        return find_board(name, std::vector<fs::path>{root_, fs::path(SKYLOOP_SOURCE_DIR) / "boards"});
    }
    [[nodiscard]] std::string refusal(const std::string& name) const {
        const auto board = find(name);
        return board ? "accepted" : board.error().message;
    }

private:
    fs::path root_ = fs::path(testing::TempDir()) /
                     (std::string("board_parents_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(BoardParents, AreBeneathWhatTheBoardSays) {
    write("old",
          "description = \"old\"\npersonality = \"ublox\"\naliases = [\"OLD-1\"]\nsources = [\"a book\"]\n"
          "[uart]\nbaud = 9600\nports = [\"uart1\", \"usb\"]\n[timing]\nboot_s = 2\nanswer_s = 0.5\n"
          "[config]\nCFG-RATE-MEAS = 200\nCFG-RATE-NAV = 2\n");
    write("middle", "extends = \"old\"\nsources = [\"a letter\"]\n[timing]\nboot_s = 3\n");
    write("new",
          "extends = \"middle\"\ndescription = \"new\"\n[uart]\nports = [\"uart1\"]\n[config]\nCFG-RATE-NAV = 5\n");
    const auto board = find("new");
    ASSERT_TRUE(board) << board.error().message;
    EXPECT_EQ(board->name, "new");
    EXPECT_EQ(board->description, "new");
    EXPECT_EQ(board->maker, firmware::MakerKind::ublox);
    EXPECT_EQ(board->baud, 9600U);
    EXPECT_THAT(board->ports, ElementsAre(firmware::PortId::uart1)) << "a list is replaced as a whole";
    EXPECT_EQ(board->timing.boot.value(), 3);
    EXPECT_EQ(board->timing.answer.value(), 0.5);
    EXPECT_EQ(board->config.at(firmware::key::rate_meas), 200U);
    EXPECT_EQ(board->config.at(firmware::key::rate_nav), 5U);
    EXPECT_THAT(board->sources, ElementsAre("a letter"));
    EXPECT_TRUE(board->aliases.empty()) << "those of another board";
    ASSERT_EQ(board->files.size(), 3U);
    EXPECT_THAT(board->files[1], HasSubstr("receivers/middle.toml"));
    EXPECT_THAT(board->files[2], HasSubstr("receivers/old.toml"));
}

TEST_F(BoardParents, MayBeABoardOfTheSameNameElsewhereOrAFileByItsPath) {
    write("ublox-m9", "extends = \"ublox-m9\"\n[uart]\nbaud = 9600\n");
    EXPECT_EQ(find("ublox-m9")->baud, 9600U);
    EXPECT_EQ(find("ublox-m9")->identity.hardware, "00190000");
    const fs::path mine = write("mine", "extends = \"ublox-m9.toml\"\n");
    EXPECT_EQ(find(mine.string())->baud, 9600U);
}

TEST_F(BoardParents, ThatAreNotThereOrInALoopAreRefused) {
    write("lost", "description = \"x\"\nextends = \"ublox-m99\"\n");
    EXPECT_THAT(refusal("lost"),
                HasSubstr("receivers/lost.toml:2:11: extends: is 'ublox-m99', which no board is called; "
                          "did you mean 'ublox-m9'?"));
    write("one", "extends = \"two\"\n");
    write("two", "extends = \"one\"\n");
    EXPECT_THAT(refusal("one"),
                HasSubstr("receivers/two.toml:1:11: extends: is 'one', which extends this board in turn"));
    write("self", "extends = \"self\"\n");
    EXPECT_THAT(refusal("self"), HasSubstr("which extends this board in turn"));
    write("number", "extends = 5\n");
    EXPECT_THAT(refusal("number"), HasSubstr("extends: is a whole number; expected a text"));
}

TEST_F(BoardParents, TheirMistakesAreToldWithTheirOwnFile) {
    write("wrong", "[uart]\nbaud = \"fast\"\n");
    write("child", "extends = \"wrong\"\n[timing]\nboot_s = -1\n");
    EXPECT_THAT(refusal("child"), HasSubstr("receivers/wrong.toml:2:8: uart.baud: is a text"));
    EXPECT_THAT(refusal("child"), HasSubstr("receivers/child.toml:3:10: timing.boot_s: is -1"));
    write("garbage", "[uart\n");
    write("other", "extends = \"garbage\"\n");
    EXPECT_THAT(refusal("other"), HasSubstr("receivers/garbage.toml:1:"));
}

TEST_F(BoardParents, AFileThatCannotBeReadMeansNothing) {
    write("garbage", "aliases = [\"NEO-X\"\n");
    write("fine", "aliases = [\"NEO-Y\"]\n");
    EXPECT_EQ(find("neo-y")->name, "fine");
    EXPECT_FALSE(find("NEO-X"));
    write("odd", "aliases = [\"a b\"]\n");
    EXPECT_THAT(refusal("odd"), HasSubstr("aliases: holds 'a b'; expected letters, digits, '-' and '_'"));
}

TEST_F(BoardParents, TheBannerSaysWhatTheIdentityDoes) {
    write("plain",
          "[identity]\nsoftware = \"EXT 1\"\nextensions = [\"MOD=A\", \"GPS\"]\n"
          "banner = [\"hello\", \"{software}\", \"{extensions}\", \"bye\"]\n");
    write("child", "extends = \"plain\"\n[identity]\nsoftware = \"EXT 2\"\n");
    EXPECT_THAT(find("child")->identity.banner, ElementsAre("hello", "EXT 2", "MOD=A", "GPS", "bye"));
}

TEST(ShippedBoards, DifferFromTheirParentAsTheirFirmwareDoes) {
    const std::vector<fs::path> folders{fs::path(SKYLOOP_SOURCE_DIR) / "boards"};
    const auto board = [&](const char* name) { return find_board(name, folders).value(); };
    EXPECT_EQ(board("ublox-max-m10s").baud, 9600U);
    EXPECT_THAT(board("ublox-sam-m10q").identity.banner, testing::Contains("MOD=SAM-M10Q"));
    EXPECT_EQ(board("ublox-f9p-hpg151").identity.software, "EXT CORE 1.00 (9e1716)");
    EXPECT_EQ(board("ublox-f9p-hpg151").items_of->name, "HPG 1.50");
    EXPECT_EQ(board("ublox-m8-rom201").identity.extensions.front(), "PROTVER 15.00");
    EXPECT_EQ(board("ublox-x20p").identity.extensions.back(), "NAVIC;LBAND");
    const auto factory = [&](const char* name, std::string_view item) {
        const firmware::ConfigValues values = firmware::factory_config(board(name));
        const auto found = values.find(firmware::find_config_key(item)->id);
        return found == values.end() ? -1 : static_cast<int>(found->second);
    };
    EXPECT_EQ(factory("ublox-f9p", "CFG-SIGNAL-QZSS_L1S_ENA"), 0);
    EXPECT_EQ(factory("ublox-m9", "CFG-SIGNAL-QZSS_L1S_ENA"), -1);
    EXPECT_EQ(factory("ublox-f9p-hpg113", "CFG-UART2INPROT-UBX"), 0);
    EXPECT_EQ(factory("ublox-f9p", "CFG-UART2INPROT-UBX"), 1);
    EXPECT_EQ(factory("ublox-f9p", "CFG-NAVSPG-FIXMODE"), 3);
    EXPECT_EQ(factory("ublox-f9p-hpg150", "CFG-NAVSPG-FIXMODE"), 2);
    EXPECT_EQ(factory("ublox-f9p-hpg150", "CFG-ITFM-ENABLE"), -1);
    EXPECT_EQ(factory("ublox-f9p-15b", "CFG-SIGNAL-GPS_L5_ENA"), 0);
    EXPECT_EQ(factory("ublox-f9p-15b", "CFG-SIGNAL-GAL_E5A_ENA"), 1);
    EXPECT_EQ(factory("ublox-x20p", "CFG-SIGNAL-PLAN"), 2);
    EXPECT_EQ(factory("ublox-x20p", "CFG-SIGNAL-QZSS_ENA"), 0);
    EXPECT_EQ(factory("ublox-x20p", "CFG-TP-TP1_ENA"), -1);
}

}  // namespace
}  // namespace skyloop
