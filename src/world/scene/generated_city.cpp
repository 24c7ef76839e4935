#include "world/scene/generated_city.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "base/core/random.hpp"
#include "detail/house_shapes.hpp"

namespace skyloop::inline world {
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

namespace {

// Five by five blocks, each of three by two houses, around a square in whose middle the origin lies:
//
//   north  . . C C .    C  the canyon's blocks, an avenue between them with an arch of glass over it
//          . . C C .    P  the park
//          . P   H .    H  a hall with windows
//          . . . T .    T  the tower
//          . . . . .
constexpr double demo_lot = 24, demo_pitch_east = 92, demo_pitch_north = 68;
constexpr int demo_reach = 2;

class DemoCity {
public:
    explicit DemoCity(const Geodetic& origin) {
        city_.origin = origin;
        brick_ = city_.material_index("brick");
        glass_ = city_.material_index("glass");
        metal_ = city_.material_index("metal");
    }

    CityModel build() {
        for (int north = -demo_reach; north <= demo_reach; ++north)
            for (int east = -demo_reach; east <= demo_reach; ++east)
                add_block(east, north);
        add_arch();
        add_ground(city_, 700);
        return std::move(city_);
    }

private:
    void add_block(int east, int north) {
        const Eigen::Vector2d middle(east * demo_pitch_east, north * demo_pitch_north);
        if (north == 0 && east == 0) return;
        if (north == 0 && east == -1) return add_park(middle);
        if (north == 0 && east == 1) return add_hall(middle);
        if (north == -1 && east == 1) return add_tower(middle);
        const bool canyon = north > 0 && (east == 0 || east == 1);
        for (int a = -1; a <= 1; ++a)
            for (int b = 0; b < 2; ++b)
                add_dwelling(middle + demo_lot * Eigen::Vector2d(a, b - 0.5), canyon);
    }

    // The canyon's houses stand wall to wall along the avenue; the others have gaps between them.
    void add_dwelling(const Eigen::Vector2d& middle, bool canyon) {
        House house;
        house.middle = middle;
        const double narrow = random_.uniform(), low = random_.uniform(), made = random_.uniform();
        house.width = demo_lot * (canyon ? 0.97 : 0.80 + 0.15 * narrow);
        house.depth = demo_lot * (canyon ? 0.99 : 0.80 + 0.15 * low);
        house.height = canyon ? 30 + 10 * random_.uniform() : 9 + 15 * random_.uniform();
        house.walls = made < 0.5 ? concrete_ : made < 0.9 ? brick_ : metal_;
        add_house(city_, house);
    }

    void add_park(const Eigen::Vector2d& middle) {
        FoliageVolume trees;
        for (int corner = 0; corner < 8; ++corner) {
            const double angle = (corner + 0.5) * std::numbers::pi / 4;
            trees.ring.emplace_back(middle.x() + 40 * std::cos(angle), middle.y() + 28 * std::sin(angle));
        }
        trees.base = 3;
        trees.top = 14;
        city_.foliage.push_back(trees);
    }

    void add_hall(const Eigen::Vector2d& middle) {
        House house;
        house.middle = middle;
        house.width = 42;
        house.depth = 28;
        house.height = 13;
        house.walls = brick_;
        house.roof = metal_;
        add_windowed_house(city_, house, {6, 0.3, glass_});
    }

    void add_tower(const Eigen::Vector2d& middle) {
        House house;
        house.middle = middle;
        house.yaw = 0.35;
        house.width = house.depth = 26;
        house.height = 110;
        house.walls = glass_;
        house.roof = metal_;
        add_house(city_, house);
    }

    // A barrel vault on two upright legs. What leans more than it stands is a roof.
    void add_arch() {
        constexpr int panes = 12;
        constexpr double east = 46, from = 52, to = 84, legs = 7, radius = 9.5;
        const auto rib = [&](int k, double north) {
            const double angle = std::numbers::pi * k / panes;
            return Eigen::Vector3d(east + radius * std::cos(angle), north, legs + radius * std::sin(angle));
        };
        for (int k = 0; k < panes; ++k) {
            const bool steep = k < panes / 4 || k >= panes - panes / 4;
            city_.add_quad({rib(k, from), rib(k, to), rib(k + 1, to), rib(k + 1, from)},
                           steep ? SurfaceKind::wall : SurfaceKind::roof, glass_);
        }
        for (const int k : {0, panes}) {
            const Eigen::Vector3d a = rib(k, from), b = rib(k, to);
            city_.add_quad({Eigen::Vector3d(a.x(), a.y(), 0), {b.x(), b.y(), 0}, b, a}, SurfaceKind::wall, glass_);
        }
    }

    RandomStream random_{1, "demo city"};
    CityModel city_;
    std::uint8_t concrete_ = 0, brick_ = 0, glass_ = 0, metal_ = 0;
};

}  // namespace

CityModel demo_city(const Geodetic& origin) { return DemoCity(origin).build(); }

}  // namespace skyloop::inline world
