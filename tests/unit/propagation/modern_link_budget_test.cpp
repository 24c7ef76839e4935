#include "world/propagation/modern_link_budget.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "modern_sky.hpp"
#include "support/oracle_table.hpp"
#include "world/propagation/modern_effects.hpp"

namespace skyloop {
namespace {

using std::chrono::seconds;

// Every satellite as strong as it should be.
ModernPropagationParameters even_powers() {
    ModernPropagationParameters parameters;
    parameters.satellite_power.enabled = false;
    return parameters;
}

Arrival link_arrival(const ModernPropagationParameters& parameters, const SatelliteInView& satellite) {
    ModernLinkBudget effect(parameters, 1);
    const TruthState truth = test::truth_of(test::odessa_place, test::april_noon);
    return test::after(effect, {{satellite}}, truth).satellites[0];
}

double link_cn0(const ModernPropagationParameters& parameters, double elevation_deg,
                SatelliteId id = {Constellation::gps, 3}, double radius = 26560e3) {
    return link_arrival(parameters, test::satellite_at(id, 40, elevation_deg, test::odessa_place, radius)).cn0->value();
}

double cn0_curve(double elevation_deg) {
    return 48.5 - 16.5 * std::pow(1 - std::sin(elevation_deg * std::numbers::pi / 180), 1.3);
}

TEST(ModernLinkBudget, FollowsTheCurveOfRealReceivers) {
    for (const double elevation : {5., 15., 25., 35., 45., 55., 65., 75., 90.})
        EXPECT_NEAR(link_cn0(even_powers(), elevation), cn0_curve(elevation), 0.05) << elevation;
}

// Means by bins of elevation of real open-sky records: cn0_gps_l1ca_el_10_20.
TEST(ModernLinkBudget, LiesAmongTheRecordsOfRealReceivers) {
    const std::string prefix = "cn0_gps_l1ca_el_";
    int rows = 0;
    for (const test::OracleRow& row : test::oracle_rows("empirical_reference.csv")) {
        const std::string item = row.text("item");
        if (item.rfind(prefix, 0) != 0) continue;
        const double middle = (std::stod(item.substr(16, 2)) + std::stod(item.substr(19, 2))) / 2;
        EXPECT_NEAR(link_cn0(even_powers(), middle), row.number("value"), 1) << item;
        ++rows;
    }
    EXPECT_GE(rows, 3);
}

TEST(ModernLinkBudget, FollowsItThroughClearAirToo) {
    auto effects = modern_effects(even_powers(), {.run = {test::april_noon, test::april_noon}});
    ASSERT_TRUE(effects) << effects.error().message;
    for (const double elevation : {5., 10., 15., 25., 35., 45., 65., 90.}) {
        SkyView sky{{test::satellite_at({Constellation::gps, 3}, 40, elevation)}};
        const TruthState truth = test::truth_of(test::odessa_place, test::april_noon);
        Arrivals arrivals = free_space(sky);
        for (const auto& effect : *effects)
            effect->apply(arrivals, sky, truth);
        // The air takes 0.37 dB at 5°, of which the curve knows nothing.
        EXPECT_NEAR(arrivals.satellites[0].cn0->value(), cn0_curve(elevation), elevation > 5 ? 0.3 : 0.4) << elevation;
    }
}

TEST(ModernLinkBudget, KnowsTheSystemsAndTheirDistances) {
    const double gps = link_cn0(even_powers(), 40);
    EXPECT_NEAR(link_cn0(even_powers(), 40, {Constellation::galileo, 2}, 29600e3), gps + 0.5, 0.01);
    EXPECT_NEAR(link_cn0(even_powers(), 40, {Constellation::glonass, 2}, 25510e3), gps - 1, 0.01);
    EXPECT_NEAR(link_cn0(even_powers(), 40, {Constellation::beidou, 30}, 27906e3), gps, 0.01);
    EXPECT_NEAR(link_cn0(even_powers(), 40, {Constellation::beidou, 3}, 42164e3), gps, 0.01);
    EXPECT_NEAR(link_cn0(even_powers(), 40, {Constellation::gps, 2}, 27091e3), gps - 0.2, 0.03);
}

TEST(ModernLinkBudget, SubtractsEveryLossOfTheArrival) {
    ModernLinkBudget effect(even_powers(), 1);
    const SkyView sky = test::gps_ring(1);
    Arrivals arrivals = free_space(sky);
    Arrival& arrival = arrivals.satellites[0];
    effect.apply(arrivals, sky, test::truth_of(test::odessa_place, test::april_noon));
    const double clear = arrival.cn0->value();
    arrival.gas_loss = Decibels(0.1);
    arrival.cloud_loss = Decibels(0.2);
    arrival.rain_loss = Decibels(0.4);
    arrival.foliage_loss = Decibels(0.8);
    arrival.iono_loss = Decibels(1.6);
    arrival.reflection_loss = Decibels(3.2);
    effect.apply(arrivals, sky, test::truth_of(test::odessa_place, test::april_noon));
    EXPECT_NEAR(arrival.cn0->value(), clear - 6.3, 1e-9);
    arrival.paths = 0;
    effect.apply(arrivals, sky, test::truth_of(test::odessa_place, test::april_noon));
    EXPECT_FALSE(arrival.cn0);
}

TEST(ModernLinkBudget, AJammerOfThirtyDecibelsLeavesThirtyTwo) {
    ModernPropagationParameters parameters = even_powers();
    parameters.link.antenna = AntennaPattern(Decibels(0), Decibels(0), 1);
    const double offset = 45 - link_cn0(parameters, 40);
    parameters.link.implementation_loss = parameters.link.implementation_loss - Decibels(offset);
    ASSERT_NEAR(link_cn0(parameters, 40), 45, 1e-9);
    parameters.link.jammer_to_signal = Decibels(30);
    EXPECT_NEAR(link_cn0(parameters, 40), 31.7, 0.1);
    parameters.link.jammer_to_signal = Decibels(40);
    EXPECT_NEAR(link_cn0(parameters, 40), 21.8, 0.1);
    parameters.link.jammer = JammerKind::wide_band;
    EXPECT_NEAR(link_cn0(parameters, 40), 21.8 + 10 * std::log10(2.2 / 1.5), 0.1);
    parameters.interference.enabled = false;
    EXPECT_NEAR(link_cn0(parameters, 40), 45, 1e-9);
}

TEST(ModernLinkBudget, AJammerHurtsTheWeakMore) {
    ModernPropagationParameters parameters = even_powers();
    parameters.link.jammer_to_signal = Decibels(30);
    const auto loss = [&](double elevation) {
        const Arrival arrival = link_arrival(parameters, test::satellite_at({Constellation::gps, 3}, 40, elevation));
        return arrival.interference_loss.value();
    };
    EXPECT_GT(loss(10), 1);
    EXPECT_NEAR(loss(10), loss(80), 0.01);  // the noise floor rises for all of them alike
    const double strong = link_cn0(parameters, 80), weak = link_cn0(parameters, 10);
    EXPECT_NEAR(strong - weak, cn0_curve(80) - cn0_curve(10), 0.05);
}

TEST(ModernLinkBudget, NoSatelliteIsStrongerThanAnEstimatorTells) {
    ModernPropagationParameters parameters = even_powers();
    parameters.link.implementation_loss = Decibels(-200);
    EXPECT_EQ(link_cn0(parameters, 40), 99);
    parameters.link.jammer_to_signal = Decibels(30);
    EXPECT_LT(link_cn0(parameters, 40), 99) << "and a jammer still weakens it";
}

TEST(ModernLinkBudget, CountsNoiseAndFilm) {
    ModernPropagationParameters parameters = even_powers();
    const double clear = link_cn0(parameters, 40);
    parameters.link.platform_noise = Decibels(3);
    EXPECT_NEAR(link_cn0(parameters, 40), clear - 3, 1e-9);
    parameters.link.man_made = NoiseEnvironment::city;
    // −11.8 dB over 290 K: 19 K more than the receiver's 250 K.
    EXPECT_NEAR(link_cn0(parameters, 40), clear - 3 - 10 * std::log10(1 + 19.2 / 249.6), 0.01);
    parameters.loss_model.antenna_film = Decibels(2);
    parameters.link.man_made.reset();
    EXPECT_NEAR(link_cn0(parameters, 40), clear - 5, 1e-9);
    parameters.antenna.enabled = false;
    EXPECT_EQ(link_arrival(parameters, test::satellite_at({Constellation::gps, 3}, 40, 10)).antenna_gain.value(), 0);
    EXPECT_NEAR(link_cn0(parameters, 10), link_cn0(parameters, 80), 0.02);
}

// What a line of 290 K takes, it takes of the signal alone where the antenna is as warm; a cold antenna hears its
// warmth.
TEST(ModernLinkBudget, ALossyLineWeakensTheSignalAndWhatTheAntennaHears) {
    const auto lost = [](double antenna_kelvin, double line_db, std::optional<NoiseEnvironment> around = std::nullopt) {
        ModernPropagationParameters parameters = even_powers();
        parameters.link.noise.antenna_temperature = Kelvin(antenna_kelvin);
        parameters.link.man_made = around;
        const double clear = link_cn0(parameters, 40);
        parameters.link.noise.line_loss = Decibels(line_db);
        return clear - link_cn0(parameters, 40);
    };
    for (const double db : {1., 3., 10.})
        EXPECT_NEAR(lost(290, db), db, 1e-9);
    EXPECT_NEAR(lost(130, 3), 4.20, 0.01);
    EXPECT_NEAR(lost(500, 3), 3 - 0.81, 0.01);
    EXPECT_GT(lost(130, 3, NoiseEnvironment::city), 3.1);
    EXPECT_LT(lost(130, 3, NoiseEnvironment::city), lost(130, 3)) << "city noise warms what the antenna hears";
}

TEST(ModernLinkBudget, ALossyLineTakesAsMuchOfAJammer) {
    ModernPropagationParameters parameters = even_powers();
    parameters.link.implementation_loss = Decibels(-40);
    parameters.link.jammer_to_signal = Decibels(30);
    const double jammed = link_cn0(parameters, 40);
    parameters.link.noise.line_loss = Decibels(3);
    EXPECT_NEAR(link_cn0(parameters, 40), jammed, 0.01) << "where noise does not count";
}

TEST(ModernLinkBudget, AcceptsThePatternOfTheSatellites) {
    ModernPropagationParameters parameters = even_powers();
    parameters.link.satellite_pattern = {{Angle::degrees(0), DecibelWatts(25)}, {Angle::degrees(14), DecibelWatts(27)}};
    const SatelliteInView satellite = test::satellite_at({Constellation::gps, 3}, 40, 90);
    const Arrival arrival = link_arrival(parameters, satellite);
    const ModernLinkBudget budget(parameters, 1);
    const TruthState truth = test::truth_of(test::odessa_place, test::april_noon);
    EXPECT_NEAR(budget.isotropic_power(arrival, truth).value(), 25 - arrival.free_space_loss.value(), 1e-6);
    // 5° up the boresight angle is 13.8°.
    const Arrival low = link_arrival(parameters, test::satellite_at({Constellation::gps, 3}, 40, 5));
    EXPECT_NEAR(budget.isotropic_power(low, truth).value(), 25 + 2 * 13.84 / 14 - low.free_space_loss.value(), 0.02);
}

TEST(ModernLinkBudget, SatellitesDifferAndRipple) {
    ModernLinkBudget effect({}, 2);
    SkyView sky;
    for (int i = 1; i <= 400; ++i)
        sky.satellites.push_back(test::satellite_at({Constellation::gps, i}, 10, 40));
    std::vector<double> sum(400), square(400);
    constexpr int epochs = 120;
    for (int t = 0; t < epochs; ++t) {
        const TruthState truth = test::truth_of(test::odessa_place, test::april_noon + seconds(120) * t);
        const Arrivals arrivals = test::after(effect, sky, truth);
        for (std::size_t i = 0; i < 400; ++i) {
            const double offset = arrivals.satellites[i].power_offset.value();
            sum[i] += offset;
            square[i] += offset * offset;
        }
    }
    double spread = 0, ripple = 0;
    for (std::size_t i = 0; i < 400; ++i) {
        const double mean = sum[i] / epochs;
        spread += mean * mean / 400;
        ripple += (square[i] / epochs - mean * mean) / 400;
    }
    EXPECT_NEAR(std::sqrt(spread), 1.5, 0.15);
    EXPECT_NEAR(std::sqrt(ripple), 0.5, 0.03);
    ModernLinkBudget alone({}, 2);
    const TruthState later = test::truth_of(test::odessa_place, test::april_noon);
    ModernLinkBudget together({}, 2);
    EXPECT_EQ(test::after(alone, {{sky.satellites[7]}}, later).satellites[0].power_offset,
              test::after(together, sky, later).satellites[7].power_offset);
    EXPECT_EQ(link_arrival(even_powers(), sky.satellites[0]).power_offset.value(), 0);
}

TEST(ModernLinkBudget, GivesTheSignalsTheirPowers) {
    const Arrival gps = link_arrival({}, test::satellite_at({Constellation::gps, 3}, 40, 50));
    ASSERT_EQ(gps.signals.size(), 3u);
    EXPECT_EQ(gps.signals[0].relative_power.value(), 0);
    EXPECT_EQ(gps.signals[1].relative_power.value(), -1.5);
    EXPECT_EQ(gps.signals[2].relative_power.value(), 0.6);
    const auto power = [](Constellation constellation, Signal signal, double range_m) {
        return relative_signal_power(constellation, signal, Metres(range_m)).value();
    };
    EXPECT_EQ(power(Constellation::galileo, Signal::l5, 25e6), 2);
    EXPECT_EQ(power(Constellation::beidou, Signal::b3i, 23e6), 0);
    EXPECT_EQ(power(Constellation::beidou, Signal::l5, 23e6), 2.5);
    EXPECT_EQ(power(Constellation::beidou, Signal::l5, 37e6), 0.5) << "in an inclined geosynchronous orbit";
    EXPECT_EQ(power(Constellation::glonass, Signal::g2, 22e6), -6);
}

}  // namespace
}  // namespace skyloop
