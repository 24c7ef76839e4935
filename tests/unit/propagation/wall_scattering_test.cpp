// What rough walls scatter: its power against the closed form, and how it beats.
#include "world/propagation/wall_scattering.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "modern_sky.hpp"

namespace {

using namespace skyloop;

constexpr Hertz l1{1575.42e6};

// Two rows of houses along a street eastwards, 10 m to the north and south of the antenna. Of 400 m they fill the
// directions towards them.
std::shared_ptr<const UrbanScene> street_scene(double top = 400) {
    CityModel city;
    city.origin = test::odessa_place;
    const std::uint8_t brick = city.material_index("brick");
    for (const double north : {-10.0, 10.0})
        city.add_quad({Eigen::Vector3d(-3000, north, -50), {3000, north, -50}, {3000, north, top}, {-3000, north, top}},
                      SurfaceKind::wall, brick);
    return *UrbanScene::build(city);
}

SceneObserver standing(double east = 0) {
    SceneObserver observer;
    observer.position = {east, 0, 0};
    return observer;
}

SceneSatellite scene_satellite(double azimuth_deg, double elevation_deg) {
    return {{Constellation::gps, 1},
            2.2e7 * direction_towards(Angle::degrees(azimuth_deg), Angle::degrees(elevation_deg)),
            {}};
}

double scattered_power(const WallScattering& scattering, const SceneSatellite& satellite) {
    double power = 0;
    for (const ScatteredGroup& group : scattering.of(satellite, l1))
        power += std::norm(group.amplitude);
    return power;
}

// Along the street the light grazes both walls; square to it and high up the one opposite is lit with cos θ = cos e.
// Over many places the mean is ½ S² cos θ/π Ω of the lit wall, half of the band of directions.
TEST(WallScattering, HasThePowerOfLambertsLaw) {
    const auto scene = street_scene();
    WallScatteringSettings settings;
    settings.coefficient = 0.4;
    WallScattering scattering(*scene, settings);
    const SceneSatellite southern = scene_satellite(180, 89);
    const double cosine = std::cos(Angle::degrees(89).rad());
    double sum = 0;
    constexpr int places = 400;
    for (int i = 0; i < places; ++i) {
        scattering.look_around(standing(3.0 * i - 600));
        sum += scattered_power(scattering, southern);
    }
    // Of the band from −20 to 60°, 7.59 sr, less what lies beyond 200 m along the street.
    const double beyond = 4 * std::asin(10.0 / 200) / (2 * std::numbers::pi);
    const double expected = 0.16 / 2 * cosine / std::numbers::pi * 7.59 / 2 * (1 - beyond);
    EXPECT_NEAR(sum / places / expected, 1, 0.25);
    settings.coefficient = 0;
    WallScattering smooth(*scene, settings);
    smooth.look_around(standing());
    EXPECT_EQ(scattered_power(smooth, southern), 0);
}

TEST(WallScattering, GivesNothingWhereTheSatelliteDoesNotShine) {
    const auto scene = street_scene();
    WallScattering scattering(*scene, {});
    scattering.look_around(standing());
    EXPECT_EQ(scattered_power(scattering, scene_satellite(180, 20)), 0) << "behind the southern wall";
    EXPECT_GT(
        scattered_power(scattering, scene_satellite(90, 60)) + scattered_power(scattering, scene_satellite(180, 89)),
        0);
}

TEST(WallScattering, BeatsAtRestAndFadesInMotion) {
    const auto scene = street_scene(60);
    WallScattering scattering(*scene, {});
    scattering.look_around(standing());
    const auto strongest = [&](double elevation_deg) {
        double most = 0;
        for (const ScatteredGroup& group : scattering.of(scene_satellite(180, elevation_deg), l1))
            most = std::max(most, std::abs(group.amplitude));
        return most;
    };
    double least = 1e9, most = 0, largest_step = 0, before = strongest(88.7);
    // 0.008° a second, as GPS satellites go: ten minutes.
    for (int second = 0; second < 600; second += 2) {
        const double now = strongest(88.7 - 0.008 * second);
        least = std::min(least, now / std::sqrt(std::cos(Angle::degrees(88.7 - 0.008 * second).rad())));
        most = std::max(most, now / std::sqrt(std::cos(Angle::degrees(88.7 - 0.008 * second).rad())));
        largest_step = std::max(largest_step, std::abs(now - before));
        before = now;
    }
    EXPECT_GT(most, 1.5 * least);
    EXPECT_LT(largest_step, 0.3 * most) << "slowly";
    SceneObserver moving = standing();
    moving.velocity = {8, 0, 0};
    const double resting = strongest(85);
    scattering.look_around(moving);
    EXPECT_LT(strongest(85), 0.5 * resting);
}

}  // namespace
