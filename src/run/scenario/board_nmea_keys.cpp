#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "detail/scenario_keys.hpp"
#include "firmware/makers.hpp"
#include "firmware/sentences/own_lines.hpp"
#include "firmware/ublox/config/config_handler.hpp"

namespace skyloop::inline run {
namespace {

using firmware::BoardProfile;
using firmware::GsaStyle;
using firmware::HeadingSource;
using firmware::MakerKind;
using firmware::NmeaSentence;
using firmware::ToldGeoid;
using firmware::ToldQuality;

constexpr std::array<std::string_view, 10> board_talkers{"GP", "GL", "GA", "GB", "GQ", "GN", "BD", "GI", "II", "IN"};
constexpr std::array<std::string_view, 8> heading_talkers{"HE", "HC", "HN", "GP", "GN", "TI", "II", "IN"};
constexpr std::array<std::string_view, 2> beidou_talkers{"GB", "BD"}, qzss_talkers{"GQ", "QZ"};
constexpr std::array<std::string_view, 2> station_fields{"", "0000"};
constexpr std::array<std::string_view, 4> rmc_statuses{"S", "C", "U", "V"};

void read_board_sentences(TableReader& rates, std::vector<firmware::SentenceRate>& sentences) {
    for (std::size_t i = 0; i < std::size(firmware::nmea_sentence_names); ++i) {
        int every = 0;
        rates.integer(firmware::nmea_sentence_names[i], every, {0, 255});
        if (every > 0) sentences.push_back({static_cast<firmware::NmeaSentence>(i), every});
    }
}

std::vector<std::string_view> sentence_names() {
    return {std::begin(firmware::nmea_sentence_names), std::end(firmware::nmea_sentence_names)};
}

// Sentences that tell an epoch of before, and how many before.
void read_late_sentences(TableReader& late, std::map<UbxMessageId, int>& epochs_of) {
    constexpr int most_epochs = 20;
    for (const std::string_view name : firmware::nmea_sentence_names) {
        int epochs = 0;
        late.integer(name, epochs, {0, most_epochs});
        if (epochs > 0) epochs_of[firmware::find_output_message(name)->id] = epochs;
    }
}

void read_own_line(TableReader& table, std::vector<firmware::OwnLine>& lines) {
    firmware::OwnLine line;
    const bool has_text = table.has("text");
    table.text("text", line.text);
    table.integer("every", line.every_epochs, {1, 255});
    if (const auto index = table.choice("after", sentence_names())) line.after = static_cast<NmeaSentence>(*index);
    if (table.recording()) return;
    if (!has_text) return table.mistake_here("has no text");
    if (const auto mistake = firmware::mistake_of_own_line(line.text)) table.mistake("text", *mistake);
    lines.push_back(std::move(line));
}

void read_one_of(TableReader& table, std::string_view key, std::span<const std::string_view> words,
                 std::string& value) {
    if (const auto index = table.choice(key, words, {}, value)) value = words[*index];
}

void read_board_style(TableReader& nmea, firmware::NmeaStyle& style) {
    nmea.integer("speed_decimals", style.speed_decimals, {0, 3});
    nmea.integer("course_decimals", style.course_decimals, {0, 3});
    nmea.boolean("course_always", style.course_always);
    nmea.boolean("satellites_padded", style.satellites_padded);
    nmea.integer("vtg_speed_decimals", style.vtg_speed_decimals, {-1, 5});
    nmea.integer("vtg_course_decimals", style.vtg_course_decimals, {-1, 5});
    nmea.integer("altitude_decimals", style.altitude_decimals, {0, 4});
    nmea.integer("dop_decimals", style.dop_decimals, {0, 3});
    nmea.number("unknown_dop", style.unknown_dop, {0, 9999});
    nmea.boolean("magnetic_fields", style.magnetic_fields);
    nmea.boolean("gsa_manual", style.gsa_manual);
    nmea.boolean("tracked_only", style.tracked_only);
    nmea.boolean("one_gsv_list", style.one_gsv_list);
    nmea.boolean("gst_ellipse", style.gst_ellipse);
    nmea.boolean("gst_padded", style.gst_padded);
    nmea.boolean("zeros_without_fix", style.zeros_without_fix);
    nmea.boolean("unknown_date_is_1980", style.unknown_date_is_1980);
    read_one_of(nmea, "rmc_status", rmc_statuses, style.rmc_status);
    read_one_of(nmea, "station_field", station_fields, style.station_field);
    read_one_of(nmea, "beidou_talker", beidou_talkers, style.beidou_talker);
    read_one_of(nmea, "qzss_talker", qzss_talkers, style.qzss_talker);
}

// What any receiver may do otherwise than all of ours so far.
void read_board_variety(TableReader& nmea, firmware::NmeaStyle& style) {
    nmea.word("heading",
              {{"antennas", HeadingSource::antennas},
               {"course", HeadingSource::course},
               {"attitude", HeadingSource::attitude}},
              style.heading);
    nmea.integer("heading_decimals", style.heading_decimals, {0, 4});
    nmea.text("heading_talker", style.heading_talker);
    if (!style.heading_talker.empty()) nmea.choice("heading_talker", heading_talkers);
    nmea.number("magnetic_variation_deg", style.magnetic_variation_deg, {-180, 180});
    nmea.word("quality",
              {{"solved", ToldQuality::solved},
               {"precise", ToldQuality::precise},
               {"manual", ToldQuality::manual},
               {"simulator", ToldQuality::simulator}},
              style.quality);
    nmea.boolean("simulated_is_valid", style.simulated_is_valid);
    nmea.word("gsa", {{"by_system", GsaStyle::by_system}, {"by_talker", GsaStyle::by_talker}, {"one", GsaStyle::one}},
              style.gsa);
    nmea.word("geoid_separation",
              {{"told", ToldGeoid::separation}, {"zero", ToldGeoid::zero}, {"empty", ToldGeoid::nothing}}, style.geoid);
}

// Of u-blox receivers version and talker are items of the configuration, which have no number for others. And lines go
// with sentences.
void refuse_what_makers_lack(TableReader& nmea, const BoardProfile& board) {
    if (nmea.recording()) return;
    const bool ublox = board.maker == MakerKind::ublox;
    if (ublox && board.nmea_version == NmeaVersion::v3_0)
        nmea.mistake("version", "is 3.0, which no u-blox receiver has; expected 2.1, 2.3, 4.0, 4.10 or 4.11");
    if (ublox && std::ranges::find(firmware::numbered_talkers, board.main_talker) == firmware::numbered_talkers.end())
        nmea.mistake(
            "main_talker",
            fmt::format("is '{}', which no u-blox receiver has; expected one of GP GL GA GB GQ GN", board.main_talker));
    if (!board.style.lines.empty() && !firmware::sends_sentences(board.maker))
        nmea.mistake("lines", fmt::format("has no effect: receivers of the personality \"{}\" send no sentences",
                                          firmware::maker_row(board.maker).name));
}

}  // namespace

void read_board_nmea(TableReader& nmea, firmware::BoardProfile& board) {
    nmea.word("version",
              {{"2.1", NmeaVersion::v2_1},
               {"2.3", NmeaVersion::v2_3},
               {"3.0", NmeaVersion::v3_0},
               {"4.0", NmeaVersion::v4_0},
               {"4.10", NmeaVersion::v4_10},
               {"4.11", NmeaVersion::v4_11}},
              board.nmea_version);
    nmea.word("satellite_numbering", {{"strict", NmeaNumbering::strict}, {"extended", NmeaNumbering::extended}},
              board.satellite_numbering);
    nmea.text("main_talker", board.main_talker);
    if (!board.main_talker.empty()) nmea.choice("main_talker", board_talkers);
    nmea.integer("coordinate_decimals", board.coordinate_decimals, {1, 8});
    nmea.integer("time_decimals", board.time_decimals, {0, 3});
    nmea.integer("max_listed_satellites", board.max_listed_satellites, {4, 99});
    nmea.quantity("course_min_speed_mps", board.course_min_speed, {0, 10});
    nmea.boolean("overflow_notice", board.quirks.overflow_notice);
    read_board_style(nmea, board.style);
    read_board_variety(nmea, board.style);
    nmea.table("sentences", [&](TableReader& rates) { read_board_sentences(rates, board.sentences); });
    nmea.table("late", [&](TableReader& late) { read_late_sentences(late, board.style.late); });
    nmea.tables("lines", {}, [&](TableReader& line) { read_own_line(line, board.style.lines); });
    refuse_what_makers_lack(nmea, board);
}

}  // namespace skyloop::inline run
