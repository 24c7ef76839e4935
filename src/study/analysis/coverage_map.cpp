#include "study/analysis/coverage_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <thread>

#include "detail/run_tables.hpp"
#include "study/analysis/scene_sky.hpp"
#include "world/gnss/dop.hpp"

namespace skyloop::inline study {
namespace {

constexpr std::size_t fewest_for_a_fix = 4;

// All satellites of an epoch, the same for every cell.
struct CoverageSky {
    GpsTime time;
    std::vector<SceneSatellite> satellites;
};

// What all threads share and none changes.
struct CoverageTask {
    std::shared_ptr<const UrbanScene> scene;
    LocalFrame frame;
    std::vector<CoverageSky> skies;
    const CoverageSettings& settings;
};

// One epoch's satellites that arrive at an antenna.
struct ArrivingSatellites {
    std::size_t line_of_sight = 0;
    std::vector<SkyDirection> directions;
    std::vector<double> excess;  // m
};

// Sums over the epochs of one cell.
class CoverageTally {
public:
    void add(const ArrivingSatellites& arriving) {
        ++epochs_;
        line_of_sight_ += static_cast<double>(arriving.line_of_sight);
        tracked_ += static_cast<double>(arriving.directions.size());
        if (arriving.directions.size() >= fewest_for_a_fix) ++fixes_;
        if (arriving.line_of_sight >= fewest_for_a_fix) ++direct_fixes_;
        const auto cofactors = cofactor_matrix(arriving.directions);
        if (!cofactors) return;
        const Eigen::Vector4d variances = cofactors->diagonal();
        hdops_.push_back(std::sqrt(variances[0] + variances[1]));
        pdops_.push_back(std::sqrt(variances.head<3>().sum()));
        error_sum_ += horizontal_shift(*cofactors, arriving);
    }

    CoverageFigures figures() {
        const double epochs = static_cast<double>(std::max<std::size_t>(epochs_, 1));
        CoverageFigures figures;
        figures.line_of_sight = line_of_sight_ / epochs;
        figures.reflected = (tracked_ - line_of_sight_) / epochs;
        figures.fix_share = static_cast<double>(fixes_) / epochs;
        figures.line_of_sight_fix_share = static_cast<double>(direct_fixes_) / epochs;
        if (hdops_.empty()) return figures;
        figures.reflection_error = error_sum_ / static_cast<double>(hdops_.size());
        figures.hdop = middle_value(hdops_);
        figures.pdop = middle_value(pdops_);
        return figures;
    }

private:
    // (HᵀH)⁻¹Hᵀ times the excess lengths: how far they push the least-squares position (MODELS.md 3.9).
    static double horizontal_shift(const Eigen::Matrix4d& cofactors, const ArrivingSatellites& arriving) {
        Eigen::Vector4d sum = Eigen::Vector4d::Zero();
        for (std::size_t i = 0; i < arriving.directions.size(); ++i) {
            const SkyDirection& d = arriving.directions[i];
            const double horizontal = std::cos(d.elevation.rad());
            sum += arriving.excess[i] * Eigen::Vector4d(horizontal * std::sin(d.azimuth.rad()),
                                                        horizontal * std::cos(d.azimuth.rad()),
                                                        std::sin(d.elevation.rad()), 1);
        }
        return (cofactors * sum).head<2>().norm();
    }

    static double middle_value(std::vector<double>& values) {
        std::sort(values.begin(), values.end());
        const std::size_t half = values.size() / 2;
        return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
    }

