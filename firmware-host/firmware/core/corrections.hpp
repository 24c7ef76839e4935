/// Corrections that a client hands in as RTCM 3.
#pragma once

#include <cstdint>
#include <optional>

#include "base/core/bytes.hpp"
#include "base/geo/frames.hpp"
#include "base/time/gps_time.hpp"
#include "firmware/core/board_profile.hpp"
#include "firmware/core/navigation_state.hpp"
#include "firmware/core/reference_data.hpp"
#include "world/flow/reference_station.hpp"

namespace skyloop::firmware {

/// What is told of one frame of corrections.
struct CorrectionAnswer {
    Bytes rtcm;  ///< RXM-RTCM
    Bytes cor;   ///< RXM-COR
};

/// From RTCM frames to what the receiver may do with them. One station is followed; another one takes its place when it
/// has been silent for ten seconds or was never complete: observations and a position of the same station.
/// State: what came when, and the station's data.
class CorrectionInput {
public:
    explicit CorrectionInput(const CorrectionAbility& ability = {}) : ability_(ability) {}

    /// One frame whose CRC held. Used are observations and positions of the station that is followed, GLONASS biases
    /// and descriptions. @param leap_seconds GPST − UTC, for the times of GLONASS
    CorrectionAnswer take(ByteSpan frame, GpsTime now, int leap_seconds = 18);
    /// What is told of a frame whose CRC did not hold: what it was is not known.
    [[nodiscard]] static CorrectionAnswer answer_to_damaged();
    /// What came in, and what it would make of a solution that measures nothing: differential at once, float and fixed
    /// after times of the board's own, and back again with age.
    [[nodiscard]] CorrectionStatus status(GpsTime now, const CorrectionLimits& limits) const;
    /// What a receiver that measures gets to solve with.
    [[nodiscard]] Corrections usable(GpsTime now, const CorrectionLimits& limits) const;
    void reset() { *this = CorrectionInput(ability_); }

private:
    struct Station {
        explicit Station(int number) : id(number), data(number) {}
        int id;
        ReferenceData data;
        std::optional<Position<Ecef>> position;
        std::optional<GpsTime> heard;           // observations, last
        std::optional<GpsTime> complete_since;  // position and observations
    };
    bool follow(int station, GpsTime now);

    CorrectionAbility ability_;
    std::optional<Station> station_;
};

}  // namespace skyloop::firmware
