#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "base/core/std_additions.hpp"
#include "base/core/words.hpp"
#include "detail/city_text.hpp"
#include "detail/height_grid.hpp"
#include "detail/place_on_earth.hpp"
#include "world/city/city_file.hpp"

namespace skyloop::inline world {
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

namespace {

// A cell so small in degrees, in a grid that fits on the globe, is geographic: 0.1° are 11 km, while few grids in
// metres have cells of a decimetre. Those of drones do, and are more than a few metres wide; a city is not so many
// degrees wide.
constexpr double largest_geographic_cell = 0.1;
constexpr double widest_geographic_grid = 6;

struct HeightGridHeader {
    double west = 0, south = 0;       ///< of the middle of the south-western cell
    double cell = 0, cell_north = 0;  ///< how wide and how tall a cell is
    double no_data = -9999;           ///< where the header names none (Esri, "ESRI ASCII raster format")
};

// Of the keys of a header, in the order in which they are known.
constexpr std::size_t header_keys = 10;
using HeaderValues = std::array<double, header_keys>;

class HeightGridReader {
public:
    HeightGridReader(std::string_view text, std::string_view name, const CityFileSettings& settings)
        : text_(text), name_(name), settings_(settings), at_(text.data()), end_(at_ + text.size()) {}

    Result<HeightGrid> read() {
        if (auto done = read_header(); !done) return fail(std::move(done.error()));
        if (auto done = read_heights(); !done) return fail(std::move(done.error()));
        grid_.system = reference_system_of_file("", settings_);
        const bool local =
            std::max(std::abs(header_.west), std::abs(header_.south)) * settings_.metres_per_unit <= farthest_local;
        // Metres that far from 0, 0 are those of a map; the grid does not say of which.
        const bool no_map = grid_.system && !grid_.system->named;
        const bool degrees = !no_map && geographic();  // also where the buildings' map is named
        if (!grid_.system || no_map || (degrees && grid_.system->kind != CoordinateKind::geographic))
            grid_.system = unnamed_system(degrees ? CoordinateKind::geographic
                                          : local ? CoordinateKind::local
                                                  : CoordinateKind::projected);
        const double unit = grid_.system->lies_on_earth() ? 1 : settings_.metres_per_unit;
        grid_.first = unit * Eigen::Vector2d(header_.west,
                                             header_.south + header_.cell_north * static_cast<double>(grid_.rows - 1));
        grid_.next_column = {unit * header_.cell, 0};
        grid_.next_row = {0, -unit * header_.cell_north};
        return std::move(grid_);
    }

private:
    [[nodiscard]] bool geographic() const {
        const double width = static_cast<double>(grid_.columns) * header_.cell,
                     height = static_cast<double>(grid_.rows) * header_.cell_north;
        return std::max(header_.cell, header_.cell_north) <= largest_geographic_cell &&
               std::max(width, height) <= widest_geographic_grid && header_.west >= -180 &&
               header_.west + width <= 361 && header_.south >= -90 && header_.south + height <= 91;
    }
    [[nodiscard]] std::string here() const {
        return line_place(name_, text_, static_cast<std::size_t>(at_ - text_.data()));
    }
    static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
    std::string_view next_word() {
        while (at_ != end_ && is_space(*at_))
            ++at_;
        const char* first = at_;
        while (at_ != end_ && !is_space(*at_))
            ++at_;
        return {first, static_cast<std::size_t>(at_ - first)};
    }
    Result<double> next_number(std::string_view what) {
        const std::string_view word = next_word();
        const char* first = word.data();
        const auto number = word.empty() ? std::nullopt : take_number(first, word.data() + word.size());
        if (!number || first != word.data() + word.size())
            return fail(ErrorCode::input, word.empty()
                                              ? fmt::format("{}: ends where {} was expected", here(), what)
                                              : fmt::format("{}: expected {}, found '{}'", here(), what, shown(word)));
        return *number;
    }

