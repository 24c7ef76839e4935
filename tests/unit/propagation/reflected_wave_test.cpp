#include "world/propagation/reflection.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::test {
namespace {

const Hertz wave_l1(carrier_frequency_l1);

std::complex<double> permittivity_of(const char* material) {
    return complex_permittivity_p2040(*surface_material(material), wave_l1);
}

Eigen::Vector3d towards(double azimuth_deg, double elevation_deg) {
    const double a = Angle::degrees(azimuth_deg).rad(), e = Angle::degrees(elevation_deg).rad();
    return {std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
}

TEST(ReflectedWave, WithoutWallsIsTheDirectOne) {
    for (const double elevation : {-20.0, 0.0, 37.0, 90.0}) {
        const CircularWave wave = reflected_wave({}, towards(130, elevation), wave_l1, Metres(0));
        EXPECT_NEAR(std::abs(wave.right - 1.0), 0, 1e-12);
        EXPECT_NEAR(std::abs(wave.left), 0, 1e-12);
    }
}

// Whatever the way a wall stands, its hands are those of the coefficients.
TEST(ReflectedWave, HandsOfOneWallAreThoseOfEveryOracleRow) {
    for (const OracleRow& row : oracle_rows("reflection_fresnel.csv")) {
        SCOPED_TRACE(row.id());
        const Hertz carrier(row.number("f_GHz") * 1e9);
        const std::complex<double> permittivity(
            row.number("eps_r"),
            -row.number("sigma_S_m") / (2 * std::numbers::pi * carrier.value() * 8.8541878128e-12));
        for (const double azimuth : {0.0, 77.0, 200.0}) {
            const Eigen::Vector3d normal = towards(azimuth, azimuth / 5);
            const Eigen::Vector3d along = normal.unitOrthogonal();
            const double incidence = Angle::degrees(row.number("incidence_deg")).rad();
            const Eigen::Vector3d arrival = -std::cos(incidence) * normal + std::sin(incidence) * along;
            const std::vector<ReflectingSurface> wall{{normal, permittivity}};
            const CircularWave wave = reflected_wave(wall, arrival, carrier, Metres(0));
            EXPECT_NEAR(std::abs(wave.right), row.number("abs_same_hand"), 1e-6);
            EXPECT_NEAR(std::abs(wave.left), row.number("abs_opposite_hand"), 1e-6);
        }
    }
}

TEST(ReflectedWave, TwoMetalWallsTurnTheHandBack) {
    const auto metal = permittivity_of("metal");
    const std::vector<ReflectingSurface> corner{{{1, 0, 0}, metal}, {{0, 1, 0}, metal}};
    const CircularWave once = reflected_wave(std::span(corner).first(1), towards(70, 10), wave_l1, Metres(0));
    EXPECT_NEAR(std::abs(once.left), 1, 0.01);
    EXPECT_LT(std::abs(once.right), 0.01);
    const CircularWave twice = reflected_wave(corner, towards(50, 10), wave_l1, Metres(0));
    EXPECT_NEAR(std::abs(twice.right), 1, 0.01);
    EXPECT_LT(std::abs(twice.left), 0.01);
}

TEST(ReflectedWave, NoPassiveWallMakesItStronger) {
    for (const SurfaceMaterial& material : surface_materials())
        for (double azimuth = 5; azimuth < 90; azimuth += 17)
            for (double elevation = -60; elevation < 90; elevation += 23) {
                const auto permittivity = complex_permittivity_p2040(material, wave_l1);
                const std::vector<ReflectingSurface> walls{
                    {{1, 0, 0}, permittivity}, {towards(20, 30), permittivity}, {{0, 0, 1}, permittivity}};
                const CircularWave wave = reflected_wave(walls, towards(azimuth, elevation), wave_l1, Metres(0));
                EXPECT_LE(std::norm(wave.right) + std::norm(wave.left), 1 + 1e-9) << material.name;
            }
}

TEST(ReflectedWave, RoughWallsGiveBackLess) {
    const std::vector<ReflectingSurface> wall{{{0, 1, 0}, permittivity_of("concrete")}};
    const Eigen::Vector3d arrival = towards(160, 30);
    const CircularWave smooth = reflected_wave(wall, arrival, wave_l1, Metres(0));
    const CircularWave rough = reflected_wave(wall, arrival, wave_l1, Metres(0.02));
    const Angle incidence = Angle::radians(std::acos(std::abs(arrival.y())));
    EXPECT_NEAR(std::abs(rough.left) / std::abs(smooth.left), roughness_factor(Metres(0.02), incidence, wave_l1),
                1e-12);
}

TEST(ReflectedWave, AnAntennaRejectsTheOtherHand) {
    EXPECT_NEAR(std::abs(heard_by_right_hand({0, {0, 0.5}}, Decibels(20))), 0.05, 1e-12);
    EXPECT_NEAR(std::arg(heard_by_right_hand({0, {0, 0.5}}, Decibels(20))), std::numbers::pi / 2, 1e-12);
    EXPECT_NEAR(std::abs(heard_by_right_hand({0.3, 0.4}, Decibels(0))), 0.5, 1e-12);
}

}  // namespace
}  // namespace skyloop::test
