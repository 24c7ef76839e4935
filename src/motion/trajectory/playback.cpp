#include "motion/trajectory/playback.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/geo/body_frame.hpp"
#include "detail/hermite_piece.hpp"

namespace skyloop {
namespace {

double peak_acceleration(const PieceCoefficients& piece, double h) {
    constexpr int places = 16;
    double peak = 0;
    for (int i = 0; i <= places; ++i)
        peak = std::max(peak, (piece * piece_powers(static_cast<double>(i) / places, 2)).norm() / (h * h));
    return peak;
}

// How long the way from the end of a loop to its beginning takes: the shortest time in which it accelerates as its ends
// do, or gently. 0: they are at one place; nothing: too far, or not ahead. s
std::optional<double> closing_time(const TrackKnot& last, const TrackKnot& first) {
    constexpr double near_m = 50, near_s = 5, least_mps = 1, shortest_s = 0.01, growth = 1.05;
    constexpr double same_m = 0.5, same_mps = 1, gentle_mps2 = 2, more_than_ends = 1.3;
    const double way = (first.position - last.position).norm();
    const double speed = (first.velocity.norm() + last.velocity.norm()) / 2;
    if (way < same_m && (first.velocity - last.velocity).norm() < same_mps) return 0.0;
    if (way > near_m + near_s * speed) return std::nullopt;
    const double allowed =
        std::max(gentle_mps2, more_than_ends * std::max(first.acceleration.norm(), last.acceleration.norm()));
    const double longest = std::max(near_s, 2 * way / std::max(speed, least_mps));
    for (double h = shortest_s; h <= longest; h *= growth)
        if (peak_acceleration(quintic_hermite(last, first, h), h) <= allowed) return h;
    return std::nullopt;
}

}  // namespace

PlayedPath::PlayedPath(std::shared_ptr<const FilePath> path, GpsTime start, const Playback& playback)
    : path_(std::move(path)), start_(start), playback_(playback) {
    if (playback_.end == EndOfPath::loop) close();
}

// Leads from the last row to the first one where they are near each other.
void PlayedPath::close() {
    const double whole = path_->duration().value();
    const auto at_row = [&](double s) {
        const GpsTime time = advanced(start_, Seconds(s));
        const TruthState state = path_->at(time);
        return TrackKnot{s, state.position.vector(), state.velocity.vector(), path_->acceleration(time), true};
    };
    const TrackKnot last = at_row(whole), first = at_row(0);
    const auto taken = closing_time(last, first);
    jumps_back_ = !taken;
    if (!taken || *taken == 0) return;
    closing_s_ = *taken;
    anchor_ = last.position;
    closing_ = quintic_hermite(last, first, closing_s_);
    std::vector<AttitudeKnot> knots;
    std::vector<Eigen::Vector3d> rates;
    for (const auto& [time, s] : {std::pair{0.0, whole}, std::pair{closing_s_, 0.0}}) {
        const TruthState state = path_->at(advanced(start_, Seconds(s)));
        if (!state.orientation) return;
        knots.push_back({time, body_to_ecef(state.orientation->attitude, state.geodetic)});
        rates.push_back(state.orientation->turn_rate);
    }
    closing_attitude_ = AttitudeCurve(std::move(knots), std::move(rates));
}

GpsTime PlayedPath::run_time_of(double track_s) const {
    constexpr double furthest_s = 5e9;  // 158 years: a time of the run remains a time
    const double in_run = playback_.delay.value() + (track_s - playback_.skip.value()) / playback_.time_scale;
    return advanced(start_, Seconds(std::clamp(in_run, -furthest_s, furthest_s)));
}

std::optional<Seconds> PlayedPath::period() const {
    if (playback_.end != EndOfPath::loop) return std::nullopt;
    return Seconds((path_->duration().value() + closing_s_) / playback_.time_scale);
}

// @param s after the last row, of the track
TruthState PlayedPath::on_closing(double s) const {
    const double u = std::clamp(s / closing_s_, 0.0, 1.0);
    TruthState state;
    state.position = Position<Ecef>(anchor_ + closing_ * piece_powers(u, 0));
    state.velocity = Velocity<Ecef>(closing_ * piece_powers(u, 1) / closing_s_);
    state.geodetic = to_geodetic(state.position);
    if (closing_attitude_.empty()) return state;
    const BodyTurn turn = closing_attitude_.at(s);
    state.orientation = Orientation{attitude_at(state.geodetic, turn.body_to_ecef), turn.rate};
    return state;
}

TruthState PlayedPath::at(GpsTime time) const {
    const double whole = path_->duration().value();
    const double waited = (difference(time, start_) - playback_.delay).value();
    double s = playback_.skip.value() + std::max(0.0, waited) * playback_.time_scale;
    if (playback_.end == EndOfPath::loop) s = std::fmod(s, whole + closing_s_);
    TruthState state = s > whole && playback_.end == EndOfPath::loop
                           ? on_closing(s - whole)
                           : path_->at(advanced(start_, Seconds(std::min(s, whole))));
    const double pace = waited < 0 || s > whole + closing_s_ ? 0 : playback_.time_scale;
    state.time = time;
    state.velocity = Velocity<Ecef>(pace * state.velocity.vector());
    if (state.orientation) state.orientation->turn_rate *= pace;
    return state;
}

}  // namespace skyloop
