#include "world/propagation/state_channel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "world/gnss/constants.hpp"
#include "world/propagation/smooth_noise.hpp"

namespace skyloop::inline world {
namespace {

constexpr double node_spacing_deg = 5;
constexpr double per_decibel = std::numbers::ln10 / 10;  // of a power
// Two kinds of obstacles, trees and houses: of one kind alone the durations would all be alike. Ours; the table's mean
// lengths of way from one change to the next, 38 m to some hundreds, lie between what the two give.
constexpr double short_cell_m = 5, long_cell_m = 40;
// Over which M_A changes within a state that lasts so long. Ours: the median duration of the table's states.
constexpr double level_cell_m = 16;
// The table's S70 and U70 have a σ of 2.47 for ln m, so that the mean of their good state, 3.6 km, hangs on a few
// events; they say no more than that changes are rare.
constexpr double longest_mean_m = 600;
// Below 20° the table has nothing: P(bad) goes on as from 30 to 20°, up to here.
constexpr double lowest_threshold = -2, highest_threshold = 1.3;
// Of the events' M_A: quantiles of 5 and 95 % of the good state, of 10 and 90 % of the bad one (P.681-11, 6.2).
constexpr double good_cut = 1.645, bad_cut = 1.2816;
// Echoes: mean power and delay of the groups, shares and factors. Ours: near scatterers, the other side of the street,
// and what lies farther away, falling exponentially with the delay.
constexpr std::array<double, ChannelSample::echo_count> echo_shares{0.6, 0.3, 0.1}, echo_delays{0.3, 1, 2.5};
constexpr double echo_spread_db = 4;  // 1 σ; clusters of 3GPP TR 38.901, 7.5, have 3

struct SmoothedRow {
    double elevation_deg, threshold, log_cycle;
    const P681Row* row;
};

// P(bad) does not grow with the elevation: where the table has it otherwise (residential from 60°, suburban at 60°) the
// campaigns had few satellites.
std::vector<SmoothedRow> smoothed(const ChannelParameters& p) {
    std::vector<SmoothedRow> rows;
    double least = 1;
    for (const P681Row& row : p681_rows(*p.environment)) {
        const double bad = row.bad.mean_duration_m();
        const double good = std::min(row.good.mean_duration_m(), longest_mean_m);
        least = std::min(least, bad / (good + bad));
        const double odds = p.bad_odds * least / (1 - least);
        rows.push_back({row.elevation_deg, normal_quantile(odds / (1 + odds)), std::log(good + bad), &row});
    }
    return rows;
}

// Between which two rows an elevation lies, and how far; outside the table below 0 or above 1.
struct RowPlace {
    const SmoothedRow *below, *above;
    double fraction;
    [[nodiscard]] double held() const { return std::clamp(fraction, 0.0, 1.0); }
    [[nodiscard]] double between(double a, double b) const { return a + held() * (b - a); }
};

RowPlace place_in(const std::vector<SmoothedRow>& rows, double elevation_deg) {
    std::size_t above = 1;
    while (above + 1 < rows.size() && rows[above].elevation_deg < elevation_deg)
        ++above;
    const SmoothedRow &a = rows[above - 1], &b = rows[above];
    return {&a, &b, (elevation_deg - a.elevation_deg) / (b.elevation_deg - a.elevation_deg)};
}

// −R''(0) of the field that crosses its threshold once for each cycle (Rice 1945), as the share of the shorter kind.
double short_share_for(double threshold, double cycle_m) {
    const double slope = 2 * std::numbers::pi / cycle_m * std::exp(threshold * threshold / 2);
    const double wanted = slope * slope / noise_curvature;
    constexpr double least = 1 / (long_cell_m * long_cell_m), most = 1 / (short_cell_m * short_cell_m);
    return std::clamp((wanted - least) / (most - least), 0.0, 1.0);
}

double curvature_of(double short_share) {
    return noise_curvature *
           (short_share / (short_cell_m * short_cell_m) + (1 - short_share) / (long_cell_m * long_cell_m));
}

std::uint64_t key_of(std::uint64_t seed, SatelliteId satellite, std::size_t which) {
    const auto id = static_cast<std::uint64_t>(satellite.constellation) << 40u |
                    static_cast<std::uint64_t>(satellite.number) << 8u | which;
    return spread_bits(seed ^ spread_bits(id));
}

// Where the fields are looked at: at rest they go by.
Eigen::Vector2d drifted(const ChannelPlace& place, MetresPerSecond creep) {
    const double way = creep.value() * to_seconds(place.time.time_since_epoch()).value();
    return place.east_north + way * Eigen::Vector2d(0.8, 0.6);
}

struct EchoPlace {
    double weight, excess;
};

using PlaneKnots = std::array<NoiseKnots, 2>;

PlaneKnots plane_knots(const Eigen::Vector2d& place, double cell) {
    return {NoiseKnots(place.x() / cell), NoiseKnots(place.y() / cell)};
}

EchoPlace echo_at(std::uint64_t key, std::size_t group, const PlaneKnots& place, const ChannelParameters& p) {
    const double power = spline_noise(key, place), delay = spline_noise(spread_bits(key), place);
    constexpr double farthest = 1e-3;  // of the distribution, which is exponential
    const double beyond = std::max(1 - normal_distribution(delay), farthest);
    return {echo_shares.at(group) * std::exp(per_decibel * echo_spread_db * power),
            -echo_delays.at(group) * p.echo_delay.value() * std::log(beyond)};
}

}  // namespace

StateChannel::StateChannel(const ChannelParameters& parameters, std::uint64_t seed)
    : parameters_(parameters),
      drawn_street_(Angle::radians(std::numbers::pi * uniform_of_bits(noise_key(seed, "channel.street")))),
      seed_(noise_key(seed, "channel.echoes")),
      short_key_(noise_key(seed, "channel.short_obstacles")),
      long_key_(noise_key(seed, "channel.long_obstacles")),
      level_key_(noise_key(seed, "channel.level")),
      shadowing_key_(noise_key(seed, "channel.shadowing")) {
    const std::vector<SmoothedRow> rows = smoothed(parameters);
    double correlation = 0;
    for (const SmoothedRow& row : rows)
        correlation += row.row->correlation_m / static_cast<double>(rows.size());
    correlation_cell_ = correlation / noise_correlation_cells * parameters.distance_scale;
    for (std::size_t i = 0; i < nodes; ++i) {
        const RowPlace at = place_in(rows, node_spacing_deg * static_cast<double>(i));
        const double outward = std::min(at.fraction, 1.0);
        const double threshold = std::clamp(at.below->threshold + outward * (at.above->threshold - at.below->threshold),
                                            lowest_threshold, highest_threshold);
        const double cycle = std::exp(at.between(at.below->log_cycle, at.above->log_cycle));
        const P681Row &a = *at.below->row, &b = *at.above->row;
        const auto state = [&](const P681State& from, const P681State& to) {
            return StateNumbers{at.between(from.mean_db, to.mean_db),
                                at.between(from.mean_sigma_db, to.mean_sigma_db),
                                at.between(from.diffuse_slope, to.diffuse_slope),
                                at.between(from.diffuse_db, to.diffuse_db),
                                at.between(from.shadowing_slope, to.shadowing_slope),
                                at.between(from.shadowing_db, to.shadowing_db)};
        };
        numbers_[i] = {threshold,           short_share_for(threshold, cycle),        state(a.good, b.good),
                       state(a.bad, b.bad), at.between(a.ramp_per_db, b.ramp_per_db), at.between(a.ramp_m, b.ramp_m)};
    }
}

StateChannel::ElevationNumbers StateChannel::numbers_at(Angle elevation) const {
    const double place = std::clamp(elevation.deg() / node_spacing_deg, 0.0, nodes - 1.0);
    const auto below = std::min(static_cast<std::size_t>(place), nodes - 2);
    const double f = place - static_cast<double>(below);
    const ElevationNumbers &a = numbers_[below], &b = numbers_[below + 1];
    const auto mix = [f](double from, double to) { return from + f * (to - from); };
    const auto state = [&](const StateNumbers& from, const StateNumbers& to) {
        return StateNumbers{mix(from.mean, to.mean),
                            mix(from.mean_sigma, to.mean_sigma),
                            mix(from.diffuse_slope, to.diffuse_slope),
                            mix(from.diffuse, to.diffuse),
                            mix(from.shadowing_slope, to.shadowing_slope),
                            mix(from.shadowing, to.shadowing)};
    };
    return {mix(a.threshold, b.threshold), mix(a.short_share, b.short_share), state(a.good, b.good),
            state(a.bad, b.bad),           mix(a.ramp_per_db, b.ramp_per_db), mix(a.ramp, b.ramp)};
}

double StateChannel::bad_share(Angle elevation) const { return normal_distribution(numbers_at(elevation).threshold); }

double StateChannel::changes_per_metre(Angle elevation) const {
    const ElevationNumbers n = numbers_at(elevation);
    return std::sqrt(curvature_of(n.short_share)) / (2 * std::numbers::pi) * std::exp(-n.threshold * n.threshold / 2) /
           parameters_.distance_scale;
}

double StateChannel::wall_threshold(const SkyDirection& direction, const ChannelPlace& place) const {
    constexpr double least_across = 0.17, most = 3;  // sine of 10°; deviations of the field
    const Angle street = parameters_.street.value_or(place.street.value_or(drawn_street_));
    const double across = std::max(std::abs(std::sin((direction.azimuth - street).rad())), least_across);
    const double top = std::atan(std::tan(parameters_.wall.rad()) * across);
    return std::clamp((top - direction.elevation.rad()) / parameters_.wall_spread.rad(), -most, most);
}

StateChannel::Rays StateChannel::rays_of(SatelliteId satellite) const {
    // Directions all around, one in each of equal sectors: Clarke's spectrum. Wavelength of L1.
    constexpr double wave_number = carrier_frequency_l1 / speed_of_light;
    constexpr double sector = 2 * std::numbers::pi / rays_per_echo;
    Rays rays;
    for (std::size_t group = 0; group < rays.size(); ++group)
        for (std::size_t i = 0; i < rays_per_echo; ++i) {
            const std::uint64_t direction = key_of(seed_, satellite, 128 + group * rays_per_echo + i);
            const std::uint64_t phase = spread_bits(direction), frequency = spread_bits(phase);
            const double azimuth = sector * (static_cast<double>(i) + uniform_of_bits(direction));
            rays[group][i] = {wave_number * Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth)),
                              uniform_of_bits(phase), parameters_.beat.value() * normal_of_bits(frequency)};
        }
    return rays;
}

