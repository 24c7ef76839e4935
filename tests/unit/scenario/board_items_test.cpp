// The configuration items of each board, against the interface description of its firmware.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "firmware/ublox/config/config_handler.hpp"
#include "run/scenario/board_files.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;
using firmware::BoardProfile;

// A list, its column of keys_by_firmware.csv, and what of it is not as that table has it.
struct ListedItems {
    std::string_view firmware, column;
    std::size_t count;
    std::uint64_t digest;
    std::set<std::uint32_t> more;  // GENERATIONS.md, sections 2 and 5; what the table lost where it was read from paper
};
const std::vector<ListedItems> listed_items{
    // PX4 sets three flags of CFG-ODO of a NEO-M9N, and has its ACK.
    {"SPG 4.04", "M9_SPG404", 585, 0x27E1229697C10CCB, {0x10220002, 0x10220003, 0x10220004}},
    {"SPG 5.10", "M10_SPG510", 390, 0xC396447237769DCD, {}},
    // The rate of TIM-VRFY is there for I2C and SPI.
    {"SPG 5.30", "M10_SPG530", 431, 0x76465F4A363BE8C2, {0x20910093}},
    {"SPGL1L5 6.00", "F10_SPG600", 375, 0x992E2364C708FBB5, {0x10320001, 0x209102A4, 0x209102A5, 0x209102A8}},
    {"HPG 1.13", "F9P_HPG113", 660, 0x55AD616175607F07, {0x10310027}},
    {"HPG 1.32",
     "F9P_HPG132",
     846,
     0xC0BC1E2F013CF4BB,
     {0x10310027, 0x30A3003C, 0x20910634, 0x20910635, 0x20910636, 0x20910637, 0x20910638, 0x20910689, 0x2091068A,
      0x2091068B, 0x2091068C, 0x2091068D}},
    {"HPG 1.50", "F9P_HPG150", 860, 0x66C395ACB3FBDBF5, {0x10310027}},
    {"HPGL1L5 1.40", "F9P15B_L1L5_140", 846, 0x7B4C1815C7CF23F3, {0x10320001}},
    {"HPG 2.00", "X20P_HPG200", 556, 0x3133C67AD819A7D5, {0x10320001}},
};

std::vector<BoardProfile> boards_with_values() {
    const std::vector<fs::path> folders{fs::path(SKYLOOP_SOURCE_DIR) / "boards"};
    std::vector<BoardProfile> boards;
    for (const std::string& name : list_boards(folders)) {
        BoardProfile board = find_board(name, folders).value();
        const bool values = board.quirks.value_config == firmware::ValueConfigSupport::full;
        if (board.maker == firmware::MakerKind::ublox && values) boards.push_back(std::move(board));
    }
    return boards;
}

std::set<std::uint32_t> items_on_the_wire(const BoardProfile& board) {
    std::set<std::uint32_t> items;
    for (const auto& [key, value] : firmware::factory_config(board))
        if (is_on_the_wire(board, key)) items.insert(key);
    return items;
}

const ListedItems& listed_for(const BoardProfile& board) {
    const auto is_its_own = [&](const ListedItems& row) { return row.firmware == board.items_of->name; };
    return *std::find_if(listed_items.begin(), listed_items.end(), is_its_own);
}

// FNV-1a over the ids, ascending, lowest byte first.
std::uint64_t digest_of(const std::set<std::uint32_t>& items) {
    std::uint64_t hash = 0xCBF2'9CE4'8422'2325;
    for (const std::uint32_t item : items)
        for (unsigned byte = 0; byte < 4; ++byte)
            hash = (hash ^ (item >> 8 * byte & 0xFF)) * 0x100'0000'01B3;
    return hash;
}

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');)
        cells.push_back(cell);
    return cells;
}

// Item ids by column.
std::map<std::string, std::set<std::uint32_t>> table_of_items(std::ifstream& file) {
    std::map<std::string, std::set<std::uint32_t>> items;
    std::string line;
    std::getline(file, line);
    const std::vector<std::string> columns = cells_of(line);
    while (std::getline(file, line)) {
        const std::vector<std::string> cells = cells_of(line);
        for (std::size_t i = 3; i < cells.size(); ++i)
            if (cells[i] == "1")
                items[columns[i]].insert(static_cast<std::uint32_t>(std::stoul(cells[0], nullptr, 16)));
    }
    return items;
}

TEST(BoardItems, EveryBoardWithCfgValsetNamesItsList) {
    std::set<std::string_view> named;
    for (const BoardProfile& board : boards_with_values()) {
        ASSERT_NE(board.items_of, nullptr) << board.name;
        named.insert(board.items_of->name);
    }
    for (const firmware::FirmwareList& list : firmware::firmware_lists())
        EXPECT_TRUE(named.contains(list.name)) << list.name;
}

TEST(BoardItems, AreThoseOfTheInterfaceDescription) {
    std::ifstream file(fs::path(SKYLOOP_SHARED_DATA) / "vectors/ublox_keys/keys_by_firmware.csv");
    if (!file) GTEST_SKIP() << "shared data absent: vectors/ublox_keys";
    const auto table = table_of_items(file);
    for (const BoardProfile& board : boards_with_values()) {
        const ListedItems& listed = listed_for(board);
        std::set<std::uint32_t> expected = table.at(std::string(listed.column));
        expected.insert(listed.more.begin(), listed.more.end());
        EXPECT_THAT(items_on_the_wire(board), testing::ContainerEq(expected)) << board.name;
    }
}

// The same where those lists are not at hand.
TEST(BoardItems, HaveTheDigestOfTheirList) {
    for (const BoardProfile& board : boards_with_values()) {
        const std::set<std::uint32_t> items = items_on_the_wire(board);
        EXPECT_EQ(items.size(), listed_for(board).count) << board.name;
        EXPECT_EQ(digest_of(items), listed_for(board).digest) << board.name;
    }
}

}  // namespace
}  // namespace skyloop
