// The modern profile as a scenario asks for it, on the nominal constellation.
#include <gtest/gtest.h>

#include "base/geo/local_frame.hpp"
#include "support/run_parts.hpp"

namespace skyloop {
namespace {

// The height error of the first fix at noon, every cause but the ionosphere's model switched off.
double up_error_at_noon(const std::string& correction) {
    std::string text = "[run]\nstart = 2024-03-05T10:00:00Z\n[model]\nname = \"modern\"\n";
    for (const char* term : {"signal_in_space", "ionosphere_residual", "troposphere", "troposphere_residual",
                             "code_noise", "multipath", "receiver_clock"})
        text += "[model.modern.terms." + std::string(term) + "]\nenabled = false\n";
    if (!correction.empty()) text += "[model.modern.solution]\nionosphere_correction = \"" + correction + "\"\n";
    const Scenario scenario = test::emulator_scenario(text);
    const GpsTime start = scenario.run.start.value();
    auto simulation =
        make_simulation(scenario, {std::make_unique<NominalConstellation>(), nullptr, start, test::emulator_data()});
    if (!simulation) throw std::runtime_error(simulation.error().message);
    ReceiverSettings settings;
    settings.signals = {{Constellation::gps, Signal::l1}};
    const Trace trace = simulation->run(start, settings);
    EXPECT_TRUE(trace.epoch.fix.has_position());
    return LocalFrame(trace.truth.geodetic).to_enu(to_ecef(trace.epoch.fix.position)).vector().z();
}

// Seconds from a start until the first fix, at 1 Hz, of GPS alone; nothing within a minute: 60.
int first_fix_of(StartKind kind, std::optional<Seconds> warm_start = {}, const std::string& keys = {}) {
    const Scenario scenario = test::emulator_scenario(
        "[run]\nstart = 2024-03-05T10:00:00Z\n[model]\nname = \"modern\"\n[model.modern.solution]\n" + keys);
    const GpsTime start = scenario.run.start.value();
    SimulationSetup setup{std::make_shared<NominalConstellation>(), nullptr, start, test::emulator_data()};
    if (warm_start) setup.warm_start = *warm_start;
    auto simulation = make_simulation(scenario, setup);
    if (!simulation) throw std::runtime_error(simulation.error().message);
    ReceiverSettings settings;
    settings.signals = {{Constellation::gps, Signal::l1}};
    settings.start = kind;
    int s = 0;
    while (s < 60 && !simulation->run(start + std::chrono::seconds(s), settings).epoch.fix.has_position())
        ++s;
    return s;
}

// RECEIVER.md 4.8, under an open sky: cold 24 to 32 s, warm 20 to 28 s, hot 1 to 2 s.
TEST(ModernSimulation, HasItsFirstFixWhenReceiversHaveIt) {
    const int cold = first_fix_of(StartKind::cold), warm = first_fix_of(StartKind::warm);
    EXPECT_GE(cold, 24);
    EXPECT_LE(cold, 32);
    EXPECT_GE(warm, 20);
    EXPECT_LE(warm, 28);
    EXPECT_LE(first_fix_of(StartKind::hot), 2);
}

TEST(ModernSimulation, TheBoardSaysHowLongAWarmStartTakesUnlessTheScenarioSaysHowLongTheCollection) {
    EXPECT_NEAR(first_fix_of(StartKind::warm, Seconds(40)), 40, 3);
    EXPECT_NEAR(first_fix_of(StartKind::warm, Seconds(40), "ephemeris_collection_s = 10\n"), 13, 3);
    EXPECT_LE(first_fix_of(StartKind::warm, Seconds(1)), 6) << "nothing is left to collect in";
}

TEST(ModernSimulation, CorrectsForAnIonosphereThatNoFileTells) {
    const double raw = up_error_at_noon("none"), corrected = up_error_at_noon("");
    EXPECT_GT(raw, 4);
    EXPECT_LT(std::abs(corrected), raw / 2);
}

}  // namespace
}  // namespace skyloop