    std::size_t epochs_ = 0, fixes_ = 0, direct_fixes_ = 0;
    double line_of_sight_ = 0, tracked_ = 0, error_sum_ = 0;
    std::vector<double> hdops_, pdops_;
};

CoverageTask make_task(const std::shared_ptr<const UrbanScene>& scene, const CoverageGrid& grid,
                       const std::vector<CoverageEpoch>& epochs, const CoverageSettings& settings) {
    CoverageTask task{scene, scene ? scene->frame() : LocalFrame(grid.middle()), {}, settings};
    for (const CoverageEpoch& epoch : epochs) {
        SkyView healthy;
        std::copy_if(epoch.sky.satellites.begin(), epoch.sky.satellites.end(), std::back_inserter(healthy.satellites),
                     [](const SatelliteInView& s) { return s.healthy; });
        task.skies.push_back({epoch.time, scene_satellites(task.frame, healthy)});
    }
    return task;
}

// The antenna in the middle of a cell: above the ground there, or above the foot of the scene where no ground is known.
CoverageCell cell_at(const CoverageTask& task, const CoverageGrid& grid, std::size_t index) {
    const auto columns = static_cast<std::size_t>(grid.columns);
    const std::size_t column = index % columns;
    const std::size_t row = index / columns;
    const double across = (static_cast<double>(column) + 0.5) / grid.columns;
    const double along = (static_cast<double>(row) + 0.5) / grid.rows;
    const Geodetic place{grid.south + (grid.north - grid.south) * along, grid.west + (grid.east - grid.west) * across,
                         task.frame.origin().height};
    Eigen::Vector3d position = task.frame.to_enu(to_ecef(place)).vector();
    if (task.scene)
        position.z() = task.scene->ground_at(position.x(), position.y()).value_or(task.scene->statistics().lowest.z());
    position.z() += task.settings.antenna_height.value();
    if (task.scene) position = task.scene->above_surface(position);
    return {to_geodetic(task.frame.to_ecef(Position<Enu>(position))), position, std::nullopt};
}

std::vector<SatellitePaths> paths_to(const CoverageTask& task, PathFinder* finder, const SceneObserver& observer,
                                     const std::vector<SceneSatellite>& satellites) {
    if (finder) return finder->epoch(observer, satellites);
    std::vector<SatellitePaths> paths;
    for (const SceneSatellite& satellite : satellites) {
        const SceneRay ray{observer.position, (satellite.position - observer.position).normalized()};
        paths.push_back({satellite.id, !task.scene || !task.scene->blocked(ray), {}});
    }
    return paths;
}

ArrivingSatellites arriving_at(const CoverageTask& task, PathFinder* finder, const CoverageCell& cell,
                               const CoverageSky& sky) {
    const LocalFrame here(cell.place);
    std::vector<SceneSatellite> above;
    std::vector<SkyDirection> directions;
    for (const SceneSatellite& satellite : sky.satellites) {
        const LookAngles look = here.look_angles(task.frame.to_ecef(Position<Enu>(satellite.position)));
        if (look.elevation < task.settings.mask) continue;
        above.push_back(satellite);
        directions.push_back({look.azimuth, look.elevation});
    }
    const std::vector<SatellitePaths> paths = paths_to(task, finder, {sky.time, cell.position}, above);
    ArrivingSatellites arriving;
    for (std::size_t i = 0; i < above.size(); ++i) {
        if (!paths[i].line_of_sight && paths[i].paths.empty()) continue;
        if (paths[i].line_of_sight) ++arriving.line_of_sight;
        arriving.directions.push_back(directions[i]);
        arriving.excess.push_back(paths[i].line_of_sight ? 0 : paths[i].paths.front().excess);
    }
    return arriving;
}

CoverageCell covered_cell(const CoverageTask& task, const CoverageGrid& grid, std::size_t index) {
    CoverageCell cell = cell_at(task, grid, index);
    if (task.scene && sees_no_sky(*task.scene, cell.position)) return cell;
    std::optional<PathFinder> finder;
    if (task.scene && task.settings.reflections) finder.emplace(task.scene, task.settings.search);
    CoverageTally tally;
    for (const CoverageSky& sky : task.skies)
        tally.add(arriving_at(task, finder ? &*finder : nullptr, cell, sky));
    cell.figures = tally.figures();
    return cell;
}

std::string figures_cells(const CoverageFigures& f) {
    const auto optional_cell = [](const std::optional<double>& value) {
        return value ? fmt::format("{:.3f}", *value) : std::string();
    };
    return fmt::format("{:.3f},{:.3f},{:.3f},{:.4f},{:.4f},{},{},{}", f.tracked(), f.line_of_sight, f.reflected,
                       f.fix_share, f.line_of_sight_fix_share, optional_cell(f.hdop), optional_cell(f.pdop),
                       optional_cell(f.reflection_error));
}

}  // namespace

CoverageMap coverage_map(const std::shared_ptr<const UrbanScene>& scene, const CoverageGrid& grid,
                         const std::vector<CoverageEpoch>& epochs, const CoverageSettings& settings) {
    const CoverageTask task = make_task(scene, grid, epochs, settings);
    CoverageMap map{grid, {}, {}, epochs.size(), std::vector<CoverageCell>(grid.cells())};
    if (!epochs.empty()) {
        map.start = epochs.front().time;
        map.end = epochs.back().time;
    }
    // Every cell is computed by itself and lands at its own place, so that the number of threads cannot be seen.
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t index = next++; index < map.cells.size(); index = next++)
            map.cells[index] = covered_cell(task, grid, index);
    };
    std::vector<std::jthread> helpers;
    for (int i = 1; i < settings.threads; ++i)
        helpers.emplace_back(work);
    work();
    helpers.clear();
    return map;
}

