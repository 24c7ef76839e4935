#include "motion/trajectory/path_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "base/geo/attitude.hpp"
#include "base/geo/local_frame.hpp"

namespace skyloop::inline motion {
namespace {

using Eigen::Vector3d;

Vector3d ned_of(const TruthState& state, const Vector3d& ecef) {
    return ned_to_ecef(state.geodetic).conjugate() * ecef;
}

void keep_larger(PathExtreme& extreme, double value, double at_s) {
    if (value > extreme.value) extreme = {value, at_s};
}

// Whether what changes between two instants changes in no time: halves the time until a microsecond is left.
template <class Quantity>
bool changes_at_once(const Trajectory& path, GpsTime from, GpsTime to, const Quantity& of) {
    constexpr Nanoseconds no_time = std::chrono::microseconds(1);
    Vector3d before = of(path.at(from)), after = of(path.at(to));
    const double whole = (after - before).norm();
    while (to - from > no_time) {
        const GpsTime middle = from + (to - from) / 2;
        const Vector3d between = of(path.at(middle));
        if ((between - before).norm() > (after - between).norm()) {
            to = middle;
            after = between;
        } else {
            from = middle;
            before = between;
        }
    }
    return (after - before).norm() > whole / 2;
}

Vector3d velocity_of(const TruthState& state) { return state.velocity.vector(); }

// Whether the velocity steps on the way from one state to a later one: more than a vehicle changes it, and at once.
bool velocity_steps(const Trajectory& path, const TruthState& before, const TruthState& now) {
    constexpr double suspicious_mps2 = 20, least_step_mps = 0.05;
    const double changed = (velocity_of(now) - velocity_of(before)).norm();
    const double span = difference(now.time, before.time).value();
    return changed > std::max(suspicious_mps2 * span, least_step_mps) &&
           changes_at_once(path, before.time, now.time, velocity_of);
}

// Whether the place jumps there: further than the velocities lead, and at once.
bool place_jumps(const Trajectory& path, const TruthState& before, const TruthState& now) {
    constexpr double least_m = 0.5;
    const Vector3d moved = (now.position - before.position).vector();
    const double span = difference(now.time, before.time).value();
    const Vector3d expected = (velocity_of(now) + velocity_of(before)) * (span / 2);
    return (moved - expected).norm() > std::max(least_m, expected.norm()) &&
           changes_at_once(path, before.time, now.time,
                           [](const TruthState& s) -> Vector3d { return s.position.vector(); });
}

// Walks along a path and keeps what is largest.
class Surveyor {
public:
    Surveyor(const Trajectory& path, const PathSpan& span) : path_(path), span_(span) {
        constexpr double finest_s = 0.01, most_steps = 1e6;
        const double length = std::max(0.0, span.length.value());
        survey_.duration_s = length;
        steps_ = static_cast<std::int64_t>(std::clamp(std::ceil(length / finest_s), 1.0, most_steps));
    }

    PathSurvey run() {
        before_ = path_.at(span_.from);
        west_ = east_ = before_.geodetic.longitude.rad();
        south_ = north_ = before_.geodetic.latitude.rad();
        const double height = before_.geodetic.height.above_ellipsoid.value();
        survey_.lowest = survey_.highest = {height, 0};
        survey_.has_orientation = before_.orientation.has_value();
        look(before_, 0);
        for (std::int64_t i = 1; i <= steps_; ++i) {
            const double t = time_of(i);
            const TruthState now = path_.at(advanced(span_.from, Seconds(t)));
            look(now, t);
            compare(now, t);
            before_ = now;
        }
        close_box();
        return survey_;
    }

private:
    // The last instant lies before the end: whether a plan stops dead on it or behind it is a matter of rounding.
    [[nodiscard]] double time_of(std::int64_t step) const {
        constexpr double before_end_s = 1e-6;
        const double t = survey_.duration_s * static_cast<double>(step) / static_cast<double>(steps_);
        return step < steps_ ? t : std::max(0.0, t - before_end_s);
    }

