#include "world/propagation/noise.hpp"

#include <cmath>

namespace skyloop {
namespace {

constexpr double boltzmann_constant = 1.380649e-23;  // J/K, exact since 2019
constexpr double noise_reference_temperature = 290;  // K

double power_ratio(Decibels ratio) { return std::pow(10, ratio.value() / 10); }

}  // namespace

Decibels man_made_noise_p372(NoiseEnvironment environment, Hertz carrier) {
    const double decades = std::log10(carrier.value() / 1e6);
    switch (environment) {
        case NoiseEnvironment::city:
            return Decibels(76.8 - 27.7 * decades);
        case NoiseEnvironment::residential:
            return Decibels(72.5 - 27.7 * decades);
        case NoiseEnvironment::rural:
            return Decibels(67.2 - 27.7 * decades);
        case NoiseEnvironment::quiet_rural:
            break;
    }
    return Decibels(53.6 - 28.6 * decades);
}

Kelvin system_temperature(const ReceiverNoise& noise) {
    const double through = 1 / power_ratio(noise.line_loss);
    return noise.antenna_temperature * through +
           Kelvin(noise_reference_temperature * (1 - through + power_ratio(noise.noise_figure) - 1));
}

DecibelWattsPerHertz noise_density(Kelvin temperature) {
    return DecibelWattsPerHertz(10 * std::log10(boltzmann_constant * temperature.value()));
}

}  // namespace skyloop