std::string coverage_csv(const CoverageMap& map) {
    std::string text =
        "lat_deg,lon_deg,height_m,east_m,north_m,up_m,satellites,line_of_sight,reflected,fix_share,"
        "line_of_sight_fix_share,hdop_median,pdop_median,reflection_error_m\n";
    for (const CoverageCell& cell : map.cells)
        fmt::format_to(std::back_inserter(text), "{:.8f},{:.8f},{:.3f},{:.3f},{:.3f},{:.3f},{}\n",
                       cell.place.latitude.deg(), cell.place.longitude.deg(), cell.place.height.above_ellipsoid.value(),
                       cell.position.x(), cell.position.y(), cell.position.z(),
                       cell.figures ? figures_cells(*cell.figures) : ",,,,,,,");
    return text;
}

namespace {

constexpr double widest_area = 100e3;
constexpr double most_cells = 1e6;

Result<CoverageGrid> parse_area(std::string_view text) {
    const auto refusal = [&](const std::string& what) {
        return fail(ErrorCode::usage, fmt::format("--grid {}: {}; expected WEST,SOUTH,EAST,NORTH in degrees, such as "
                                                  "30.725,46.475,30.735,46.480",
                                                  text, what));
    };
    const std::vector<std::string_view> cells = split_cells(text, ',');
    if (cells.size() != 4) return refusal(fmt::format("found {} values", cells.size()));
    double degrees[4];
    for (std::size_t i = 0; i < 4; ++i) {
        const std::optional<double> value = cell_value(cells[i]);
        const double limit = i % 2 == 0 ? 360 : 89;
        if (!value || !(std::abs(*value) <= limit))
            return refusal(
                fmt::format("'{}' is no {} within ±{:g}", cells[i], i % 2 == 0 ? "longitude" : "latitude", limit));
        degrees[i] = *value;
    }
    // Across the 180th meridian east is the lesser number; more than half the Earth is a mistake.
    if (degrees[2] < degrees[0] && degrees[2] + 360 - degrees[0] < 180) degrees[2] += 360;
    if (!(degrees[0] < degrees[2])) return refusal("west is not less than east");
    if (!(degrees[1] < degrees[3])) return refusal("south is not less than north");
    CoverageGrid grid{Angle::degrees(degrees[0]), Angle::degrees(degrees[1]), Angle::degrees(degrees[2]),
                      Angle::degrees(degrees[3])};
    if (grid.width() > widest_area || grid.height() > widest_area)
        return refusal(fmt::format("{:.0f} by {:.0f} km are too large, at most 100 km", grid.width() / 1000,
                                   grid.height() / 1000));
    return grid;
}

Result<CoverageGrid> with_cells(CoverageGrid grid, double step) {
    const double columns = std::max(1.0, std::round(grid.width() / step));
    const double rows = std::max(1.0, std::round(grid.height() / step));
    if (!(columns * rows <= most_cells))
        return fail(ErrorCode::usage, fmt::format("--step: {:.3g} m make {:.3g} cells; expected at most {:.0f}", step,
                                                  columns * rows, most_cells));
    grid.columns = static_cast<int>(columns);
    grid.rows = static_cast<int>(rows);
    return grid;
}

}  // namespace

Result<CoverageGrid> CoverageGrid::parse(std::string_view text, Metres step) {
    auto grid = parse_area(text);
    if (!grid) return grid;
    if (!(step.value() > 0 && std::isfinite(step.value())))
        return fail(ErrorCode::usage, fmt::format("--step {}: expected metres above 0", step.value()));
    return with_cells(*grid, step.value());
}

Result<CoverageGrid> CoverageGrid::parse(std::string_view text, int cells) {
    auto grid = parse_area(text);
    if (!grid) return grid;
    if (cells < 1) return fail(ErrorCode::usage, fmt::format("--grid-size {}: expected 1 or more", cells));
    return with_cells(*grid, std::max(grid->width(), grid->height()) / cells);
}

Geodetic CoverageGrid::middle() const {
    const Angle longitude = Angle::degrees(std::remainder((west + east).deg() / 2, 360));
    return {(south + north) * 0.5, longitude, EllipsoidalHeight{Metres(0)}};
}

double CoverageGrid::width() const {
    const Angle latitude = middle().latitude;
    return (east - west).rad() * curvature_radii(latitude).prime_vertical * std::cos(latitude.rad());
}

double CoverageGrid::height() const { return (north - south).rad() * curvature_radii(middle().latitude).meridian; }

}  // namespace skyloop::inline study
