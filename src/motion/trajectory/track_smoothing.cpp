#include "motion/trajectory/track.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "base/core/std_additions.hpp"
#include "base/geo/local_frame.hpp"

namespace skyloop::inline motion {
namespace {

using Rows = std::span<TrackRow>;

// Position, velocity and acceleration of one axis (rows) for east, north and up (columns).
using AxisMotion = Eigen::Matrix3d;

double seconds_between(const TrackRow& from, const TrackRow& to) { return to_seconds(to.time - from.time).value(); }

double median_of(std::vector<double>& values) { return values.empty() ? 0 : middle_of(values); }

// The next jump after the row, or the end.
std::size_t end_of_smooth_stretch(const std::vector<TrackRow>& rows, std::size_t begin) {
    std::size_t end = begin + 1;
    while (end < rows.size() && !rows[end].jump)
        ++end;
    return end;
}

Eigen::Matrix3d transition(double h) {
    Eigen::Matrix3d f;
    f << 1, h, h * h / 2, 0, 1, h, 0, 0, 1;
    return f;
}

// Of a white jerk of density 1 (FEEDS.md 1.13.2, step 3).
Eigen::Matrix3d process_noise(double h) {
    const double h2 = h * h, h3 = h2 * h, h4 = h2 * h2, h5 = h4 * h;
    Eigen::Matrix3d q;
    q << h5 / 20, h4 / 8, h3 / 6, h4 / 8, h3 / 3, h2 / 2, h3 / 6, h2 / 2, h;
    return q;
}

// What a filter knows: the covariance of the axes in plan, and that of the one up.
struct Belief {
    AxisMotion state = AxisMotion::Zero();
    std::array<Eigen::Matrix3d, 2> covariance{};
};

// The filter over one stretch and its backward pass (Rauch, Tung and Striebel 1965).
class StretchSmoother {
public:
    StretchSmoother(Rows rows, double jerk_density, const PositionNoise& noise)
        : rows_(rows),
          frame_(to_geodetic(rows.front().position)),
          jerk_(jerk_density * jerk_density),
          sigma_{noise.in_plan, noise.up} {}

    void run(SmoothingReport& report) {
        filter(report);
        for (std::size_t i = beliefs_.size() - 1; i-- > 0;)
            smooth(beliefs_[i], beliefs_[i + 1], seconds_between(rows_[i], rows_[i + 1]));
        for (std::size_t i = 0; i < rows_.size(); ++i)
            move(rows_[i], beliefs_[i].state, counts_[i] ? &report.largest_shift : nullptr);
    }

private:
    static constexpr double velocity_sigma_mps = 0.3;

    [[nodiscard]] Eigen::RowVector3d place(const TrackRow& row) const {
        return frame_.to_enu(row.position).vector().transpose();
    }
    [[nodiscard]] Eigen::RowVector3d velocity(const TrackRow& row) const {
        return frame_.to_enu(*row.velocity).vector().transpose();
    }

    Belief first_belief() const {
        constexpr double unknown_velocity_mps = 30, unknown_acceleration_mps2 = 5;
        Belief belief;
        belief.state.row(0) = place(rows_[0]);
        if (rows_[0].velocity) belief.state.row(1) = velocity(rows_[0]);
        const double v = rows_[0].velocity ? velocity_sigma_mps : unknown_velocity_mps;
        for (std::size_t k = 0; k < 2; ++k)
            belief.covariance[k] =
                Eigen::Vector3d(sigma_[k] * sigma_[k], v * v, unknown_acceleration_mps2 * unknown_acceleration_mps2)
                    .asDiagonal();
        return belief;
    }
    [[nodiscard]] Belief predicted(const Belief& from, double h) const {
        const Eigen::Matrix3d f = transition(h);
        Belief next;
        next.state = f * from.state;
        for (std::size_t k = 0; k < 2; ++k)
            next.covariance[k] = f * from.covariance[k] * f.transpose() + jerk_ * process_noise(h);
        return next;
    }
    // Further than 5 σ from where the motion leads.
    [[nodiscard]] bool lies_out(const Belief& belief, const TrackRow& row) const {
        constexpr double gate = 5;
        const Eigen::RowVector3d off = place(row) - belief.state.row(0);
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            const std::size_t k = axis == 2 ? 1 : 0;
            if (std::abs(off(axis)) > gate * std::sqrt(belief.covariance[k](0, 0) + sigma_[k] * sigma_[k])) return true;
        }
        return false;
    }
    // @param part 0: a position was measured, 1: a velocity
    static void update(Belief& belief, const Eigen::RowVector3d& measured, Eigen::Index part,
                       const std::array<double, 2>& sigma) {
        const Eigen::RowVector3d off = measured - belief.state.row(part);
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            const std::size_t k = axis == 2 ? 1 : 0;
            const Eigen::Vector3d gain =
                belief.covariance[k].col(part) / (belief.covariance[k](part, part) + sigma[k] * sigma[k]);
            belief.state.col(axis) += gain * off(axis);
        }
        for (std::size_t k = 0; k < 2; ++k) {
            Eigen::Matrix3d& p = belief.covariance[k];
            const double r = sigma[k] * sigma[k];
            const Eigen::Vector3d gain = p.col(part) / (p(part, part) + r);
            Eigen::Matrix3d left = Eigen::Matrix3d::Identity();
            left.col(part) -= gain;
            p = (left * p * left.transpose() + r * gain * gain.transpose()).eval();  // Joseph's form stays symmetric
        }
    }
    void filter(SmoothingReport& report) {
        // So many in a row are no outliers: the vehicle is there.
        constexpr int most_outliers = 5;
        int outliers = 0;
        beliefs_.push_back(first_belief());
        counts_.assign(rows_.size(), true);
        for (std::size_t i = 1; i < rows_.size(); ++i) {
            Belief belief = predicted(beliefs_.back(), seconds_between(rows_[i - 1], rows_[i]));
            if (lies_out(belief, rows_[i]) && ++outliers <= most_outliers) {
                ++report.outliers;
                counts_[i] = false;
            } else {
                outliers = 0;
                update(belief, place(rows_[i]), 0, sigma_);
                if (rows_[i].velocity) update(belief, velocity(rows_[i]), 1, {velocity_sigma_mps, velocity_sigma_mps});
            }
            beliefs_.push_back(belief);
        }
    }
    void smooth(Belief& belief, const Belief& next, double h) const {
        const Belief ahead = predicted(belief, h);
        const Eigen::Matrix3d f = transition(h);
        for (std::size_t k = 0; k < 2; ++k) {
            // Of the motion's own scale, so that steps of a millisecond are solved as well as those of a minute.
            const Eigen::Vector3d scale = ahead.covariance[k].diagonal().cwiseSqrt().cwiseInverse();
            const Eigen::Matrix3d scaled = scale.asDiagonal() * ahead.covariance[k] * scale.asDiagonal();
            const Eigen::Matrix3d gain =
                (scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * f * belief.covariance[k])).transpose();
            const Eigen::Index first = k == 0 ? 0 : 2, count = k == 0 ? 2 : 1;
            belief.state.middleCols(first, count) +=
                gain * (next.state.middleCols(first, count) - ahead.state.middleCols(first, count));
        }
    }
    void move(TrackRow& row, const AxisMotion& state, double* largest_shift) const {
        const Eigen::Vector3d shift = state.row(0) - place(row);
        if (!shift.allFinite() || !state.allFinite()) return;
        if (largest_shift) *largest_shift = std::max(*largest_shift, shift.norm());
        row.position = row.position + frame_.to_ecef(Displacement<Enu>(shift));
        row.velocity = frame_.to_ecef(Velocity<Enu>(Eigen::Vector3d(state.row(1).transpose())));
    }

    Rows rows_;
    LocalFrame frame_;
    double jerk_;
    std::array<double, 2> sigma_;
    std::vector<Belief> beliefs_;
    std::vector<bool> counts_;
};

