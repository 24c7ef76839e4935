/// Corrections that a client hands in as RTCM 3.
#pragma once

#include <optional>
#include <vector>

#include "firmware/board_profile.hpp"
#include "firmware/config/config_store.hpp"
#include "firmware/navigation_state.hpp"
#include "skyloop/base/bytes.hpp"
#include "skyloop/time/gps_time.hpp"

namespace skyloop::firmware {

/// From RTCM frames to the state of the corrected solution: differential one epoch after the first complete set
/// (observations and a station's position, same station), float and fixed after times of their own, back again with
/// age (RECEIVER.md 4.12). State: what came when.
class CorrectionInput {
public:
    /// One frame whose CRC held. Gives the RXM-RTCM frame that answers it.
    Bytes take(ByteSpan frame, GpsTime now);
    /// What a solution at `now` can be. @param store for CFG-NAVHPG-DGNSSMODE and the time-out
    [[nodiscard]] CorrectionStatus status(GpsTime now, const ConfigStore& store) const;
    void reset() { *this = {}; }

private:
    struct Station {
        int id = 0;
        std::optional<GpsTime> observations, position, complete_since;
    };
    std::optional<Station> station_;
    std::vector<int> recent_types_;
};

}  // namespace skyloop::firmware
