/// What a careful client asks of each solution before it navigates by it.
/// What a scripted client has understood of one epoch, whatever protocol told it.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <string>

#include "base/time/gps_time.hpp"
#include "receiver/observed/observed_log.hpp"

namespace skyloop::inline run {

/// A solution as a client hears it. Angles are in degrees, as on the wire.
struct HeardSolution {
    GpsTime heard{};         ///< by the client's own clock
    bool valid = false;      ///< the receiver says that this is a fix
    bool has_place = false;  ///< a latitude and a longitude were told
    bool three_dimensional = false;
    int satellites = 0;              ///< used
    double latitude_deg = 0;         ///< north positive
    double longitude_deg = 0;        ///< east positive
    std::optional<double> height_m;  ///< above whatever surface the protocol uses
    std::optional<double> horizontal_accuracy_m, vertical_accuracy_m, speed_accuracy_mps;  ///< 1 σ, as told
    std::optional<double> hdop;
    std::optional<std::array<double, 3>> velocity_mps{};  ///< north, east, down; down is 0 where it is not told
    bool has_vertical_velocity = false;
    std::optional<double> seconds;  ///< of the GPS week (UBX), or of the UTC day (NMEA)
    double seconds_wrap = 604800;   ///< at which `seconds` begins anew
    std::optional<double> utc_s;    ///< since 1970, without leap seconds, where date and time are told as known
    std::optional<double> gps_s;    ///< since the GPS epoch, from week and time of week, where both are told as known
    bool counts_gps_weeks = false;  ///< `seconds` are of the GPS week
};

/// What an epoch tells, without its times of day and of the receiver's GPS week. A place at 0°, 0° is one.
HeardSolution heard_solution(const ObservedEpoch& epoch, GpsTime heard);

/// `a − b` on a circle of `wrap`, from −wrap/2 to wrap/2.
double wrapped_difference(double a, double b, double wrap);

/// Limits of a careful client. The sources are the defaults of autopilots' own checks.
struct HealthLimits {
    int satellites = 6;                ///< at least: PX4 EKF2_REQ_NSATS 6, ArduPilot EKF3 6
    double horizontal_accuracy_m = 5;  ///< ArduPilot EKF3 calcGpsGoodToAlign(): hAcc 5 m; PX4 EKF2_REQ_EPH 3 m
    double vertical_accuracy_m = 7.5;  ///< ArduPilot EKF3: vAcc 7.5 m; PX4 EKF2_REQ_EPV 5 m
    double speed_accuracy_mps = 1;     ///< ArduPilot EKF3: sAcc 1 m/s; PX4 EKF2_REQ_SACC 0.5 m/s
    double hdop = 2.5;                 ///< ArduPilot EKF3: HDOP 2.5; PX4 EKF2_REQ_PDOP 2.5
    double time_jump_s = 1;            ///< against the client's clock
    double late_s = 0.3;               ///< ArduPilot counts more than 245 ms as delayed
    double early_s = 0.1;              ///< time of the receiver that gains on the client's
    double settled_s = 10;             ///< after which a time that jumped and then went on evenly is taken
    double consistency_window_s = 10;  ///< ArduPilot EKF3 posRetryTimeUseVel: 10 s until a far position is taken
    double acceleration_mps2 = 40;     ///< 4 g, the dynamic model that autopilots ask for ("airborne < 4 g")
    double frozen_s = 3;               ///< the same place …
    double frozen_speed_mps = 1;       ///< … at more than this speed
    double oldest_utc_s = 0;           ///< when the client was made, since 1970

    /// Those of a client that was made a year before it is switched on.
    static HealthLimits made_before(GpsTime switched_on);
};

/// Is it a fix, of enough satellites, of enough accuracy, at a place at all? Nothing: no doubt.
std::optional<std::string> doubt_fix(const HeardSolution& solution, const HealthLimits& limits);

/// Follows the time that solutions tell against the client's clock. State: the last solution, and how late solutions
/// came at first.
class TimeChecks {
public:
    std::optional<std::string> doubt(const HeardSolution& solution, const HealthLimits& limits);
    /// Forgets how late solutions come, as after another speed or rate.
    void forget();

private:
    std::optional<std::string> doubt_order(const HeardSolution& solution);
    std::optional<std::string> doubt_lag(const HeardSolution& solution, const HealthLimits& limits);

    std::optional<HeardSolution> last_;
    int repeated_ = 0;
    std::optional<GpsTime> lag_since_;  // first solution that made the base
    double base_ = 0;                   // of the client's clock minus told seconds, the least at the beginning
    std::optional<GpsTime> off_since_;  // evenly off since
    double off_by_ = 0;
};

/// Follows positions against velocities. State: differences of both within the window.
class MotionChecks {
public:
    std::optional<std::string> doubt(const HeardSolution& solution, const HealthLimits& limits);

private:
    struct Sample {
        GpsTime heard;
        double north_m = 0, east_m = 0, down_m = 0;  // position minus integrated velocity
    };
    std::optional<std::string> doubt_step(const HeardSolution& solution, const HealthLimits& limits);
    std::optional<std::string> doubt_window(const HeardSolution& solution, const HealthLimits& limits);
    void begin_anew(const HeardSolution& solution);

    std::optional<HeardSolution> last_;
    std::deque<Sample> window_;
    double origin_latitude_deg_ = 0, origin_longitude_deg_ = 0, origin_height_m_ = 0;
    double moved_north_m_ = 0, moved_east_m_ = 0, moved_down_m_ = 0;  // integrated velocity
    GpsTime same_since_{};
};

/// All of them, for each solution in turn.
class HealthChecks {
public:
    HealthChecks() = default;
    explicit HealthChecks(const HealthLimits& limits) : limits_(limits) {}
    /// The first doubt, in a sentence; nothing when there is none.
    std::optional<std::string> doubt(const HeardSolution& solution);
    /// The client has changed speed or rate.
    void forget_timing() { time_.forget(); }

private:
    HealthLimits limits_;
    TimeChecks time_;
    MotionChecks motion_;
};

}  // namespace skyloop::inline run