    void look(const TruthState& state, double t) {
        const double height = state.geodetic.height.above_ellipsoid.value();
        if (height < survey_.lowest.value) survey_.lowest = {height, t};
        if (height > survey_.highest.value) survey_.highest = {height, t};
        const Vector3d ned = ned_of(state, state.velocity.vector());
        keep_larger(survey_.fastest, ned.norm(), t);
        keep_larger(survey_.fastest_over_ground, ned.head<2>().norm(), t);
        keep_larger(survey_.climb, -ned.z(), t);
        keep_larger(survey_.descent, ned.z(), t);
        if (state.orientation) keep_larger(survey_.turn_rate, state.orientation->turn_rate.norm(), t);
        // Counts on from the longitude before.
        const double middle = (west_ + east_) / 2;
        const double longitude = middle + std::remainder(state.geodetic.longitude.rad() - middle, 2 * std::numbers::pi);
        west_ = std::min(west_, longitude);
        east_ = std::max(east_, longitude);
        south_ = std::min(south_, state.geodetic.latitude.rad());
        north_ = std::max(north_, state.geodetic.latitude.rad());
        positions_ += state.position.vector();
    }

    void compare(const TruthState& now, double t) {
        const double step = difference(now.time, before_.time).value();
        if (!(step > 0)) return;
        compare_places(now, t);
        const Vector3d changed = now.velocity.vector() - before_.velocity.vector();
        if (velocity_steps(path_, before_, now)) {
            ++survey_.velocity_steps;
            keep_larger(survey_.largest_step, changed.norm(), t);
            acceleration_.reset();
            return;
        }
        const Vector3d acceleration = changed / step;
        keep_larger(survey_.acceleration, acceleration.norm(), t - step / 2);
        if (acceleration_) keep_larger(survey_.jerk, (acceleration - *acceleration_).norm() / step, t - step);
        acceleration_ = acceleration;
    }

    void compare_places(const TruthState& now, double t) {
        const double moved = (now.position - before_.position).vector().norm();
        if (place_jumps(path_, before_, now)) {
            ++survey_.jumps;
            keep_larger(survey_.largest_jump, moved, t);
        } else {
            survey_.length_m += moved;
        }
    }

    // Where meridians run together, a box of them says little: its sides are those of the plane that touches the
    // middle of the way, and a way round the pole holds it.
    void close_polar_box() {
        constexpr double round = 0.99 * 2 * std::numbers::pi, least_off_axis = 1e-3;
        if (east_ - west_ > round) {
            west_ = -std::numbers::pi;
            east_ = std::numbers::pi;
            (north_ > 0 ? north_ : south_) = std::copysign(std::numbers::pi / 2, north_);
        }
        Geodetic middle = to_geodetic(Position<Ecef>(positions_ / static_cast<double>(steps_ + 1)));
        const TruthState first = path_.at(span_.from);
        const double off_axis = positions_.head<2>().norm() / static_cast<double>(steps_ + 1);
        if (off_axis < least_off_axis) middle.longitude = first.geodetic.longitude;  // at the pole any is right
        const LocalFrame plane(middle);
        Vector3d least = plane.to_enu(first.position).vector(), most = least;
        for (std::int64_t i = 1; i <= steps_; ++i) {
            const Vector3d enu = plane.to_enu(path_.at(advanced(span_.from, Seconds(time_of(i)))).position).vector();
            least = least.cwiseMin(enu);
            most = most.cwiseMax(enu);
        }
        survey_.east_west_m = most.x() - least.x();
        survey_.north_south_m = most.y() - least.y();
    }

