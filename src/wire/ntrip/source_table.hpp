/// The source table of a caster: which mount points there are (RTCM 10410.0, section 5; RTCM 10410.1, section 3.2).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace skyloop::inline wire {

/// A record STR: one mount point.
struct SourceRecord {
    std::string mount;
    std::string identifier;           ///< of the source, for people
    std::string format = "RTCM 3.3";  ///< "RTCM 3.3"
    std::string details;              ///< messages with their intervals in seconds: "1005(10),1077(1)"
    int carrier = 0;                  ///< phases: 0 none, 1 of L1, 2 of L1 and L2
    std::string systems;              ///< "GPS+GLO"
    double latitude_deg = 0, longitude_deg = 0;
    bool wants_position = false;  ///< clients have to say where they are
    bool network = false;         ///< made from several base stations, rather than by one
    bool needs_password = false;
    int bit_rate = 0;  ///< bit/s
};
/// With the end of the line. Semicolons and ends of lines in texts become blanks.
std::string source_line(const SourceRecord& record);
/// The whole table, ENDSOURCETABLE with it. @param lines of source_line()
std::string source_table(const std::vector<std::string>& lines);
/// The mount points of a table that another caster has sent, whole or cut.
std::vector<std::string> mounts_of(std::string_view table);

}  // namespace skyloop::inline wire
