/// How a vehicle gathers and loses speed along its way.
#pragma once

#include <vector>

namespace skyloop {

/// Limits along a way; m/s, m/s², m/s³.
struct SpeedLimits {
    double speed = 10, acceleration = 2, jerk = 2;
};

/// Where a vehicle is along its way; m, m/s, m/s².
struct AlongWay {
    double way = 0, speed = 0, acceleration = 0;
};

/// s until the speed has changed by that much, acceleration being zero before and after. @param change m/s
double speed_change_time(double change, const SpeedLimits& limits);
/// m that this takes
double speed_change_length(double from, double to, const SpeedLimits& limits);
/// The largest speed, at most `limits.speed`, to which one gets from `from` within a length.
double fastest_after(double from, double length, const SpeedLimits& limits);

/// Pieces of constant jerk, one after the other: seven of them are the S-curve (FEEDS.md 2.1; Biagiotti and Melchiorri,
/// Trajectory Planning for Automatic Machines and Robots, 3.4). The acceleration is continuous, and zero between the
/// calls of the functions that add.
class SpeedProfile {
public:
    /// @param speed at the beginning, m/s
    explicit SpeedProfile(double speed = 0) : speed_(speed) {}
    /// To another speed, as fast as the limits let.
    void change(double to, const SpeedLimits& limits);
    /// At the speed as it is; @param seconds also infinite
    void keep(double seconds);
    /// Over a length to a speed at its end, as fast as the limits let. @param to not beyond what change() reaches in
    /// that length, see fastest_after()
    void run(double length, double to, const SpeedLimits& limits);

    [[nodiscard]] AlongWay at(double t) const;
    [[nodiscard]] double duration() const { return ends_; }
    /// m from beginning to end
    [[nodiscard]] double length() const { return way_; }
    /// m/s at the end
    [[nodiscard]] double speed() const { return speed_; }

private:
    struct Segment {
        double begins, way, speed, acceleration, jerk;
    };
    void add(double seconds, double acceleration, double jerk);

    std::vector<Segment> segments_;
    double ends_ = 0, way_ = 0, speed_;
};

}  // namespace skyloop
