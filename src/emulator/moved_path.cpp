#include "skyloop/emulator/moved_path.hpp"

#include "skyloop/geo/local_frame.hpp"

namespace skyloop {

MovedPath::MovedPath(std::unique_ptr<Trajectory> path, const Geodetic& place, GpsTime now)
    : path_(std::move(path)), from_(path_->at(now).geodetic), to_(place) {}

TruthState MovedPath::at(GpsTime time) const {
    TruthState state = path_->at(time);
    const LocalFrame from(from_), to(to_);
    state.position = to_ecef(to_) + to.to_ecef(from.to_enu(state.position - to_ecef(from_)));
    state.velocity = to.to_ecef(from.to_enu(state.velocity));
    state.geodetic = to_geodetic(state.position);
    return state;
}

}  // namespace skyloop
