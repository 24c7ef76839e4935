#include "world/propagation/surroundings_effect.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "world/gnss/constants.hpp"

namespace skyloop::inline world {
namespace {

constexpr double faintest_echo = 0.02;  // amplitude over that of the tracked ray; it moves a code by centimetres
constexpr double faintest_power = 1e-5;

Decibels roof_loss(Decibels roof, Angle elevation) {
    const double lowest = std::sin(Angle::degrees(35).rad());
    return roof * std::max(0.0, (std::sin(elevation.rad()) - lowest) / (1 - lowest));
}

// A ray at the antenna: amplitude and phase, and how late it is against the direct one.
struct ChannelRay {
    std::complex<double> gain;
    Metres excess;
    MetresPerSecond excess_rate;
};

Angle angle_of(double radians) { return Angle::radians(std::remainder(radians, 2 * std::numbers::pi)); }

// The phase of an echo comes to what its excess makes of it (Echo).
void add_echo(Arrival& arrival, const ChannelRay& ray, const ChannelRay& tracked, double amplitude) {
    const double relative = std::abs(ray.gain) / amplitude;
    if (relative < faintest_echo) return;
    const Metres excess = ray.excess - tracked.excess;
    const double turns = excess.value() * first_carrier(arrival).value() / speed_of_light;
    const double lag = std::arg(ray.gain) - std::arg(tracked.gain) - 2 * std::numbers::pi * turns;
    // Its beat is in the gain, which is averaged already.
    arrival.echoes.push_back({arrival.direction, excess, MetresPerSecond(0), relative, angle_of(lag), 1});
}

void track_strongest(Arrival& arrival, const ChannelSample& sample, Decibels more_loss) {
    const double over = std::pow(10, (sample.direct - more_loss).value() / 10);
    const auto strongest = std::max_element(sample.echoes.begin(), sample.echoes.end(),
                                            [](const auto& a, const auto& b) { return a.power < b.power; });
    const bool direct = over >= strongest->power;
    const ChannelRay straight{std::sqrt(over), Metres(0), MetresPerSecond(0)};
    const ChannelRay scattered{strongest->gain, strongest->excess, strongest->excess_rate};
    const ChannelRay& tracked = direct ? straight : scattered;
    double power = std::norm(tracked.gain);
    for (const ChannelEcho& echo : sample.echoes)
        power += echo.unsteady_power;
    power = std::max(power, faintest_power);
    const double amplitude = std::sqrt(power);
    if (!direct) add_echo(arrival, straight, tracked, amplitude);
    for (const ChannelEcho& echo : sample.echoes)
        if (direct || &echo != &*strongest)
            add_echo(arrival, {echo.gain, echo.excess, echo.excess_rate}, tracked, amplitude);
    std::stable_sort(arrival.echoes.begin(), arrival.echoes.end(),
                     [](const Echo& a, const Echo& b) { return a.amplitude > b.amplitude; });
    arrival.shadowing_loss = Decibels(-10 * std::log10(power));
    arrival.line_of_sight = direct;
    arrival.reflections = direct ? 0 : 1;
    arrival.excess_path = tracked.excess;
    arrival.excess_rate = tracked.excess_rate;
    arrival.paths = 1 + static_cast<int>(arrival.echoes.size());
}

}  // namespace

SurroundingsEffect::SurroundingsEffect(const ChannelParameters& parameters, const ErrorTerm& term, std::uint64_t seed)
    : channel_(parameters, term.seed.value_or(seed)), factor_(term.factor()), roof_(parameters.roof) {}

ChannelPlace channel_place(const TruthState& truth) {
    constexpr double radius = 6371000;
    const double latitude = truth.geodetic.latitude.rad(), longitude = truth.geodetic.longitude.rad();
    const double parallel = std::cos(Angle::degrees(std::round(truth.geodetic.latitude.deg())).rad());
    const Eigen::Vector3d east(-std::sin(longitude), std::cos(longitude), 0);
    const Eigen::Vector3d north(-std::sin(latitude) * std::cos(longitude), -std::sin(latitude) * std::sin(longitude),
                                std::cos(latitude));
    const Eigen::Vector3d& velocity = truth.velocity.vector();
    return {radius * Eigen::Vector2d(parallel * longitude, latitude),
            {east.dot(velocity), north.dot(velocity)},
            truth.time};
}

void SurroundingsEffect::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    if (factor_ == 0) return;
    const ChannelPlace place = channel_place(truth);
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        if (arrival.echoes_known || arrival.paths == 0) return;
        ChannelSample sample = channel_.at(satellite.id, direction_of(satellite), place);
        sample.direct = sample.direct * factor_;
        for (ChannelEcho& echo : sample.echoes) {
            echo.power *= factor_ * factor_;
            echo.unsteady_power *= factor_ * factor_;
            echo.gain *= factor_;
        }
        track_strongest(arrival, sample, roof_loss(roof_, satellite.elevation) * factor_);
    });
}

}  // namespace skyloop::inline world
