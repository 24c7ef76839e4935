/// From the coordinates of a reference system to WGS 84, by PROJ.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>

#include "base/core/result.hpp"

struct PJconsts;
struct pj_ctx;

namespace skyloop::inline world {

/// A reference system of maps or of latitudes and longitudes, alone or with heights. Each has a PROJ context of its
/// own, which never asks the network. Not for several threads at once.
///
/// Places are east, north in the units of the system, or longitude, latitude, whatever the order of its axes.
class EarthMap {
public:
    /// @param definition whatever PROJ reads: "EPSG:7415", "EPSG:25832+7837", WKT
    /// Fails with `input` for a system that is unknown or of another kind, with `outside` without PROJ's database.
    static Result<std::shared_ptr<EarthMap>> open(const std::string& definition);

    bool geographic = false;      ///< latitudes and longitudes
    bool north_first = false;     ///< the registry's first axis points north
    std::string vertical_system;  ///< its name; empty without one
    bool knows_heights = false;   ///< PROJ can do the heights of the vertical system, once settled
    std::string why_no_heights;   ///< else: "the grid nl_nsgi_nlgeo2018.tif is not installed"

    /// How a place fits the area of use: by more than 15° of longitude or 10° of latitude not, nearly, or well.
    enum class Fit { none, near, inside };
    [[nodiscard]] Fit fit(const Eigen::Vector2d& place) const { return fit_of(bare(place)); }

    /// Takes the operations that PROJ prefers at a place for all that follow, so that no seam runs through a city.
    /// @returns what is doubtful about them, one line; empty where nothing is
    std::string settle(const Eigen::Vector2d& place);

    /// Longitude and latitude of WGS 84, degrees; not finite where the map has no such place. Eastings of UTM may have
    /// the zone before them: 32691603 is 691603 in zone 32.
    [[nodiscard]] Eigen::Vector2d on_earth(const Eigen::Vector2d& place) const { return transformed(bare(place)); }
    /// The height above the ellipsoid of one of the vertical system, m. Only where it knows_heights.
    [[nodiscard]] double ellipsoidal_height(const Eigen::Vector3d& place) const;

private:
    using Object = std::shared_ptr<PJconsts>;

    EarthMap();
    Result<void> read(const std::string& definition);
    [[nodiscard]] Object object(PJconsts* made) const;
    [[nodiscard]] Object operation(const Object& from, const Object& to) const;
    [[nodiscard]] Object used_at(const Object& operations, const Eigen::Vector2d& place) const;
    [[nodiscard]] std::string missing_grid(const Object& from, const Object& to, const Eigen::Vector2d& degrees) const;
    [[nodiscard]] Eigen::Vector2d transformed(const Eigen::Vector2d& place) const;
    [[nodiscard]] Fit fit_of(const Eigen::Vector2d& place) const;
    [[nodiscard]] Eigen::Vector2d bare(const Eigen::Vector2d& place) const;

    std::shared_ptr<pj_ctx> context_;
    Object system_, flat_system_, wgs84_, wgs84_heights_;
    Object flat_, heights_;  ///< operations: one for each part of the area until settle(), one for all after it
    int zone_ = 0;           ///< of UTM
    double west_ = -180, south_ = -90, east_ = 180, north_ = 90;
};

/// Changes when PROJ's version or the files in its folders do: what a file was understood as may then be another.
std::uint64_t proj_data_digest();

}  // namespace skyloop::inline world
