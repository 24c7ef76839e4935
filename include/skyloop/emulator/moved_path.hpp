/// A path that was moved while somebody was on it.
#pragma once

#include <memory>

#include "skyloop/geo/geodetic.hpp"
#include "skyloop/trajectory/trajectory.hpp"

namespace skyloop {

/// Another path carried to another place: at `now` it is at `place`, and from there it makes the same way over the
/// ground, in east, north and up.
class MovedPath : public Trajectory {
public:
    MovedPath(std::unique_ptr<Trajectory> path, const Geodetic& place, GpsTime now);
    [[nodiscard]] TruthState at(GpsTime time) const override;

private:
    std::unique_ptr<Trajectory> path_;
    Geodetic from_, to_;
};

}  // namespace skyloop
