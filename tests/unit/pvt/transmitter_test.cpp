#include "receiver/pvt/transmitter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "synthetic_sky.hpp"

namespace skyloop {
namespace {

using test::sample_time;

TEST(BroadcastTransmitters, AnswersDoNotDependOnWhatWasAskedBefore) {
    const auto sky = test::synthetic_sky(sample_time, {Constellation::glonass});
    const SatelliteId r7{Constellation::glonass, 7};
    BroadcastTransmitters used(sky);
    for (int s = -900; s <= 900; s += 7) {
        const GpsTime time = sample_time + std::chrono::seconds(s) + std::chrono::milliseconds(75);
        BroadcastTransmitters fresh(sky);
        const auto a = used.at(r7, Signal::g1, time, Metres(2.2e7));
        const auto b = fresh.at(r7, Signal::g1, time, Metres(2.2e7));
        ASSERT_TRUE(a && b);
        EXPECT_EQ(a->position.vector(), b->position.vector());
        EXPECT_EQ(a->clock_bias, b->clock_bias);

        // The carried record follows the direct integration.
        const auto record = sky.ephemeris(r7, time);
        const double travel = 2.2e7 / speed_of_light;
        const SatelliteState direct = satellite_state(*record, time, Seconds(-travel - a->clock_bias.value()));
        EXPECT_LT((direct.position.vector() - a->position.vector()).norm(), 2e-7);
        EXPECT_LT((direct.velocity.vector() - a->velocity.vector()).norm(), 1e-7);
    }
}

TEST(BroadcastTransmitters, FindsTheInstantOfTransmissionForAnyClock) {
    auto sky = test::synthetic_sky(sample_time, {Constellation::gps, Constellation::galileo});
    for (const double clock : {0.0, 9e-4, -1.9e-3, 0.02}) {
        std::get<KeplerEphemeris>(sky.records()[2]).af0 = clock;
        const SatelliteId g3{Constellation::gps, 3};
        BroadcastTransmitters transmitters(sky);
        const auto t = transmitters.at(g3, Signal::l1, sample_time, Metres(2.3e7));
        ASSERT_TRUE(t);
        const Seconds group = *group_delay(sky.records()[2], Signal::l1);
        const SatelliteState state =
            satellite_state(sky.records()[2], sample_time, Seconds(-2.3e7 / speed_of_light - t->clock_bias.value()));
        EXPECT_LT((state.position.vector() - t->position.vector()).norm(), 5e-8);
        EXPECT_LT((state.velocity.vector() - t->velocity.vector()).norm(), 2e-7);
        EXPECT_NEAR(state.clock_bias - group.value(), t->clock_bias.value(), 1e-16);
    }
}

TEST(BroadcastTransmitters, KnowsNothingOfUnknownSatellitesSignalsAndRanges) {
    const auto sky = test::synthetic_sky(sample_time, {Constellation::gps});
    BroadcastTransmitters transmitters(sky);
    const SatelliteId g3{Constellation::gps, 3};
    EXPECT_FALSE(transmitters.at({Constellation::gps, 30}, Signal::l1, sample_time, Metres(2.3e7)));
    EXPECT_FALSE(transmitters.at(g3, Signal::l5, sample_time, Metres(2.3e7))) << "no group delay is broadcast";
    BroadcastTransmitters emulated(sky, UntoldDelay::none);
    const auto first = emulated.at(g3, Signal::l1, sample_time, Metres(2.3e7));
    const auto second = emulated.at(g3, Signal::l5, sample_time, Metres(2.3e7));
    ASSERT_TRUE(first && second);
    EXPECT_NEAR(second->clock_bias.value() - first->clock_bias.value(),
                group_delay(sky.records()[2], Signal::l1)->value(), 1e-16);
    EXPECT_FALSE(emulated.at(g3, Signal::b1i, sample_time, Metres(2.3e7))) << "another system's";
    EXPECT_FALSE(transmitters.at(g3, Signal::l1, sample_time, Metres(std::nan(""))));
    EXPECT_FALSE(transmitters.at(g3, Signal::l1, sample_time, Metres(1e300)));
}

TEST(PreciseTransmitters, AgreesWithTheOrbitThatItsTableWasMadeOf) {
    const auto sky = test::synthetic_sky(sample_time, {Constellation::gps});
    std::map<SatelliteId, std::vector<PreciseSample>> samples;
    for (const Ephemeris& record : sky.records())
        for (int k = -12; k <= 12; ++k) {
            const GpsTime time = sample_time + k * std::chrono::minutes(5);
            const SatelliteState state = satellite_state(record, time);
            samples[satellite_of(record)].push_back({time, state.position, state.clock_bias - state.relativistic_bias});
        }
    const PreciseOrbits orbits(std::move(samples), std::chrono::minutes(5));
    PreciseTransmitters precise(orbits, &sky);
    BroadcastTransmitters broadcast(sky);
    const GpsTime time = sample_time + std::chrono::seconds(100);
    double largest_relativity = 0;
    for (int number = 1; number <= 24; ++number) {
        const SatelliteId id{Constellation::gps, number};
        const auto a = precise.at(id, Signal::l1, time, Metres(2.4e7));
        const auto b = broadcast.at(id, Signal::l1, time, Metres(2.4e7));
        ASSERT_TRUE(a && b);
        EXPECT_LT((a->position.vector() - b->position.vector()).norm(), 1e-3);
        EXPECT_LT((a->velocity.vector() - b->velocity.vector()).norm(), 1e-4);
        // The harmonics of the orbit leave r·v a little different from e√a sin E.
        EXPECT_NEAR(a->clock_bias.value(), b->clock_bias.value(), 3e-10) << number;
        largest_relativity =
            std::max(largest_relativity, std::abs(satellite_state(*sky.ephemeris(id, time), time).relativistic_bias));
    }
    EXPECT_GT(largest_relativity, 1e-8) << "nothing was tested";
    EXPECT_FALSE(precise.at({Constellation::gps, 31}, Signal::l1, sample_time, Metres(2.4e7)));
    EXPECT_FALSE(precise.at({Constellation::gps, 5}, Signal::l1, sample_time + std::chrono::hours(3), Metres(2.4e7)));
}

}  // namespace
}  // namespace skyloop
