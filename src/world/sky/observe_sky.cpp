#include "world/sky/observe_sky.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "world/gnss/constants.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline world {

Position<Ecef> in_reception_frame(const Position<Ecef>& at_transmission, Seconds travel_time) {
    return Position<Ecef>(turned_by(at_transmission.vector(), travel_time.value()));
}

namespace {

// What the receiver sees of the transmitter, in the frame of the reception instant.
struct Sight {
    Eigen::Vector3d direction;
    Eigen::Vector3d velocity;
    Eigen::Vector3d turn;  // how the Earth's rotation moves the transmitter on while its signal travels, m/s

    // A longer way is seen from an earlier satellite through more of the Earth's rotation.
    double slope() const { return direction.dot(turn - velocity); }
};

Sight sight_of(const EcefMotion& transmitter, const Position<Ecef>& receiver, Seconds travel_time) {
    const Eigen::Vector3d position = turned_by(transmitter.position.vector(), travel_time.value());
    return {(position - receiver.vector()).normalized(), turned_by(transmitter.velocity.vector(), travel_time.value()),
            earth_rotation_rate * Eigen::Vector3d(position.y(), -position.x(), 0)};
}

}  // namespace

MetresPerSecond light_time_slope(const EcefMotion& transmitter, const Position<Ecef>& receiver, Seconds travel_time) {
    return MetresPerSecond(sight_of(transmitter, receiver, travel_time).slope());
}

MetresPerSecond light_time_range_rate(const EcefMotion& transmitter, const EcefMotion& receiver, Seconds travel_time) {
    const Sight sight = sight_of(transmitter, receiver.position, travel_time);
    const double own = sight.direction.dot(sight.velocity - receiver.velocity.vector());
    return MetresPerSecond(own / (1 - sight.slope() / speed_of_light));  // with τ = ρ/c it stands on both sides
}

namespace {

constexpr std::chrono::minutes change_length{5};
constexpr std::chrono::seconds search_step{30};  // no satellite changes its record twice in it
constexpr double longest_step_m = 10;

bool is_same_record(const Ephemeris& a, const Ephemeris& b) {
    return toe_of(a) == toe_of(b) && iode_of(a) == iode_of(b) && message_of(a) == message_of(b);
}

// The first nanosecond at which `before` serves no more; it does at `from` and does not at `to`.
GpsTime change_between(const Ephemeris& before, const NavigationSource& source, GpsTime from, GpsTime to) {
    while (to - from > Nanoseconds(1)) {
        const GpsTime middle = from + (to - from) / 2;
        const std::optional<Ephemeris> there = source.ephemeris(satellite_of(before), middle);
        (there && is_same_record(*there, before) ? from : to) = middle;
    }
    return to;
}

// Position in the frame of the reception and clock, as one record minus another.
struct RecordStep {
    Eigen::Vector3d position, velocity;
    double clock_m = 0, clock_mps = 0;
};

RecordStep step_between(const Ephemeris& before, const Ephemeris& after, GpsTime now, Seconds travel_time) {
    const SatelliteState a = satellite_state(before, now, -travel_time), b = satellite_state(after, now, -travel_time);
    return {turned_by(a.position.vector() - b.position.vector(), travel_time.value()),
            turned_by(a.velocity.vector() - b.velocity.vector(), travel_time.value()),
            speed_of_light * (a.clock_bias - b.clock_bias), speed_of_light * (a.clock_drift - b.clock_drift)};
}

}  // namespace

void RecordChanges::add_change(Satellite& satellite, const Change& change, const Ephemeris& after) {
    const RecordStep step = step_between(change.before, after, change.time, Seconds(0));
    if (step.position.norm() + std::abs(step.clock_m) <= longest_step_m) {
        satellite.changes.push_back(change);
        return;
    }
    satellite.changes.clear();
    satellite.jumped = change.time;
}

// From the last look on.
void RecordChanges::find_changes(Satellite& satellite, SatelliteId id, const NavigationSource& source, GpsTime now) {
    for (GpsTime from = satellite.looked; from < now;) {
        const GpsTime to = std::min<GpsTime>(from + search_step, now);
        std::optional<Ephemeris> after = source.ephemeris(id, to);
        if (!after) {
            satellite.changes.clear();
        } else if (satellite.record && !is_same_record(*satellite.record, *after)) {
            add_change(satellite, {change_between(*satellite.record, source, from, to), *satellite.record}, *after);
        }
        satellite.record = std::move(after);
        from = to;
    }
}

