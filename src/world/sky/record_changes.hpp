/// Changes of broadcast records, and what they leave behind.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

#include "world/flow/earlier_records.hpp"
#include "world/gnss/navigation_source.hpp"

namespace skyloop {

/// A ray from a satellite to the antenna.
struct RecordRay {
    Eigen::Vector3d way;       ///< from the antenna to the satellite, in the frame of the reception, m
    Eigen::Vector3d velocity;  ///< of the satellite against the antenna, m/s
    Seconds travel_time;
};

/// Makes a smooth path of the records of a satellite, for models whose orbits are not quite those of the broadcast. A
/// record is the prediction of one upload and the next differs by decimetres to metres; the satellite itself knows
/// nothing of it. So the present record's range goes on from the one before, whose share falls to nothing in five
/// minutes by a cubic without a kink. Of steps above 10 m, as after a manoeuvre or of SBAS satellites that tell their
/// orbit by coarse parabolas, nothing is smoothed (our decisions).
///
/// State: the last changes of each satellite. They hang on the records alone: whoever looks first after a change sees
/// the same.
class RecordChanges {
public:
    /// @param record the one that serves its satellite at `now`
    EarlierRecords at(const Ephemeris& record, const NavigationSource& source, GpsTime now, const RecordRay& ray);

private:
    struct Change {
        GpsTime time;  ///< the first instant of the record behind it
        Ephemeris before;
    };
    struct Satellite {
        GpsTime looked;
        std::optional<Ephemeris> record;  ///< that served then
        std::vector<Change> changes;
        std::optional<GpsTime> jumped;
    };
    static void follow(Satellite& satellite, const Ephemeris& record, const NavigationSource& source, GpsTime now);
    static void find_changes(Satellite& satellite, SatelliteId id, const NavigationSource& source, GpsTime now);
    static void add_change(Satellite& satellite, const Change& change, const Ephemeris& after);

    std::map<SatelliteId, Satellite> satellites_;
};

}  // namespace skyloop
