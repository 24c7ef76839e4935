/// Where a satellite was when it sent, and what its clock showed.
#pragma once

#include <optional>

#include "base/geo/frames.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/orbit.hpp"
#include "world/gnss/precise_orbits.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline receiver {

/// A satellite at the instant of transmission, in the ECEF frame of that instant.
struct Transmitter {
    Position<Ecef> position;
    Velocity<Ecef> velocity;
    Seconds clock_bias;      ///< satellite clock − GPST, relativity included, less the signal's group delay
    double clock_drift = 0;  ///< s/s
    bool healthy = true;
    Metres accuracy;  ///< of orbit and clock as broadcast, 1 σ; 0: not told
};

/// Orbits and clocks as a receiver needs them: by what it measured.
class TransmitterSource {
public:
    virtual ~TransmitterSource() = default;
    /// The transmission took place at receive_time − P/c − clock bias in GPST, to better than 1e-12 s.
    /// @param receive_time by the receiver's clock  @param pseudorange as measured at that reading
    /// @return nothing where no orbit, clock or group delay is known
    virtual std::optional<Transmitter> at(SatelliteId satellite, Signal signal, GpsTime receive_time,
                                          Metres pseudorange) = 0;
};

/// What a group delay is that the broadcast does not tell, as that of GPS L5.
enum class UntoldDelay {
    unknown,  ///< as of real satellites
    none,     ///< 0, as of emulated ones (sent_group_delay())
};

/// By broadcast records.
///
/// State: GLONASS records near the present.
class BroadcastTransmitters : public TransmitterSource {
public:
    /// @param source outlives this
    explicit BroadcastTransmitters(const NavigationSource& source, UntoldDelay untold = UntoldDelay::unknown)
        : source_(source), untold_(untold) {}
    /// The instant at which records are chosen from the source; else it is that of transmission.
    void choose_records_at(GpsTime time) { choice_ = time; }
    std::optional<Transmitter> at(SatelliteId satellite, Signal signal, GpsTime receive_time,
                                  Metres pseudorange) override;

private:
    const NavigationSource& source_;
    UntoldDelay untold_;
    std::optional<GpsTime> choice_;
    CarriedRecords carried_;
};

/// By tables of positions and clocks; their clocks get the eccentricity term −2 r·v/c² (IS-GPS-200, 20.3.3.3.3.1).
class PreciseTransmitters : public TransmitterSource {
public:
    /// @param group_delays of single signals (table_group_delay()) and health; may be absent: then 0, which is wrong by
    /// tens of metres for BeiDou, and healthy
    PreciseTransmitters(const PreciseOrbits& orbits, const NavigationSource* group_delays)
        : orbits_(orbits), group_delays_(group_delays) {}
    std::optional<Transmitter> at(SatelliteId satellite, Signal signal, GpsTime receive_time,
                                  Metres pseudorange) override;

private:
    const PreciseOrbits& orbits_;
    const NavigationSource* group_delays_;
};

/// The transmitter `span` later (or earlier): at most a few milliseconds.
Transmitter moved(const Transmitter& transmitter, Seconds span);

}  // namespace skyloop::inline receiver
