#include "motion/trajectory/live_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "base/geo/geodetic.hpp"
#include "detail/live_motion.hpp"

namespace skyloop::inline motion {
namespace {

using Motion = LivePath::Motion;

constexpr double live_memory_s = 5;
constexpr std::size_t most_live_knots = 8192;
constexpr double longest_step_s = 2;
constexpr double return_s = 0.3;               // FEEDS.md 3.1
constexpr double jump_m = 2, jump_part = 0.5;  // FEEDS.md 3.1
constexpr double first_speed_mps = 300;        // of a source that tells no velocity and has said one place
constexpr double farthest_height_m = 1e6, fastest_mps = 12e3;             // FEEDS.md 3.1
constexpr double unseen_m = 0.01, unseen_mps = 0.05, unseen_rad = 0.002;  // differences that no receiver shows

bool is_finite(const TruthSample& sample) {
    return sample.position.vector().allFinite() && (!sample.velocity || sample.velocity->vector().allFinite()) &&
           (!sample.acceleration || sample.acceleration->allFinite()) &&
           (!sample.attitude || sample.attitude->body_to_ned().coeffs().allFinite()) &&
           (!sample.turn_rate || sample.turn_rate->allFinite());
}

// Of the turn from one attitude to another, body axes, rad.
Eigen::Vector3d turn_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
    Eigen::Quaterniond turn = from.conjugate() * to;
    if (turn.w() < 0) turn.coeffs() *= -1;
    const Eigen::AngleAxisd angle(turn);
    return angle.angle() * angle.axis();
}

// What was concluded from the samples before does not hold behind a jump.
void leave_untold(Motion& motion, const TruthSample& sample, bool same) {
    if (!sample.velocity) motion.velocity.setZero();
    if (!sample.acceleration) motion.acceleration.setZero();
    if (!sample.turn_rate) motion.turn_rate.setZero();
    if (!sample.attitude && !same) motion.body_to_ned.reset();
}

double seconds_between(GpsTime from, GpsTime to) { return difference(to, from).value(); }

}  // namespace

std::optional<std::string> implausible(const TruthSample& sample) {
    constexpr double farthest_m = 1e8;
    if (!is_finite(sample)) return "a number is not finite; expected finite ones";
    const Eigen::Vector3d& place = sample.position.vector();
    if (place.norm() > farthest_m)
        return fmt::format("the place is {:g} m from the centre of the Earth; expected less than 1 000 000 m of height",
                           place.norm());
    if (place.y() == 0 && place.z() == 0)
        return "the place is at latitude and longitude 0, as of a source that does not know its own yet; expected "
               "another";
    const double height = to_geodetic(sample.position).height.above_ellipsoid.value();
    if (std::abs(height) >= farthest_height_m)
        return fmt::format("the height is {:.0f} m above the ellipsoid; expected less than 1 000 000", height);
    if (sample.velocity && !(sample.velocity->vector().norm() < fastest_mps))
        return fmt::format("the speed is {:g} m/s; expected less than 12 000", sample.velocity->vector().norm());
    return std::nullopt;
}

LivePath::LivePath(const LivePathSettings& settings) : settings_(settings) {}

