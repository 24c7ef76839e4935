#include "skyloop/trajectory/path_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "skyloop/geo/body_frame.hpp"
#include "skyloop/geo/local_frame.hpp"

namespace skyloop {
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
            const double t = survey_.duration_s * static_cast<double>(i) / static_cast<double>(steps_);
            const TruthState now = path_.at(advanced(span_.from, Seconds(t)));
            look(now, t);
            compare(now, t);
            before_ = now;
        }
        close_box();
        return survey_;
    }

private:
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
    }

    void compare(const TruthState& now, double t) {
        const double step = difference(now.time, before_.time).value();
        if (!(step > 0)) return;
        compare_places(now, t, step);
        const Vector3d changed = now.velocity.vector() - before_.velocity.vector();
        constexpr double suspicious_mps2 = 20, least_step_mps = 0.05;
        if (changed.norm() > std::max(suspicious_mps2 * step, least_step_mps) &&
            changes_at_once(path_, before_.time, now.time,
                            [](const TruthState& s) -> Vector3d { return s.velocity.vector(); })) {
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

    void compare_places(const TruthState& now, double t, double step) {
        constexpr double least_m = 0.5;
        const Vector3d moved = (now.position - before_.position).vector();
        const Vector3d expected = (now.velocity.vector() + before_.velocity.vector()) * (step / 2);
        if ((moved - expected).norm() > std::max(least_m, expected.norm()) &&
            changes_at_once(path_, before_.time, now.time,
                            [](const TruthState& s) -> Vector3d { return s.position.vector(); })) {
            ++survey_.jumps;
            keep_larger(survey_.largest_jump, moved.norm(), t);
        } else {
            survey_.length_m += moved.norm();
        }
    }

    void close_box() {
        const auto corner = [](double latitude, double longitude, double height) {
            return Geodetic{Angle::radians(latitude), Angle::radians(longitude), {Metres(height)}};
        };
        survey_.south_west = corner(south_, west_, survey_.lowest.value);
        survey_.north_east = corner(north_, east_, survey_.highest.value);
        // Lengths of the parallel and the meridian through the middle (MODELS.md 3.10).
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
};

}  // namespace

PathSurvey survey_path(const Trajectory& path, const PathSpan& span) { return Surveyor(path, span).run(); }

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

Result<std::vector<PathSample>> sample_path(const Trajectory& path, const PathSpan& span, Hertz rate) {
    constexpr double most_samples = 1e7;
    constexpr Nanoseconds beside = std::chrono::microseconds(500);
    const double count = std::max(1.0, std::floor(span.length.value() * rate.value() + 1e-9) + 1);
    if (!(count <= most_samples))
        return fail(ErrorCode::usage, fmt::format("{:g} s at {:g} Hz are {:g} samples; expected ten million at most",
                                                  span.length.value(), rate.value(), count));
    std::vector<PathSample> samples;
    samples.reserve(static_cast<std::size_t>(count));
    const GpsTime end = advanced(span.from, span.length);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        PathSample sample;
        sample.time_s = static_cast<double>(i) / rate.value();
        const GpsTime time = advanced(span.from, Seconds(sample.time_s));
        sample.state = path.at(time);
        sample.velocity_ned = ned_of(sample.state, sample.state.velocity.vector());
        // Inside the span: before it and after it the path stands.
        const GpsTime before = std::max(time - beside, span.from), after = std::min(time + beside, end);
        if (after > before) {
            const Vector3d changed = path.at(after).velocity.vector() - path.at(before).velocity.vector();
            sample.acceleration_ned = ned_of(sample.state, changed / difference(after, before).value());
        }
        samples.push_back(std::move(sample));
    }
    return samples;
}

std::string path_csv(const std::vector<PathSample>& samples) {
    const bool stands = !samples.empty() && samples.front().state.orientation.has_value();
    std::string text = "t_s,lat_deg,lon_deg,h_ell_m,vn_mps,ve_mps,vd_mps,an_mps2,ae_mps2,ad_mps2";
    text += stands ? ",roll_deg,pitch_deg,yaw_deg\n" : "\n";
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
        }
        text += '\n';
    }
    return text;
}

}  // namespace skyloop
