/// A path that several antennas share.
#pragma once

#include <memory>
#include <utility>

#include "motion/trajectory/trajectory.hpp"

namespace skyloop {

/// Is where another path is, which it keeps alive.
class SharedPath : public Trajectory {
public:
    explicit SharedPath(std::shared_ptr<const Trajectory> path) : path_(std::move(path)) {}
    [[nodiscard]] TruthState at(GpsTime time) const override { return path_->at(time); }

private:
    std::shared_ptr<const Trajectory> path_;
};

}  // namespace skyloop
