#include "world/propagation/wall_scattering.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "world/gnss/constants.hpp"
#include "world/propagation/smooth_noise.hpp"

namespace skyloop::inline world {
namespace {

constexpr double pi = std::numbers::pi;
// Directions between 20° below and 60° above the horizon, of equal solid angle.
constexpr std::size_t directions = 96;
constexpr double lowest_sine = -0.342, highest_sine = 0.866;
constexpr double solid_angle = 2 * pi * (highest_sine - lowest_sine) / directions;
constexpr double farthest_wall = 200;                                              // m
constexpr double patch = 0.25;                                                     // m
constexpr std::array<double, WallScattering::group_count - 1> group_ends{15, 60};  // m of excess

// A spiral of equal steps in height and of the golden angle in azimuth.
std::array<Eigen::Vector3d, directions> all_around() {
    std::array<Eigen::Vector3d, directions> result;
    const double golden = pi * (3 - std::sqrt(5.0));
    for (std::size_t i = 0; i < directions; ++i) {
        const double share = (static_cast<double>(i) + 0.5) / directions;
        const double up = lowest_sine + share * (highest_sine - lowest_sine), level = std::sqrt(1 - up * up);
        const double azimuth = golden * static_cast<double>(i);
        result[i] = {level * std::sin(azimuth), level * std::cos(azimuth), up};
    }
    return result;
}

std::complex<double> roughness_at(std::uint64_t seed, const Eigen::Vector3d& place) {
    std::uint64_t key = seed;
    for (int axis = 0; axis < 3; ++axis)
        key = spread_bits(key ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(place[axis] / patch))));
    return std::complex(normal_of_bits(key), normal_of_bits(spread_bits(key))) / std::numbers::sqrt2;
}

std::size_t group_of(double excess) {
    return static_cast<std::size_t>(std::lower_bound(group_ends.begin(), group_ends.end(), excess) -
                                    group_ends.begin());
}

}  // namespace

WallScattering::WallScattering(const UrbanScene& scene, const WallScatteringSettings& settings)
    : scene_(scene), settings_(settings) {
    settings_.seed = noise_key(settings.seed, "scattering");
}

void WallScattering::look_around(const SceneObserver& observer) {
    static const std::array<Eigen::Vector3d, directions> around = all_around();
    constexpr double steepest = 0.5;  // of a wall's normal, its sine of elevation
    observer_ = observer;
    pieces_.clear();
    if (!acts()) return;
    std::vector<SceneRay> rays;
    for (const Eigen::Vector3d& direction : around)
        rays.push_back({observer.position, direction});
    std::vector<SceneHit> hits(rays.size());
    scene_.first_hits(rays, hits, true);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].any() || hits[i].distance > farthest_wall) continue;
        Eigen::Vector3d normal = scene_.planes()[hits[i].plane].normal;
        if (std::abs(normal.z()) > steepest) continue;
        if (normal.dot(rays[i].direction) > 0) normal = -normal;
        const Eigen::Vector3d place = observer.position + hits[i].distance * rays[i].direction;
        pieces_.push_back({place, rays[i].direction, normal, hits[i].distance, roughness_at(settings_.seed, place)});
    }
}

Decibels WallScattering::unevenness(const Eigen::Vector3d& place) const {
    constexpr double spread_db = 5, cell = 0.6 / noise_correlation_cells;
    if (!acts()) return Decibels(0);
    const std::array cells{place.x() / cell, place.y() / cell, place.z() / cell};
    return Decibels(spread_db * std::max(smooth_noise(spread_bits(settings_.seed), cells), 0.0));
}

std::array<ScatteredGroup, WallScattering::group_count> WallScattering::of(const SceneSatellite& satellite,
                                                                           Hertz carrier) const {
    constexpr double off_the_wall = 0.05;  // m
    const Eigen::Vector3d direct = (satellite.position - observer_.position).normalized();
    std::vector<const Piece*> lit;
    std::vector<SceneRay> rays;
    for (const Piece& piece : pieces_) {
        if (piece.normal.dot(direct) <= 0) continue;
        lit.push_back(&piece);
        rays.push_back({piece.place + off_the_wall * piece.normal, direct});
    }
    std::vector<std::uint8_t> dark(rays.size());
    scene_.blocked(rays, dark);
    const double wave_number = 2 * pi * carrier.value() / speed_of_light;
    std::array<ScatteredGroup, group_count> groups;
    std::array<double, group_count> powers{};
    for (std::size_t i = 0; i < lit.size(); ++i) {
        if (dark[i] != 0) continue;
        const Piece& piece = *lit[i];
        const double excess = piece.distance * (1 - piece.from.dot(direct));
        const double power =
            settings_.coefficient * settings_.coefficient / 2 * piece.normal.dot(direct) / pi * solid_angle;
        const double beat = wave_number * (piece.from - direct).dot(observer_.velocity) * settings_.averaging.value();
        const std::size_t at = group_of(excess);
        groups[at].amplitude +=
            std::sqrt(power / (1 + beat * beat)) * piece.roughness * std::polar(1.0, -wave_number * excess);
        groups[at].excess += power * excess;
        groups[at].from += power * piece.from;
        powers[at] += power;
    }
    for (std::size_t i = 0; i < group_count; ++i) {
        if (!(powers[i] > 0)) continue;
        groups[i].excess /= powers[i];
        groups[i].from.normalize();
        groups[i].amplitude *= std::polar(1.0, wave_number * groups[i].excess);
    }
    return groups;
}

}  // namespace skyloop::inline world
