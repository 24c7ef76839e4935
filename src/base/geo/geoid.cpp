#include "base/geo/geoid.hpp"

#include <fmt/format.h>

#include <GeographicLib/Geoid.hpp>
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

}  // namespace skyloop::inline base
