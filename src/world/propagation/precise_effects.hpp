/// What reaches millimetres, beside precise orbits and clocks: phase centres of antennas.
/// The phase that antennas make which turn against each other.
/// The solid Earth's tides.
#pragma once

#include <Eigen/Core>

#include <memory>
#include <optional>

#include "world/gnss/antenna_calibration.hpp"
#include "world/propagation/modern_parameters.hpp"
#include "world/propagation/per_satellite.hpp"
#include "world/propagation/propagation_effect.hpp"

namespace skyloop::inline world {

/// Writes what the phase centres of the satellites' antennas add to the range from the centre of mass, of satellites
/// whose truth is that of precise products: offsets in the axes of yaw_steering(), variations by the nadir angle.
class SatelliteAntennaPhase : public PropagationEffect {
public:
    SatelliteAntennaPhase(std::shared_ptr<const AntennaCatalogue> catalogue, const ErrorTerm& term)
        : catalogue_(std::move(catalogue)), term_(term) {}
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    std::shared_ptr<const AntennaCatalogue> catalogue_;
    ErrorTerm term_;
};

/// Writes what the phase centre of the receiver's antenna adds to the range to its reference point. The antenna is
/// level and its north mark looks north.
class ReceiverAntennaPhase : public PropagationEffect {
public:
    ReceiverAntennaPhase(AntennaCalibration antenna, const ErrorTerm& term)
        : antenna_(std::move(antenna)), term_(term) {}
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    AntennaCalibration antenna_;
    ErrorTerm term_;
};

/// The phase of a right-hand circularly polarised wave between a satellite that steers its yaw and an antenna whose
/// dipoles look north and west, cycles within ±0.5 (J. Wu et al. (1993), Effects of antenna orientation on GPS carrier
/// phase, Manuscripta Geodaetica 18, 91-98, equations 27 to 30).
/// @param satellite and `antenna` in one frame, as is `sun`; @param north of the antenna; west is across it and the ray
double wind_up_cycles(const Position<Ecef>& satellite, const Position<Ecef>& antenna, const Geodetic& place,
                      const Position<Ecef>& sun);

/// Writes wind_up_cycles(), carried on over whole cycles.
///
/// State: the last value of each satellite.
class CarrierWindUp : public PropagationEffect {
public:
    explicit CarrierWindUp(const ErrorTerm& term) : term_(term) {}
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    ErrorTerm term_;
    PerSatellite<std::optional<double>> cycles_;
};

/// What raises tides.
struct TideRaisers {
    Position<Ecef> sun, moon;
    Angle sidereal_time;  ///< of Greenwich
    /// By sun_position(), moon_position() and sidereal_time().
    static TideRaisers at(GpsTime time);
};

/// Where the tides of the solid Earth move a place on the ground: IERS Conventions (2010), Technical Note 36, 7.1.1.1,
/// step 1 with real nominal Love numbers of degree 2 (h 0.6078, l 0.0847 with their latitude terms) and 3 (equations
/// 7.5 and 7.6), and of step 2 the largest term, K1 in the height (J. Kouba (2009), A Guide to Using International GNSS
/// Service (IGS) Products, 5.2.1). Left out are terms of millimetres: out-of-phase parts and the other frequencies. The
/// permanent part is in it, as coordinates of the ITRF, which are "tide free", ask for.
Displacement<Ecef> solid_tide(const Position<Ecef>& place, const TideRaisers& raisers);

/// Writes what solid_tide() of the antenna's place adds to each range.
class SolidTideEffect : public PropagationEffect {
public:
    explicit SolidTideEffect(const ErrorTerm& term) : term_(term) {}
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    ErrorTerm term_;
};

}  // namespace skyloop::inline world
