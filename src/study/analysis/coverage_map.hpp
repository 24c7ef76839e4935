/// Where in an area a receiver finds its satellites, over a span of time.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "base/time/gps_time.hpp"
#include "world/flow/sky_view.hpp"
#include "world/scene/path_finder.hpp"

namespace skyloop::inline study {

/// A piece of the Earth between two meridians and two parallels, cut into equal cells.
struct CoverageGrid {
    Angle west, south, east, north;  ///< east is greater than west, beyond 180° where the 180th meridian lies between
    int columns = 0, rows = 0;

    /// Reads "WEST,SOUTH,EAST,NORTH" in degrees; cells are about `step` wide and high. Fails with `usage` for what is
    /// no area, is wider or higher than 100 km or has more than a million cells.
    static Result<CoverageGrid> parse(std::string_view text, Metres step);
    /// The same with `cells` cells along the longer side.
    static Result<CoverageGrid> parse(std::string_view text, int cells);

    [[nodiscard]] Geodetic middle() const;
    [[nodiscard]] std::size_t cells() const {
        return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    }
    /// Sizes at the middle, m.
    [[nodiscard]] double width() const;
    [[nodiscard]] double height() const;
};

/// What stands above the middle of the area at one instant.
struct CoverageEpoch {
    GpsTime time;
    SkyView sky;
};

/// How a map is made.
struct CoverageSettings {
    Metres antenna_height{1.5};  ///< above the ground
    Angle mask = Angle::degrees(5);
    bool reflections = true;  ///< false: line of sight alone
    /// Antennas of a map stand still: rays of a search add up over the epochs.
    PathSearchSettings search{.rays = 4096, .search_ahead = false};
    int threads = 1;  ///< the map is the same for any number
};

/// Means and medians of one cell over all epochs.
struct CoverageFigures {
    double line_of_sight = 0;            ///< satellites above the mask in line of sight, mean
    double reflected = 0;                ///< that come by reflections alone, mean
    double fix_share = 0;                ///< share of epochs with four satellites or more, direct or reflected
    double line_of_sight_fix_share = 0;  ///< the same of those in line of sight
    std::optional<double> hdop, pdop;    ///< medians over epochs with a geometry to solve, all that arrive
    /// Horizontal error that excess lengths alone make in an unweighted least-squares position of all that arrive,
    /// m, mean over the same epochs: what a receiver errs by that knows nothing of reflections.
    std::optional<double> reflection_error;
    [[nodiscard]] double tracked() const { return line_of_sight + reflected; }
};

/// One cell; its place is that of the antenna in its middle.
struct CoverageCell {
    Geodetic place;
    Eigen::Vector3d position;                ///< of the antenna in the map's frame, m
    std::optional<CoverageFigures> figures;  ///< nothing inside buildings
};

/// The map. Rows go from south to north, cells of a row from west to east.
struct CoverageMap {
    CoverageGrid grid;
    GpsTime start, end;  ///< first and last epoch
    std::size_t epochs = 0;
    std::vector<CoverageCell> cells;
    [[nodiscard]] const CoverageCell& at(int column, int row) const {
        return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                     static_cast<std::size_t>(column)];
    }
};

/// Makes the map. @param scene may be absent: an open sky; the frame is then at the grid's middle
CoverageMap coverage_map(const std::shared_ptr<const UrbanScene>& scene, const CoverageGrid& grid,
                         const std::vector<CoverageEpoch>& epochs, const CoverageSettings& settings);

/// CSV with a header line, a row per cell: lat_deg,lon_deg,height_m,east_m,north_m,up_m,satellites,line_of_sight,
/// reflected,fix_share,line_of_sight_fix_share,hdop_median,pdop_median,reflection_error_m. Cells inside buildings end
/// after up_m, their other cells are empty.
std::string coverage_csv(const CoverageMap& map);

}  // namespace skyloop::inline study
