/// Corrections that a client hands in as RTCM 3.
#pragma once

#include <cstdint>
#include <optional>

#include "base/core/bytes.hpp"
#include "base/geo/frames.hpp"
#include "base/time/gps_time.hpp"
#include "firmware/core/board_profile.hpp"
#include "firmware/core/navigation_state.hpp"

namespace skyloop::firmware {

/// What is told of one frame of corrections.
struct CorrectionAnswer {
    Bytes rtcm;  ///< RXM-RTCM
    Bytes cor;   ///< RXM-COR
};

/// From RTCM frames to the state of the corrected solution: differential at the first epoch after the first complete
/// set (observations and a station's position, same station), float and fixed after times of their own, back again with
/// age (RECEIVER.md 4.12). After a silence beyond the time-out it begins anew, with the position that is known. One
/// station is followed; another one takes its place when it has been silent for ten seconds or was never complete.
/// State: what came when.
class CorrectionInput {
public:
    explicit CorrectionInput(const CorrectionAbility& ability = {}) : ability_(ability) {}

    /// One frame whose CRC held. Used are observations and positions of the station that is followed, GLONASS biases
    /// and descriptions.
    CorrectionAnswer take(ByteSpan frame, GpsTime now, const CorrectionLimits& limits = {});
    /// What is told of a frame whose CRC did not hold: what it was is not known.
    [[nodiscard]] static CorrectionAnswer answer_to_damaged();
    /// What a solution at `now` can be.
    [[nodiscard]] CorrectionStatus status(GpsTime now, const CorrectionLimits& limits) const;
    void reset() { *this = CorrectionInput(ability_); }

private:
    struct Station {
        int id = 0;
        std::optional<GpsTime> observations, complete_since;
        std::optional<Position<Ecef>> position;
        std::optional<GpsTime> resumed;  // after a silence in which fixed ambiguities were lost
    };
    bool follow(int station, GpsTime now);
    void take_observations(GpsTime now, const CorrectionLimits& limits);

    CorrectionAbility ability_;
    std::optional<Station> station_;
};

}  // namespace skyloop::firmware
