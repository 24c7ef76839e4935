// Constant delays of a receiver's filters.
#include <gtest/gtest.h>

#include "receiver/measurement/measurement_engine.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

Arrivals two_satellites() {
    Arrivals arrivals;
    for (const SatelliteId id : {SatelliteId{Constellation::galileo, 3}, SatelliteId{Constellation::glonass, 5}}) {
        Arrival arrival;
        arrival.id = id;
        arrival.direction = {Angle::degrees(100), Angle::degrees(50)};
        arrival.range = Metres(2.2e7);
        arrival.cn0 = DbHz(48);
        for (const Signal signal : emulated_signals(id.constellation)) {
            const int channel = id.constellation == Constellation::glonass ? -4 : 0;
            arrival.signals.push_back({signal, carrier_frequency(signal, channel), Seconds(0), Decibels(0)});
        }
        arrivals.satellites.push_back(arrival);
    }
    return arrivals;
}

Observations observed(const ReceiverBiases& biases, bool enabled = true) {
    MeasurementParameters parameters;
    parameters.biases = biases;
    parameters.receiver_biases.enabled = enabled;
    MeasurementEngine engine(parameters, 7);
    ReceiverSettings settings;
    for (const Signal signal : {Signal::g1, Signal::g2})
        settings.signals.insert({Constellation::glonass, signal});
    settings.signals.insert({Constellation::galileo, Signal::l1});
    Observations last;
    for (int i = 0; i < 20; ++i)
        last = engine.measure(two_satellites(), to_gps_time(2300, i), settings).observations;
    return last;
}

TEST(ReceiverBiases, AreThoseOfSystemAndChannel) {
    ReceiverBiases biases;
    biases.systems.at(static_cast<std::size_t>(Constellation::galileo)) = Metres(12);
    biases.systems.at(static_cast<std::size_t>(Constellation::glonass)) = Metres(-30);
    biases.glonass_channel_code = Metres(0.5);
    biases.glonass_channel_phase = Metres(0.02);
    const Observations plain = observed({}), late = observed(biases), off = observed(biases, false);
    ASSERT_EQ(plain.signals.size(), 3U);
    ASSERT_EQ(late.signals.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        const Observation& a = plain.signals[i];
        const Observation& b = late.signals[i];
        const bool glonass = a.satellite.constellation == Constellation::glonass;
        EXPECT_NEAR((*b.pseudorange - *a.pseudorange).value(), glonass ? -30 - 4 * 0.5 : 12, 1e-6);
        ASSERT_TRUE(a.carrier_phase && b.carrier_phase);
        const double metres = (*b.carrier_phase - *a.carrier_phase) * speed_of_light / a.carrier.value();
        EXPECT_NEAR(metres, glonass ? -4 * 0.02 : 0, 1e-6);
        EXPECT_EQ(*off.signals[i].pseudorange, *a.pseudorange);
    }
}

}  // namespace
}  // namespace skyloop
