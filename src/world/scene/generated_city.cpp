#include "world/scene/generated_city.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "base/core/random.hpp"
#include "detail/house_shapes.hpp"

namespace skyloop {
namespace {

// Blocks of three by two houses, one every 92 by 68 m, with streets of 20 m between them.
constexpr int houses_wide = 3, houses_deep = 2;
constexpr double lot = 24, street = 20;
constexpr double pitch_east = houses_wide * lot + street, pitch_north = houses_deep * lot + street;
constexpr double ordinary_shrink = 0.95, turned_shrink = 0.75;
constexpr double ordinary_yaw = 4, largest_turn = 25;  // degrees
constexpr double lowest_house = 6, highest_house = 150, highest_windowed_house = 60;
constexpr double eye_height = 1.6, off_centre = 4;
constexpr double ground_beyond = 500;
constexpr std::size_t places_wanted = 400;

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// Where a block of the street grid stands; the frame's origin is a crossing.
struct BlockPlace {
    Eigen::Vector2d middle;
    double reach = 0;  ///< half the side of the square around the origin that just holds it, m
};

/// Blocks from the origin outwards, at least so many: however many are built, the city is about a square.
std::vector<BlockPlace> block_places(std::size_t count) {
    const double side = std::sqrt(static_cast<double>(count) * pitch_east * pitch_north) / 2 + pitch_east;
    const int east = static_cast<int>(std::ceil(side / pitch_east));
    const int north = static_cast<int>(std::ceil(side / pitch_north));
    std::vector<BlockPlace> places;
    for (int j = -north; j < north; ++j)
        for (int i = -east; i < east; ++i) {
            const Eigen::Vector2d middle((i + 0.5) * pitch_east, (j + 0.5) * pitch_north);
            places.push_back(
                {middle, std::max(std::abs(middle.x()) + pitch_east / 2, std::abs(middle.y()) + pitch_north / 2)});
        }
    std::stable_sort(places.begin(), places.end(),
                     [](const BlockPlace& a, const BlockPlace& b) { return a.reach < b.reach; });
    return places;
}

class CityBuilder {
public:
    CityBuilder(const GeneratedCitySettings& settings, const Geodetic& origin)
        : settings_(settings), random_(settings.seed, "generated city") {
        result_.city.origin = origin;
        for (const std::string_view name : {"brick", "glass", "metal"})
            result_.city.material_index(name);
        windows_.pane = result_.city.material_index("glass");
    }

    GeneratedCity build() {
        const std::size_t ground = settings_.ground ? 2 : 0;
        wanted_ = std::max(settings_.triangles, ground + 1) - ground;
        for (const BlockPlace& place : block_places(likely_blocks())) {
            if (full_) break;
            reach_ = place.reach;
            add_block(place.middle);
        }
        if (settings_.ground) add_ground(result_.city, reach_ + ground_beyond);
        place_on_streets();
        return std::move(result_);
    }

private:
    /// More than enough: no house has fewer triangles.
    [[nodiscard]] std::size_t likely_blocks() const {
        const std::size_t of_block =
            settings_.windows ? houses_wide * houses_deep * 500 : houses_wide * houses_deep * 10;
        return wanted_ / of_block + 1;
    }

    void add_block(const Eigen::Vector2d& middle) {
        const bool turned = random_.uniform() < settings_.turned_blocks;
        const double largest = turned ? largest_turn : ordinary_yaw;
        const double yaw = radians(largest * (2 * random_.uniform() - 1));
        const double shrink = turned ? turned_shrink : ordinary_shrink;
        const double block_height = 22 * std::exp(0.45 * random_.normal());
        const double c = std::cos(yaw), s = std::sin(yaw);
        for (int a = 0; a < houses_wide; ++a)
            for (int b = 0; b < houses_deep; ++b) {
                const double x = (a - (houses_wide - 1) / 2.0) * lot * shrink;
                const double y = (b - (houses_deep - 1) / 2.0) * lot * shrink;
                House house;
                house.middle = middle + Eigen::Vector2d(c * x - s * y, s * x + c * y);
                house.yaw = yaw;
                house.width = lot * shrink * (0.85 + 0.12 * random_.uniform());
                house.depth = lot * shrink * (0.85 + 0.12 * random_.uniform());
                house.height = std::clamp(block_height * std::exp(0.3 * random_.normal()), lowest_house,
                                          settings_.windows ? highest_windowed_house : highest_house);
                house.walls = static_cast<std::uint8_t>(random_.uniform() * 3);
                add(house);
            }
    }

    // The last house is the one that brings the count nearest to the wanted one.
    void add(const House& house) {
        if (full_) return;
        const std::size_t has = result_.city.triangles.size();
        const std::size_t more = settings_.windows ? windowed_house_triangles(house, windows_) : 10;
        full_ = has > 0 && has + more / 2 > wanted_;
        if (full_) return;
        if (settings_.windows)
            add_windowed_house(result_.city, house, windows_);
        else
            add_house(result_.city, house);
    }

    // Lines of the street grid lie at whole multiples of the pitch. Turned blocks stand up to 4 m into the street, so
    // that 4 m off its middle is free.
    void place_on_streets() {
        RandomStream random(settings_.seed, "generated city places");
        const double inner = reach_ / 2;
        while (result_.street_places.size() < places_wanted) {
            const bool eastward = random.uniform() < 0.5;
            const double pitch = eastward ? pitch_north : pitch_east;
            const double along = inner * (2 * random.uniform() - 1);
            const double lines = std::floor(inner / pitch);
            const double line = pitch * std::floor((2 * lines + 1) * random.uniform() - lines);
            const double across = line + off_centre * (2 * random.uniform() - 1);
            result_.street_places.emplace_back(eastward ? along : across, eastward ? across : along, eye_height);
        }
    }

    GeneratedCitySettings settings_;
    RandomStream random_;
    WindowSettings windows_;
    GeneratedCity result_;
    std::size_t wanted_ = 0;
    double reach_ = 0;
    bool full_ = false;
};

}  // namespace

GeneratedCity generated_city(const GeneratedCitySettings& settings, const Geodetic& origin) {
    return CityBuilder(settings, origin).build();
}

}  // namespace skyloop
