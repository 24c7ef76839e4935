// What the air does to two receivers differs the more, the farther apart they stand: double differences follow the
// structure functions of the sources.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "base/geo/local_frame.hpp"
#include "unit/propagation/modern_sky.hpp"
#include "world/propagation/ionosphere_effects.hpp"
#include "world/propagation/modern_effects.hpp"
#include "world/propagation/troposphere_delay.hpp"

namespace skyloop::test {
namespace {

using std::chrono::seconds;

const Geodetic base_place = Geodetic::degrees(48.1, 11.6, 50);

Geodetic away_from_base(double distance_m, double azimuth_deg) {
    const GeodesicPoint to = geodesic_direct(base_place, Angle::degrees(azimuth_deg), Metres(distance_m));
    return {to.latitude, to.longitude, base_place.height};
}

// The same satellites as another antenna sees them.
SkyView seen_from(const Geodetic& place, const SkyView& sky) {
    SkyView there = sky;
    for (SatelliteInView& satellite : there.satellites) {
        const LookAngles look = LocalFrame(place).look_angles(satellite.position_at_transmission);
        satellite.azimuth = look.azimuth;
        satellite.elevation = look.elevation;
    }
    return there;
}

SkyView two_satellites(double first_elevation, double second_elevation, double second_azimuth = 200) {
    return {{satellite_at({Constellation::gps, 1}, 30, first_elevation, base_place),
             satellite_at({Constellation::gps, 2}, second_azimuth, second_elevation, base_place)}};
}

struct Receiver {
    TruthState truth;
    SkyView sky;
};

// What an effect does to both satellites at a receiver.
template <Metres Arrival::*delay>
std::array<double, 2> delays_at(PropagationEffect& effect, const Receiver& receiver) {
    const Arrivals arrivals = after(effect, receiver.sky, receiver.truth);
    return {(arrivals.satellites[0].*delay).value(), (arrivals.satellites[1].*delay).value()};
}

// Treuhaft and Lanyi 1987, of the zenith delay: h = 2 km, L = 3000 km, C = 2.4e-7 m^(-1/3).
double wet_structure(double distance) {
    constexpr double height = 2000, saturation = 3000e3, constant = 2.4e-7;
    constexpr int steps = 400;
    const auto refractivity = [](double r) {
        return std::cbrt(r * r) / (1 + std::cbrt(r * r / (saturation * saturation)));
    };
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double apart = (i + 0.5) / steps * height;
        sum += 2 * (height - apart) * (refractivity(std::hypot(distance, apart)) - refractivity(apart));
    }
    return constant * constant * sum * height / steps;
}

// Of differences of a field between a and b at one receiver and the same at the other, from its structure function.
double double_difference_variance(const std::array<std::array<Eigen::Vector3d, 2>, 2>& points,
                                  const std::array<double, 2>& mapping) {
    const auto apart = [&](int receiver, int satellite, int other_receiver, int other_satellite) {
        return wet_structure(
            (points[static_cast<std::size_t>(receiver)][static_cast<std::size_t>(satellite)] -
             points[static_cast<std::size_t>(other_receiver)][static_cast<std::size_t>(other_satellite)])
                .norm());
    };
    const double common = (apart(0, 0, 1, 1) + apart(1, 0, 0, 1) - apart(0, 0, 0, 1) - apart(1, 0, 1, 1)) / 2;
    return mapping[0] * mapping[0] * apart(0, 0, 1, 0) + mapping[1] * mapping[1] * apart(0, 1, 1, 1) -
           2 * mapping[0] * mapping[1] * common;
}

Receiver receiver_at(const Geodetic& place, const SkyView& sky, GpsTime time = april_noon) {
    return {truth_of(place, time), seen_from(place, sky)};
}

class WetOnly {
public:
    explicit WetOnly(std::uint64_t seed) : effect_(vapour_alone(), {}, {}, seed) {}
    std::array<double, 2> at(const Receiver& receiver) { return delays_at<&Arrival::tropo_delay>(effect_, receiver); }

private:
    static ModernPropagationParameters vapour_alone() {
        ModernPropagationParameters parameters;
        parameters.troposphere.enabled = false;
        return parameters;
    }
    TroposphereDelay effect_;
};

TEST(Decorrelation, VapourFollowsItsStructureFunction) {
    constexpr int seeds = 700;
    const SkyView sky = two_satellites(85, 25);
    const std::array<double, 2> mapping{niell_wet_mapping(base_place.latitude, Angle::degrees(85)),
                                        niell_wet_mapping(base_place.latitude, Angle::degrees(25))};
    for (const double distance : {100., 300., 1e3, 3e3, 10e3, 30e3, 100e3, 300e3}) {
        double expected = 0, square = 0;
        for (std::uint64_t seed = 0; seed < seeds; ++seed) {
            const Receiver base = receiver_at(base_place, sky);
            // Near the far one's horizon the mapping is another: azimuths across the low satellite's.
            const Receiver rover = receiver_at(away_from_base(distance, seed % 2 == 0 ? 110 : 290), sky);
            WetOnly of_base(seed), of_rover(seed);
            const auto here = of_base.at(base), there = of_rover.at(rover);
            square += std::pow((here[0] - here[1]) - (there[0] - there[1]), 2) / seeds;
            if (seed > 1) continue;
            std::array<std::array<Eigen::Vector3d, 2>, 2> points;
            for (std::size_t i = 0; i < 2; ++i) {
                for (std::size_t r = 0; r < 2; ++r) {
                    const Receiver& receiver = r == 0 ? base : rover;
                    points[r][i] = sphere_crossing(receiver.truth, receiver.sky.satellites[i],
                                                   Metres(receiver.truth.position.vector().norm()) -
                                                       base_place.height.above_ellipsoid + Metres(1000));
                }
            }
            expected += double_difference_variance(points, mapping) / 2;
        }
        EXPECT_GT(square / expected, 0.75) << distance << " m: " << std::sqrt(square) << " m";
        EXPECT_LT(square / expected, 1.3) << distance << " m: " << std::sqrt(square) << " m";
    }
}

TEST(Decorrelation, VapourPassesWithTheWind) {
    constexpr int seeds = 700;
    const Receiver start = receiver_at(base_place, two_satellites(90, 40));
    for (const int time : {60, 600, 3600, 6 * 3600, 24 * 3600}) {
        double square = 0;
        for (std::uint64_t seed = 0; seed < seeds; ++seed) {
            WetOnly air(seed);
            Receiver later = start;
            later.truth.time = start.truth.time + seconds(time);
            square += std::pow(air.at(later)[0] - air.at(start)[0], 2) / seeds;
        }
        EXPECT_NEAR(square / wet_structure(8. * time), 1, 0.25) << time << " s: " << std::sqrt(square) << " m";
    }
}

// Of the L1 delay of ionosphere_residual and model, rms over the seeds, in parts per million of the distance.
double ionosphere_ppm(double distance, Tecu disturbance) {
    constexpr int seeds = 300;
    ModernPropagationParameters parameters;
    parameters.ionosphere_model.waves.content = disturbance;
    double square = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const double turn = static_cast<double>(seed) * 67;
        const SkyView sky = two_satellites(70, 25 + turn - 35 * std::floor(turn / 35), turn);
        const Receiver base = receiver_at(base_place, sky),
                       rover = receiver_at(away_from_base(distance, 3 * turn), sky);
        const auto effect = [&] {
            auto truth = make_ionosphere_truth(parameters.ionosphere_model, {});
            return IonosphereDelay(std::move(*truth), parameters, {}, seed);
        };
        IonosphereDelay of_base = effect(), of_rover = effect();
        const auto here = delays_at<&Arrival::iono_delay>(of_base, base);
        const auto there = delays_at<&Arrival::iono_delay>(of_rover, rover);
        square += std::pow((here[0] - here[1]) - (there[0] - there[1]), 2) / seeds;
    }
    return std::sqrt(square) / distance * 1e6;
}