void LivePath::add(GpsTime time, const TruthSample& sample) {
    if (implausible(sample)) {
        ++counts_.refused;
        return;
    }
    bool begins = sample.jump || knots_.empty();
    bool same = false;
    std::optional<Knot> replaced;
    if (!knots_.empty()) {
        // A statement that came twice may have got another time, since the way between the clocks moves.
        same = time == knots_.back().time || (sample.source_time && sample.source_time == knots_.back().source_time);
        if (same) time = knots_.back().time;
        if (time < knots_.back().time && !sample.jump) {
            ++counts_.late;
            return;
        }
    }
    ++counts_.samples;
    if (same) {
        begins = begins || knots_.back().begins;
        if (sample.jump && !knots_.back().begins) ++counts_.jumps;
        replaced = knots_.back();
        knots_.pop_back();
    }
    while (sample.jump && !knots_.empty() && knots_.back().time > time)
        knots_.pop_back();
    Knot knot = completed(time, sample);
    if (replaced && !sample.attitude && !sample.jump) {
        knot.motion.body_to_ned = replaced->motion.body_to_ned;
        knot.own_attitude = replaced->own_attitude;
        if (!sample.turn_rate) knot.motion.turn_rate = replaced->motion.turn_rate;
    }
    knot.begins = begins || knots_.empty() || (!same && is_jump(knot));
    if (!same && !knots_.empty() && knot.begins) ++counts_.jumps;
    if (knot.begins) leave_untold(knot.motion, sample, same);
    if (!knots_.empty() && !same) remember_shown(knot);
    if (!knots_.empty() && !knot.begins) learn_step(seconds_between(knots_.back().time, time));
    knots_.push_back(knot);
    if (!shown_.empty() && shown_.back().length > 0) measure(shown_.back());
    asked_.reset();
    forget();
}

LivePath::Knot LivePath::completed(GpsTime time, const TruthSample& sample) const {
    Knot knot;
    knot.time = time;
    knot.source_time = sample.source_time;
    knot.own_velocity = sample.velocity.has_value();
    Motion& motion = knot.motion;
    motion.position = sample.position.vector();
    motion.velocity = sample.velocity ? sample.velocity->vector() : estimated(&Motion::position, knot);
    if (sample.acceleration && sample.acceleration->norm() < hardest_mps2)
        motion.acceleration = *sample.acceleration;
    else if (sample.velocity && !knots_.empty() && knots_.back().own_velocity)
        motion.acceleration = estimated(&Motion::velocity, knot);
    if (!(motion.velocity.norm() < fastest_mps)) motion.velocity.setZero();
    if (!(motion.acceleration.norm() < hardest_mps2)) motion.acceleration.setZero();
    complete_attitude(knot, sample);
    return knot;
}

void LivePath::complete_attitude(Knot& knot, const TruthSample& sample) const {
    Motion& motion = knot.motion;
    knot.own_attitude = sample.attitude.has_value();
    if (sample.attitude) {
        motion.body_to_ned = sample.attitude->body_to_ned();
        motion.turn_rate = told_turn_rate(knot);
    } else if (!sample.jump && !knots_.empty()) {
        const Knot& last = knots_.back();
        const Motion carried = carried_on(last.motion, patience(), seconds_between(last.time, knot.time));
        motion.body_to_ned = carried.body_to_ned;
        motion.turn_rate = carried.turn_rate;
    }
    if (sample.turn_rate) motion.turn_rate = *sample.turn_rate;
    if (!(motion.turn_rate.norm() < fastest_turn_radps)) motion.turn_rate.setZero();
}

// From the attitude that was told before: what lies between was carried on from it, and says nothing new.
Eigen::Vector3d LivePath::told_turn_rate(const Knot& newest) const {
    for (auto knot = knots_.rbegin(); knot != knots_.rend(); ++knot) {
        if (knot->own_attitude && newest.time > knot->time)
            return turn_between(*knot->motion.body_to_ned, *newest.motion.body_to_ned) /
                   seconds_between(knot->time, newest.time);
        if (knot->begins) break;
    }
    return Eigen::Vector3d::Zero();
}

// The slope of a member at the newest sample, which is not among the others yet.
Eigen::Vector3d LivePath::estimated(const Eigen::Vector3d Motion::*member, const Knot& newest) const {
    constexpr std::size_t most = 9;
    const double window_s = std::max(0.25, 2.5 * step_s_);
    std::vector<double> times{0};
    std::vector<Eigen::Vector3d> values{newest.motion.*member};
    for (auto knot = knots_.rbegin(); knot != knots_.rend() && times.size() < most; ++knot) {
        const double ago = seconds_between(knot->time, newest.time);
        if (times.size() > 1 && ago > window_s) break;
        if (ago <= 0) continue;
        times.insert(times.begin(), -ago);
        values.insert(values.begin(), knot->motion.*member);
        if (knot->begins) break;
    }
    return slope_at_end(times, values);
}

