/// From orbits and a place to what stands in the sky.
#pragma once

#include <vector>

#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"
#include "world/gnss/carried_records.hpp"
#include "world/gnss/navigation_source.hpp"
#include "world/sky/record_changes.hpp"

namespace skyloop {

/// Every satellite of `source` above the horizon at `truth.time`, with light time iterated and the Earth's rotation
/// during it (MODELS.md 3.4). Satellites without a valid record are absent.
SkyView observe_sky(const TruthState& truth, const NavigationSource& source);

/// Gives what observe_sky() gives, faster when epochs follow each other: a satellite far below the horizon is not
/// looked at before it could have risen, and a GLONASS orbit is integrated from minute to minute, not from its record
/// each time.
///
/// State: when to look again at each satellite, GLONASS orbits at the last whole minute, and changes of records. A jump
/// in time or place makes it look at everything.
class SkyObserver {
public:
    /// @param source the same at every call
    SkyView observe(const TruthState& truth, const NavigationSource& source);

private:
    struct Satellite {
        SatelliteId id;
        GpsTime look_again;  ///< it stays below the horizon until then
    };
    void begin(const TruthState& truth, const NavigationSource& source);

    CarriedRecords carried_;
    RecordChanges changes_;
    std::vector<Satellite> satellites_;
    GpsTime last_time_;
    Position<Ecef> looked_from_;
};

}  // namespace skyloop
