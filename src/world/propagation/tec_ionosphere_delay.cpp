#include "world/propagation/tec_ionosphere_delay.hpp"

#include <cassert>
#include <cmath>

#include "world/gnss/atmosphere.hpp"

namespace skyloop {
namespace {

// Delay at L1 of one TECU, m, with the article's three digits (40.3·10¹⁶/f² = 0.1624).
constexpr double metres_per_tecu = 0.162;

}  // namespace

double ionosphere_obliquity(Angle elevation) { return 1 + 2.74e-6 * std::pow(96 - elevation.deg(), 3); }

Metres tec_delay(Tecu vertical, Angle elevation) {
    return Metres(metres_per_tecu * ionosphere_obliquity(elevation) * vertical.value());
}

Tecu tec_of_vertical_delay(Metres vertical_delay) { return Tecu(vertical_delay.value() / metres_per_tecu); }

Tecu TecIonosphereDelay::vertical_content(const SatelliteInView& satellite, const TruthState& truth) const {
    if (const Tecu* constant = std::get_if<Tecu>(&content_)) return *constant;
    const SkyDirection direction{satellite.azimuth, satellite.elevation};
    if (const IonosphereMaps* maps = std::get_if<IonosphereMaps>(&content_))
        return held_content(*maps, pierce_point(maps->shell, truth.geodetic, direction), truth.time).value_or(Tecu(0));
    const auto& broadcast = std::get<KlobucharCoefficients>(content_);
    return tec_of_vertical_delay(klobuchar_delay(broadcast, truth.geodetic, direction, truth.time).vertical);
}

void TecIonosphereDelay::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    assert(arrivals.satellites.size() == sky.satellites.size());
    for (std::size_t i = 0; i < sky.satellites.size(); ++i) {
        const SatelliteInView& satellite = sky.satellites[i];
        arrivals.satellites[i].iono_delay = tec_delay(vertical_content(satellite, truth), satellite.elevation);
    }
}

}  // namespace skyloop
