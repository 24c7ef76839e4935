/// One epoch, from where the antenna is to what the receiver believes.
#pragma once

#include <memory>
#include <vector>

#include "skyloop/base/units.hpp"
#include "skyloop/error_model/error_model.hpp"
#include "skyloop/flow/trace.hpp"
#include "skyloop/gnss/navigation_source.hpp"
#include "skyloop/propagation/effect.hpp"
#include "skyloop/trajectory/trajectory.hpp"

namespace skyloop {

/// The world and the sensor model of one antenna.
class Simulation {
public:
    struct Parts {
        std::unique_ptr<Trajectory> trajectory;
        std::unique_ptr<NavigationSource> navigation;
        std::vector<std::unique_ptr<PropagationEffect>> effects;  ///< in the order in which they are applied
        std::unique_ptr<ErrorModel> error_model;
    };
    explicit Simulation(Parts parts) : parts_(std::move(parts)) {}

    /// Epochs come in ascending time.
    Trace run(GpsTime time);
    /// What stands above an antenna, and nothing of what reaches it.
    [[nodiscard]] SkyView view(const TruthState& truth) const;
    [[nodiscard]] const NavigationSource& navigation() const { return *parts_.navigation; }

private:
    Parts parts_;
};

}  // namespace skyloop
