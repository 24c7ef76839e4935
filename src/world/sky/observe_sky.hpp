/// From orbits and a place to what stands in the sky.
/// A signal's way from a moving transmitter to a moving receiver on the turning Earth.
/// Changes of broadcast records, and what they leave behind.
/// How far records are from the truth of precise products.
#pragma once

#include <Eigen/Core>

#include <map>
#include <optional>
#include <vector>

#include "base/core/units.hpp"
#include "base/geo/frames.hpp"
#include "base/geo/local_frame.hpp"
#include "world/flow/earlier_records.hpp"
#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/orbit.hpp"
#include "world/gnss/precise_truth.hpp"

namespace skyloop::inline world {

/// A point and how it moves in the Earth-fixed frame.
struct EcefMotion {
    Position<Ecef> position;
    Velocity<Ecef> velocity;
};

/// A point in the ECEF frame of the transmission instant, in that of the reception instant `travel_time` later:
/// Rz(ω_e τ), MODELS.md 3.4.
Position<Ecef> in_reception_frame(const Position<Ecef>& at_transmission, Seconds travel_time);

/// The derivative, by the travel time τ, of the range |Rz(ω_e τ) r_s(t − τ) − r_r(t)|.
/// @param transmitter at t − τ, in the frame of that instant
/// @param receiver at t
MetresPerSecond light_time_slope(const EcefMotion& transmitter, const Position<Ecef>& receiver, Seconds travel_time);

/// The derivative, by reception time, of the light-time range ρ = |Rz(ω_e τ) r_s(t − τ) − r_r(t)| with τ = ρ/c.
/// @param transmitter at transmission, in the frame of that instant
/// @param receiver at reception
MetresPerSecond light_time_range_rate(const EcefMotion& transmitter, const EcefMotion& receiver, Seconds travel_time);

/// A ray from a satellite to the antenna.
struct RecordRay {
    Eigen::Vector3d way;       ///< from the antenna to the satellite, in the frame of the reception, m
    Eigen::Vector3d velocity;  ///< of the satellite against the antenna, m/s
    Seconds travel_time;
};

/// Makes a smooth path of the records of a satellite, for models whose orbits are not quite those of the broadcast. A
/// record is the prediction of one upload and the next differs by decimetres to metres; the satellite itself knows
/// nothing of it. So the present record's range goes on from the one before, whose share falls to nothing in five
/// minutes by a cubic without a kink. Of steps above 10 m, as after a manoeuvre or of SBAS satellites that tell their
/// orbit by coarse parabolas, nothing is smoothed (our decisions).
///
/// State: the last changes of each satellite. They hang on the records alone: whoever looks first after a change sees
/// the same.
class RecordChanges {
public:
    /// @param record the one that serves its satellite at `now`
    EarlierRecords at(const Ephemeris& record, const NavigationSource& source, GpsTime now, const RecordRay& ray);

private:
    struct Change {
        GpsTime time;  ///< the first instant of the record behind it
        Ephemeris before;
    };
    struct Satellite {
        GpsTime looked;
        std::optional<Ephemeris> record;  ///< that served then
        std::vector<Change> changes;
        std::optional<GpsTime> jumped;
    };
    static void follow(Satellite& satellite, const Ephemeris& record, const NavigationSource& source, GpsTime now);
    static void find_changes(Satellite& satellite, SatelliteId id, const NavigationSource& source, GpsTime now);
    static void add_change(Satellite& satellite, const Change& change, const Ephemeris& after);

    std::map<SatelliteId, Satellite> satellites_;
};

/// Every satellite of `source` above the horizon at `truth.time`, with light time iterated and the Earth's rotation
/// during it (MODELS.md 3.4). Satellites without a valid record are absent.
/// @param precise where the satellites really are; null: where their records say. Satellites that it knows and cannot
/// tell of at this instant are absent, those that it does not know are not
SkyView observe_sky(const TruthState& truth, const NavigationSource& source, const PreciseTruth* precise = nullptr);

/// Gives what observe_sky() gives, faster when epochs follow each other: a satellite far below the horizon is not
/// looked at before it could have risen, and a GLONASS orbit is integrated from minute to minute, not from its record
/// each time.
///
/// State: when to look again at each satellite, GLONASS orbits at the last whole minute, and changes of records. A jump
/// in time or place makes it look at everything.
class SkyObserver {
public:
    /// @param precise as that of observe_sky(), which it outlives
    explicit SkyObserver(const PreciseTruth* precise = nullptr) : precise_(precise) {}
    /// @param source the same at every call
    SkyView observe(const TruthState& truth, const NavigationSource& source);

private:
    struct Satellite {
        SatelliteId id;
        GpsTime look_again;  ///< it stays below the horizon until then
    };
    void begin(const TruthState& truth, const NavigationSource& source);
    [[nodiscard]] std::optional<SatelliteInView> look(Satellite& satellite, const TruthState& truth,
                                                      const LocalFrame& local, const NavigationSource& source);

    const PreciseTruth* precise_;
    CarriedRecords carried_;
    RecordChanges changes_;
    std::vector<Satellite> satellites_;
    GpsTime last_time_;
    Position<Ecef> looked_from_;
};

}  // namespace skyloop::inline world
