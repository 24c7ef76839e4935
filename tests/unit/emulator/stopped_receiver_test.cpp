// What a simulation gives a receiver that its user has stopped, and what its monitors see.
#include <gtest/gtest.h>

#include "support/run_parts.hpp"

namespace skyloop {
namespace {

using test::emulator_scenario;

Simulation simulation_of(const std::string& text) {
    const Scenario scenario = emulator_scenario("[run]\nstart = 2024-03-05T12:00:00Z\n" + text);
    auto simulation =
        make_simulation(scenario, {std::make_unique<NominalConstellation>(), nullptr, *scenario.run.start});
    EXPECT_TRUE(simulation);
    return std::move(*simulation);
}

const GpsTime stopped_start = emulator_scenario("[run]\nstart = 2024-03-05T12:00:00Z").run.start.value();

Trace second_of(Simulation& simulation, int second, bool navigating) {
    ReceiverSettings settings;
    settings.navigating = navigating;
    return simulation.run(stopped_start + std::chrono::seconds(second), settings);
}

TEST(StoppedReceiver, TracksNothingAndHasNoFix) {
    for (const char* model : {"modern", "baseline", "ideal"}) {
        Simulation simulation = simulation_of("[model]\nname = \"" + std::string(model) + "\"");
        EXPECT_TRUE(second_of(simulation, 0, true).epoch.fix.has_position()) << model;
        for (int i = 1; i < 10; ++i) {
            const Trace stopped = second_of(simulation, i, false);
            EXPECT_EQ(stopped.epoch.fix.type, FixType::none) << model << ", not even coasting";
            EXPECT_TRUE(stopped.epoch.fix.satellites.empty());
            EXPECT_TRUE(stopped.epoch.observations.signals.empty());
            EXPECT_EQ(stopped.epoch.fix.time, stopped.truth.time);
            EXPECT_GT(stopped.sky.satellites.size(), 4U) << "the world goes on";
        }
        bool again = false;
        for (int i = 10; i < 70; ++i)
            again |= second_of(simulation, i, true).epoch.fix.has_position();
        EXPECT_TRUE(again) << model;
    }
}

TEST(FrontEndOfAnEpoch, TellsWhatAJammerTakes) {
    Simulation clear = simulation_of("");
    EXPECT_EQ(second_of(clear, 0, true).epoch.front_end.interference, Decibels(0));
    Simulation jammed = simulation_of("[model.modern.interference]\njammer_to_signal_db = 20");
    const Trace trace = second_of(jammed, 0, true);
    EXPECT_GT(trace.epoch.front_end.interference.value(), 0.3);
    for (const Arrival& arrival : trace.arrivals.satellites)
        EXPECT_LE(arrival.interference_loss, trace.epoch.front_end.interference);
    EXPECT_EQ(trace.epoch.front_end.antenna, AntennaStatus::ok);
}

}  // namespace
}  // namespace skyloop
