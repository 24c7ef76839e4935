/// Faults that hit corrections on a wire: RTCM 3 messages that are missing or tell something else.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/bytes.hpp"
#include "base/core/random.hpp"
#include "base/time/gps_time.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "run/fault/correction_conditions.hpp"

namespace skyloop::inline run {

/// What becomes of whole messages, but for their delay.
///
/// State: epochs that have passed, and the messages of the one that stays.
class CorrectionDamage {
public:
    CorrectionDamage(std::uint64_t seed, const std::string& stream);

    void set(const CorrectionConditions& conditions);
    [[nodiscard]] bool active() const { return active_; }
    /// @param frame with a right CRC  @return empty: it is missing
    Bytes change(Bytes frame, GpsTime now);

private:
    [[nodiscard]] bool is_due(GpsTime epoch);
    Bytes frozen(Bytes frame, int number, GpsTime epoch);
    [[nodiscard]] Position<Ecef> told(const Position<Ecef>& place, GpsTime now) const;
    [[nodiscard]] Bytes with_place_changed(const Rtcm3Message& message, Bytes frame, GpsTime now) const;
    [[nodiscard]] Bytes with_multipath(const Rtcm3Message& message, Bytes frame, GpsTime now) const;
    [[nodiscard]] double multipath(std::string_view of, int number, int satellite, GpsTime now) const;

    CorrectionConditions conditions_;
    bool active_ = false;
    RandomStream losses_;
    std::uint64_t seed_;
    std::string stream_;
    std::optional<GpsTime> passed_;       // the last epoch that did
    std::optional<GpsTime> cut_;          // the epoch that may have begun before
    std::optional<GpsTime> kept_;         // the one that stays
    std::map<int, Bytes> kept_messages_;  // of it, by number
};

}  // namespace skyloop::inline run