    void close_box() {
        constexpr double polar = 85 * std::numbers::pi / 180;
        if (north_ > polar || south_ < -polar)
            close_polar_box();
        else
            measure_box();
        const auto corner = [](double latitude, double longitude, double height) {
            return Geodetic{Angle::radians(latitude), Angle::radians(longitude), {Metres(height)}};
        };
        survey_.south_west = corner(south_, west_, survey_.lowest.value);
        survey_.north_east = corner(north_, east_, survey_.highest.value);
    }

    // Lengths of the parallel and the meridian through the middle (MODELS.md 3.10).
    void measure_box() {
        const double middle = (south_ + north_) / 2;
        const CurvatureRadii radii = curvature_radii(Angle::radians(middle));
        survey_.east_west_m = (east_ - west_) * radii.prime_vertical * std::cos(middle);
        survey_.north_south_m = (north_ - south_) * radii.meridian;
    }

    const Trajectory& path_;
    PathSpan span_;
    PathSurvey survey_;
    std::int64_t steps_ = 1;
    TruthState before_;
    std::optional<Vector3d> acceleration_;                // of the step before, ECEF, m/s²
    double west_ = 0, east_ = 0, south_ = 0, north_ = 0;  // rad
    Vector3d positions_ = Vector3d::Zero();               // their sum, ECEF, m
};

}  // namespace

PathSurvey survey_path(const Trajectory& path, const PathSpan& span) { return Surveyor(path, span).run(); }

LongitudeSpan longitude_span(const PathSurvey& survey) {
    constexpr double round_deg = 360, half_deg = 180;
    const double west = survey.south_west.longitude.deg(), east = survey.north_east.longitude.deg();
    if (east - west >= round_deg) return {-half_deg, half_deg};
    const auto inside = [](double deg) {
        return deg >= -half_deg && deg <= half_deg ? deg : std::remainder(deg, round_deg);
    };
    return {inside(west), inside(east)};
}

std::vector<ExceededLimit> exceeded_limits(const PathSurvey& survey, std::optional<VehicleClass> vehicle) {
    constexpr double standard_gravity = 9.80665;
    std::vector<ExceededLimit> exceeded;
    const auto check = [&](std::string_view of, std::string_view what, std::string_view unit, double limit,
                           const PathExtreme& found) {
        if (found.value > limit)
            exceeded.push_back({std::string(of), std::string(what), std::string(unit), limit, found});
    };
    check("receiver", "acceleration", "m/s²", 4 * standard_gravity, survey.acceleration);
    check("receiver", "height", "m", 50000, survey.highest);
    check("receiver", "speed", "m/s", 500, survey.fastest);
    check("COCOM", "height", "m", 18288, survey.highest);
    check("COCOM", "speed", "m/s", 515, survey.fastest);
    if (!vehicle) return exceeded;
    const VehicleTraits& traits = traits_of(*vehicle);
    check(traits.name, "speed", "m/s", traits.speed_limit.value(), survey.fastest);
    check(traits.name, "climb", "m/s", traits.climb_limit.value(), survey.climb);
    check(traits.name, "descent", "m/s", traits.climb_limit.value(), survey.descent);
    check(traits.name, "acceleration", "m/s²", traits.acceleration_limit, survey.acceleration);
    check(traits.name, "step of the velocity", "m/s", 0, survey.largest_step);
    check(traits.name, "jump", "m", 0, survey.largest_jump);
    return exceeded;
}

namespace {

// Slope of the velocity at an instant, over half a millisecond before and after it, or over the one of them in which
// the velocity does not step; nothing where it does in both. Inside the span: before it and after it the path stands.
Vector3d acceleration_at(const Trajectory& path, const TruthState& state, GpsTime from, GpsTime to) {
    constexpr Nanoseconds beside = std::chrono::microseconds(500);
    const TruthState before = path.at(std::max(state.time - beside, from)),
                     after = path.at(std::min(state.time + beside, to));
    const auto slope = [&](const TruthState& a, const TruthState& b) -> std::optional<Vector3d> {
        if (b.time <= a.time || velocity_steps(path, a, b)) return std::nullopt;
        return (velocity_of(b) - velocity_of(a)) / difference(b.time, a.time).value();
    };
    for (const auto& found : {slope(before, after), slope(state, after), slope(before, state)})
        if (found) return *found;
    return Vector3d::Zero();
}

// Whether a path jumps between two states, looked at as finely as a survey does.
bool jumps_between(const Trajectory& path, TruthState before, const TruthState& to) {
    constexpr Nanoseconds finest = std::chrono::milliseconds(10);
    while (before.time < to.time) {
        TruthState now = path.at(std::min(before.time + finest, to.time));
        if (place_jumps(path, before, now)) return true;
        before = std::move(now);
    }
    return false;
}

}  // namespace

Result<std::vector<PathSample>> sample_path(const Trajectory& path, const PathSpan& span, Hertz rate) {
    constexpr double most_samples = 1e7;
    const double count = std::max(1.0, std::floor(span.length.value() * rate.value() + 1e-9) + 1);
    if (!(count <= most_samples))
        return fail(ErrorCode::usage, fmt::format("{:g} s at {:g} Hz are {:g} samples; expected ten million at most",
                                                  span.length.value(), rate.value(), count));
    std::vector<PathSample> samples;
    samples.reserve(static_cast<std::size_t>(count) + 1);
    const GpsTime end = advanced(span.from, span.length);
    const auto whole = static_cast<std::size_t>(count);
    constexpr double at_once = 1e-6;  // s
    const bool ends_between = span.length.value() - (count - 1) / rate.value() > at_once;
    for (std::size_t i = 0; i < whole + (ends_between ? 1 : 0); ++i) {
        PathSample sample;
        sample.time_s = i < whole ? static_cast<double>(i) / rate.value() : span.length.value();
        sample.state = path.at(advanced(span.from, Seconds(sample.time_s)));
        sample.velocity_ned = ned_of(sample.state, velocity_of(sample.state));
        sample.acceleration_ned = ned_of(sample.state, acceleration_at(path, sample.state, span.from, end));
        sample.jumped = i > 0 && jumps_between(path, samples.back().state, sample.state);
        samples.push_back(std::move(sample));
    }
    return samples;
}

std::string path_csv(const std::vector<PathSample>& samples) {
    const bool stands = !samples.empty() && samples.front().state.orientation.has_value();
    std::string text = "t_s,lat_deg,lon_deg,h_ell_m,vn_mps,ve_mps,vd_mps,an_mps2,ae_mps2,ad_mps2";
    if (stands) text += ",roll_deg,pitch_deg,yaw_deg";
    const bool jumps = std::any_of(samples.begin(), samples.end(), [](const PathSample& s) { return s.jumped; });
    text += jumps ? ",reset\n" : "\n";
    std::size_t beginnings = 0;
    for (const PathSample& sample : samples) {
        const Geodetic& place = sample.state.geodetic;
        const Vector3d &v = sample.velocity_ned, &a = sample.acceleration_ned;
        fmt::format_to(std::back_inserter(text),
                       "{:.9g},{:.10f},{:.10f},{:.4f},{:.5f},{:.5f},{:.5f},{:.4f},{:.4f},{:.4f}", sample.time_s,
                       place.latitude.deg(), place.longitude.deg(), place.height.above_ellipsoid.value(), v.x(), v.y(),
                       v.z(), a.x(), a.y(), a.z());
        if (stands && sample.state.orientation) {
            const Attitude& attitude = sample.state.orientation->attitude;
            fmt::format_to(std::back_inserter(text), ",{:.4f},{:.4f},{:.4f}", attitude.roll().deg(),
                           attitude.pitch().deg(), attitude.yaw().deg());
        } else if (stands) {
            text += ",,,";
        }
        if (sample.jumped) ++beginnings;
        if (jumps) fmt::format_to(std::back_inserter(text), ",{}", beginnings);
        text += '\n';
    }
    return text;
}

}  // namespace skyloop::inline motion
