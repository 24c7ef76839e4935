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
    if (roof == Decibels(0)) return roof;
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

}  // namespace

void meet_surroundings(Arrival& arrival, const ChannelSample& sample, Decibels more_loss) {
    const double over = std::exp(std::numbers::ln10 / 10 * (sample.direct - more_loss).value());
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
    arrival.direct_loss = more_loss - sample.direct;
    arrival.shadowed = sample.bad;
    arrival.line_of_sight = direct;
    arrival.reflections = direct ? 0 : 1;
    arrival.excess_path = tracked.excess;
    arrival.excess_rate = tracked.excess_rate;
    arrival.paths = 1 + static_cast<int>(arrival.echoes.size());
}

ChannelSample between(const ChannelSample& one, const ChannelSample& other, double weight) {
    if (weight == 1) return other;
    const auto mixed = [weight](auto from, auto to) { return from + (to - from) * weight; };
    const auto mixed_power = [&](double from, double to) {
        const double amplitude = mixed(std::sqrt(from), std::sqrt(to));
        return amplitude * amplitude;
    };
    ChannelSample result;
    result.bad = weight < 0.5 ? one.bad : other.bad;
    result.direct = mixed(one.direct, other.direct);
    result.shadowing = mixed(one.shadowing, other.shadowing);
    result.diffuse = mixed(one.diffuse, other.diffuse);
    for (std::size_t i = 0; i < result.echoes.size(); ++i) {
        const ChannelEcho &a = one.echoes[i], &b = other.echoes[i];
        ChannelEcho& echo = result.echoes[i];
        echo.power = mixed_power(a.power, b.power);
        echo.gain = mixed(a.gain, b.gain);
        echo.unsteady_power = mixed_power(a.unsteady_power, b.unsteady_power);
        const double sum = a.power + weight * (b.power - a.power), share = sum > 0 ? weight * b.power / sum : weight;
        echo.excess = a.excess + (b.excess - a.excess) * share;
        echo.excess_rate = a.excess_rate + (b.excess_rate - a.excess_rate) * share;
    }
    return result;
}

namespace {

// Which share of a ray gets in through an opening so far ahead, as far off its direction as that.
double share_through(const ChannelParameters& p, double ahead, Angle off, Angle elevation) {
    constexpr double edge = 1;  // m
    if (std::cos(off.rad()) <= 0 || !std::isfinite(ahead)) return 0;
    const double aside = ahead * std::abs(std::tan(off.rad()));
    const double above = ahead / std::cos(off.rad()) * std::tan(elevation.rad());
    const double within = std::min(p.opening_side.value() - aside, p.opening_height.value() - above);
    return std::clamp(0.5 + within / edge, 0.0, 1.0);
}

}  // namespace

Decibels cover_loss(const ChannelParameters& parameters, const StretchPlace& place, std::optional<Angle> heading,
                    const SkyDirection& direction) {
    double share = 0;
    if (place.inside && heading) {
        const Angle off = direction.azimuth - *heading;
        share = std::max(share_through(parameters, place.left, off, direction.elevation),
                         share_through(parameters, place.since, off + Angle::degrees(180), direction.elevation));
    }
    return parameters.cover * (1 - share);
}

SurroundingsEffect::Part::Part(const ChannelParameters& numbers, std::uint64_t seed) : parameters(numbers) {
    if (numbers.environment) channel.emplace(numbers, seed);
}

SurroundingsEffect::SurroundingsEffect(const SurroundingsParameters& parameters, const ErrorTerm& term,
                                       std::uint64_t seed)
    : start_(parameters.start), factor_(term.factor()), roof_(parameters.everywhere.roof) {
    const std::uint64_t own = term.seed.value_or(seed);
    parts_.emplace_back(parameters.everywhere, own);
    for (SurroundingsStretch stretch : parameters.stretches) {
        stretch.channel.roof = roof_;  // the vehicle's
        parts_.emplace_back(stretch.channel, own).stretch = stretch;
    }
}

ChannelPlace channel_place(const TruthState& truth) {
    constexpr double radius = 6371000;
    const double latitude = truth.geodetic.latitude.rad(), longitude = truth.geodetic.longitude.rad();
    const double parallel = std::cos(Angle::degrees(std::round(truth.geodetic.latitude.deg())).rad());
    const Eigen::Vector3d east(-std::sin(longitude), std::cos(longitude), 0);
    const Eigen::Vector3d north(-std::sin(latitude) * std::cos(longitude), -std::sin(latitude) * std::sin(longitude),
                                std::cos(latitude));
    const Eigen::Vector3d& velocity = truth.velocity.vector();
    ChannelPlace place;
    place.east_north = radius * Eigen::Vector2d(parallel * longitude, latitude);
    place.velocity = {east.dot(velocity), north.dot(velocity)};
    place.time = truth.time;
    return place;
}

void SurroundingsEffect::move_to(const TruthState& truth, const Eigen::Vector2d& velocity) {
    constexpr double slowest_heading = 0.5;  // m/s
    if (before_) antenna_.travelled += Metres((truth.position.vector() - before_->vector()).norm());
    before_ = truth.position;
    antenna_.place = truth.geodetic;
    antenna_.speed = MetresPerSecond(velocity.norm());
    if (velocity.norm() > slowest_heading) antenna_.heading = Angle::radians(std::atan2(velocity.x(), velocity.y()));
    antenna_.elapsed = difference(truth.time, start_);
    for (Part& part : parts_)
        if (part.stretch) part.place = place_in(*part.stretch, antenna_);
}

void SurroundingsEffect::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    ChannelPlace place = channel_place(truth);
    move_to(truth, place.velocity);
    const bool acts = std::any_of(parts_.begin(), parts_.end(),
                                  [](const Part& part) { return part.place.inside && part.parameters.acts(); });
    if (factor_ == 0 || !acts) return;
    place.street = antenna_.heading;
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        if (arrival.echoes_known || arrival.paths == 0) return;
        const SkyDirection direction = direction_of(satellite);
        ChannelSample sample;
        Decibels cover;
        for (Part& part : parts_) {
            if (!part.place.inside) continue;
            const ChannelSample own = part.channel ? part.channel->at(satellite.id, direction, place) : ChannelSample();
            sample = between(sample, own, part.place.weight);
            cover = cover_loss(part.parameters, part.place, antenna_.heading, direction);
        }
        sample = between(ChannelSample(), sample, factor_);
        meet_surroundings(arrival, sample, roof_loss(roof_, satellite.elevation) * factor_);
        arrival.shadowing_loss += cover * factor_;
        arrival.direct_loss += cover * factor_;
    });
}

}  // namespace skyloop::inline world
