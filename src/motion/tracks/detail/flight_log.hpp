// What the logs of autopilots share: places, velocities and attitudes by the clock of the autopilot, which starts anew
// with it, and their way into one track.
///
// The ways of autopilots from local metres to degrees (FEEDS.md 0.1). None of them is exact on WGS 84; they give the
// degrees that the autopilot itself gave.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/geo/geodetic.hpp"
#include "track_formats.hpp"

namespace skyloop::inline motion {

// A place in degrees and metres above the sea.
struct GlobalSample {
    std::int64_t ns = 0;
    double latitude_deg = 0, longitude_deg = 0, height_m = 0;
};

// A degree of latitude of ArduPilot's flat Earth, m (libraries/AP_Common/Location).
inline constexpr double ardupilot_metres_per_degree = 111318.845;
// Of longitude, north_m from a latitude, at the middle between both.
double ardupilot_metres_per_degree_east(double latitude_deg, double north_m);
// ardupilot_flat. Not finite for metres that leave the Earth.
GlobalSample on_ardupilot_map(const GlobalSample& origin, const Eigen::Vector3d& ned_m);
// px4_azimuthal: a sphere's azimuthal equidistant map (PX4-Autopilot, lib/geo).
GlobalSample on_px4_map(const GlobalSample& origin, const Eigen::Vector3d& ned_m);

// Nanoseconds of an autopilot's clock, or of GPS time, that are taken for a time: up to 126 years, so that neither sums
// nor differences leave 64 bits.
inline constexpr std::int64_t longest_flight_clock_ns = 4'000'000'000'000'000'000;

// Microseconds of an autopilot's clock; nothing for what is none.
std::optional<std::int64_t> flight_clock_ns(std::optional<double> microseconds);
// GPS time of a POSIX time in microseconds, ns; nothing for a clock that was not set: before 2000, or after 2100.
std::optional<std::int64_t> gps_ns_of_posix_us(double microseconds);

inline Eigen::Vector3d between_samples(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double part) {
    return a + (b - a) * part;
}
inline Eigen::Quaterniond between_samples(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b, double part) {
    return a.slerp(part, b);
}

// Samples of one quantity.
template <class Value>
class TimedSeries {
public:
    void add(std::int64_t ns, const Value& value) { samples_.push_back({ns, value}); }
    void sort() {
        std::stable_sort(samples_.begin(), samples_.end(),
                         [](const Sample& a, const Sample& b) { return a.ns < b.ns; });
    }
    [[nodiscard]] std::size_t size() const { return samples_.size(); }
    // Between the two next samples; nothing between two that are more than 2 s apart and farther than 0.2 s from both.
    // After sort().
    [[nodiscard]] std::optional<Value> at(std::int64_t ns) const {
        constexpr std::int64_t longest = 2'000'000'000, nearest = 200'000'000;
        const auto after = std::lower_bound(samples_.begin(), samples_.end(), ns,
                                            [](const Sample& sample, std::int64_t time) { return sample.ns < time; });
        if (after != samples_.end() && after != samples_.begin()) {
            const Sample& before = *(after - 1);
            const std::int64_t step = after->ns - before.ns;
            if (step > 0 && step <= longest)
                return between_samples(before.value, after->value,
                                       static_cast<double>(ns - before.ns) / static_cast<double>(step));
        }
        if (after != samples_.end() && after->ns - ns <= nearest) return after->value;
        if (after != samples_.begin() && ns - (after - 1)->ns <= nearest) return (after - 1)->value;
        return std::nullopt;
    }

private:
    struct Sample {
        std::int64_t ns;
        Value value;
    };
    std::vector<Sample> samples_;
};
using VectorSeries = TimedSeries<Eigen::Vector3d>;
using AttitudeSeries = TimedSeries<Eigen::Quaterniond>;

// Of a length near one; nothing else is a turn.
std::optional<Eigen::Quaterniond> logged_quaternion(std::optional<double> w, std::optional<double> x,
                                                    std::optional<double> y, std::optional<double> z);
// North, east, down, m/s; nothing for what is no velocity of a vehicle.
std::optional<Eigen::Vector3d> logged_velocity(std::optional<double> north, std::optional<double> east,
                                               std::optional<double> down);
std::optional<Eigen::Quaterniond> logged_angles(std::optional<double> roll_deg, std::optional<double> pitch_deg,
                                                std::optional<double> yaw_deg);

// One place of a vehicle.
struct FlightRow {
    std::int64_t ns = 0;  // of the autopilot's clock
    Geodetic place;
    bool above_sea = true;                          // its height is one above the sea, not yet above the ellipsoid
    std::optional<Eigen::Vector3d> velocity_ned{};  // m/s
    bool jump = false;
    std::optional<Eigen::Quaterniond> turn{};  // where the source tells the attitude with the place
};
// Nothing for numbers that are no place, and for 0°, 0°, where what is not known is put.
std::optional<FlightRow> flight_row(std::int64_t ns, double latitude_deg, double longitude_deg, double height_m);

// A source of places in a log; of each start of the autopilot its rows.
struct FlightOffer {
    std::string name;
    std::vector<std::vector<FlightRow>> starts;
};
// The first one whose rows cover at least half of the time that any of them covers; nothing when none has two rows.
std::optional<std::size_t> chosen_offer(std::span<const FlightOffer> offers);
// "places are the 2300 of POS, 24.9 Hz by the middle step", and whether better sources were passed by.
std::string told_choice(const FlightOffer& offer, std::size_t index);

// What is known of one start of the autopilot, beside its places.
struct FlightClock {
    std::optional<std::int64_t> gps_offset_ns;  // GPS time less the autopilot's clock
    AttitudeSeries attitudes;
};

// A whole log.
struct FlightLog {
    std::string name, format;
    FlightOffer places;
    std::vector<FlightClock> clocks;       // as many as places.starts
    std::optional<double> undulation_m{};  // as the log tells it, for where the geoid's grid is not there
    std::vector<std::string> notes{};
};
// Fails with `input` when there are no rows, and when heights above the sea find no geoid.
Result<Track> track_of_flight(FlightLog log, const Geoid* geoid);

// Tells the starts of an autopilot apart, by times that are in order but for damage and small disorder.
class AutopilotStarts {
public:
    // The number of the start, from 0; nothing for a time that does not fit until a second one confirms it.
    std::optional<std::size_t> of(std::int64_t ns);
    // Whether the time just given confirms the one refused last: that one now has a start, too.
    [[nodiscard]] bool confirmed() const { return confirmed_; }

private:
    static bool follows(std::int64_t ns, std::int64_t last);
    std::optional<std::int64_t> last_, candidate_;
    std::size_t start_ = 0;
    bool confirmed_ = false;
};

// The middle one, or nothing of none.
std::optional<std::int64_t> middle_offset(std::vector<std::int64_t>& offsets);

// "3 records … ", when there are any.
void add_count_note(std::vector<std::string>& notes, std::size_t count, const std::string& what);

}  // namespace skyloop::inline motion
