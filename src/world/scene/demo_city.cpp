#include <cmath>
#include <numbers>

#include "base/core/random.hpp"
#include "detail/house_shapes.hpp"
#include "world/scene/generated_city.hpp"

namespace skyloop {
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

}  // namespace skyloop
