#include "motion/trajectory/recorded_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "base/geo/attitude.hpp"
#include "base/geo/geodetic.hpp"
#include "detail/track_knots.hpp"
#include "motion/trajectory/path_attitude.hpp"

namespace skyloop::inline motion {
namespace {

// Whether a quintic piece accelerates far more than its ends and its way ask for (FEEDS.md 1.13.3).
bool swings_out(const PieceCoefficients& c, const TrackKnot& from, const TrackKnot& to, double h) {
    // Noise of rows is not worth a step of the acceleration: a few millimetres between them, or 1 m/s² at most.
    constexpr double hardly_m = 0.5;
    const double least_mps2 = std::clamp(hardly_m / (h * h), 0.1, 1.0);
    const Eigen::Vector3d needed = 2 * (to.position - from.position - h * from.velocity) / (h * h);
    const double allowed = 3 * std::max({from.acceleration.norm(), to.acceleration.norm(), needed.norm(), least_mps2});
    for (int i = 1; i < 8; ++i)
        if ((c * piece_powers(i / 8.0, 2)).norm() > allowed * h * h) return true;
    return false;
}

// What the way between two rows differs by from that of their velocities, where that shakes the curve's velocity by a
// centimetre per second, in steps that are short. Nothing where it is more than degrees with seven decimals are rounded
// by.
Eigen::Vector3d rounding_of(const TrackKnot& from, const TrackKnot& to, double h, bool cubic) {
    constexpr double most_m = 0.03, longest_s = 0.5, least_mps = 0.01, steepest = 1.875;
    if (h > longest_s) return Eigen::Vector3d::Zero();
    Eigen::Vector3d way = (from.velocity + to.velocity) * (h / 2);
    if (!cubic) way += (from.acceleration - to.acceleration) * (h * h / 12);
    const Eigen::Vector3d left = to.position - from.position - way;
    const bool shakes = left.norm() * steepest > least_mps * h;
    return shakes && left.norm() <= most_m ? left : Eigen::Vector3d::Zero();
}

// Of the rows that tell one. Rows of a stretch that follows a jump do not turn out of those before.
std::vector<AttitudeKnot> attitudes_of(const Track& track) {
    std::vector<AttitudeKnot> knots;
    bool jumped = false;
    for (const TrackRow& row : track.points) {
        jumped |= row.jump;
        if (!row.attitude) continue;
        knots.push_back({to_seconds(row.time - track.points.front().time).value(),
                         body_to_ecef(*row.attitude, to_geodetic(row.position)), jumped && !knots.empty()});
        jumped = false;
    }
    return knots;
}

}  // namespace

// Leads the pieces from knot to knot.
struct RecordedPath::Builder {
    RecordedPath& path;
    const Track& track;
    std::span<const TrackGap> gaps;
    double most_mps2;

