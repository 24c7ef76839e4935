#include "motion/tracks/read_track.hpp"
#include "base/core/letter_case.hpp"

#include "detail/track_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "detail/text_track.hpp"
#include "detail/xml_tree.hpp"
#include "motion/trajectory/track_csv.hpp"

namespace skyloop {
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

std::vector<std::string_view> track_endings() {
    std::vector<std::string_view> endings;
    for (const TrackFormat& format : formats)
        for (const std::string_view ending : format.endings)
            if (!ending.empty()) endings.push_back(ending);
    return endings;
}

}  // namespace skyloop
