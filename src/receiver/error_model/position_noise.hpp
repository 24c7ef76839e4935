/// White position noise that draws the same numbers whatever the sky looks like.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "base/core/random.hpp"

namespace skyloop {

/// Three normal numbers an epoch. An epoch without a fix draws them too, so that no later epoch depends on how many
/// satellites were visible before.
class PositionNoise {
public:
    PositionNoise(std::uint64_t seed, std::string_view stream) : random_(seed, stream) {}
    /// Three independent standard normal numbers. Call once an epoch.
    Eigen::Vector3d draw() {
        Eigen::Vector3d numbers;
        for (double& number : numbers)
            number = random_.normal();
        return numbers;
    }

private:
    RandomStream random_;
};

}  // namespace skyloop