    void add(const TrackKnot& from, const TrackKnot& to) {
        const double h = to.time - from.time;
        Piece piece{from.time, h, from.position, quintic_hermite(from, to, h)};
        piece.cubic = swings_out(piece.coefficients, from, to, h);
        if (piece.cubic) {
            piece.coefficients = cubic_hermite(from, to, h);
            ++path.report_.cubic_pieces;
        }
        if (from.has_velocity && to.has_velocity) piece.rounding = rounding_of(from, to, h, piece.cubic);
        path.pieces_.push_back(piece);
    }
    void add_bridge(const TrackKnot& from, const TrackKnot& to) {
        TrackKnot before = from;
        for (const TrackKnot& knot : bridge_of_gap(from, to, most_mps2)) {
            add(before, knot);
            before = knot;
        }
        add(before, to);
    }
    // The path stands there until `until`.
    void stand(const TrackKnot& at, double until) {
        path.pieces_.push_back({at.time, until - at.time, at.position, PieceCoefficients::Zero()});
    }
    // After months a nanosecond is less than a step of these numbers.
    void stand_for_an_instant(const TrackKnot& at) {
        constexpr double instant_s = 1e-9;
        stand(at, std::max(at.time + instant_s, std::nextafter(at.time, HUGE_VAL)));
    }
    void add_stretch(std::span<const TrackKnot> knots) {
        for (std::size_t i = 1; i < knots.size(); ++i) {
            if (contradict(knots[i - 1], knots[i])) ++path.report_.contradictions;
            add(knots[i - 1], knots[i]);
        }
    }
    // What leads from one stretch to the next.
    void join(const TrackKnot& last, const TrackKnot& next, bool jump) {
        if (jump)
            stand(last, next.time);
        else
            add_bridge(last, next);
    }
    // The row after the last one of the stretch that begins with this one.
    std::size_t end_of_stretch(std::size_t begin) {
        std::size_t end = begin + 1;
        for (; end < track.points.size() && !track.points[end].jump; ++end) {
            while (!gaps.empty() && gaps.front().to < track.points[end].time)
                gaps = gaps.subspan(1);
            if (!gaps.empty() && gaps.front().to == track.points[end].time) break;
        }
        return end;
    }
    // When the path begins and after each jump, s.
    std::vector<double> lead_through_rows() {
        std::vector<TrackKnot> knots = knots_of(track);
        path.pieces_.reserve(knots.size());
        std::vector<double> begins{0};
        for (std::size_t begin = 0, end = 0; begin < knots.size(); begin = end) {
            end = end_of_stretch(begin);
            const auto stretch = std::span(knots).subspan(begin, end - begin);
            fill_in_motion(stretch, most_mps2);
            if (begin > 0) join(knots[begin - 1], knots[begin], track.points[begin].jump);
            if (begin > 0 && track.points[begin].jump) begins.push_back(knots[begin].time);
            add_stretch(stretch);
        }
        if (path.pieces_.empty() || track.points.back().jump) stand_for_an_instant(knots.back());
        return begins;
    }
};

Eigen::Vector3d RecordedPath::Piece::derivative(double u, int order) const {
    static const PiecePowers third{0, 0, 3, -2, 0, 0}, fifth{0, 0, 0, 10, -15, 6};  // from 0 to 1, level at both ends
    const PiecePowers powers = piece_powers(u, order);
    const double taken = (cubic ? third : fifth).dot(powers);
    return (coefficients * powers - rounding * taken) / std::pow(length, order);
}

std::string_view attitude_source_name(AttitudeSource source) {
    return std::array<std::string_view, 3>{"not told", "of the rows",
                                           "from the motion"}[static_cast<std::size_t>(source)];
}

RecordedPath::RecordedPath(const Track& asked, std::span<const TrackGap> gaps, GpsTime start,
                           const CurveSettings& settings)
    : start_(start) {
    Track track = asked;
    if (settings.smoothing != Smoothing::none)
        report_.smoothing = smooth_track(track, settings.vehicle.value_or(VehicleClass::car), settings.smoothing);
    const double most_mps2 = settings.vehicle ? traits_of(*settings.vehicle).acceleration_limit : HUGE_VAL;
    const std::vector<double> begins = Builder{*this, track, gaps, most_mps2}.lead_through_rows();
    for (const TrackRow& row : track.points) {
        report_.rows_with_velocity += row.velocity.has_value();
        report_.rows_with_attitude += row.attitude.has_value();
    }
    report_.stretches = begins.size();
    if (report_.rows_with_attitude >= 2) {
        attitude_ = AttitudeCurve(attitudes_of(track));
        report_.attitude = AttitudeSource::rows;
    } else if (settings.vehicle) {
        stand_by_motion(begins, settings);
        report_.attitude = AttitudeSource::motion;
    }
}

// Asks the finished curve 20 times a second, more seldom on ways that are longer than three hours.
void RecordedPath::stand_by_motion(std::span<const double> stretch_begins, const CurveSettings& settings) {
    constexpr double finest_step_s = 0.05, most_samples = 2e5;
    const double whole = duration().value();
    const double wanted_step = std::max(finest_step_s, whole / most_samples);
    std::vector<MotionSample> samples;
    for (std::size_t k = 0; k < stretch_begins.size(); ++k) {
        const double begin = stretch_begins[k];
        const double end = k + 1 < stretch_begins.size() ? stretch_begins[k + 1] : whole;
        const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil((end - begin) / wanted_step)));
        const double step = (end - begin) / static_cast<double>(count);
        // The end of a stretch belongs to the next one.
        const std::size_t last = k + 1 < stretch_begins.size() ? count - 1 : count;
        for (std::size_t i = 0; i <= last; ++i) {
            const double t = begin + static_cast<double>(i) * step;
            const Place place = place_at(t);
            const Piece& piece = *place.piece;
            const Geodetic geodetic =
                to_geodetic(Position<Ecef>(piece.anchor + piece.coefficients * piece_powers(place.u, 0)));
            const Eigen::Quaterniond to_ned = ned_to_ecef(geodetic).conjugate();
            samples.push_back(
                {t, geodetic, to_ned * piece.derivative(place.u, 1), to_ned * piece.derivative(place.u, 2), i == 0});
        }
    }
    attitude_ = AttitudeCurve(attitude_from_motion(samples, *settings.vehicle, settings.heading));
}

RecordedPath::Place RecordedPath::place_at(double t) const {
    constexpr double half_step_s = 5e-10;  // of the clock: a whole nanosecond may lie beyond the last row by rounding
    const double inside = std::clamp(t, 0.0, duration().value());
    auto piece = std::upper_bound(pieces_.begin(), pieces_.end(), inside,
                                  [](double value, const Piece& p) { return value < p.begins; });
    piece = piece == pieces_.begin() ? piece : std::prev(piece);
    return {&*piece, std::min(1.0, (inside - piece->begins) / piece->length),
            t >= 0 && t <= duration().value() + half_step_s};
}

Eigen::Vector3d RecordedPath::acceleration(GpsTime time) const {
    const Place place = place_at(difference(time, start_).value());
    if (!place.inside) return Eigen::Vector3d::Zero();
    return place.piece->derivative(place.u, 2);
}

TruthState RecordedPath::at(GpsTime time) const {
    const double t = difference(time, start_).value();
    const Place place = place_at(t);
    const Piece& piece = *place.piece;
    TruthState state;
    state.time = time;
    state.position = Position<Ecef>(piece.anchor + piece.coefficients * piece_powers(place.u, 0));
    state.geodetic = to_geodetic(state.position);
    if (place.inside) state.velocity = Velocity<Ecef>(piece.derivative(place.u, 1));
    if (attitude_.empty()) return state;
    const BodyTurn turn = attitude_.at(std::clamp(t, 0.0, duration().value()));
    state.orientation.emplace();
    state.orientation->attitude = attitude_at(state.geodetic, turn.body_to_ecef);
    if (place.inside) state.orientation->turn_rate = turn.rate;
    return state;
}

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

}  // namespace skyloop::inline motion
