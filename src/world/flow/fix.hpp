/// What the receiver believes.
/// How the errors of a solution go together.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "base/geo/geodetic.hpp"
#include "base/time/gps_time.hpp"
#include "world/gnss/dop.hpp"
#include "world/gnss/satellite.hpp"

namespace skyloop::inline world {

/// Correlations of a solution's errors, beside how large they are: −1 … 1, and 1 of each with itself. They stay what
/// they are while accuracies grow or are scaled.
struct ErrorCorrelation {
    Eigen::Matrix4d position_clock = Eigen::Matrix4d::Identity();  ///< east, north, up, receiver clock
    Eigen::Matrix3d velocity = Eigen::Matrix3d::Identity();        ///< east, north, up

    /// For a height that is told from elsewhere, and a receiver that does not move along it.
    void part_height() {
        constexpr Eigen::Index up = 2;
        const auto part = [](auto& correlation) {
            correlation.row(up).setZero();
            correlation.col(up).setZero();
            correlation(up, up) = 1;
        };
        part(position_clock);
        part(velocity);
    }
};

/// The correlations in a covariance. What has no variance goes with nothing.
template <int Size>
Eigen::Matrix<double, Size, Size> correlation_of(const Eigen::Matrix<double, Size, Size>& covariance) {
    Eigen::Matrix<double, Size, Size> correlation = Eigen::Matrix<double, Size, Size>::Identity();
    for (Eigen::Index row = 0; row < Size; ++row)
        for (Eigen::Index column = 0; column < row; ++column) {
            const double deviations = std::sqrt(covariance(row, row) * covariance(column, column));
            if (deviations > 0)
                correlation(row, column) = correlation(column, row) = covariance(row, column) / deviations;
        }
    return correlation;
}

/// The covariance of errors so large that go together so; its diagonal is `variances`.
template <int Size>
Eigen::Matrix<double, Size, Size> covariance_of(const Eigen::Matrix<double, Size, 1>& variances,
                                                const Eigen::Matrix<double, Size, Size>& correlation) {
    const Eigen::Matrix<double, Size, 1> deviations = variances.cwiseSqrt();
    Eigen::Matrix<double, Size, Size> covariance = correlation.cwiseProduct(deviations * deviations.transpose());
    covariance.diagonal() = variances;
    return covariance;
}

/// Kinds of solution, as fixes.csv names them.
enum class FixType { none, dead_reckoning, fix_2d, fix_3d, dgnss, rtk_float, rtk_fixed, time_only };

/// As in fixes.csv, in the order of FixType.
inline constexpr std::array<std::string_view, 8> fix_type_names{"none",  "dead_reckoning", "2d",        "3d",
                                                                "dgnss", "rtk_float",      "rtk_fixed", "time_only"};
constexpr std::string_view fix_type_name(FixType type) { return fix_type_names[static_cast<std::size_t>(type)]; }

/// Velocity over ground, metres per second.
struct VelocityNed {
    double north = 0, east = 0, down = 0;
};

/// What an SBAS satellite has told of another one, as it was applied.
struct AppliedSbas {
    int udre_index = 0;       ///< of the bound of its error, 0 … 13
    Metres range_correction;  ///< fast, added to the pseudorange
    Metres ionosphere;        ///< slant, taken off it
};

/// One satellite as the receiver reports it.
struct SatelliteStatus {
    SatelliteId id;
    Angle azimuth;
    Angle elevation;
    std::optional<DbHz> cn0;  ///< nothing: in view, not tracked
    bool used = false;
    bool has_ephemeris = true;         ///< the receiver has a record of its orbit
    bool healthy = true;               ///< by that record, and by what it sends now
    std::optional<Metres> residual{};  ///< of the pseudorange after the solution
    std::optional<AppliedSbas> sbas{};
};

/// A position, velocity and time solution. Without a fix only `time`, `leap_seconds` and `satellites` mean something.
struct Fix {
    GpsTime time;
    FixType type = FixType::none;
    int leap_seconds = 18;  ///< GPST − UTC that the receiver believes, s
    Geodetic position;
    Metres geoid_undulation;  ///< of the receiver's own geoid at `position`
    VelocityNed velocity;
    MetresPerSecond speed;  ///< over ground
    Angle course;           ///< 0 … 360°
    Dop dop;
    Metres horizontal_accuracy;  ///< 1 σ estimate, horizontal
    Metres vertical_accuracy;
    MetresPerSecond speed_accuracy;                 ///< 1 σ estimate
    Angle course_accuracy;                          ///< 1 σ estimate
    Metres time_accuracy;                           ///< 1 σ estimate, times the speed of light
    std::optional<ErrorCorrelation> correlation{};  ///< of the errors that the accuracies are of; nothing: not known
    Metres clock_bias;                              ///< receiver clock − GPST as solved
    MetresPerSecond clock_drift;                    ///< of it
    std::vector<SatelliteStatus> satellites;        ///< all that the receiver knows of, ascending
    bool withheld = false;                     ///< no fix, as what was solved lies beyond the dynamic model's limits
    std::optional<SatelliteId> sbas_source{};  ///< whose corrections are in the solution

    [[nodiscard]] bool has_position() const { return type != FixType::none && type != FixType::time_only; }
    [[nodiscard]] int satellites_used() const {
        int count = 0;
        for (const SatelliteStatus& s : satellites)
            count += s.used ? 1 : 0;
        return count;
    }
};

}  // namespace skyloop::inline world
