/// The EGM96 geoid.
#pragma once

#include <filesystem>
#include <memory>

#include "base/core/result.hpp"
#include "base/geo/geodetic.hpp"

namespace GeographicLib {
class Geoid;
}

namespace skyloop::inline base {

/// Geoid undulations on the 15-minute EGM96 grid, cubic interpolation (GeographicLib::Geoid).
class Geoid {
public:
    /// Opens a grid file in GeographicLib's format, e.g. build/share/skyloop/geoids/egm96-15.pgm.
    /// Fails with `outside` and a sentence that says how the file is made.
    static Result<Geoid> open(const std::filesystem::path& grid_file);

    Geoid(Geoid&&) noexcept;
    Geoid& operator=(Geoid&&) noexcept;
    ~Geoid();

    /// Height of the geoid above the ellipsoid, N.
    [[nodiscard]] Metres undulation(Angle latitude, Angle longitude) const;
    /// For a receiver that stores the geoid at every `step_deg` of latitude and longitude, and
    /// interpolates linearly; 0: the whole grid.
    [[nodiscard]] Metres undulation(Angle latitude, Angle longitude, double step_deg) const;

private:
    explicit Geoid(std::unique_ptr<GeographicLib::Geoid> grid);
    std::unique_ptr<GeographicLib::Geoid> grid_;
};

}  // namespace skyloop::inline base
