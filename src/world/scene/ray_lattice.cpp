#include "detail/ray_lattice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace skyloop::inline world {
namespace {

const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));

Eigen::Vector3d fibonacci_point(std::size_t index, double count) {
    const double height = 1 - (static_cast<double>(index) + 0.5) / count;
    const double radius = std::sqrt(1 - height * height);
    const double azimuth = std::fmod(golden_angle * static_cast<double>(index), 2 * std::numbers::pi);
    return {radius * std::cos(azimuth), radius * std::sin(azimuth), height};
}

bool within(std::span<const ElevationBand> bands, double height) {
    return std::any_of(bands.begin(), bands.end(),
                       [height](const ElevationBand& band) { return height >= band.lowest && height <= band.highest; });
}

}  // namespace

void merge_bands(std::vector<ElevationBand>& bands) {
    std::sort(bands.begin(), bands.end(),
              [](const ElevationBand& a, const ElevationBand& b) { return a.lowest < b.lowest; });
    std::size_t kept = 0;
    for (const ElevationBand& band : bands) {
        if (kept > 0 && band.lowest <= bands[kept - 1].highest)
            bands[kept - 1].highest = std::max(bands[kept - 1].highest, band.highest);
        else
            bands[kept++] = band;
    }
    bands.resize(kept);
}

RayLattice::RayLattice(int points) : spacing_(std::sqrt(2 * std::numbers::pi / points)) {
    const auto count = static_cast<std::size_t>(points);
    points_.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        points_.push_back(fibonacci_point(i, points));
    const auto rows = static_cast<std::size_t>(std::max(1.0, std::sqrt(points / 8.0)));
    for (std::size_t row = 0; row < rows; ++row) {
        const Row made{row * count / rows, (row + 1) * count / rows, points_[(row + 1) * count / rows - 1].z(),
                       points_[row * count / rows].z()};
        rows_.push_back(made);
    }
    for (std::size_t row = 0; row < rows; ++row) {
        const bool back = row % 2 == 1;
        const auto begin = points_.begin();
        std::sort(begin + static_cast<std::ptrdiff_t>(rows_[row].first),
                  begin + static_cast<std::ptrdiff_t>(rows_[row].last),
                  [back](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
                      const double left = std::atan2(a.y(), a.x());
                      const double right = std::atan2(b.y(), b.x());
                      return back ? left > right : left < right;
                  });
    }
}

void RayLattice::select(std::span<const ElevationBand> bands, double turn,
                        std::vector<Eigen::Vector3d>& directions) const {
    const double angle = 2 * std::numbers::pi * turn;
    const Eigen::Vector2d unit(std::cos(angle), std::sin(angle));
    select_half(bands, 1, unit, directions);
    select_half(bands, -1, unit, directions);
}

void RayLattice::select_half(std::span<const ElevationBand> bands, double sign, const Eigen::Vector2d& turn,
                             std::vector<Eigen::Vector3d>& directions) const {
    for (const Row& row : rows_) {
        const double lowest = sign > 0 ? row.lowest : -row.highest;
        const double highest = sign > 0 ? row.highest : -row.lowest;
        const auto first = std::find_if(bands.begin(), bands.end(),
                                        [lowest](const ElevationBand& band) { return band.highest >= lowest; });
        const auto last =
            std::find_if(first, bands.end(), [highest](const ElevationBand& band) { return band.lowest > highest; });
        if (first == last) continue;
        const std::span<const ElevationBand> here(first, last);
        for (std::size_t i = row.first; i < row.last; ++i) {
            const Eigen::Vector3d& point = points_[i];
            if (!within(here, sign * point.z())) continue;
            directions.emplace_back(turn.x() * point.x() - turn.y() * point.y(),
                                    turn.y() * point.x() + turn.x() * point.y(), sign * point.z());
        }
    }
}

}  // namespace skyloop::inline world