bool LivePath::is_jump(const Knot& knot) const {
    const Knot& last = knots_.back();
    const double silence = seconds_between(last.time, knot.time);
    double speed = last.motion.velocity.norm();
    if (knot.own_velocity) speed = std::max(speed, knot.motion.velocity.norm());
    double limit = std::max(jump_m, jump_part * speed * silence);
    if (last.begins && !last.own_velocity && !knot.own_velocity) limit = std::max(limit, first_speed_mps * silence);
    return (knot.motion.position - shown_at(knot.time).position).norm() > limit;
}

LivePath::Patience LivePath::patience() const {
    constexpr double live_steps = 1.5, least_fading_s = 0.2;  // FEEDS.md 3.1
    const double coast = std::max(0.0, settings_.coast.value()), fade = std::max(coast, settings_.fade.value());
    Patience patience;
    patience.live = live_steps * step_s_;
    patience.coast = std::max(coast, patience.live);
    patience.fade = patience.coast + fade - coast;
    patience.fading_time = std::max(least_fading_s, step_s_);
    return patience;
}

Motion LivePath::through_samples(GpsTime time) const {
    const auto after = std::upper_bound(knots_.begin(), knots_.end(), time,
                                        [](GpsTime value, const Knot& knot) { return value < knot.time; });
    if (after == knots_.begin()) {
        const Motion& first = knots_.front().motion;
        Motion standing;
        const bool at_first = forgot_ || settings_.begins_at_first;
        standing.position = at_first ? first.position : to_ecef(settings_.before).vector();
        if (at_first) standing.body_to_ned = first.body_to_ned;
        return standing;
    }
    const Knot& from = *std::prev(after);
    const double t = seconds_between(from.time, time);
    if (after == knots_.end() || after->begins) return carried_on(from.motion, patience(), t);
    const bool told = from.own_velocity && after->own_velocity;
    return between(from.motion, after->motion, seconds_between(from.time, after->time), t,
                   told ? Velocities::told : Velocities::of_the_curve);
}

Motion LivePath::shown_at(GpsTime time) const {
    const auto next = std::upper_bound(shown_.begin(), shown_.end(), time,
                                       [](GpsTime value, const Shown& shown) { return value < shown.until; });
    Motion motion;
    if (next != shown_.end() && time > next->knot)
        motion = carried_on(next->from, next->patience, seconds_between(next->knot, time));
    else
        motion = through_samples(time);
    if (next == shown_.begin()) return motion;
    const Shown& before = *std::prev(next);
    const double since = seconds_between(before.until, time);
    if (since >= before.length) return motion;
    const Motion left = taken_away(before.difference, before.length, since);
    motion.position += left.position;
    motion.velocity += left.velocity;
    motion.acceleration += left.acceleration;
    const double part = part_left(before.length, since);
    if (motion.body_to_ned)
        motion.body_to_ned = Eigen::Quaterniond::Identity().slerp(part, before.turn) * *motion.body_to_ned;
    return motion;
}

// What was shown for want of the next sample stays so.
void LivePath::remember_shown(const Knot& next) {
    const GpsTime newest = knots_.back().time;
    const bool asked = asked_ && *asked_ > newest && (shown_.empty() || *asked_ > shown_.back().until);
    if (!asked && !next.begins) return;
    Shown shown;
    shown.knot = newest;
    shown.from = knots_.back().motion;
    shown.patience = patience();
    shown.until = asked ? *asked_ : next.time;
    if (next.begins) shown.until = std::max(shown.until, next.time);
    shown.shown = shown_at(shown.until);
    if (!next.begins) {
        const double silence = seconds_between(newest, shown.until);
        constexpr double least_s = 0.02;
        const bool silent = silence > shown.patience.live && silence > least_s;
        shown.length = silent ? return_s : std::clamp(2 * step_s_, least_s, return_s);
        // What is still being taken away is not to be hurried.
        if (!shown_.empty())
            shown.length =
                std::max(shown.length, shown_.back().length - seconds_between(shown_.back().until, shown.until));
    }
    while (!shown_.empty() && shown_.back().until >= shown.until)
        shown_.pop_back();
    shown_.push_back(shown);
}

