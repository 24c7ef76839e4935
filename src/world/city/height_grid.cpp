#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/core/lowered_text.hpp"
#include "base/core/middle.hpp"
#include "detail/city_text.hpp"
#include "detail/place_on_earth.hpp"
#include "world/city/city_file.hpp"

namespace skyloop {
namespace {

// A cell so small in degrees, in a grid that fits on the globe, is geographic: 0.1° are 11 km, while few grids in
// metres have cells of a decimetre. Those of drones do, and are more than a few metres wide; a city is not so many
// degrees wide.
constexpr double largest_geographic_cell = 0.1;
constexpr double widest_geographic_grid = 6;

struct HeightGridHeader {
    std::size_t columns = 0, rows = 0;
    double west = 0, south = 0;       ///< of the middle of the south-western cell
    double cell = 0, cell_north = 0;  ///< how wide and how tall a cell is
    double no_data = -9999;           ///< where the header names none (Esri, "ESRI ASCII raster format")
    [[nodiscard]] bool geographic() const {
        const double east = west + static_cast<double>(columns) * cell,
                     north = south + static_cast<double>(rows) * cell_north;
        return std::max(cell, cell_north) <= largest_geographic_cell &&
               std::max(east - west, north - south) <= widest_geographic_grid && west >= -180 && east <= 361 &&
               south >= -90 && north <= 91;
    }
};

// Of the keys of a header, in the order in which they are known.
constexpr std::size_t header_keys = 10;
using HeaderValues = std::array<double, header_keys>;

class HeightGridReader {
public:
    HeightGridReader(std::string_view text, std::string_view name, const CityFileSettings& settings)
        : text_(text), name_(name), settings_(settings), at_(text.data()), end_(at_ + text.size()) {}

    Result<CityFile> read() {
        if (auto done = read_header(); !done) return fail(std::move(done.error()));
        if (auto done = read_heights(); !done) return fail(std::move(done.error()));
        if (auto done = place_cells(); !done) return fail(std::move(done.error()));
        join_cells();
        if (file_.model.triangles.empty())
            return fail(ErrorCode::input, fmt::format("{}: no four neighbours have a height", name_));
        file_.format = "height grid";
        if (file_.dropped > 0)
            file_.warnings.push_back(
                fmt::format("{}: {} heights are no numbers and were left out", name_, file_.dropped));
        if (settings_.file_origin != Eigen::Vector3d::Zero() && !settings_.anchor)
            file_.warnings.push_back(fmt::format("{}: {}", name_, file_origin_unused));
        if (settings_.axes)
            file_.warnings.push_back(fmt::format("{}: axes mean nothing for a height grid, north is up there", name_));
        return std::move(file_);
    }

private:
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
            const std::string key = lowered_text(next_word());
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
        header_.columns = static_cast<std::size_t>(values[0]);
        header_.rows = static_cast<std::size_t>(values[1]);
        header_.cell = cell;
        header_.cell_north = cell_north;
        header_.west = has(5) ? values[5] : values[3] + cell / 2;
        header_.south = has(6) ? values[6] : values[4] + cell_north / 2;
        if (has(7)) header_.no_data = values[7];
        if (!(std::abs(header_.west) < 1e9 && std::abs(header_.south) < 1e9))
            return fail(ErrorCode::input,
                        fmt::format("{}: its corner {}, {} lies nowhere", name_, header_.west, header_.south));
        const std::size_t cells = header_.columns * header_.rows;
        const std::size_t triangles = 2 * (header_.columns - 1) * (header_.rows - 1);
        if (triangles > settings_.most_triangles || cells > std::numeric_limits<std::uint32_t>::max())
            return fail(
                ErrorCode::input,
                fmt::format("{}: holds {} triangles, {} are the most that is read ({} would take {:.3g} GB of memory)",
                            name_, triangles, settings_.most_triangles, triangles,
                            static_cast<double>(triangles * sizeof(CityTriangle) + cells * 24) / 1e9));
        const auto left = static_cast<std::size_t>(end_ - at_);
        if (cells > (left + 1) / 2)
            return fail(ErrorCode::input, fmt::format("{}: tells of {} by {} cells, but {} bytes are left", name_,
                                                      header_.columns, header_.rows, left));
        return {};
    }

    // Rows from north to south; a height that is absent or no number is NaN afterwards.
    Result<void> read_heights() {
        heights_.reserve(header_.columns * header_.rows);
        for (std::size_t i = 0; i < header_.columns * header_.rows; ++i) {
            const auto height = next_number("a height");
            if (!height) return fail(height.error());
            const bool absent = *height == header_.no_data;
            const double metres = *height * settings_.metres_per_unit;
            const bool usable = std::abs(metres) < 1e6;
            if (!absent && !usable) ++file_.dropped;
            heights_.push_back(absent || !usable ? std::nan("") : metres);
        }
        if (const std::string_view more = next_word(); !more.empty())
            return fail(ErrorCode::input, fmt::format("{}: found '{}' after the last of {} by {} heights", here(),
                                                      shown(more), header_.columns, header_.rows));
        return {};
    }