    // Keywords in any order, until a number stands where one could be.
    Result<void> read_header() {
        constexpr std::array<std::string_view, header_keys> keys{"ncols",     "nrows",     "cellsize",  "xllcorner",
                                                                 "yllcorner", "xllcenter", "yllcenter", "nodata_value",
                                                                 "dx",        "dy"};
        HeaderValues values{};
        unsigned seen = 0;
        for (;;) {
            const char* before = at_;
            const std::string key = lower_case(next_word());
            const auto found = std::find(keys.begin(), keys.end(), key);
            if (found == keys.end()) {
                const bool letter = !key.empty() && key[0] >= 'a' && key[0] <= 'z' && key != "nan" && key != "inf";
                if (letter || seen == 0)
                    return fail(ErrorCode::input,
                                fmt::format("{}: '{}' is no key of a height grid; expected ncols, nrows, "
                                            "xllcorner, yllcorner, cellsize, dx, dy or NODATA_value",
                                            here(), shown(key)));
                at_ = before;
                break;
            }
            const auto index = static_cast<std::size_t>(found - keys.begin());
            const auto value = next_number(fmt::format("a number for {}", *found));
            if (!value) return fail(value.error());
            values[index] = *value;
            seen |= 1U << index;
        }
        return take_header(values, seen);
    }

    Result<void> take_header(const HeaderValues& values, unsigned seen) {
        const auto has = [seen](unsigned key) { return (seen >> key & 1U) != 0; };
        const bool oblong = has(8) && has(9);
        if (!has(0) || !has(1) || !(has(2) || oblong) || (!has(3) && !has(5)) || (!has(4) && !has(6)))
            return fail(ErrorCode::input,
                        fmt::format("{}: expected ncols, nrows, xllcorner, yllcorner and cellsize, or dx and "
                                    "dy, before the heights",
                                    here()));
        const auto whole = [](double value) { return value >= 2 && value <= 1e9 && value == std::floor(value); };
        if (!whole(values[0]) || !whole(values[1]))
            return fail(ErrorCode::input, fmt::format("{}: a grid of {} by {} cells; expected 2 or more each way",
                                                      name_, values[0], values[1]));
        const double cell = has(2) ? values[2] : values[8], cell_north = has(2) ? values[2] : values[9];
        if (!(std::min(cell, cell_north) > 0 && std::max(cell, cell_north) < 1e7))
            return fail(ErrorCode::input,
                        has(2) ? fmt::format("{}: cellsize {}; expected more than 0", name_, cell)
                               : fmt::format("{}: dx {} and dy {}; expected more than 0", name_, cell, cell_north));
        grid_.columns = static_cast<std::size_t>(values[0]);
        grid_.rows = static_cast<std::size_t>(values[1]);
        header_.cell = cell;
        header_.cell_north = cell_north;
        header_.west = has(5) ? values[5] : values[3] + cell / 2;
        header_.south = has(6) ? values[6] : values[4] + cell_north / 2;
        if (has(7)) header_.no_data = values[7];
        if (!(std::abs(header_.west) < 1e9 && std::abs(header_.south) < 1e9))
            return fail(ErrorCode::input,
                        fmt::format("{}: its corner {}, {} lies nowhere", name_, header_.west, header_.south));
        if (auto done = check_grid_size(grid_, name_, settings_); !done) return done;
        const std::size_t cells = grid_.columns * grid_.rows;
        const auto left = static_cast<std::size_t>(end_ - at_);
        if (cells > (left + 1) / 2)
            return fail(ErrorCode::input, fmt::format("{}: tells of {} by {} cells, but {} bytes are left", name_,
                                                      grid_.columns, grid_.rows, left));
        return {};
    }

    // Rows from north to south.
    Result<void> read_heights() {
        grid_.heights.reserve(grid_.columns * grid_.rows);
        for (std::size_t i = 0; i < grid_.columns * grid_.rows; ++i) {
            const auto height = next_number("a height");
            if (!height) return fail(height.error());
            grid_.heights.push_back(grid_.usable(*height, *height == header_.no_data, settings_));
        }
        if (const std::string_view more = next_word(); !more.empty())
            return fail(ErrorCode::input, fmt::format("{}: found '{}' after the last of {} by {} heights", here(),
                                                      shown(more), grid_.columns, grid_.rows));
        return {};
    }

    std::string_view text_, name_;
    const CityFileSettings& settings_;
    const char* at_;
    const char* end_;
    HeightGridHeader header_;
    HeightGrid grid_;
};

}  // namespace

Result<CityFile> parse_height_grid(std::string_view text, std::string_view name, const CityFileSettings& settings) {
    auto grid = HeightGridReader(without_byte_order_mark(text), name, settings).read();
    if (!grid) return fail(grid.error());
    return city_of_grid(std::move(*grid), name, settings);
}

}  // namespace skyloop::inline world
