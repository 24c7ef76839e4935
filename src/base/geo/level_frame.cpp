#include "base/geo/level_frame.hpp"

#include <cmath>

namespace skyloop {

LevelFrame::LevelFrame(const LevelPlacement& placement) : placement_(placement), local_(placement.origin) {
    const double s = std::sin(placement.yaw.rad());
    const double c = std::cos(placement.yaw.rad());
    const double y = placement.left_handed ? 1 : -1;  // Y points to the right of X, or to its left
    level_to_enu_ << s, y * c, 0,                     //
        c, -y * s, 0,                                 //
        0, 0, 1;
    level_to_enu_ *= placement.unit.value();
}

Position<Ecef> LevelFrame::to_ecef(const Position<Level>& point) const {
    return local_.to_ecef(Position<Enu>(level_to_enu_ * point.vector()));
}

Position<Level> LevelFrame::to_level(const Position<Ecef>& point) const {
    const double unit = placement_.unit.value();
    return Position<Level>(level_to_enu_.transpose() * local_.to_enu(point).vector() / (unit * unit));
}

Velocity<Ecef> LevelFrame::to_ecef(const Velocity<Level>& velocity) const {
    return local_.to_ecef(Velocity<Enu>(level_to_enu_ * velocity.vector()));
}

bool LevelFrame::beyond_reach(const Position<Level>& point) const {
    return point.vector().head<2>().norm() * placement_.unit.value() > placement_.reach.value();
}

}  // namespace skyloop
