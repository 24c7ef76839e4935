#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "base/core/middle.hpp"
#include "detail/city_text.hpp"
#include "detail/height_grid.hpp"
#include "detail/place_on_earth.hpp"

namespace skyloop {
namespace {

constexpr std::uint32_t no_vertex = ~0U;

/// Makes triangles of a grid.
class GridGround {
public:
    GridGround(HeightGrid grid, std::string_view name, const CityFileSettings& settings)
        : grid_(std::move(grid)), name_(name), settings_(settings) {}

    Result<CityFile> build() {
        if (auto done = place_cells(); !done) return fail(std::move(done.error()));
        join_cells();
        if (file_.model.triangles.empty())
            return fail(ErrorCode::input, fmt::format("{}: no four neighbours have a height", name_));
        file_.format = "height grid";
        file_.dropped = grid_.dropped;
        if (file_.dropped > 0) warn(fmt::format("{} heights are no numbers and were left out", file_.dropped));
        if (settings_.file_origin != Eigen::Vector3d::Zero() && !settings_.anchor) warn(file_origin_unused);
        if (settings_.axes) warn("axes mean nothing for a height grid, north is up there");
        return std::move(file_);
    }

private:
    void warn(std::string_view what) { file_.warnings.push_back(fmt::format("{}: {}", name_, what)); }
    [[nodiscard]] double middle_height() const {
        std::vector<double> heights;
        std::copy_if(grid_.heights.begin(), grid_.heights.end(), std::back_inserter(heights),
                     [](double h) { return !std::isnan(h); });
        return heights.empty() ? 0 : middle_of(heights);
    }
    [[nodiscard]] Eigen::Vector2d middle_of_cell(std::size_t column, std::size_t row) const {
        return grid_.first + grid_.next_column * static_cast<double>(column) +
               grid_.next_row * static_cast<double>(row);
    }
    Result<PlaceOnEarth> find_place() const {
        PlaceOnEarth::Extent extent;
        for (const std::size_t row : {std::size_t{0}, grid_.rows - 1})
            for (const std::size_t column : {std::size_t{0}, grid_.columns - 1})
                extent.include(middle_of_cell(column, row));
        CityFileSettings settings = settings_;
        settings.metres_per_unit = 1;  // has been applied to all numbers
        const bool of_a_map = grid_.system->kind == CoordinateKind::projected;
        return PlaceOnEarth::make(*grid_.system, extent, of_a_map ? middle_height() : 0, settings);
    }

    Result<void> place_cells() {
        const auto place = find_place();
        if (!place) {
            const std::string of = grid_.system->named ? fmt::format("{}: ", shown(grid_.system->name)) : "";
            return fail(place.error().code, fmt::format("{}: {}{}", name_, of, place.error().message));
        }
        file_.model.origin = place->origin();
        file_.anchor = place->anchor();
        for (const std::string& doubt : place->doubts(settings_, true))
            warn(doubt);
        file_.model.materials = {settings_.material};
        numbers_.assign(grid_.heights.size(), no_vertex);
        for (std::size_t i = 0; i < grid_.heights.size(); ++i) {
            if (std::isnan(grid_.heights[i])) continue;
            const Eigen::Vector2d middle = middle_of_cell(i % grid_.columns, i / grid_.columns);
            numbers_[i] = static_cast<std::uint32_t>(file_.model.vertices.size());
            file_.model.vertices.push_back((*place)({middle.x(), middle.y(), grid_.heights[i]}));
        }
        return {};
    }

    // Two triangles between four neighbours; one where a fourth is absent. Seen from above they turn left, as rows run
    // south or, in some files, north.
    void join_cells() {
        const bool southward = grid_.next_column.x() * grid_.next_row.y() < grid_.next_column.y() * grid_.next_row.x();
        const std::size_t columns = grid_.columns;
        for (std::size_t row = 0; row + 1 < grid_.rows; ++row)
            for (std::size_t column = 0; column + 1 < columns; ++column) {
                std::size_t north_west = row * columns + column, south_west = north_west + columns;
                if (!southward) std::swap(north_west, south_west);
                const std::array<std::uint32_t, 4> around{numbers_[south_west], numbers_[south_west + 1],
                                                          numbers_[north_west + 1], numbers_[north_west]};
                // Along the diagonal whose ends have heights.
                const std::size_t turn = around[0] == no_vertex || around[2] == no_vertex ? 1 : 0;
                add_ground({around[turn], around[turn + 1], around[turn + 2]});
                add_ground({around[turn], around[turn + 2], around[(turn + 3) % 4]});
            }
    }
    void add_ground(const std::array<std::uint32_t, 3>& corners) {
        if (std::find(corners.begin(), corners.end(), no_vertex) == corners.end())
            file_.model.triangles.push_back({corners, SurfaceKind::ground, 0});
    }

    HeightGrid grid_;
    std::string_view name_;
    const CityFileSettings& settings_;
    std::vector<std::uint32_t> numbers_;  // of vertices, by cell
    CityFile file_;
};

}  // namespace

double HeightGrid::usable(double height, bool absent, const CityFileSettings& settings) {
    const double metres = height * settings.metres_per_unit;
    const bool possible = std::abs(metres) < 1e6;
    if (!absent && !possible) ++dropped;
    return absent || !possible ? std::nan("") : metres;
}

Result<void> check_grid_size(const HeightGrid& grid, std::string_view name, const CityFileSettings& settings) {
    const std::size_t cells = grid.columns * grid.rows;
    const std::size_t triangles = 2 * (grid.columns - 1) * (grid.rows - 1);
    if (triangles <= settings.most_triangles && cells <= std::numeric_limits<std::uint32_t>::max()) return {};
    return fail(ErrorCode::input,
                fmt::format("{}: holds {} triangles, {} are the most that is read ({} would take {:.3g} GB of memory)",
                            name, triangles, settings.most_triangles, triangles,
                            static_cast<double>(triangles * sizeof(CityTriangle) + cells * 24) / 1e9));
}

Result<CityFile> city_of_grid(HeightGrid grid, std::string_view name, const CityFileSettings& settings) {
    return GridGround(std::move(grid), name, settings).build();
}

}  // namespace skyloop
