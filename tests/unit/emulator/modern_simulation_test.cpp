// The modern profile as a scenario asks for it, on the nominal constellation.
#include <gtest/gtest.h>

#include "skyloop/geo/local_frame.hpp"
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
        make_simulation(scenario, std::make_unique<NominalConstellation>(), nullptr, start, test::emulator_data());
    if (!simulation) throw std::runtime_error(simulation.error().message);
    ReceiverSettings settings;
    settings.signals = {{Constellation::gps, Signal::l1}};
    const Trace trace = simulation->run(start, settings);
    EXPECT_TRUE(trace.epoch.fix.has_position());
    return LocalFrame(trace.truth.geodetic).to_enu(to_ecef(trace.epoch.fix.position)).vector().z();
}

TEST(ModernSimulation, CorrectsForAnIonosphereThatNoFileTells) {
    const double raw = up_error_at_noon("none"), corrected = up_error_at_noon("");
    EXPECT_GT(raw, 4);
    EXPECT_LT(std::abs(corrected), raw / 2);
}

}  // namespace
}  // namespace skyloop
