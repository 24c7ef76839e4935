#include "world/propagation/scintillation_indices.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "world/gnss/constants.hpp"
#include "world/gnss/thin_shell.hpp"
#include "world/propagation/free_space.hpp"

namespace skyloop {
namespace {

constexpr ThinShell scintillation_shell{Metres(6371000), Metres(350000)};

double bell(double distance, double width) { return std::exp(-distance * distance / (2 * width * width)); }

}  // namespace

Angle dipole_modified_dip(const Geodetic& place) {
    const Angle pole_latitude = Angle::degrees(79.74), pole_longitude = Angle::degrees(-71.78);
    const double latitude = place.latitude.rad();
    const double sine =
        std::sin(latitude) * std::sin(pole_latitude.rad()) +
        std::cos(latitude) * std::cos(pole_latitude.rad()) * std::cos((place.longitude - pole_longitude).rad());
    const double dip = std::atan(2 * std::tan(std::asin(std::clamp(sine, -1.0, 1.0))));
    return Angle::radians(std::atan2(dip, std::sqrt(std::max(std::cos(latitude), 0.0))));
}

double evening_share(const ScintillationParameters& parameters, const Geodetic& place, double hours) {
    if (!parameters.equatorial_evening) return 1;
    const double local = hours + place.longitude.deg() / 15;
    const double from_peak = std::remainder(local - parameters.evening_peak_h, 24.0);
    const double from_crest = std::abs(dipole_modified_dip(place).deg()) - parameters.crest.deg();
    double crest = bell(from_crest, parameters.crest_width.deg());
    if (from_crest < 0) crest = (1 + crest) / 2;  // half of it is left between the crests
    return bell(from_peak, parameters.evening_width_h) * crest;
}

ScintillationIndices::ScintillationIndices(const ScintillationParameters& parameters, const ErrorTerm& term,
                                           LeapSeconds leap_seconds)
    : parameters_(parameters), factor_(term.factor()), leap_seconds_(std::move(leap_seconds)) {}

void ScintillationIndices::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    assert(arrivals.satellites.size() == sky.satellites.size());
    if (factor_ == 0 || (parameters_.s4 == 0 && parameters_.sigma_phi.rad() == 0)) return;
    if (truth.geodetic.height.above_ellipsoid >= scintillation_shell.height) return;
    const double hours = to_utc(truth.time, leap_seconds_).seconds_of_day() / 3600;
    for (std::size_t i = 0; i < sky.satellites.size(); ++i) {
        Arrival& arrival = arrivals.satellites[i];
        const SkyDirection direction{sky.satellites[i].azimuth, sky.satellites[i].elevation};
        const PiercePoint pierce = pierce_point(scintillation_shell, truth.geodetic, direction);
        const double share = factor_ * evening_share(parameters_, {pierce.latitude, pierce.longitude, {}}, hours);
        const double slant =
            single_layer_mapping(scintillation_shell, direction.elevation, truth.geodetic.height.above_ellipsoid);
        const double wavelength = carrier_frequency_l1 / first_carrier(arrival).value();  // over that of L1
        arrival.amplitude_scintillation =
            std::min(parameters_.s4 * share * std::pow(slant, 0.9) * std::pow(wavelength, 1.5), strongest_s4);
        arrival.phase_scintillation = parameters_.sigma_phi * (share * std::sqrt(slant) * wavelength);
    }
}

}  // namespace skyloop
