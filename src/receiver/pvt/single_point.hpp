/// Position, clocks and velocity from the measurements of one epoch.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "receiver/pvt/corrections.hpp"
#include "receiver/pvt/transmitter.hpp"
#include "world/flow/fix.hpp"
#include "world/gnss/dop.hpp"

namespace skyloop::inline receiver {

/// One clock for each system; QZSS and SBAS keep GPS's time.
inline constexpr std::size_t clock_count = 5;
/// 0 … clock_count − 1: GPS, Galileo, BeiDou, GLONASS, NavIC.
std::size_t clock_of(Constellation constellation);

/// A delay that the receiver has measured.
struct MeasuredDelay {
    Metres delay;                ///< at the carrier of the range
    double variance_factor = 0;  ///< its variance, as a multiple of s0² + s1²/sin² e
};

/// One pseudorange, ready to be solved.
struct RangeEquation {
    SatelliteId satellite;
    Transmitter transmitter;  ///< for `pseudorange` as it was measured
    Metres pseudorange;
    Hertz carrier;     ///< 0: the ionosphere is already out
    Metres deviation;  ///< 1 σ of the loops
    bool excluded = false;
    bool selected = true;                       ///< the receiver uses this satellite at all
    std::optional<AppliedSbas> sbas{};          ///< its corrections, where it has been corrected by them
    std::optional<MeasuredDelay> ionosphere{};  ///< by two carriers, beside what the model says
    Metres grid{};                              ///< of the ionosphere, taken off by what SBAS tells of it
};

/// A height that is known from elsewhere.
struct HeldHeight {
    EllipsoidalHeight height;
    Metres deviation;  ///< 1 σ, above 0
};

/// How an epoch is solved.
struct SinglePointSetup {
    GpsTime time{};  ///< of the corrections
    WeightParameters weights{};
    Angle elevation_mask = Angle::degrees(-90);     ///< >= is used
    const RangeCorrections* corrections = nullptr;  ///< absent: none
    std::optional<Position<Ecef>> start{};          ///< absent: the centre of the Earth
    std::optional<HeldHeight> held_height{};        ///< for solutions that three ranges must carry
    double noise = 1;                               ///< of the codes, against what the weights expect
};

/// What became of one pseudorange.
struct RangeOutcome {
    SkyDirection direction;
    Metres residual;                 ///< corrected pseudorange − computed one; without a clock to compare with, 0
    double variance = 0;             ///< m², as weighted
    double cofactor = 0;             ///< m², variance of the residual's estimate
    Metres ionosphere, troposphere;  ///< that were taken off by models
    Metres grid;                     ///< of the ionosphere, by what SBAS tells of it
    Hertz carrier;                   ///< 0 for a combination that the ionosphere does not touch
    Eigen::Vector3d line;            ///< unit vector receiver to satellite, ECEF of reception
    /// What one metre more of this pseudorange does to the position, ECEF, and to the reference clock; 0 if not used.
    Eigen::Vector3d position_gain = Eigen::Vector3d::Zero();
    double clock_gain = 0;
    Position<Ecef> satellite;           ///< at transmission, in the ECEF frame of reception
    Velocity<Ecef> satellite_velocity;  ///< the same
    bool used = false;
};

/// A solved epoch.
struct SinglePoint {
    Position<Ecef> position;
    std::array<std::optional<Metres>, clock_count> clocks;     ///< receiver clock − that of the system
    std::size_t reference = 0;                                 ///< the first clock that was solved
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();      ///< of the position, ECEF, m²
    double clock_variance = 0;                                 ///< of the reference clock, m²
    Eigen::Vector3d position_clock = Eigen::Vector3d::Zero();  ///< covariance of the two, ECEF, m²
    Dop dop;
    std::vector<RangeOutcome> ranges;  ///< in the order of the equations
    double ionosphere_doubt = 1;       ///< how wrong the correction may be, against the model's alone
    int used = 0;
    int redundancy = 0;    ///< ranges less unknowns
    double statistic = 0;  ///< Σ residual²/variance
    bool height_held = false;
    [[nodiscard]] Metres clock() const { return clocks[reference].value_or(Metres(0)); }
};

/// Weighted least squares, iterated until less than 1e-8 m is left; corrections follow the position until they are
/// finer than 1e-6 m, or than a ten-thousandth of the residuals (MODELS.md 7.13). The clocks are eliminated: the
/// satellites of a system count against their weighted mean, so that one which is alone in its system tells nothing and
/// is not used. DOPs come from unit weights; TDOP and GDOP take the reference clock. With a held height HDOP and TDOP
/// are those of the two other directions, and GDOP, PDOP and VDOP are not numbers.
/// @return nothing for too few ranges or a singular geometry
std::optional<SinglePoint> solve_single_point(std::span<const RangeEquation> equations, const SinglePointSetup& setup);

/// The clocks alone, with the antenna at setup.start.
std::optional<SinglePoint> solve_clocks(std::span<const RangeEquation> equations, const SinglePointSetup& setup);

/// One Doppler shift, ready to be solved.
struct DopplerEquation {
    Eigen::Vector3d line;               ///< unit vector receiver to satellite, ECEF of reception
    Position<Ecef> satellite;           ///< at transmission, in the ECEF frame of reception
    Velocity<Ecef> satellite_velocity;  ///< the same
    double satellite_drift = 0;         ///< of its clock, s/s
    MetresPerSecond range_rate;         ///< −(c/f)·Doppler
    MetresPerSecond deviation;          ///< 1 σ, above 0
};

/// A solved velocity.
struct SinglePointVelocity {
    Velocity<Ecef> velocity;
    MetresPerSecond clock_drift;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< ECEF, m²/s²
};

/// Weighted least squares on the derivative of the light-time range by the time of reception, which is linear in the
/// velocity of the receiver (MODELS.md 7.13): with τ = ρ/c, ρ̇ = u·(v_s − v_r)/(1 + u·(v_s − ω×r_s)/c).
/// @param held_up unit vector along which the receiver is taken not to move, for solutions of three shifts
std::optional<SinglePointVelocity> solve_velocity(std::span<const DopplerEquation> equations,
                                                  std::optional<Eigen::Vector3d> held_up = std::nullopt);

}  // namespace skyloop::inline receiver
