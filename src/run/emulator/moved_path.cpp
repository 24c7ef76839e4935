#include "run/emulator/moved_path.hpp"

#include "base/geo/local_frame.hpp"

namespace skyloop {
namespace {

// What takes east, north and up of one place to those of another.
Eigen::Matrix3d turn_between(const Geodetic& from, const Geodetic& to) {
    const LocalFrame here(from), there(to);
    Eigen::Matrix3d turn;
    for (int axis = 0; axis < turn.cols(); ++axis)
        turn.col(axis) = there.to_ecef(here.to_enu(Displacement<Ecef>(Eigen::Vector3d::Unit(axis)))).vector();
    return turn;
}

}  // namespace

std::unique_ptr<Trajectory> MovedPath::moved(std::unique_ptr<Trajectory> path, const Geodetic& place, GpsTime now) {
    if (auto* again = dynamic_cast<MovedPath*>(path.get())) {
        again->move(place, now);
        return path;
    }
    std::unique_ptr<MovedPath> first(new MovedPath(std::move(path)));
    first->move(place, now);
    return first;
}

void MovedPath::move(const Geodetic& place, GpsTime now) {
    const TruthState unmoved = path_->at(now);
    const Geodetic before = to_geodetic(to_ + Displacement<Ecef>(turn_ * (unmoved.position - from_).vector()));
    turn_ = turn_between(before, place) * turn_;
    from_ = unmoved.position;
    to_ = to_ecef(place);
}

TruthState MovedPath::at(GpsTime time) const {
    TruthState state = path_->at(time);
    state.position = to_ + Displacement<Ecef>(turn_ * (state.position - from_).vector());
    state.velocity = Velocity<Ecef>(turn_ * state.velocity.vector());
    state.geodetic = to_geodetic(state.position);
    return state;
}

}  // namespace skyloop
