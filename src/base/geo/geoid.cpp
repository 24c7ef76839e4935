#include "base/geo/geoid.hpp"

#include <fmt/format.h>

#include <GeographicLib/Geoid.hpp>
#include <algorithm>
#include <cmath>
#include <exception>
#include <string_view>
#include <system_error>

namespace skyloop::inline base {

Geoid::Geoid(std::unique_ptr<GeographicLib::Geoid> grid) : grid_(std::move(grid)) {}
Geoid::Geoid(Geoid&&) noexcept = default;
Geoid& Geoid::operator=(Geoid&&) noexcept = default;
Geoid::~Geoid() = default;

Result<Geoid> Geoid::open(const std::filesystem::path& grid_file) {
    const auto refused = [&](std::string_view reason) {
        return fail(ErrorCode::outside,
                    fmt::format("{}: no geoid grid: {}; the build makes egm96-15.pgm from Debian's package proj-data",
                                grid_file.string(), reason));
    };
    // GeographicLib adds the ending itself, and a fifo would hang it.
    if (grid_file.extension() != ".pgm") return refused("its name does not end in .pgm");
    std::error_code ignored;
    if (!std::filesystem::exists(grid_file, ignored)) return refused("no such file");
    if (!std::filesystem::is_regular_file(grid_file, ignored)) return refused("not a regular file");
    // An empty folder would mean GeographicLib's own.
    const std::filesystem::path folder = grid_file.has_parent_path() ? grid_file.parent_path() : ".";
    constexpr bool cubic = true;
    constexpr bool whole_in_memory = true;  // so that a look-up neither reads the disk nor changes a cache
    try {
        return Geoid(
            std::make_unique<GeographicLib::Geoid>(grid_file.stem().string(), folder.string(), cubic, whole_in_memory));
    } catch (const std::exception& reason) {
        return refused(reason.what());
    }
}

Metres Geoid::undulation(Angle latitude, Angle longitude) const {
    return Metres((*grid_)(latitude.deg(), longitude.deg()));
}

Metres Geoid::undulation(Angle latitude, Angle longitude, double step_deg) const {
    if (!(step_deg > 0)) return undulation(latitude, longitude);
    const auto cell = [step_deg](double degrees) { return std::floor(degrees / step_deg) * step_deg; };
    const double south = std::min(cell(latitude.deg()), 90 - step_deg), west = cell(longitude.deg());
    const double up = (latitude.deg() - south) / step_deg, right = (longitude.deg() - west) / step_deg;
    const auto row = [&](double at) {
        return (1 - right) * (*grid_)(at, west) + right * (*grid_)(at, west + step_deg);
    };
    return Metres((1 - up) * row(south) + up * row(south + step_deg));
}

}  // namespace skyloop::inline base
