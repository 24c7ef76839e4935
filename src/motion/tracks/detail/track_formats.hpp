// The readers of single formats: one function each, listed in read_track.cpp.
#pragma once

#include "motion/tracks/read_track.hpp"

namespace skyloop::inline motion {

// The whole file, and what its reader needs to know.
struct TrackFile {
    ByteSpan bytes;
    std::string_view text;  // the same
    const std::string& name;
    const TrackReading& reading;
};

Result<Track> read_gpx(const TrackFile& file);
Result<Track> read_kml(const TrackFile& file);
Result<Track> read_kmz(const TrackFile& file);
bool is_qgc_plan(const TrackFile& file);
Result<Track> read_qgc_plan(const TrackFile& file);
bool is_wpl(const TrackFile& file);
Result<Track> read_wpl(const TrackFile& file);
bool is_igc(const TrackFile& file);
Result<Track> read_igc(const TrackFile& file);
bool is_table_dialect(const TrackFile& file);
Result<Track> read_table_dialect(const TrackFile& file);
bool is_ulog_track(const TrackFile& file);
Result<Track> read_ulog_track(const TrackFile& file);
bool is_dataflash_track(const TrackFile& file);
Result<Track> read_dataflash_track(const TrackFile& file);
bool is_tlog(const TrackFile& file);
Result<Track> read_tlog(const TrackFile& file);
// Receivers' messages, solutions of RTKLIB, and NMEA sentences.
bool is_message_track(const TrackFile& file);
bool is_solution_track(const TrackFile& file);
bool is_sentence_track(const TrackFile& file);
Result<Track> read_observed_track(const TrackFile& file);
// A file that no format knows by its content and whose name says that it is one of these logs.
bool is_named_flight_log(const TrackFile& file);
Result<Track> refuse_flight_log(const TrackFile& file);
// A file that is known to hold no track, whatever a reader of tables would find in it.
bool is_other_file(const TrackFile& file);
Result<Track> refuse_other_file(const TrackFile& file);
// How a track of another format becomes one that is read. @param format as gpsbabel calls it
std::string gpsbabel_command(std::string_view format);

}  // namespace skyloop::inline motion
