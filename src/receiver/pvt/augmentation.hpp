/// Corrections that SBAS satellites send.
#pragma once

#include <map>
#include <optional>
#include <span>

#include "base/geo/local_frame.hpp"
#include "receiver/pvt/sbas_data.hpp"
#include "receiver/pvt/single_point.hpp"
#include "world/flow/observations.hpp"
#include "world/flow/receiver_settings.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline receiver {

/// What a receiver makes of the messages of SBAS satellites, and whose corrections it uses: one satellite's, as long as
/// they serve for four satellites and reach to its zenith, then those of the one that has most.
///
/// State: what each satellite has told, the last two records of each corrected one, and whose corrections are used.
class Augmentation {
public:
    /// Messages since the last epoch, of SBAS satellites or others.
    void hear(std::span<const Subframe> messages, const ReceiverSettings& settings);

    struct Input {
        const NavigationSource& received;  ///< the records that the receiver knows
        const Observations& observations;
        const ReceiverSettings& settings;
        GpsTime time;
        std::optional<Geodetic> place{};  ///< where the receiver believes to be
    };
    /// An epoch; they come in ascending time.
    void begin(const Input& input);
    /// Takes the ionosphere of the grid off a range of that epoch, whatever its system, and what is told of its
    /// satellite, if anything is. Beyond the grid nothing.
    void correct(RangeEquation& equation) const;
    /// Whose corrections are used; nothing: nobody's.
    [[nodiscard]] const std::optional<SatelliteId>& source() const { return source_; }
    void reset() { *this = Augmentation(); }

private:
    struct Records {
        Ephemeris current;
        std::optional<Ephemeris> previous{};
    };
    void remember_records(const Input& input);
    [[nodiscard]] int served(const SbasData& data, const Input& input) const;
    // From the record that a transmitter is of to the one that is corrected; nothing: it is not known.
    [[nodiscard]] std::optional<Transmitter> moved_to(int iode, const RangeEquation& equation) const;

    std::map<SatelliteId, SbasData> satellites_;
    std::map<SatelliteId, Records> records_;
    std::optional<SatelliteId> source_;
    std::optional<LocalFrame> frame_;  // at the place of this epoch
    GpsTime time_;
};

}  // namespace skyloop::inline receiver
