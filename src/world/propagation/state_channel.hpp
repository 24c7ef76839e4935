/// What stands between an antenna and satellites where no scene describes it, as a function of place, direction and
/// time.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <cstdint>
#include <optional>

#include "base/time/gps_time.hpp"
#include "world/flow/arrivals.hpp"
#include "world/gnss/dop.hpp"
#include "world/gnss/satellite.hpp"
#include "world/propagation/channel_parameters.hpp"
#include "world/propagation/per_satellite.hpp"

namespace skyloop::inline world {

/// Where and when an antenna is.
struct ChannelPlace {
    Eigen::Vector2d east_north = Eigen::Vector2d::Zero();  ///< on a plane that all antennas share, m
    Eigen::Vector2d velocity = Eigen::Vector2d::Zero();    ///< on it, m/s
    GpsTime time;
    std::optional<Angle> street{};  ///< azimuth of the street that it moves along
};

/// One group of scattered rays.
struct ChannelEcho {
    double power = 0;             ///< mean, over that of the direct ray in the open
    std::complex<double> gain;    ///< at this place, over that amplitude, as far as it lasts through the averaging
    double unsteady_power = 0;    ///< mean power of the rays that beat too fast for that
    Metres excess;                ///< over the direct ray
    MetresPerSecond excess_rate;  ///< of the strongest group, where it outdoes the direct ray; else 0
};

/// What a satellite's signals meet.
struct ChannelSample {
    static constexpr std::size_t echo_count = 3;
    bool bad = false;    ///< which of P.681's two states
    Decibels direct;     ///< of the direct ray, over that in the open: M_A with the shadowing
    Decibels shadowing;  ///< what of that is shadowing within the state
    Decibels diffuse;    ///< MP
    std::array<ChannelEcho, echo_count> echoes;
};

/// The channel of P.681-11, section 6.2, in which a satellite is in a good or a bad state for metres of way, weakened
/// by M_A and log-normal shadowing (Loo 1985), with diffuse rays beside the direct one.
///
/// The state is bad where a Gaussian field over direction and place is below the threshold that gives P(bad); the
/// field's curvature gives the table's number of changes per metre (Rice 1945). So satellites near to each other in the
/// sky and antennas of one vehicle meet the same obstacles, and nothing depends on what was asked before.
/// Between the walls of a street the threshold follows from their height in place of the table's P(bad): that of a long
/// row of houses, whose tops stand at atan(tan h |sin Δ|) in a direction Δ off the street; of its ends, as at 10°.
/// Of the durations, the mean is the table's and the distribution is the field's. M_A runs from one state's to the
/// other's over the ramp, on average; Σ_A and MP follow M_A.
///
/// State: rays of satellites that have been met, which depend on the seed and the satellite alone.
class StateChannel {
public:
    StateChannel(const ChannelParameters& parameters, std::uint64_t seed);
    ChannelSample at(SatelliteId satellite, const SkyDirection& direction, const ChannelPlace& place);
    /// P(bad) at an elevation, of the distance.
    [[nodiscard]] double bad_share(Angle elevation) const;
    /// Changes from good to bad per metre.
    [[nodiscard]] double changes_per_metre(Angle elevation) const;

private:
    // P.681's numbers between the rows of the table.
    struct StateNumbers {
        double mean, mean_sigma, diffuse_slope, diffuse, shadowing_slope, shadowing;
    };
    struct ElevationNumbers {
        double threshold;    // of the field, below which the state is bad
        double short_share;  // of the field's variance, in obstacles of the shorter kind
        StateNumbers good, bad;
        double ramp_per_db, ramp;
    };
    struct Ray {
        Eigen::Vector2d turns_per_metre;
        double turns, frequency;  // at the origin; Hz
    };
    static constexpr std::size_t rays_per_echo = 8;
    using Rays = std::array<std::array<Ray, rays_per_echo>, ChannelSample::echo_count>;

    [[nodiscard]] ElevationNumbers numbers_at(Angle elevation) const;
    [[nodiscard]] double wall_threshold(const SkyDirection& direction, const ChannelPlace& place) const;
    [[nodiscard]] Rays rays_of(SatelliteId satellite) const;
    void set_echoes(ChannelSample& sample, SatelliteId satellite, const ChannelPlace& place);
    void set_gain(ChannelEcho& echo, const std::array<Ray, rays_per_echo>& rays, const ChannelPlace& place) const;

    static constexpr std::size_t nodes = 19;  // each 5°
    ChannelParameters parameters_;
    Angle drawn_street_;
    double correlation_cell_;  // m
    std::array<ElevationNumbers, nodes> numbers_{};
    std::uint64_t seed_, short_key_, long_key_, level_key_, shadowing_key_;
    PerSatellite<Rays> rays_;
};

}  // namespace skyloop::inline world
