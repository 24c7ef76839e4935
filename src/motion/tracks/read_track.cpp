// The formats of tracks. Files that hold no track though a reader of tables would try are refused by what they are, or
// by their name.
#include "motion/tracks/read_track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "base/core/words.hpp"
#include "detail/text_track.hpp"
#include "detail/track_formats.hpp"
#include "detail/xml_tree.hpp"
#include "motion/trajectory/track_csv.hpp"

namespace skyloop::inline motion {
namespace {

constexpr std::size_t other_looked_at = 65536;

bool is_utf16(std::string_view head) { return head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF"); }

// The first byte that no text has; Ctrl-Z ends old ones.
std::optional<std::size_t> binary_byte(std::string_view head) {
    const auto at = std::find_if(head.begin(), head.end(), [](char letter) {
        const auto byte = static_cast<unsigned char>(letter);
        return byte == 0x7F ||
               (byte < 0x20 && std::string_view("\t\n\v\f\r\x1A").find(letter) == std::string_view::npos);
    });
    return at == head.end() ? std::nullopt : std::optional(static_cast<std::size_t>(at - head.begin()));
}

// Flexible and Interoperable Data Transfer protocol, "FIT File Header": data type, bytes 8 to 11.
bool is_fit(std::string_view head) { return head.size() >= 12 && head.substr(8, 4) == ".FIT"; }

// RFC 7946; writers put "type" first or last.
bool is_geojson(std::string_view head) {
    constexpr std::array<std::string_view, 4> words{"\"FeatureCollection\"", "\"Feature\"", "\"LineString\"",
                                                    "\"coordinates\""};
    return trimmed_cell(head).starts_with('{') && std::any_of(words.begin(), words.end(), [&](std::string_view word) {
               return head.find(word) != std::string_view::npos;
           });
}

bool is_rinex(std::string_view head) {
    constexpr std::size_t label_column = 60;
    const std::string_view line = head.substr(0, head.find_first_of("\r\n"));
    if (line.size() <= label_column) return false;
    const std::string_view label = line.substr(label_column);
    return label.starts_with("RINEX VERSION / TYPE") || label.starts_with("CRINEX VERS");
}

// A line "$GPGGA,…" without "*hh".
bool is_unchecked_sentence(std::string_view line) {
    constexpr std::size_t address_end = 6;
    const std::string_view plain = trimmed_cell(line);
    if (plain.size() <= address_end || plain[0] != '$' || plain[address_end] != ',') return false;
    constexpr std::array<std::string_view, 5> kinds{"GGA", "RMC", "GLL", "GNS", "VTG"};
    const std::string_view kind = plain.substr(3, 3);
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end() && plain.find('*') == std::string_view::npos;
}

bool has_unchecked_sentences(std::string_view head) {
    TextLines lines(head);
    while (lines.next())
        if (is_unchecked_sentence(lines.line())) return true;
    return false;
}

// What the file is, and what was expected; empty: a table, for all that is known.
std::string what_it_is(std::string_view head) {
    if (is_utf16(head)) return "is text in UTF-16; expected UTF-8, which iconv -f UTF-16 -t UTF-8 makes of it";
    if (is_fit(head))
        return "is a FIT file; expected GPX or KML, which gpsbabel makes of it: " + gpsbabel_command("garmin_fit");
    if (const auto at = binary_byte(head))
        return fmt::format("is not text (byte {:#04x} at offset {}) and no log that is known; expected a track",
                           static_cast<unsigned char>(head[*at]), *at);
    if (is_geojson(head))
        return "is GeoJSON; expected GPX or KML. gpsbabel makes a route of it, without times and heights: " +
               gpsbabel_command("geojson");
    if (is_rinex(head)) return "is a RINEX file, which holds no track; skyloop solve makes fixes of RINEX observations";
    if (has_unchecked_sentences(head))
        return "holds NMEA sentences without a checksum, which are not read; expected …*hh behind each";
    if (head.find('\r') != std::string_view::npos && head.find('\n') == std::string_view::npos)
        return "has lines that end in CR alone; expected LF or CR LF, which tr '\\r' '\\n' makes of it";
    return {};
}

struct NamedFlightLog {
    std::string_view ending, expected;
};
constexpr std::array named_flight_logs{
    NamedFlightLog{".ulg", "a PX4 log, which begins with 55 4c 6f 67"},
    NamedFlightLog{".bin", "an ArduPilot log, which begins with a3 95"},
    NamedFlightLog{".tlog", "a MAVLink log, which begins with a time of eight bytes and fe or fd"},
    NamedFlightLog{".ubx", "a UBX log with NAV-PVT, NAV-PVAT, NAV-HPPOSLLH, NAV-POSLLH or NAV-SOL"}};

const NamedFlightLog* named_flight_log(const std::string& name) {
    const std::string lower = lower_case(name);
    const auto found = std::find_if(named_flight_logs.begin(), named_flight_logs.end(),
                                    [&](const NamedFlightLog& log) { return lower.ends_with(log.ending); });
    return found == named_flight_logs.end() ? nullptr : &*found;
}

}  // namespace

bool is_named_flight_log(const TrackFile& file) { return named_flight_log(file.name) != nullptr; }

Result<Track> refuse_flight_log(const TrackFile& file) {
    constexpr std::size_t most_shown = 8;
    std::string begin;
    for (const std::uint8_t byte : file.bytes.first(std::min(file.bytes.size(), most_shown)))
        begin += fmt::format("{}{:02x}", begin.empty() ? "" : " ", byte);
    return fail(ErrorCode::input,
                fmt::format("{}: {}; expected {}", file.name, begin.empty() ? "is empty" : "begins with " + begin,
                            named_flight_log(file.name)->expected));
}

std::string gpsbabel_command(std::string_view format) {
    return fmt::format("gpsbabel -t -i {} -f FILE -o gpx,gpxver=1.0 -F track.gpx", format);
}

bool is_other_file(const TrackFile& file) { return !what_it_is(file.text.substr(0, other_looked_at)).empty(); }

Result<Track> refuse_other_file(const TrackFile& file) {
    return fail(ErrorCode::input, fmt::format("{}: {}", file.name, what_it_is(file.text.substr(0, other_looked_at))));
}

namespace {

// One format. Formats are tried in the order of the table.
struct TrackFormat {
    std::array<std::string_view, 3> endings;  // with their dots; empty ones count for nothing
    bool (*fits)(const TrackFile&);           // by the content
    Result<Track> (*read)(const TrackFile&);
};

Result<Track> read_csv(const TrackFile& file) {
    return read_track_csv(file.text, file.name, file.reading.geoid, file.reading.origin);
}

// By the root of XML; a file in another encoding than UTF-8 shows none, and is told by its ending.
bool is_xml_of(const TrackFile& file, std::string_view root, std::string_view ending) {
    const std::string_view name = xml_root_name(file.text);
    return name.empty() ? lower_case(file.name).ends_with(ending) : name == root;
}

bool is_kmz(const TrackFile& file) { return file.text.starts_with("PK\x03\x04"); }

bool is_other_xml(const TrackFile& file) { return !xml_root_name(file.text).empty(); }

Result<Track> refuse_xml(const TrackFile& file) {
    return fail(
        ErrorCode::input,
        fmt::format("{}: XML whose root is <{}>; expected <gpx> or <kml>, which gpsbabel makes of most others: {}",
                    file.name, one_line_of(std::string(xml_root_name(file.text))), gpsbabel_command("FORMAT")));
}

constexpr TrackFormat formats[] = {
    {{".ulg", "", ""}, is_ulog_track, read_ulog_track},
    {{".bin", "", ""}, is_dataflash_track, read_dataflash_track},
    {{".tlog", "", ""}, is_tlog, read_tlog},
    {{".ubx", ".sbf"}, is_message_track, read_observed_track},
    {{".plan"}, is_qgc_plan, read_qgc_plan},
    {{".waypoints"}, is_wpl, read_wpl},
    {{".gpx"}, [](const TrackFile& file) { return is_xml_of(file, "gpx", ".gpx"); }, read_gpx},
    {{".kml"}, [](const TrackFile& file) { return is_xml_of(file, "kml", ".kml"); }, read_kml},
    {{}, is_other_xml, refuse_xml},
    {{".kmz"}, is_kmz, read_kmz},
    {{".igc"}, is_igc, read_igc},
    {{".pos"}, is_solution_track, read_observed_track},
    {{}, is_table_dialect, read_table_dialect},
    {{".nmea", ".log"}, is_sentence_track, read_observed_track},
    {{"", "", ""}, is_named_flight_log, refuse_flight_log},
    {{"", "", ""}, is_other_file, refuse_other_file},
    {{".csv", ".txt", ""}, [](const TrackFile&) { return true; }, read_csv},
};

const TrackFormat& format_of(const TrackFile& file) {
    return *std::find_if(std::begin(formats), std::end(formats) - 1,
                         [&](const TrackFormat& candidate) { return candidate.fits(file); });
}

TrackFile track_file(ByteSpan bytes, const std::string& name, const TrackReading& reading) {
    constexpr std::array<std::uint8_t, 3> byte_order_mark{0xEF, 0xBB, 0xBF};
    if (bytes.size() >= byte_order_mark.size() &&
        std::equal(byte_order_mark.begin(), byte_order_mark.end(), bytes.begin()))
        bytes = bytes.subspan(byte_order_mark.size());
    return {bytes, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name, reading};
}

}  // namespace

Result<Track> read_track(ByteSpan bytes, const std::string& name, const TrackReading& reading) {
    const TrackFile file = track_file(bytes, name, reading);
    Result<Track> track = format_of(file).read(file);
    if (track) find_useless_times(*track);
    return track;
}

bool is_track(ByteSpan bytes, const std::string& name) {
    const TrackReading reading;
    const auto read = format_of(track_file(bytes, name, reading)).read;
    return read != read_csv && read != refuse_other_file && read != refuse_flight_log;
}

}  // namespace skyloop::inline motion
