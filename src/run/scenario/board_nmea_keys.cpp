#include <array>

#include "detail/board_keys.hpp"

namespace skyloop {
namespace {

constexpr std::array<std::string_view, 6> board_talkers{"GP", "GL", "GA", "GB", "GQ", "GN"};
constexpr std::array<std::string_view, 2> beidou_talkers{"GB", "BD"}, qzss_talkers{"GQ", "QZ"};
constexpr std::array<std::string_view, 2> station_fields{"", "0000"};

void read_board_sentences(TableReader& rates, std::vector<firmware::SentenceRate>& sentences) {
    for (std::size_t i = 0; i < std::size(firmware::nmea_sentence_names); ++i) {
        int every = 0;
        rates.integer(firmware::nmea_sentence_names[i], every, {0, 255});
        if (every > 0) sentences.push_back({static_cast<firmware::NmeaSentence>(i), every});
    }
}

void read_one_of(TableReader& table, std::string_view key, std::span<const std::string_view> words,
                 std::string& value) {
    if (const auto index = table.choice(key, words)) value = words[*index];
}

void read_board_style(TableReader& nmea, firmware::NmeaStyle& style) {
    nmea.integer("speed_decimals", style.speed_decimals, {0, 3});
    nmea.integer("course_decimals", style.course_decimals, {0, 3});
    nmea.boolean("course_always", style.course_always);
    nmea.boolean("satellites_padded", style.satellites_padded);
    nmea.integer("dop_decimals", style.dop_decimals, {0, 3});
    nmea.boolean("gst_ellipse", style.gst_ellipse);
    nmea.boolean("gst_padded", style.gst_padded);
    nmea.boolean("zeros_without_fix", style.zeros_without_fix);
    nmea.boolean("unknown_date_is_1980", style.unknown_date_is_1980);
    read_one_of(nmea, "station_field", station_fields, style.station_field);
    read_one_of(nmea, "beidou_talker", beidou_talkers, style.beidou_talker);
    read_one_of(nmea, "qzss_talker", qzss_talkers, style.qzss_talker);
}

}  // namespace

void read_board_nmea(TableReader& nmea, firmware::BoardProfile& board) {
    nmea.word("version",
              {{"2.1", NmeaVersion::v2_1},
               {"2.3", NmeaVersion::v2_3},
               {"4.0", NmeaVersion::v4_0},
               {"4.10", NmeaVersion::v4_10},
               {"4.11", NmeaVersion::v4_11}},
              board.nmea_version);
    nmea.word("satellite_numbering", {{"strict", NmeaNumbering::strict}, {"extended", NmeaNumbering::extended}},
              board.satellite_numbering);
    nmea.text("main_talker", board.main_talker);
    if (!board.main_talker.empty()) nmea.choice("main_talker", board_talkers);
    nmea.integer("coordinate_decimals", board.coordinate_decimals, {3, 7});
    nmea.integer("time_decimals", board.time_decimals, {0, 3});
    nmea.integer("max_listed_satellites", board.max_listed_satellites, {4, 99});
    nmea.quantity("course_min_speed_mps", board.course_min_speed, {0, 10});
    nmea.boolean("overflow_notice", board.quirks.overflow_notice);
    read_board_style(nmea, board.style);
    nmea.table("sentences", [&](TableReader& rates) { read_board_sentences(rates, board.sentences); });
}

}  // namespace skyloop
