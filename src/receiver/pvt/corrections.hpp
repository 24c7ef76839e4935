/// The delays that a receiver takes off its pseudoranges.
#pragma once

#include <optional>

#include "base/geo/geodetic.hpp"
#include "base/geo/geoid.hpp"
#include "base/time/utc_time.hpp"
#include "receiver/pvt/navigation_parameters.hpp"
#include "world/gnss/atmosphere.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/shell_ionosphere.hpp"

namespace skyloop::inline receiver {

/// Coefficients of an ordinary day, those of GPS on 2004-01-01, for a receiver that has heard none.
const KlobucharCoefficients& default_klobuchar_coefficients();

/// The vertical ionosphere and its mapping as BeiDou broadcasts it (BDS-SIS-ICD B1I 3.0, 5.2.4.7): a shell at 375 km
/// over a sphere of 6378 km, geographic latitude, a cosine of 12 hours and more.
/// @return slant delay at B1I
Metres beidou_klobuchar_delay(const KlobucharCoefficients& coefficients, const Geodetic& place,
                              const SkyDirection& direction, GpsTime time);

/// What the receiver knows of the air.
struct CorrectionKnowledge {
    BroadcastIonosphere ionosphere;
    const Geoid* geoid = nullptr;  ///< absent: heights above the ellipsoid are taken for heights above the sea
    LeapSeconds leap_seconds = LeapSeconds::announced();
};

/// Formulas for the delays at one place and instant, with all that does not depend on the direction.
class SiteCorrections {
public:
    SiteCorrections(const CorrectionParameters& parameters, const CorrectionKnowledge& knowledge, const Geodetic& place,
                    GpsTime time);
    /// Of the code at the carrier; 0 for directions below the horizon.
    [[nodiscard]] Metres ionosphere(Constellation constellation, const SkyDirection& direction, Hertz carrier) const;
    /// Elevations below 0.1° are taken as that.
    [[nodiscard]] Metres troposphere(Angle elevation) const;

private:
    [[nodiscard]] const KlobucharCoefficients* coefficients_of(Constellation constellation) const;

    const CorrectionParameters& parameters_;
    const CorrectionKnowledge& knowledge_;
    Geodetic place_;
    GpsTime time_;
    MslHeight height_;
    ZenithDelay zenith_;
    IonosphereTime ionosphere_time_;
    MappingCoefficients hydrostatic_, wet_;
};

/// The receiver's corrections anywhere.
///
/// Heights are those above sea level when there is a geoid. RTKLIB's Saastamoinen takes the ellipsoidal height: leave
/// the geoid out to compare with it.
class RangeCorrections {
public:
    RangeCorrections(const CorrectionParameters& parameters, CorrectionKnowledge knowledge)
        : parameters_(parameters), knowledge_(std::move(knowledge)) {}
    [[nodiscard]] const CorrectionParameters& parameters() const { return parameters_; }
    /// It must not outlive this.
    [[nodiscard]] SiteCorrections at(const Geodetic& place, GpsTime time) const {
        return {parameters_, knowledge_, place, time};
    }

private:
    CorrectionParameters parameters_;
    CorrectionKnowledge knowledge_;
};

}  // namespace skyloop::inline receiver