// Each ray turns with place and time. What turns faster than the receiver averages is left of it as by a low-pass of
// first order, and the rest adds its power.
void StateChannel::set_gain(ChannelEcho& echo, const std::array<Ray, rays_per_echo>& rays,
                            const ChannelPlace& place) const {
    const double time = to_seconds(place.time.time_since_epoch()).value();
    const double amplitude = std::sqrt(echo.power / rays_per_echo);
    constexpr double least_steady = 1e-3;  // what is left of a ray is faint then
    for (const Ray& ray : rays) {
        const double beat = ray.turns_per_metre.dot(place.velocity) + ray.frequency;
        const double turned = 2 * std::numbers::pi * beat * parameters_.averaging.value();
        const double steady = 1 / (1 + turned * turned);
        echo.unsteady_power += amplitude * amplitude * (1 - steady);
        if (steady < least_steady) continue;
        const double turns = ray.turns + ray.turns_per_metre.dot(place.east_north) + ray.frequency * time;
        echo.gain += std::polar(amplitude * std::sqrt(steady), 2 * std::numbers::pi * (turns - std::floor(turns)));
    }
}

void StateChannel::set_echoes(ChannelSample& sample, SatelliteId satellite, const ChannelPlace& place) {
    const Rays& rays = rays_.of(satellite, [this](SatelliteId id) { return rays_of(id); });
    constexpr double ahead = 0.1;  // s
    const Eigen::Vector2d here = drifted(place, parameters_.creep);
    const PlaneKnots knots = plane_knots(here, parameters_.echo_length.value());
    double sum = 0;
    std::size_t strongest = 0;
    for (std::size_t group = 0; group < sample.echoes.size(); ++group) {
        const std::uint64_t key = key_of(seed_, satellite, group);
        const EchoPlace now = echo_at(key, group, knots, parameters_);
        ChannelEcho& echo = sample.echoes[group];
        echo.power = now.weight;
        echo.excess = Metres(now.excess);
        sum += now.weight;
        if (now.weight > sample.echoes[strongest].power) strongest = group;
    }
    const double diffuse = std::exp(per_decibel * sample.diffuse.value());
    for (std::size_t group = 0; group < sample.echoes.size(); ++group) {
        sample.echoes[group].power *= diffuse / sum;
        set_gain(sample.echoes[group], rays[group], place);
    }
    ChannelEcho& tracked = sample.echoes[strongest];
    const double direct = std::exp(per_decibel * (sample.direct - parameters_.roof).value());
    if (tracked.power < direct) return;
    const Eigen::Vector2d drift = place.velocity + parameters_.creep.value() * Eigen::Vector2d(0.8, 0.6);
    const PlaneKnots there = plane_knots(here + ahead * drift, parameters_.echo_length.value());
    const double later = echo_at(key_of(seed_, satellite, strongest), strongest, there, parameters_).excess;
    tracked.excess_rate = MetresPerSecond((later - tracked.excess.value()) / ahead);
}