TEST(Decorrelation, TheIonosphereHasOneToTwoPartsPerMillionByQuietDaysAndTenByDisturbedOnes) {
    for (const double distance : {10e3, 30e3, 100e3}) {
        const double calm = ionosphere_ppm(distance, Tecu(0)), quiet = ionosphere_ppm(distance, Tecu(0.35));
        EXPECT_GT(quiet, 1) << distance << " m, the model alone " << calm;
        EXPECT_LT(quiet, 2) << distance << " m, the model alone " << calm;
        EXPECT_LT(calm, quiet);
        EXPECT_GT(ionosphere_ppm(distance, Tecu(4)), 10) << distance << " m";
    }
}

std::vector<double> sky_at(std::vector<std::unique_ptr<PropagationEffect>>& effects, int second) {
    const SkyView sky = gps_ring(8);
    Arrivals arrivals = free_space(sky);
    for (const auto& effect : effects)
        effect->apply(arrivals, sky, truth_of(odessa_place, april_noon + seconds(second)));
    std::vector<double> values;
    for (const Arrival& a : arrivals.satellites)
        values.insert(values.end(), {a.signal_in_space_error.value(), a.range_rate_error.value(), a.iono_delay.value(),
                                     a.tropo_delay.value(), a.power_offset.value()});
    return values;
}

TEST(Decorrelation, OrbitsClocksAndAirAreTheSameFromWhateverStartToTheBit) {
    ModernPropagationParameters parameters;
    parameters.ionosphere_model.residual = Choice::on;
    const auto sky = [&](std::uint64_t seed) { return std::move(modern_effects(parameters, {.seed = seed}).value()); };
    auto early = sky(7), stranger = sky(8);
    for (int second = 0; second < 3 * 3600; second += 37) {
        const std::vector<double> expected = sky_at(early, second);
        if (second % 10 != 0) continue;
        auto late = sky(7);
        EXPECT_EQ(sky_at(late, second), expected) << second << " s";
        EXPECT_NE(sky_at(stranger, second), expected);
    }
}

}  // namespace
}  // namespace skyloop::test
