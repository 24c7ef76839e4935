/// One epoch, from where the antenna is to what the receiver believes.
#pragma once

#include <functional>
#include <memory>
#include <variant>
#include <vector>

#include "motion/trajectory/trajectory.hpp"
#include "receiver/error_model/error_model.hpp"
#include "receiver/measurement/measurement_engine.hpp"
#include "receiver/measurement/sbas_reception.hpp"
#include "receiver/measurement/subframe_reception.hpp"
#include "receiver/pvt/navigation_engine.hpp"
#include "run/fault/active_faults.hpp"
#include "world/flow/receiver_settings.hpp"
#include "world/flow/trace.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/sbas_message.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/ray_traced_scene.hpp"
#include "world/sky/observe_sky.hpp"

namespace skyloop::inline run {

/// A receiver that measures what arrives and solves it: the modern profile.
struct MeasuringReceiver {
    MeasurementEngine measurement;
    NavigationEngine navigation;
};

/// The two ways to a fix.
using FixMaker = std::variant<std::unique_ptr<ErrorModel>, MeasuringReceiver>;

/// The world and the receiver's solution of one antenna.
class Simulation {
public:
    struct Parts {
        std::unique_ptr<Trajectory> trajectory;
        std::shared_ptr<const NavigationSource> navigation;       ///< that the antennas of a run share
        std::vector<std::unique_ptr<PropagationEffect>> effects;  ///< in the order in which they are applied
        FixMaker fix_maker;
        const RayTracedScene* city = nullptr;           ///< one of the effects; null: nothing stands around
        std::shared_ptr<const OsnmaKeys> osnma{};       ///< of Galileo's pages; null: they are not authenticated
        std::shared_ptr<const PreciseTruth> precise{};  ///< where the satellites are; null: where their records say
        std::unique_ptr<SbasSource> sbas{};             ///< what SBAS satellites send; null: nothing
    };
    explicit Simulation(Parts parts);

    /// Epochs come in ascending time. A receiver that is stopped tracks nothing and has no fix; the world, its clock
    /// and every random number go on. @param settings what the receiver is configured to do
    /// @param faults edit what arrives, what is measured and what is solved; null: none
    Trace run(GpsTime time, const ReceiverSettings& settings, ActiveFaults* faults = nullptr);
    /// Adds the vector from the base of a moving pair, by what both measured at the last instant of run(), and the type
    /// of fix that it makes. @param base null: it has no epoch then, and the type stays for a while
    void relate(Trace& rover, const Trace* base);
    /// What stands above an antenna, and nothing of what reaches it.
    [[nodiscard]] SkyView view(const TruthState& truth) const;
    [[nodiscard]] const NavigationSource& navigation() const { return *parts_.navigation; }
    [[nodiscard]] const std::shared_ptr<const PreciseTruth>& precise() const { return parts_.precise; }
    /// Where the antenna is.
    [[nodiscard]] TruthState truth_at(GpsTime time) const { return parts_.trajectory->at(time); }
    /// The antenna's path from now on. Whoever moves it says so to the device under test, or finds out what it does.
    void replace_trajectory(const std::function<std::unique_ptr<Trajectory>(std::unique_ptr<Trajectory>)>& make) {
        parts_.trajectory = make(std::move(parts_.trajectory));
    }
    /// What the buildings did at the last epoch; null: nothing stands around.
    [[nodiscard]] const RayTracedScene* city() const { return parts_.city; }
    /// True when the receiver measures: there are observations to write down.
    [[nodiscard]] bool measures() const { return std::holds_alternative<MeasuringReceiver>(parts_.fix_maker); }

private:
    void make_fix(MeasuringReceiver& receiver, Trace& trace, const ReceiverSettings& settings, ActiveFaults* faults);

    Parts parts_;
    SkyObserver observer_;
    SubframeReception subframes_;
    SbasReception sbas_reception_;
};

}  // namespace skyloop::inline run
