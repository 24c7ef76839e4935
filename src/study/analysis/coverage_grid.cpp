#include <fmt/format.h>

#include <cmath>

#include "detail/table_cells.hpp"
#include "study/analysis/coverage_map.hpp"

namespace skyloop {
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

}  // namespace skyloop