// With the samples that are there now.
void LivePath::measure(Shown& shown) const {
    if (shown.until <= knots_.back().time && knots_.size() > 1 && shown.until <= knots_[knots_.size() - 2].time) return;
    const Motion through = through_samples(shown.until);
    shown.difference.position = shown.shown.position - through.position;
    shown.difference.velocity = shown.shown.velocity - through.velocity;
    shown.difference.acceleration = shown.shown.acceleration - through.acceleration;
    shown.turn.setIdentity();
    if (shown.shown.body_to_ned && through.body_to_ned)
        shown.turn = *shown.shown.body_to_ned * through.body_to_ned->conjugate();
    if (shown.difference.position.norm() > unseen_m || shown.difference.velocity.norm() > unseen_mps ||
        Eigen::AngleAxisd(shown.turn).angle() > unseen_rad)
        return;
    shown.difference = {};
    shown.turn.setIdentity();
}

void LivePath::learn_step(double step_s) {
    constexpr double gain = 0.1, most_steps = 3;
    const double step = std::min(step_s, longest_step_s);
    step_s_ = step_s_ > 0 ? step_s_ + gain * (std::min(step, most_steps * step_s_) - step_s_) : step;
}

void LivePath::forget() {
    const GpsTime oldest = knots_.back().time - to_nanoseconds(Seconds(live_memory_s));
    while (knots_.size() > 2 && (knots_[1].time < oldest || knots_.size() > most_live_knots)) {
        knots_.pop_front();
        forgot_ = true;
    }
    while (shown_.size() > 1 && (shown_[1].until < oldest || shown_.size() > most_live_knots))
        shown_.pop_front();
}

TruthState LivePath::at(GpsTime time) const {
    const GpsTime inside = time - to_nanoseconds(settings_.delay);
    TruthState state;
    state.time = time;
    if (knots_.empty()) {
        state.geodetic = settings_.before;
        state.position = to_ecef(settings_.before);
        return state;
    }
    const Motion motion = shown_at(inside);
    state.position = Position<Ecef>(motion.position);
    state.velocity = Velocity<Ecef>(motion.velocity);
    state.geodetic = to_geodetic(state.position);
    if (motion.body_to_ned) state.orientation = Orientation{Attitude(*motion.body_to_ned), motion.turn_rate};
    if (inside > knots_.back().time) asked_ = std::max(inside, asked_.value_or(inside));
    if (!latest_ || inside >= *latest_) {
        latest_ = inside;
        look_at_age(seconds_between(knots_.back().time, inside));
    }
    return state;
}

void LivePath::look_at_age(double age_s) const {
    constexpr double coast_steps = 2;
    const Patience now = patience();
    const bool coasts = age_s > (step_s_ > 0 ? coast_steps * step_s_ : now.coast), holds = age_s > now.fade;
    // Samples that come and are old end no silence.
    if (coasts && !coasts_) ++counts_.coasts;
    if (holds && !holds_) ++counts_.holds;
    coasts_ = coasts;
    holds_ = holds;
}

LiveState LivePath::state(GpsTime time) const {
    if (knots_.empty()) return LiveState::silent;
    const double age = seconds_between(knots_.back().time, time - to_nanoseconds(settings_.delay));
    const Patience now = patience();
    if (age <= now.live || age <= 0) return LiveState::live;
    if (age <= now.coast) return LiveState::coasting;
    return age <= now.fade ? LiveState::fading : LiveState::holding;
}

std::optional<GpsTime> LivePath::newest() const {
    if (knots_.empty()) return std::nullopt;
    return knots_.back().time;
}

std::optional<GpsTime> LivePath::rests_at() const {
    if (knots_.empty()) return std::nullopt;
    return advanced(knots_.back().time, settings_.delay + Seconds(patience().fade));
}

}  // namespace skyloop::inline motion
