#include "world/gnss/ntcm_g.hpp"

#include <cmath>
#include <numbers>

namespace skyloop {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

// Daily variation, F1.
double ntcm_daily(double latitude, double longitude, const IonosphereTime& when) {
    const double local_time = when.hours + longitude / two_pi * 24;
    const double diurnal = two_pi * (local_time - 14) / 24;
    const double semidiurnal = two_pi * local_time / 12;
    const double terdiurnal = two_pi * local_time / 8;
    const double declination =
        Angle::degrees(23.44 * std::sin(Angle::degrees(0.9856 * (when.day_of_year - 80.7)).rad())).rad();
    const double solar = std::cos(latitude - declination);
    const double c3 = solar + 0.4;
    const double c2 = solar - 2 / std::numbers::pi * latitude * std::sin(declination);
    return c3 + c2 * (0.92519 * std::cos(diurnal) + 0.16951 * std::cos(semidiurnal) + 0.00443 * std::sin(semidiurnal) +
                      0.06626 * std::cos(terdiurnal) + 0.00899 * std::sin(terdiurnal));
}

// Annual and semiannual variation, F2.
double ntcm_seasonal(double day_of_year) {
    return 1 + 0.21289 * std::cos(two_pi * (day_of_year - 18) / 365.25) -
           0.15414 * std::cos(2 * two_pi * (day_of_year - 6) / 365.25);
}

// Latitude in the field of a dipole whose northern pole lies at 79.74° N, 71.78° W.
double ntcm_magnetic_latitude(double latitude, double longitude) {
    const double pole = Angle::degrees(79.74).rad();
    return std::asin(std::sin(latitude) * std::sin(pole) +
                     std::cos(latitude) * std::cos(pole) * std::cos(longitude + Angle::degrees(71.78).rad()));
}

// The two crests of the equatorial anomaly, F4.
double ntcm_crests(double magnetic_latitude_deg) {
    const double north = (magnetic_latitude_deg - 16) / 12, south = (magnetic_latitude_deg + 10) / 13;
    return 1 + 1.14023 * std::exp(-north * north / 2) + 1.20556 * std::exp(-south * south / 2);
}

}  // namespace

IonosphereTime IonosphereTime::of(const UtcTime& utc) {
    return {std::floor(skyloop::day_of_year(utc)), utc.seconds_of_day() / 3600};
}

double ntcm_g_ionisation(const EffectiveIonisation& b) {
    if (!b.given()) return default_ionisation_level;
    return std::sqrt(b.a0 * b.a0 + 1633.33 * b.a1 * b.a1 + 4802000 * b.a2 * b.a2 + 3266.67 * b.a0 * b.a2);
}

Tecu ntcm_g_vertical_content(const EffectiveIonisation& broadcast, const PiercePoint& where,
                             const IonosphereTime& when) {
    const double latitude = where.latitude.rad(), longitude = where.longitude.rad();
    const double magnetic = ntcm_magnetic_latitude(latitude, longitude);
    const double f3 = 1 - 0.38439 * std::cos(magnetic);
    const double f5 = 1.41808 + 0.13985 * ntcm_g_ionisation(broadcast);
    return Tecu(ntcm_daily(latitude, longitude, when) * ntcm_seasonal(when.day_of_year) * f3 *
                ntcm_crests(Angle::radians(magnetic).deg()) * f5);
}

NtcmGContent ntcm_g_content(const EffectiveIonisation& broadcast, const Geodetic& place, const SkyDirection& direction,
                            const IonosphereTime& when) {
    const ThinShell shell;
    NtcmGContent content;
    // The model leaves the height of the antenna out.
    content.pierce = published_pierce_point(shell, {place.latitude, place.longitude, {}}, direction);
    content.vertical = ntcm_g_vertical_content(broadcast, content.pierce, when);
    content.slant_factor = modified_single_layer_mapping(shell, direction.elevation);
    content.slant = content.vertical * content.slant_factor;
    return content;
}

}  // namespace skyloop
