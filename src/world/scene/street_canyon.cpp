#include <algorithm>
#include <cmath>
#include <numbers>

#include "detail/house_shapes.hpp"
#include "world/scene/generated_city.hpp"

namespace skyloop {
namespace {

constexpr double ground_beyond_canyon = 500;

/// One stretch of houses between side streets, along the street from its middle, m.
struct Stretch {
    double from = 0, to = 0;
};

// A house of full length stands at the middle of the street, so that the origin never lies in a crossing.
std::vector<Stretch> stretches(const StreetCanyonSettings& settings) {
    const double half = settings.length / 2;
    if (!(settings.gap_every > 0 && settings.gap_width > 0)) return {{-half, half}};
    std::vector<Stretch> result;
    const double house = settings.gap_every - settings.gap_width;
    if (house <= 0) return result;
    const int most = static_cast<int>(std::ceil(half / settings.gap_every));
    for (int k = -most; k <= most; ++k) {
        const double from = std::max(-half, k * settings.gap_every - house / 2);
        const double to = std::min(half, k * settings.gap_every + house / 2);
        if (from < to) result.push_back({from, to});
    }
    return result;
}

}  // namespace

CityModel street_canyon(const StreetCanyonSettings& settings, const Geodetic& origin) {
    CityModel city;
    city.origin = origin;
    const double azimuth = settings.azimuth_deg * std::numbers::pi / 180;
    const Eigen::Vector2d along(std::sin(azimuth), std::cos(azimuth)), right(along.y(), -along.x());
    for (const double side : {-1.0, 1.0}) {
        const double height = side < 0 ? settings.left_height : settings.right_height;
        if (!(height > 0)) continue;
        for (const Stretch& stretch : stretches(settings)) {
            House house;
            house.middle =
                along * ((stretch.from + stretch.to) / 2) + right * (side * (settings.width + settings.depth) / 2);
            house.yaw = std::numbers::pi / 2 - azimuth;
            house.width = stretch.to - stretch.from;
            house.depth = settings.depth;
            house.height = height;
            add_house(city, house);
        }
    }
    add_ground(city, std::hypot(settings.length / 2, settings.width / 2 + settings.depth) + ground_beyond_canyon);
    return city;
}

}  // namespace skyloop