// The fourth difference of rows i … i+4, in the frame; nothing unless they are evenly spaced.
std::optional<Eigen::Vector3d> fourth_difference(std::span<const TrackRow> rows, std::size_t i, const LocalFrame& frame,
                                                 double step) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    constexpr std::array<double, 5> weights{1, -4, 6, -4, 1};
    for (std::size_t k = 0; k < weights.size(); ++k) {
        if (k > 0 && (rows[i + k].jump || std::abs(seconds_between(rows[i + k - 1], rows[i + k]) - step) > 0.02 * step))
            return std::nullopt;
        sum += weights[k] * (rows[i + k].position.vector() - rows[i].position.vector());
    }
    return frame.to_enu(Displacement<Ecef>(sum)).vector();
}

}  // namespace

PositionNoise noise_of(const Track& track, VehicleClass vehicle) {
    const std::vector<TrackRow>& rows = track.points;
    if (rows.size() < 9) return {};
    std::vector<double> steps, in_plan, up;
    for (std::size_t i = 1; i < rows.size(); ++i)
        steps.push_back(seconds_between(rows[i - 1], rows[i]));
    const double step = median_of(steps);
    for (std::size_t i = 0; i + 4 < rows.size(); ++i) {
        const LocalFrame frame(to_geodetic(rows[i].position));
        const auto difference_enu = fourth_difference(rows, i, frame, step);
        if (!difference_enu) continue;
        in_plan.push_back(std::abs(difference_enu->x()));
        in_plan.push_back(std::abs(difference_enu->y()));
        up.push_back(std::abs(difference_enu->z()));
    }
    // Of a normal distribution the median of the magnitude is 0.6745 σ.
    const double jerk = traits_of(vehicle).jerk_density;
    const double of_motion = 2.0 / 3 * jerk * jerk * std::pow(step, 5);
    const auto sigma = [&](std::vector<double>& sizes) {
        constexpr double of_noise = 70, median_of_magnitude = 0.6745;
        const double variance = std::pow(median_of(sizes) / median_of_magnitude, 2);
        return variance > 2 * of_motion ? std::sqrt((variance - of_motion) / of_noise) : 0.0;
    };
    return {sigma(in_plan), sigma(up)};
}

SmoothingReport smooth_track(Track& track, VehicleClass vehicle, Smoothing smoothing) {
    constexpr double least_m = 0.001;
    SmoothingReport report;
    if (smoothing == Smoothing::none) return report;
    PositionNoise noise{1.5, 3};
    if (smoothing == Smoothing::noise) {
        noise = noise_of(track, vehicle);
        if (std::max(noise.in_plan, noise.up) < least_m) return report;
        noise = {std::max(noise.in_plan, least_m), std::max(noise.up, least_m)};
    }
    report.taken = noise;
    const Rows rows(track.points);
    for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
        end = end_of_smooth_stretch(track.points, begin);
        if (end - begin >= 3)
            StretchSmoother(rows.subspan(begin, end - begin), traits_of(vehicle).jerk_density, noise).run(report);
    }
    return report;
}

}  // namespace skyloop::inline motion
