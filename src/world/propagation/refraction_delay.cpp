#include "world/propagation/refraction_delay.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "detail/sea_level.hpp"

namespace skyloop {
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

Angle refraction_bending_of_apparent(Angle apparent, MslHeight antenna) {
    const double t = apparent.deg();
    const double h = std::clamp(antenna.above_sea_level.value() / 1000, 0.0, 3.0);
    return Angle::degrees(
        1 / (1.314 + 0.6437 * t + 0.02869 * t * t + h * (0.2305 + 0.09428 * t + 0.01096 * t * t) + h * h * 0.008583));
}

void RefractionDelay::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    assert(arrivals.satellites.size() == sky.satellites.size());
    const MslHeight height = sea_level_height(truth.geodetic, geoid_);
    for (std::size_t i = 0; i < sky.satellites.size(); ++i) {
        const Angle elevation = sky.satellites[i].elevation;
        const Angle apparent = elevation + refraction_bending(elevation, height);
        arrivals.satellites[i].tropo_delay = trace_ray(air_, apparent, height).excess();
    }
}

}  // namespace skyloop
