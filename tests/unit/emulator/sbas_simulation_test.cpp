// Receivers under the nominal sky, whose SBAS satellites send the corrections of the run.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "support/run_parts.hpp"
#include "world/gnss/nominal_sky.hpp"
#include "world/gnss/sbas_message.hpp"

namespace skyloop {
namespace {

const std::vector heard_systems{Constellation::gps, Constellation::sbas, Constellation::galileo};

struct SbasRun {
    explicit SbasRun(const std::string& place, const std::string& seed = "1") {
        const Scenario scenario = test::emulator_scenario(
            "[run]\nstart = 2024-03-05T10:00:00Z\nseed = " + seed +
            "\n[model]\nname = \"modern\"\n[trajectory]\nkind = \"fixed\"\nat = " + place + "\n");
        start = scenario.run.start.value();
        auto made = make_simulation(
            scenario, {std::make_shared<NominalSky>(heard_systems), nullptr, start, test::emulator_data()});
        if (!made) throw std::runtime_error(made.error().message);
        simulation = std::make_unique<Simulation>(std::move(*made));
        for (const Constellation c : heard_systems)
            settings.signals.insert({c, Signal::l1});
    }
    Trace at(int second) { return simulation->run(start + std::chrono::seconds(second), settings); }

    GpsTime start;
    std::unique_ptr<Simulation> simulation;
    ReceiverSettings settings;
};

double error_of(const Trace& trace) {
    return (to_ecef(trace.epoch.fix.position) - trace.truth.position).length().value();
}

TEST(SbasSimulation, AReceiverInEuropeIsCorrectedWithinAMinute) {
    double before = 0, after = 0;
    for (const char* seed : {"1", "2", "3", "4", "5", "6"}) {
        SbasRun run("[48.1, 11.5, 600]", seed);
        int first = 0;
        for (int second = 0; second <= 90; ++second) {
            const Trace trace = run.at(second);
            if (first == 0 && trace.epoch.fix.type == FixType::dgnss) first = second;
            if (second == 20) before += error_of(trace);
            if (second == 90) after += error_of(trace);
            if (first == 0) continue;
            ASSERT_EQ(trace.epoch.fix.type, FixType::dgnss);
            ASSERT_EQ(trace.epoch.fix.sbas_source->constellation, Constellation::sbas);
            for (const SatelliteStatus& s : trace.epoch.fix.satellites)
                EXPECT_TRUE(!s.sbas || (s.used && s.id.constellation == Constellation::gps));
        }
        EXPECT_GT(first, 20) << "it takes as long as the messages do";
        EXPECT_LT(first, 60);
    }
    EXPECT_LT(after, 0.75 * before);
}

TEST(SbasSimulation, AReceiverInLaPazIsNot) {
    SbasRun run("[-16.5, -68.15, 3640]");
    for (int second = 0; second <= 90; ++second)
        EXPECT_EQ(run.at(second).epoch.fix.type, FixType::fix_3d);
}

TEST(SbasSimulation, MessagesAreGivenToThoseWhoWantThem) {
    SbasRun run("[48.1, 11.5, 600]"), deaf("[48.1, 11.5, 600]");
    run.settings.subframes = true;
    int messages = 0;
    for (int second = 0; second <= 30; ++second) {
        const Epoch epoch = run.at(second).epoch;
        EXPECT_TRUE(std::ranges::is_sorted(epoch.subframes, {}, &Subframe::end));
        for (const Subframe& s : epoch.subframes)
            if (s.satellite.constellation == Constellation::sbas) {
                EXPECT_TRUE(decode_sbas(s.words));
                ++messages;
            }
        EXPECT_TRUE(deaf.at(second).epoch.subframes.empty());
    }
    EXPECT_GT(messages, 60);
}

}  // namespace
}  // namespace skyloop
