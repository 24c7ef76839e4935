/// Runs of the modern profile on orbits that need no file.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "base/geo/local_frame.hpp"
#include "motion/trajectory/geometric_paths.hpp"
#include "run/emulator/simulation.hpp"
#include "run/scenario/modern_settings.hpp"
#include "support/four_systems.hpp"
#include "world/propagation/modern_effects.hpp"

namespace skyloop::test {

/// The first signals of GPS, Galileo, BeiDou and GLONASS, down to 5°.
inline ReceiverSettings all_systems() { return {}; }

inline ReceiverSettings gps_alone() {
    ReceiverSettings settings;
    settings.signals = {{Constellation::gps, Signal::l1}};
    return settings;
}

/// What the effects of a run see of it.
inline ModernContext context_of(const ModernSettings& settings, const NavigationSource& navigation,
                                std::uint64_t seed) {
    ModernContext context;
    context.broadcast = navigation.ionosphere();
    if (settings.navigation.corrections.ionosphere != IonosphereCorrection::none)
        context.receiver_correction = IonosphereModel::klobuchar;
    context.seed = seed;
    return context;
}

/// @param settings taken through effective()
inline Simulation modern_run(const ModernSettings& settings, std::unique_ptr<Trajectory> trajectory,
                             std::uint64_t seed = 1, std::unique_ptr<FourSystems> navigation = nullptr) {
    if (!navigation) navigation = std::make_unique<FourSystems>();
    const ModernContext context = context_of(settings, *navigation, seed);
    auto effects = modern_effects(settings.propagation, context);
    EXPECT_TRUE(effects) << effects.error().message;
    MeasuringReceiver receiver{MeasurementEngine(settings.measurement, seed),
                               NavigationEngine(settings.navigation, {navigation.get()})};
    return Simulation({std::move(trajectory), std::move(navigation), std::move(*effects), std::move(receiver)});
}

/// Geometry and the satellites' clocks, and nothing else; every epoch stands alone.
inline Simulation errorless_run(std::unique_ptr<Trajectory> trajectory) {
    ModernSettings settings = ModernSettings::of(ModernPreset::consumer);
    settings.errors = false;
    settings = effective(settings);
    return modern_run(settings, std::move(trajectory));
}

/// East, north and up errors of every epoch with a position.
struct ErrorSeries {
    std::vector<double> east, north, up, horizontal;
    int epochs = 0;
    void add(const Trace& trace) {
        ++epochs;
        if (!trace.epoch.fix.has_position()) return;
        const Eigen::Vector3d error =
            LocalFrame(trace.truth.geodetic).to_enu(to_ecef(trace.epoch.fix.position)).vector();
        east.push_back(error.x());
        north.push_back(error.y());
        up.push_back(error.z());
        horizontal.push_back(std::hypot(error.x(), error.y()));
    }
};

}  // namespace skyloop::test