void RecordChanges::follow(Satellite& satellite, const Ephemeris& record, const NavigationSource& source, GpsTime now) {
    const Nanoseconds passed = now - satellite.looked;
    const bool followed = satellite.record && passed >= Nanoseconds(0) && passed <= search_step;
    if (!followed) {
        const GpsTime start = now - change_length;
        satellite = {start, source.ephemeris(satellite_of(record), start), {}, std::nullopt};
    }
    // What served at both ends served in between.
    if (!satellite.record || !is_same_record(*satellite.record, record))
        find_changes(satellite, satellite_of(record), source, now);
    satellite.looked = now;
    std::erase_if(satellite.changes, [now](const Change& change) { return now - change.time >= change_length; });
    if (satellite.jumped && now - *satellite.jumped >= change_length) satellite.jumped.reset();
}

EarlierRecords RecordChanges::at(const Ephemeris& record, const NavigationSource& source, GpsTime now,
                                 const RecordRay& ray) {
    Satellite& satellite = satellites_[satellite_of(record)];
    follow(satellite, record, source, now);
    EarlierRecords result{{}, {}, satellite.jumped};
    const double range = ray.way.norm();
    const Eigen::Vector3d sight = ray.way / range;
    const Eigen::Vector3d sight_rate = (ray.velocity - sight * sight.dot(ray.velocity)) / range;
    for (std::size_t i = 0; i < satellite.changes.size(); ++i) {
        const Change& change = satellite.changes[i];
        const Ephemeris& after = i + 1 < satellite.changes.size() ? satellite.changes[i + 1].before : record;
        const RecordStep step = step_between(change.before, after, now, ray.travel_time);
        const double longer = sight.dot(step.position) - step.clock_m;
        const double rate = sight.dot(step.velocity) + sight_rate.dot(step.position) - step.clock_mps;
        constexpr double length_s = std::chrono::seconds(change_length).count();
        const double passed = difference(now, change.time).value() / length_s;
        const double share = 1 - passed * passed * (3 - 2 * passed), fall = -6 * passed * (1 - passed) / length_s;
        result.range += Metres(share * longer);
        result.range_rate += MetresPerSecond(share * rate + fall * longer);
    }
    return result;
}

namespace {

// A signal on its way from a satellite to the antenna.
struct SignalPath {
    SatelliteState transmitter;  // at transmission, in the frame of that instant
    Position<Ecef> seen_at;      // the transmitter's place in the frame of the reception instant
    Metres range;
    Seconds travel_time;
};

// About what a signal takes from a navigation satellite: 67 to 90 ms.
constexpr Seconds usual_travel_time(0.075);

// Below this by a rough look a satellite is below the horizon by an exact one.
constexpr double sure_to_be_down_deg = -0.1;

// The soonest that a satellite can stand on the horizon: seen from the ground none climbs faster than a degree in a
// minute, which the angular speed of an orbit of 11 h, 0.55° a minute, stays far below. A jump of the antenna of 10 km
// turns the horizon by 0.1°.
Seconds time_until_rise(Angle rough_elevation) {
    constexpr double margin_deg = 0.3;
    return Seconds(60 * std::max(0.0, -rough_elevation.deg() - margin_deg));
}

EcefMotion motion_of(const SatelliteState& state) { return {state.position, state.velocity}; }

// From the satellite's state the usual travel time ago. @param state_at of a time before that of the truth, s
template <class StateAt>
SignalPath signal_path(const SatelliteState& usually, const TruthState& truth, StateAt&& state_at) {
    SignalPath path;
    path.travel_time = usual_travel_time;
    path.transmitter = usually;
    // By Newton's method: two steps reach the last bit, for the speed of a satellite changes by 1e-9 of that of light
    // in a second.
    for (int pass = 0; pass < 5; ++pass) {
        if (pass > 0) path.transmitter = state_at(-path.travel_time);
        path.seen_at = in_reception_frame(path.transmitter.position, path.travel_time);
        path.range = (path.seen_at - truth.position).length();
        const Seconds travel_time(path.range.value() / speed_of_light);
        const Seconds error = travel_time - path.travel_time;
        if (std::abs(error.value()) < 1e-15) {
            path.travel_time = travel_time;
            break;
        }
        const MetresPerSecond slope = light_time_slope(motion_of(path.transmitter), truth.position, path.travel_time);
        path.travel_time += error / (1 - slope.value() / speed_of_light);
    }
    return path;
}

MetresPerSecond range_rate_of(const SignalPath& path, const TruthState& truth) {
    return light_time_range_rate(motion_of(path.transmitter), {truth.position, truth.velocity}, path.travel_time);
}

// Of a satellite that the products know. @param told the path from where the record has it
std::optional<RecordError> record_error(const PreciseTruth& precise, const Ephemeris& record, const SignalPath& told,
                                        const TruthState& truth) {
    const SatelliteId id = satellite_of(record);
    const auto usually = precise.state(id, truth.time, -usual_travel_time);
    if (!usually) return std::nullopt;
    const SignalPath path = signal_path(
        *usually, truth, [&](Seconds offset) { return precise.state(id, truth.time, offset).value_or(*usually); });
    const double clock = path.transmitter.clock_bias + table_clock_delay(record).value() - told.transmitter.clock_bias;
    const double drift = path.transmitter.clock_drift - told.transmitter.clock_drift;
    return RecordError{
        path.range - told.range - Metres(speed_of_light * clock),
        range_rate_of(path, truth) - range_rate_of(told, truth) - MetresPerSecond(speed_of_light * drift)};
}

RecordRay ray_of(const SignalPath& path, const TruthState& truth) {
    return {path.seen_at.vector() - truth.position.vector(),
            turned_by(path.transmitter.velocity.vector(), path.travel_time.value()) - truth.velocity.vector(),
            path.travel_time};
}

SatelliteInView in_view(const Ephemeris& record, const SignalPath& path, const LookAngles& look,
                        const TruthState& truth) {
    SatelliteInView seen;
    seen.id = satellite_of(record);
    seen.azimuth = look.azimuth;
    seen.elevation = look.elevation;
    seen.range = path.range;
    seen.range_rate = range_rate_of(path, truth);
    seen.travel_time = path.travel_time;
    seen.position_at_transmission = path.transmitter.position;
    seen.velocity_at_transmission = path.transmitter.velocity;
    seen.clock_bias = Seconds(path.transmitter.clock_bias);
    seen.clock_drift = path.transmitter.clock_drift;
    seen.signals = transmitted_signals(record);
    seen.toe = toe_of(record);
    seen.iode = iode_of(record);
    seen.healthy = is_healthy(record);
    return seen;
}

}  // namespace

