// What one start of ArduPilot has logged of its places.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "flight_log.hpp"
#include "receiver/observed/dataflash.hpp"

namespace skyloop::inline motion {

// A place in metres from an origin, north, east, down, and the velocity there.
struct LocalSample {
    std::int64_t ns = 0;
    std::optional<Eigen::Vector3d> place;
    std::optional<Eigen::Vector3d> velocity;
};

// Rows of a filter, or of a simulation, that writes its places twice: finely in metres from an origin, and coarsely as
// 1e-7 degrees. The origin follows from both; where they do not agree, the degrees count, with the velocity of the
// metres. Without degrees the rows need `origin`.
std::vector<FlightRow> joined_rows(const std::vector<GlobalSample>& globals, const std::vector<LocalSample>& locals,
                                   const std::optional<GlobalSample>& origin);

// Of a filter's core.
struct DataflashCore {
    std::vector<LocalSample> places;
    AttitudeSeries angles, quaternions;
};
// One receiver's.
struct DataflashReceiver {
    struct Epoch {
        FlightRow row;
        std::optional<std::int64_t> gps_ns;
    };
    std::vector<Epoch> epochs;
    std::vector<std::int64_t> undulations_mm;
};

// One start of the autopilot.
struct DataflashStart {
    std::vector<GlobalSample> simulated, estimated;
    std::vector<LocalSample> simulated_motion;
    std::map<std::pair<std::string, int>, DataflashCore> cores;  // by "XKF1" or "NKF1" and number
    std::map<int, std::size_t> primary;                          // how often which core was
    std::map<int, DataflashReceiver> receivers;
    std::optional<GlobalSample> origin;
    AttitudeSeries simulated_turns, turns;
    std::vector<std::int64_t> offsets_3d, offsets;  // GPS time less the autopilot's clock

    void take(const DataflashRecord& record, std::int64_t ns);

private:
    void take_simulation(const DataflashRecord& record, std::int64_t ns);
    void take_filter(const DataflashRecord& record, std::int64_t ns);
    void take_receiver(const DataflashRecord& record, std::int64_t ns);
};

}  // namespace skyloop::inline motion
