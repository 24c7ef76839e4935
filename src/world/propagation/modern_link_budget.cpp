#include "world/propagation/modern_link_budget.hpp"

#include <algorithm>
#include <cmath>

#include "world/gnss/signal.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/ray_geometry.hpp"

namespace skyloop::inline world {
namespace {

// No estimator tells more, nor a sentence with two digits, however strong a scenario makes its satellites.
constexpr double most_cn0 = 99;
constexpr Nanoseconds ripple_spacing = std::chrono::seconds(5);
constexpr double geosynchronous_radius = 42164e3;

// Of the ripple at the horizon.
double low_share(Angle elevation) {
    constexpr double fall = 20;  // degrees
    return std::exp(-elevation.deg() / fall);
}

double link_ratio(double decibels) { return std::pow(10, decibels / 10); }

// Whether a satellite of BeiDou is one of the high ones.
bool is_geosynchronous(Metres range) { return range.value() > 30000e3; }

// Semi-major axes of the constellations, m; BeiDou has two kinds, told by the distance.
double nominal_orbit_radius(Constellation constellation, Metres range) {
    switch (constellation) {
        case Constellation::gps:
            return 26560e3;
        case Constellation::galileo:
            return 29600e3;
        case Constellation::glonass:
            return 25510e3;
        case Constellation::beidou:
            return is_geosynchronous(range) ? geosynchronous_radius : 27906e3;
        default:
            return geosynchronous_radius;
    }
}

// EIRP between the points of a table; constant beyond them.
DecibelWatts eirp_at(const std::vector<SatellitePowerPoint>& pattern, Angle off_boresight) {
    const auto above =
        std::upper_bound(pattern.begin(), pattern.end(), off_boresight,
                         [](Angle angle, const SatellitePowerPoint& point) { return angle < point.off_boresight; });
    if (above == pattern.begin()) return pattern.front().eirp;
    if (above == pattern.end()) return pattern.back().eirp;
    const SatellitePowerPoint& below = *(above - 1);
    const double fraction =
        (off_boresight - below.off_boresight).rad() / (above->off_boresight - below.off_boresight).rad();
    return below.eirp * (1 - fraction) + above->eirp * fraction;
}

// The Earth's radius that makes the antenna's distance from the centre right.
SphericalRay ray_from_antenna(const Arrival& arrival, const TruthState& truth) {
    const double from_centre = truth.position.vector().norm();
    return {arrival.direction.elevation, Metres(0), Metres(from_centre > 0 ? from_centre : 6371000)};
}

}  // namespace

Decibels relative_signal_power(Constellation constellation, Signal signal, Metres range) {
    // Of minimum received powers, dBW. GPS and QZSS: L1 C/A −158.5, L2C −160.0, L5 −157.9 (IS-GPS-200, table 3-Va;
    // IS-GPS-705, table 3-III; IS-QZSS-PNT). Galileo: E1 −157.25, E5a and E5b −155.25 (OS SIS ICD 2.0, table 12).
    // BeiDou: B1I, B2I and B3I −163 (B1I ICD 3.0, 4.2.5; B3I ICD 1.0). GLONASS: L1 −161, L2 −167 (ICD L1, L2 5.1,
    // 3.3.1.6). B2a: −156 of MEO, −158 of IGSO satellites (B2a ICD 1.0). B1I's −163 is no measure for it: satellites
    // exceed that by far, and so does their nominal power here. That is the one of GPS, whose document has −158.5, and
    // B2a is taken against those: 7 dB over B1I were 6 dB over GPS L5, of which the documents tell 1.9.
    switch (constellation) {
        case Constellation::gps:
        case Constellation::qzss:
            return Decibels(signal == Signal::l2 ? -1.5 : signal == Signal::l5 ? 0.6 : 0);
        case Constellation::galileo:
            return Decibels(signal == Signal::l5 || signal == Signal::e5b ? 2 : 0);
        case Constellation::glonass:
            return Decibels(signal == Signal::g2 ? -6 : 0);
        case Constellation::beidou:
            if (signal != Signal::l5) return Decibels(0);
            return Decibels(is_geosynchronous(range) ? 0.5 : 2.5);
        default:
            return Decibels(0);
    }
}

ModernLinkBudget::ModernLinkBudget(const ModernPropagationParameters& parameters, std::uint64_t seed)
    : link_(parameters.link),
      power_term_(parameters.satellite_power),
      antenna_factor_(parameters.antenna.factor()),
      interference_factor_(parameters.interference.factor()),
      film_(parameters.loss_model.antenna_film),
      seed_(seed) {}

DecibelWatts ModernLinkBudget::isotropic_power(const Arrival& arrival, const TruthState& truth) const {
    const SphericalRay ray = ray_from_antenna(arrival, truth);
    const double radius = nominal_orbit_radius(arrival.id.constellation, arrival.range);
    if (!link_.satellite_pattern.empty()) {
        // The satellite's distance from the centre of the Earth, by the law of cosines.
        const double r = ray.earth_radius.value(), d = arrival.range.value();
        const double orbit = std::sqrt(r * r + d * d + 2 * r * d * std::sin(ray.elevation.rad()));
        const Angle theta = off_boresight_angle(ray, Metres(orbit));
        return DecibelWatts(eirp_at(link_.satellite_pattern, theta).value() - arrival.free_space_loss.value());
    }
    const DecibelWatts nominal = of_system(link_.received, arrival.id);
    if (arrival.range.value() <= 0) return nominal;
    const Metres distance = path_to_height(ray, Metres(radius) - ray.earth_radius);
    return nominal - DecibelWatts(20 * std::log10(arrival.range.value() / distance.value()));
}

DecibelWattsPerHertz ModernLinkBudget::noise(Hertz carrier) const {
    DecibelWattsPerHertz density = noise_density(system_temperature(link_.noise));
    if (link_.man_made) {
        // Over k · 290 K at the antenna, and added to what the receiver has behind its line.
        const double over = link_ratio(man_made_noise_p372(*link_.man_made, carrier).value());
        const double receiver = system_temperature(link_.noise).value();
        density = noise_density(Kelvin(receiver + 290 * over / link_ratio(link_.noise.line_loss.value())));
    }
    return density + DecibelWattsPerHertz(link_.platform_noise.value());
}

void ModernLinkBudget::set_cn0(Arrival& arrival, const TruthState& truth) const {
    const Decibels losses = arrival.gas_loss + arrival.cloud_loss + arrival.rain_loss + arrival.foliage_loss +
                            arrival.iono_loss + arrival.reflection_loss + arrival.shadowing_loss;
    // At the antenna's port.
    const double signal = isotropic_power(arrival, truth).value() + arrival.antenna_gain.value() +
                          arrival.power_offset.value() - losses.value();
    const double density = noise(first_carrier(arrival)).value();
    // The noise is that at the receiver's end of the line, where the signal is weaker, too (Friis).
    const Decibels inside = link_.noise.line_loss + link_.implementation_loss;
    const DbHz clear(std::min(signal - inside.value() - density, most_cn0));
    arrival.cn0 = clear;
    if (!link_.jammer_to_signal || interference_factor_ == 0) return;
    // The jammer is as strong as it is; a weaker satellite suffers more. The line weakens both alike.
    const Decibels jammer_over_signal(nominal_signal_power.value() + link_.jammer_to_signal->value() - signal);
    const DbHz jammed = cn0_under_interference(clear, jammer_over_signal, {rejection_quality(link_.jammer)});
    arrival.interference_loss = Decibels(interference_factor_ * (clear - jammed).value());
    arrival.cn0 = clear - DbHz(arrival.interference_loss.value());
}

void ModernLinkBudget::apply(Arrivals& arrivals, const SkyView& /*sky*/, const TruthState& truth) {
    const double power_factor = power_term_.factor();
    for (Arrival& arrival : arrivals.satellites) {
        for (SignalArrival& signal : arrival.signals)
            signal.relative_power = relative_signal_power(arrival.id.constellation, signal.signal, arrival.range);
        if (antenna_factor_ != 0)
            arrival.antenna_gain = (link_.antenna.gain(arrival.direction) - film_) * antenna_factor_;
        if (power_factor != 0) {
            Power& power = powers_.of(arrival.id, [this](SatelliteId id) {
                const std::string name = "satellite_power." + to_string(id);
                // Satellites lie within two deviations: a satellite that is stronger than any real one helps nobody.
                const double normal = std::clamp(power_term_.stream(seed_, name).normal(), -2.0, 2.0);
                const double spread = normal * link_.satellite_spread.value();
                return Power{spread, KnottedProcess({1, link_.ripple_time}, ripple_spacing,
                                                    power_term_.stream(seed_, name + ".ripple"))};
            });
            const double ripple =
                link_.ripple.value() + link_.ripple_at_horizon.value() * low_share(arrival.direction.elevation);
            arrival.power_offset = Decibels(power_factor * (power.spread + ripple * power.ripple.at(truth.time)));
        }
        arrival.cn0.reset();
        if (arrival.paths > 0) set_cn0(arrival, truth);
    }
}

}  // namespace skyloop::inline world
