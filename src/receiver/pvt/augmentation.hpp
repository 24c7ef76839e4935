/// Corrections that SBAS satellites send.
#pragma once

#include <map>
#include <optional>

#include "base/geo/geodetic.hpp"
#include "world/flow/observations.hpp"
#include "world/flow/receiver_settings.hpp"
#include "world/gnss/sbas_service.hpp"

namespace skyloop::inline receiver {

/// Whether a receiver has the corrections of an SBAS system at hand.
///
/// State: since when each satellite of the systems has been tracked, and when one last served.
class Augmentation {
public:
    /// An epoch; they come in ascending time. @param place where the receiver believes to be
    void update(const Observations& observations, const ReceiverSettings& settings,
                const std::optional<Geodetic>& place);
    [[nodiscard]] bool serves() const { return serves_; }
    void reset() { *this = Augmentation(); }

private:
    std::map<SatelliteId, GpsTime> tracked_since_;
    std::optional<GpsTime> served_;
    bool serves_ = false;
};

}  // namespace skyloop::inline receiver
