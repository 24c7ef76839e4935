#include "skyloop/geo/geoid.hpp"

#include <fmt/format.h>

#include <GeographicLib/Geoid.hpp>
#include <exception>

namespace skyloop {

Geoid::Geoid(std::unique_ptr<GeographicLib::Geoid> grid) : grid_(std::move(grid)) {}
Geoid::Geoid(Geoid&&) noexcept = default;
Geoid& Geoid::operator=(Geoid&&) noexcept = default;
Geoid::~Geoid() = default;

Result<Geoid> Geoid::open(const std::filesystem::path& grid_file) {
    try {
        auto grid = std::make_unique<GeographicLib::Geoid>(grid_file.stem().string(), grid_file.parent_path().string());
        return Geoid(std::move(grid));
    } catch (const std::exception& reason) {
        return fail(ErrorCode::outside,
                    fmt::format("{}: no geoid grid ({}); the build makes it from egm96_15.gtx of Debian's package proj-data",
                                grid_file.string(), reason.what()));
    }
}

Metres Geoid::undulation(Angle latitude, Angle longitude) const {
    return Metres((*grid_)(latitude.deg(), longitude.deg()));
}

}  // namespace skyloop
