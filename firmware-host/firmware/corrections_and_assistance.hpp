/// Corrections that a client hands in as RTCM 3.
/// What a u-blox receiver says to assistance, UBX class MGA.
#pragma once

#include <cstdint>
#include <optional>

#include "base/core/bytes.hpp"
#include "base/geo/frames.hpp"
#include "base/time/gps_time.hpp"
#include "firmware/board_profile.hpp"
#include "firmware/config/config_store.hpp"
#include "firmware/navigation_state.hpp"
#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop::firmware {

/// What a receiver's configuration allows of corrections.
struct CorrectionLimits {
    Seconds timeout{60};      ///< of differential corrections (CFG-NAVSPG-CONSTR_DGNSSTO)
    bool float_only = false;  ///< ambiguities are not fixed (CFG-NAVHPG-DGNSSMODE 2)

    /// As configured; the values above where the receiver does not have an item.
    static CorrectionLimits of(const ConfigStore& store) {
        CorrectionLimits limits;
        if (store.has(key::navspg_dgnss_timeout))
            limits.timeout = Seconds(static_cast<double>(store.value(key::navspg_dgnss_timeout)));
        constexpr std::uint64_t rtk_float = 2;
        limits.float_only = store.has(key::navhpg_dgnssmode) && store.value(key::navhpg_dgnssmode) == rtk_float;
        return limits;
    }
};

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
    [[nodiscard]] CorrectionStatus status(GpsTime now, const ConfigStore& store) const {
        return status(now, CorrectionLimits::of(store));
    }
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

/// infoCode of MGA-ACK-DATA0 (u-blox M8 interface description, 32.16.1). There are 4, not stored, and 5, not ready,
/// too.
enum class AssistanceInfo : std::uint8_t {
    accepted = 0,
    time_unknown = 1,
    other_version = 2,
    wrong_size = 3,
    unknown_type = 6
};

/// Whether a message would be used. @param time_known ephemerides, almanacs and AssistNow Offline need the time
AssistanceInfo judge_assistance(const UbxFrameView& frame, bool time_known);

/// Whether it tells the time: MGA-INI-TIME_UTC and TIME_GNSS.
bool tells_time(const UbxFrameView& frame);

}  // namespace skyloop::firmware
