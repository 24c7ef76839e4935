/// What a virtual reference station measures.
/// Where a client of a caster is, and where the virtual reference station of such a client stands.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string_view>

#include "base/core/result.hpp"
#include "base/geo/geodetic.hpp"
#include "base/geo/geoid.hpp"
#include "run/emulator/data_folders.hpp"
#include "run/scenario/scenario.hpp"
#include "world/flow/observations.hpp"
#include "world/flow/receiver_settings.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/precise_truth.hpp"

namespace skyloop::inline run {

/// What a GGA sentence says of its receiver's place.
struct ClientPlace {
    Angle latitude;
    Angle longitude;
    MslHeight height{};
    std::optional<Metres> undulation{};  ///< of the geoid; nothing: the sentence has none, or one that cannot be
};
/// Nothing of other sentences, without a fix (quality 0), and for heights that are not −1 to 20 km: no network serves
/// them. A sentence without a height is at sea level.
std::optional<ClientPlace> client_place(std::string_view gga);

/// The place on the ellipsoid. @param geoid of the undulation where the client tells none; null: 0
Geodetic on_ellipsoid(const ClientPlace& place, const Geoid* geoid);

/// Where the station of a client stands: a corner of a grid of 5 m beside it, 3 to 11 m towards the north east, and
/// within 3 m of its height. A client whose position wanders by less is given the same place again, and none the place
/// of its own antenna, where a baseline of no length would hide what a rover makes wrong. Within 1.1 km of a pole the
/// station stands on the parallel of 89.99°.
Geodetic station_place(const Geodetic& client);

/// The antenna of a virtual reference station, and the receiver behind it.
///
/// State: what the effects, the observer of the sky and the channels of the receiver keep.
class VirtualAntenna {
public:
    class Parts;
    explicit VirtualAntenna(std::unique_ptr<Parts> parts);
    ~VirtualAntenna();

    /// Instants ascend. The clock of the receiver is that of GPS.
    Observations observe(GpsTime time);
    [[nodiscard]] const Position<Ecef>& position() const;

private:
    std::unique_ptr<Parts> parts_;
};

/// The sky of a run as a geodetic antenna in the open hears it, wherever it stands: satellites, orbits, clocks and air
/// of the run, and nothing of the surroundings, jammers and faults of its receivers. What a network sends for a virtual
/// station are the observations of a real one, moved there with the air between (Landau, Vollath and Chen 2002, Virtual
/// Reference Station Systems, Journal of Global Positioning Systems 1(2), 137-143): they have the noise of a geodetic
/// receiver's loops, of preset "survey". That its multipath, clock and cycle slips are gone, and that the air between
/// is known without error, are our decisions.
class VirtualSky {
public:
    /// What lies outside the scenario. All of it outlives sky and antennas.
    struct World {
        const NavigationSource& navigation;
        const Geoid* geoid = nullptr;  ///< null: heights above the sea are those above the ellipsoid
        GpsTime start;                 ///< of the run
        DataFolders data;
        std::shared_ptr<const PreciseTruth> precise{};  ///< null: records are the truth
    };
    /// Fails with `usage` for a sensor model, with which nothing is measured; with `input` where a file that the air is
    /// made from is missing or does not fit the run.
    static Result<VirtualSky> of(const Scenario& scenario, const World& world);

    /// @param seed of the noise of its receiver
    [[nodiscard]] Result<std::unique_ptr<VirtualAntenna>> antenna(const Geodetic& place, std::uint64_t seed) const;
    /// That are observed: all of the run's systems.
    [[nodiscard]] const std::set<SystemSignal>& signals() const;
    [[nodiscard]] const Geoid* geoid() const;

private:
    struct Ground;
    explicit VirtualSky(std::shared_ptr<const Ground> ground) : ground_(std::move(ground)) {}
    std::shared_ptr<const Ground> ground_;
};

}  // namespace skyloop::inline run