void SkyObserver::begin(const TruthState& truth, const NavigationSource& source) {
    constexpr double far_m = 10000;
    const Nanoseconds passed = truth.time - last_time_;
    const bool jumped = passed < Nanoseconds(0) || (truth.position - looked_from_).length().value() > far_m;
    if (satellites_.empty())
        for (const SatelliteId id : source.satellites())
            satellites_.push_back({id, truth.time});
    last_time_ = truth.time;
    if (!jumped) return;
    looked_from_ = truth.position;
    for (Satellite& satellite : satellites_)
        satellite.look_again = truth.time;
}

std::optional<SatelliteInView> SkyObserver::look(Satellite& satellite, const TruthState& truth, const LocalFrame& local,
                                                 const NavigationSource& source) {
    const std::optional<Ephemeris> record = source.ephemeris(satellite.id, truth.time);
    if (!record) return std::nullopt;
    const auto* glonass = std::get_if<GlonassEphemeris>(&*record);
    const Ephemeris orbit = glonass ? Ephemeris(carried_.at(*glonass, truth.time)) : *record;
    // A look without light time tells most: half of the satellites stand far below the horizon, and in a tenth of a
    // second a satellite moves by less than a kilometre.
    const SatelliteState usually = satellite_state(orbit, truth.time, -usual_travel_time);
    const Angle rough = local.look_angles(usually.position).elevation;
    if (rough.deg() < sure_to_be_down_deg) {
        satellite.look_again = advanced(truth.time, time_until_rise(rough));
        return std::nullopt;
    }
    const SignalPath path =
        signal_path(usually, truth, [&](Seconds offset) { return satellite_state(orbit, truth.time, offset); });
    // The usual convention, and that of the reference scenes: directions leave out the Earth's rotation during the
    // light time. It would turn them by less than 0.0004°.
    const LookAngles direction = local.look_angles(path.transmitter.position);
    if (direction.elevation.rad() < 0) return std::nullopt;
    SatelliteInView seen = in_view(*record, path, direction, truth);
    if (precise_ == nullptr || !precise_->knows(satellite.id)) {
        seen.earlier_records = changes_.at(*record, source, truth.time, ray_of(path, truth));
        return seen;
    }
    seen.record_error = record_error(*precise_, *record, path, truth);
    if (!seen.record_error) return std::nullopt;
    for (TransmittedSignal& signal : seen.signals)
        if (const auto late = precise_->code_bias(satellite.id, signal.signal, truth.time))
            signal.group_delay = *late + table_clock_delay(*record);
    return seen;
}

SkyView SkyObserver::observe(const TruthState& truth, const NavigationSource& source) {
    begin(truth, source);
    const LocalFrame local(truth.geodetic);
    SkyView sky;
    sky.satellites.reserve(satellites_.size() / 2);
    for (Satellite& satellite : satellites_) {
        if (truth.time < satellite.look_again) continue;
        if (std::optional<SatelliteInView> seen = look(satellite, truth, local, source))
            sky.satellites.push_back(std::move(*seen));
    }
    return sky;
}

SkyView observe_sky(const TruthState& truth, const NavigationSource& source, const PreciseTruth* precise) {
    SkyObserver observer(precise);
    return observer.observe(truth, source);
}

}  // namespace skyloop::inline world
