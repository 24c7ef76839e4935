#include "skyloop/scenario/board_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>

#include "scenario_keys.hpp"
#include "skyloop/base/spelling.hpp"
#include "skyloop/base/text_file.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;

constexpr std::array<Word<NmeaVersion>, 4> board_nmea_versions{{{"2.3", NmeaVersion::v2_3},
                                                                {"4.0", NmeaVersion::v4_0},
                                                                {"4.10", NmeaVersion::v4_10},
                                                                {"4.11", NmeaVersion::v4_11}}};
constexpr std::array<Word<NmeaNumbering>, 2> board_numberings{
    {{"strict", NmeaNumbering::strict}, {"extended", NmeaNumbering::extended}}};
constexpr std::array<std::string_view, 6> board_talkers{"GP", "GL", "GA", "GB", "GQ", "GN"};

void read_board_uart(TableReader& uart, firmware::BoardProfile& board) {
    uart.integer("baud", board.baud, {1200, 8'000'000});
    uart.integer("transmit_buffer_bytes", board.transmit_buffer_bytes, {128, 1'048'576});
}

void read_board_navigation(TableReader& navigation, firmware::BoardProfile& board) {
    read_constellation_list(navigation, board.constellations);
    navigation.number("max_rate_hz", board.max_rate_hz, {0.1, 100});
    // A board slower than the usual rate starts at its own maximum.
    board.default_rate_hz = std::min(board.default_rate_hz, board.max_rate_hz);
    navigation.number("default_rate_hz", board.default_rate_hz, {0.1, board.max_rate_hz});
    double mask = board.elevation_mask.deg();
    navigation.number("elevation_mask_deg", mask, {0, 90});
    board.elevation_mask = Angle::degrees(mask);
    navigation.quantity("solution_latency_s", board.solution_latency, {0, 2});
}

void read_board_sentences(TableReader& rates, std::vector<firmware::SentenceRate>& sentences) {
    for (std::size_t i = 0; i < std::size(firmware::nmea_sentence_names); ++i) {
        int every = 0;
        rates.integer(firmware::nmea_sentence_names[i], every, {0, 255});
        if (every > 0) sentences.push_back({static_cast<firmware::NmeaSentence>(i), every});
    }
}

void read_board_nmea(TableReader& nmea, firmware::BoardProfile& board) {
    nmea.word("version", board_nmea_versions, board.nmea_version);
    nmea.word("satellite_numbering", board_numberings, board.satellite_numbering);
    nmea.text("main_talker", board.main_talker);
    if (!board.main_talker.empty()) nmea.choice("main_talker", board_talkers);
    nmea.integer("coordinate_decimals", board.coordinate_decimals, {3, 7});
    nmea.integer("time_decimals", board.time_decimals, {0, 3});
    nmea.integer("max_listed_satellites", board.max_listed_satellites, {4, 99});
    nmea.quantity("course_min_speed_mps", board.course_min_speed, {0, 10});
    nmea.boolean("overflow_notice", board.quirks.overflow_notice);
    nmea.table("sentences", [&](TableReader& rates) { read_board_sentences(rates, board.sentences); });
}

void read_board_keys(TableReader& top, firmware::BoardProfile& board) {
    top.text("description", board.description);
    top.table("uart", [&](TableReader& t) { read_board_uart(t, board); });
    top.table("navigation", [&](TableReader& t) { read_board_navigation(t, board); });
    top.table("nmea", [&](TableReader& t) { read_board_nmea(t, board); });
}

fs::path board_path(const fs::path& directory, std::string_view name) {
    return directory / "receivers" / (std::string(name) + ".toml");
}

}  // namespace

Result<firmware::BoardProfile> read_board(std::string_view toml_text, std::string_view name) {
    firmware::BoardProfile board;
    board.name = fs::path(name).stem().string();
    board.constellations = {Constellation::gps};
    const auto read = read_toml(toml_text, std::string(name), [&](TableReader& top) { read_board_keys(top, board); });
    if (!read) return fail(read.error());
    return board;
}

Result<firmware::BoardProfile> find_board(std::string_view name, std::span<const fs::path> directories) {
    std::optional<fs::path> path;
    std::error_code error;
    if (name.ends_with(".toml")) path = name;
    for (const fs::path& directory : directories)
        if (!path && name.find('/') == std::string_view::npos && fs::exists(board_path(directory, name), error))
            path = board_path(directory, name);
    if (path) {
        const auto text = read_text_file(*path);
        if (!text) return fail(text.error());
        return read_board(*text, path->string());
    }
    const std::vector<std::string> known = list_boards(directories);
    if (known.empty()) {
        std::string searched;
        for (const fs::path& directory : directories)
            searched += " " + directory.string();
        return fail(ErrorCode::usage, fmt::format("board '{}': no board files are found; searched:{}", name, searched));
    }
    const std::vector<std::string_view> words(known.begin(), known.end());
    return fail(ErrorCode::usage, fmt::format("board '{}' is not known{}; known are {}", name,
                                              did_you_mean(name, words), fmt::join(known, ", ")));
}

std::vector<std::string> list_boards(std::span<const fs::path> directories) {
    std::vector<std::string> names;
    for (const fs::path& directory : directories) {
        std::error_code error;
        for (const fs::directory_entry& entry : fs::directory_iterator(directory / "receivers", error))
            if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

}  // namespace skyloop
