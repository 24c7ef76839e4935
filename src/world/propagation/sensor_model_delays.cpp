#include "world/propagation/sensor_model_delays.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "world/gnss/atmosphere.hpp"
#include "world/propagation/ray_geometry.hpp"

namespace skyloop::inline world {
namespace {

// Delay at L1 of one TECU, m, with the article's three digits (40.3·10¹⁶/f² = 0.1624).
constexpr double metres_per_tecu = 0.162;
constexpr Metres broadcast_shell_height{350000};  // IS-GPS-200, 20.3.3.5.2.5

}  // namespace

double ionosphere_obliquity(Angle elevation) { return 1 + 2.74e-6 * std::pow(96 - elevation.deg(), 3); }

Metres tec_delay(Tecu vertical, Angle elevation) {
    return Metres(metres_per_tecu * ionosphere_obliquity(elevation) * vertical.value());
}

Tecu tec_of_vertical_delay(Metres vertical_delay) { return Tecu(vertical_delay.value() / metres_per_tecu); }

Tecu TecIonosphereDelay::vertical_content(const SatelliteInView& satellite, const TruthState& truth) const {
    if (const Tecu* constant = std::get_if<Tecu>(&content_)) return *constant;
    const SkyDirection direction = direction_of(satellite);
    if (const IonosphereMaps* maps = std::get_if<IonosphereMaps>(&content_))
        return held_content(*maps, pierce_point(maps->shell, truth.geodetic, direction), truth.time).value_or(Tecu(0));
    const auto& broadcast = std::get<KlobucharCoefficients>(content_);
    return tec_of_vertical_delay(klobuchar_delay(broadcast, truth.geodetic, direction, truth.time).vertical);
}

Metres TecIonosphereDelay::shell_height() const {
    const IonosphereMaps* maps = std::get_if<IonosphereMaps>(&content_);
    return maps != nullptr ? maps->shell.height : broadcast_shell_height;
}

void TecIonosphereDelay::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    if (truth.geodetic.height.above_ellipsoid >= shell_height()) return;
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        const Metres at_l1 = tec_delay(vertical_content(satellite, truth), satellite.elevation);
        arrival.iono_delay = ionosphere_delay_at(at_l1, first_carrier(arrival));
    });
}

DryAndWetDelay zenith_delay(const AtmosphereParameters& atmosphere, MslHeight height) {
    const double thinning = std::exp(-atmosphere.zenith_dry_decay_per_m * height.above_sea_level.value());
    return {atmosphere.zenith_dry_delay * thinning, atmosphere.zenith_wet_delay};
}

Metres slant_delay(const DryAndWetDelay& zenith, const MappingSite& site, Angle elevation) {
    return zenith.dry * niell_hydrostatic_mapping(site, elevation) +
           zenith.wet * niell_wet_mapping(site.latitude, elevation);
}

NiellTroposphereDelay::NiellTroposphereDelay(const AtmosphereParameters& atmosphere, const Geoid* geoid,
                                             LeapSeconds leap_seconds)
    : atmosphere_(atmosphere), geoid_(geoid), leap_seconds_(std::move(leap_seconds)) {}

void NiellTroposphereDelay::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    const MappingSite site{truth.geodetic.latitude, sea_level_height(truth.geodetic, geoid_),
                           day_of_year(to_utc(truth.time, leap_seconds_))};
    const DryAndWetDelay zenith = zenith_delay(atmosphere_, site.height);
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        arrival.tropo_delay = slant_delay(zenith, site, above_horizon(satellite.elevation));
    });
}

namespace {

constexpr double refraction_earth_radius = 6371000;
constexpr double top_of_air = 100000;

// Gauss-Legendre nodes and weights of order 8 on [−1, 1], positive half (Abramowitz and Stegun, table 25.4).
struct GaussPoint {
    double node, weight;
};
constexpr std::array<GaussPoint, 4> gauss_points{{{0.1834346424956498, 0.3626837833783620},
                                                  {0.5255324099163290, 0.3137066458778873},
                                                  {0.7966664774136267, 0.2223810344533745},
                                                  {0.9602898564975363, 0.1012285362903763}}};

// The three integrals along a ray, or their integrands.
struct RaySums {
    double length = 0;         // ∫ds, m
    double excess = 0;         // ∫(n − 1)ds, m
    double central_angle = 0;  // rad
    void add(const RaySums& step, double weight) {
        length += weight * step.length;
        excess += weight * step.excess;
        central_angle += weight * step.central_angle;
    }
};

double refractivity(const ExponentialRefractivity& air, double height) {
    return 1e-6 * air.surface * std::exp(-height / air.scale_height.value());
}

}  // namespace

RefractedRay trace_ray(const ExponentialRefractivity& air, Angle apparent, MslHeight antenna) {
    const double start = std::min(antenna.above_sea_level.value(), top_of_air);
    const double r0 = refraction_earth_radius + start;
    const double invariant = (1 + refractivity(air, start)) * r0 * std::cos(apparent.rad());
    // Heights run as the square of u, which takes the peak at a level start out of the integrands.
    const double u_end = std::sqrt(top_of_air - start);
    const auto integrands = [&](double u) {
        const double r = r0 + u * u;
        const double n_minus_1 = refractivity(air, start + u * u);
        const double nr = (1 + n_minus_1) * r;
        // A ray that such strong air would bend back to the ground is kept level instead.
        const double rise = std::sqrt(std::max(nr * nr - invariant * invariant, 1.0));
        const double ds = 2 * u * nr / rise;
        return RaySums{ds, n_minus_1 * ds, 2 * u * invariant / (r * rise)};
    };
    RaySums ray;
    constexpr int panels = 16;
    const double half = u_end / (2 * panels);
    for (int panel = 0; panel < panels; ++panel)
        for (const GaussPoint& point : gauss_points)
            for (const double side : {-1.0, 1.0})
                ray.add(integrands((2 * panel + 1 + side * point.node) * half), point.weight * half);

    const double r1 = r0 + u_end * u_end;
    // r1 cos φ − r0, without the cancellation of two large numbers.
    const double up = u_end * u_end - 2 * r1 * std::pow(std::sin(ray.central_angle / 2), 2);
    const double along = r1 * std::sin(ray.central_angle);
    return {Angle::radians(std::atan2(up, along)), Metres(ray.excess), Metres(ray.length - std::hypot(up, along))};
}

Angle refraction_bending(Angle free_space_elevation, MslHeight antenna) {
    const double t = free_space_elevation.deg();
    const double h = std::clamp(antenna.above_sea_level.value() / 1000, 0.0, 3.0);
    return Angle::degrees(1 / (1.728 + 0.5411 * t + 0.03723 * t * t + h * (0.1815 + 0.06272 * t + 0.0138 * t * t) +
                               h * h * (0.01727 + 0.008288 * t)));
}

void RefractionDelay::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    const MslHeight height = sea_level_height(truth.geodetic, geoid_);
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        const Angle apparent = satellite.elevation + refraction_bending(satellite.elevation, height);
        arrival.tropo_delay = trace_ray(air_, apparent, height).excess();
    });
}

}  // namespace skyloop::inline world