    // Metres that far from 0, 0 are those of a map; the grid does not say of which.
    [[nodiscard]] bool of_a_map() const {
        return !header_.geographic() &&
               std::max(std::abs(header_.west), std::abs(header_.south)) * settings_.metres_per_unit > farthest_local;
    }
    [[nodiscard]] double middle_height() const {
        std::vector<double> heights;
        std::copy_if(heights_.begin(), heights_.end(), std::back_inserter(heights),
                     [](double h) { return !std::isnan(h); });
        return heights.empty() ? 0 : middle_of(heights);
    }
    [[nodiscard]] Eigen::Vector2d middle_of_cell(std::size_t column, std::size_t row) const {
        const double unit = header_.geographic() ? 1 : settings_.metres_per_unit;
        return Eigen::Vector2d(header_.west + header_.cell * static_cast<double>(column),
                               header_.south + header_.cell_north * static_cast<double>(header_.rows - 1 - row)) *
               unit;
    }
    Result<PlaceOnEarth> find_place() {
        const CoordinateKind kind = header_.geographic() ? CoordinateKind::geographic
                                    : of_a_map()         ? CoordinateKind::projected
                                                         : CoordinateKind::local;
        PlaceOnEarth::Extent extent;
        extent.include(middle_of_cell(0, 0));
        extent.include(middle_of_cell(header_.columns - 1, header_.rows - 1));
        const ReferenceSystem system{kind, false, "unnamed", {}, false};
        if (std::string doubt = PlaceOnEarth::doubt_of_heights(system, settings_); !doubt.empty())
            file_.warnings.push_back(fmt::format("{}: {}", name_, doubt));
        CityFileSettings settings = settings_;
        settings.metres_per_unit = 1;  // has been applied to all numbers
        return PlaceOnEarth::make(system, extent, of_a_map() ? middle_height() : 0, settings);
    }

    Result<void> place_cells() {
        const auto place = find_place();
        if (!place) return fail(place.error().code, fmt::format("{}: {}", name_, place.error().message));
        file_.model.origin = place->origin();
        file_.anchor = place->anchor();
        if (std::string doubt = place->doubt_of_map(settings_); !doubt.empty())
            file_.warnings.push_back(fmt::format("{}: {}", name_, doubt));
        file_.model.materials = {settings_.material};
        numbers_.assign(heights_.size(), ~0U);
        for (std::size_t i = 0; i < heights_.size(); ++i) {
            if (std::isnan(heights_[i])) continue;
            const Eigen::Vector2d middle = middle_of_cell(i % header_.columns, i / header_.columns);
            numbers_[i] = static_cast<std::uint32_t>(file_.model.vertices.size());
            file_.model.vertices.push_back((*place)({middle.x(), middle.y(), heights_[i]}));
        }
        return {};
    }

    // Two triangles between four neighbours; one where a fourth is absent.
    void join_cells() {
        const std::size_t columns = header_.columns;
        for (std::size_t row = 0; row + 1 < header_.rows; ++row)
            for (std::size_t column = 0; column + 1 < columns; ++column) {
                const std::size_t north_west = row * columns + column, south_west = north_west + columns;
                const std::array<std::uint32_t, 4> around{numbers_[south_west], numbers_[south_west + 1],
                                                          numbers_[north_west + 1], numbers_[north_west]};
                // Along the diagonal whose ends have heights.
                const std::size_t turn = around[0] == ~0U || around[2] == ~0U ? 1 : 0;
                add_ground({around[turn], around[turn + 1], around[turn + 2]});
                add_ground({around[turn], around[turn + 2], around[(turn + 3) % 4]});
            }
    }
    void add_ground(const std::array<std::uint32_t, 3>& corners) {
        for (const std::uint32_t corner : corners)
            if (corner == ~0U) return;
        file_.model.triangles.push_back({corners, SurfaceKind::ground, 0});
    }

    std::string_view text_, name_;
    const CityFileSettings& settings_;
    const char* at_;
    const char* end_;
    HeightGridHeader header_;
    std::vector<double> heights_;
    std::vector<std::uint32_t> numbers_;  // of vertices, by cell
    CityFile file_;
};

}  // namespace

Result<CityFile> parse_height_grid(std::string_view text, std::string_view name, const CityFileSettings& settings) {
    return HeightGridReader(without_byte_order_mark(text), name, settings).read();
}

}  // namespace skyloop