ChannelSample StateChannel::at(SatelliteId satellite, const SkyDirection& direction, const ChannelPlace& place) {
    ElevationNumbers n = numbers_at(direction.elevation);
    if (parameters_.wall > Angle()) n.threshold = wall_threshold(direction, place);
    // Equal angles of the sky are equal distances from the zenith outwards.
    const double zenith = (90 - direction.elevation.deg()) / (parameters_.reach.deg() / noise_reach_cells);
    const double across = zenith * std::sin(direction.azimuth.rad()), up = zenith * std::cos(direction.azimuth.rad());
    const Eigen::Vector2d here = drifted(place, parameters_.creep);
    const NoiseKnots across_knots(across), up_knots(up);
    const auto field = [&](std::uint64_t key, double cell) {
        const PlaneKnots plane = plane_knots(here, cell);
        return spline_noise(key, std::array{across_knots, up_knots, plane[0], plane[1]});
    };
    const double scale = parameters_.distance_scale;
    const double obstacles = std::sqrt(n.short_share) * field(short_key_, short_cell_m * scale) +
                             std::sqrt(1 - n.short_share) * field(long_key_, long_cell_m * scale);
    const double level = field(level_key_, level_cell_m * scale);
    const double good = n.good.mean + n.good.mean_sigma * std::clamp(level, -good_cut, good_cut);
    const double bad = n.bad.mean + n.bad.mean_sigma * std::clamp(level, -bad_cut, bad_cut);
    // On average the field crosses its threshold with a slope of √(π/2) times its own deviation (Rice 1945).
    const double ramp = std::max(n.ramp_per_db * std::abs(good - bad) + n.ramp, 0.0) * scale;
    const double rise = std::max(ramp * std::sqrt(curvature_of(n.short_share) * std::numbers::pi / 2) / scale, 1e-6);
    const double badness = std::clamp(0.5 + (n.threshold - obstacles) / rise, 0.0, 1.0);
    const auto mixed = [badness](double from, double to) { return from + badness * (to - from); };

    ChannelSample sample;
    sample.bad = obstacles < n.threshold;
    const double deviation =
        parameters_.shadowing_scale * mixed(std::max(n.good.shadowing_slope * good + n.good.shadowing, 0.0),
                                            std::max(n.bad.shadowing_slope * bad + n.bad.shadowing, 0.0));
    sample.shadowing = Decibels(deviation * field(shadowing_key_, correlation_cell_));
    sample.direct = Decibels(mixed(good, bad)) + sample.shadowing -
                    Decibels(mixed(parameters_.good_loss.value(), parameters_.bad_loss.value()));
    sample.diffuse =
        Decibels(mixed(n.good.diffuse_slope * good + n.good.diffuse, n.bad.diffuse_slope * bad + n.bad.diffuse)) +
        parameters_.diffuse;
    set_echoes(sample, satellite, place);
    return sample;
}

}  // namespace skyloop::inline world
