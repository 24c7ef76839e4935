// A led run, and what its caller says of the vehicle, in our frames and units.

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <span>
#include <string_view>

#include "base/geo/geoid.hpp"
#include "base/geo/local_frame.hpp"
#include "detail/session.hpp"
#include "motion/trajectory/live_path.hpp"
#include "motion/trajectory/trajectory.hpp"

namespace skyloop::inline run {

namespace {

// What the positions of a caller refer to.
struct TruthFrames {
    const Geoid* geoid = nullptr;  // null: heights above sea level are not understood
    const LocalFrame* local = nullptr;
};

constexpr std::uint32_t positions = SKY_POS_ECEF | SKY_POS_LLA_ELLIPSOID | SKY_POS_LLA_MSL | SKY_POS_LOCAL_NED;
constexpr std::uint32_t known_fields = positions | SKY_VEL | SKY_ACC | SKY_ATT | SKY_RATE | SKY_RESET;
constexpr double quaternion_tolerance = 0.05;  // FEEDS.md 3.1
constexpr double farthest_m = 1e7;             // of local metres: beyond it they are in another unit

struct NamedNumbers {
    std::uint32_t field;
    std::string_view name;
    std::span<const double> numbers;
};

Answer<void> check_numbers(const sky_truth& t) {
    for (const NamedNumbers& one : {NamedNumbers{positions, "pos", t.pos}, NamedNumbers{SKY_VEL, "vel_ned", t.vel_ned},
                                    NamedNumbers{SKY_ACC, "acc_ned", t.acc_ned}, NamedNumbers{SKY_ATT, "q_nb", t.q_nb},
                                    NamedNumbers{SKY_RATE, "rate_frd", t.rate_frd}}) {
        if ((t.fields & one.field) == 0) continue;
        for (std::size_t i = 0; i < one.numbers.size(); ++i)
            if (!std::isfinite(one.numbers[i]))
                return refuse(SKY_E_RANGE,
                              fmt::format("{}[{}] is {}; expected a finite number", one.name, i, one.numbers[i]));
    }
    return {};
}

Answer<void> check_below(const char* name, double size, const char* unit, double limit) {
    if (size < limit) return {};
    return refuse(SKY_E_RANGE, fmt::format("{} is {:g} {}; expected less than {:g}", name, size, unit, limit));
}

Answer<Position<Ecef>> place_of_degrees(const double (&pos)[3], Metres undulation) {
    constexpr double lowest_m = -1e4, highest_m = 1e6;  // FEEDS.md 3.1
    if (!(pos[2] >= lowest_m && pos[2] < highest_m))
        return refuse(SKY_E_RANGE, fmt::format("pos: height is {:g} m; expected -10 000 to 1 000 000", pos[2]));
    const auto place = place_from_degrees(pos[0], pos[1], pos[2] + undulation.value());
    if (!place) return refuse(SKY_E_RANGE, "pos: " + place.error());
    return to_ecef(*place);
}

Answer<Position<Ecef>> position_of(const sky_truth& truth, const TruthFrames& frames) {
    const auto& pos = truth.pos;
    switch (truth.fields & positions) {
        case SKY_POS_ECEF:
            return Position<Ecef>(pos[0], pos[1], pos[2]);
        case SKY_POS_LLA_ELLIPSOID:
            return place_of_degrees(pos, Metres(0));
        case SKY_POS_LLA_MSL: {
            if (frames.geoid == nullptr)
                return refuse(SKY_E_STATE,
                              "SKY_POS_LLA_MSL needs the geoid, which was not found: see the log of sky_create()");
            if (const auto place = place_of_degrees(pos, Metres(0)); !place) return place;
            return place_of_degrees(
                pos, frames.geoid->undulation(Angle::degrees(pos[0]), Angle::degrees(std::remainder(pos[1], 360))));
        }
        default:
            if (!(std::hypot(pos[0], pos[1], pos[2]) < farthest_m))
                return refuse(SKY_E_RANGE, fmt::format("pos is {:g} m from the origin; expected less than {:g} m",
                                                       std::hypot(pos[0], pos[1], pos[2]), farthest_m));
            return frames.local->to_ecef(Position<Enu>(pos[1], pos[0], -pos[2]));
    }
}

Answer<Attitude> attitude_of(const double (&q)[4]) {
    const Eigen::Quaterniond turn(q[0], q[1], q[2], q[3]);
    if (std::abs(turn.norm() - 1) > quaternion_tolerance)
        return refuse(SKY_E_RANGE, fmt::format("q_nb has the length {:g}; expected 1", turn.norm()));
    return Attitude(turn);
}

// Beyond them a path takes its own estimate for what was told.
Answer<void> check_motion(const sky_truth& t) {
    const double acceleration = (t.fields & SKY_ACC) != 0 ? Eigen::Vector3d(t.acc_ned).stableNorm() : 0;
    const double turn_rate = (t.fields & SKY_RATE) != 0 ? Eigen::Vector3d(t.rate_frd).stableNorm() : 0;
    if (auto soft = check_below("acc_ned", acceleration, "m/s²", LivePath::hardest_mps2); !soft) return soft;
    return check_below("rate_frd", turn_rate, "rad/s", LivePath::fastest_turn_radps);
}

// Its time is left to the caller. Fails with SKY_E_ARG for fields that contradict each other, SKY_E_UNSUPPORTED for
// ones that are not known, SKY_E_RANGE for numbers that are not finite or out of their bounds, SKY_E_STATE for a height
// above sea level without a geoid.
Answer<TruthSample> truth_sample(const sky_truth& truth, const TruthFrames& frames) {
    if ((truth.fields & ~known_fields) != 0)
        return refuse(SKY_E_UNSUPPORTED, fmt::format("fields is {:#x}, of which {:#x} is not known to this version",
                                                     truth.fields, truth.fields & ~known_fields));
    if (truth.reserved != 0)
        return refuse(SKY_E_UNSUPPORTED, fmt::format("reserved is {:#x}; expected 0", truth.reserved));
    if (std::popcount(truth.fields & positions) != 1)
        return refuse(SKY_E_ARG, fmt::format("fields is {:#x}; expected exactly one SKY_POS_…", truth.fields));
    if (const auto finite = check_numbers(truth); !finite) return refuse(finite.error());
    if (const auto usable = check_motion(truth); !usable) return refuse(usable.error());
    const auto position = position_of(truth, frames);
    if (!position) return refuse(position.error());
    TruthSample sample;
    sample.position = *position;
    sample.jump = (truth.fields & SKY_RESET) != 0;
    const LocalFrame own(to_geodetic(*position));
    const LocalFrame& axes = (truth.fields & SKY_POS_LOCAL_NED) != 0 ? *frames.local : own;
    const auto turned = [&](const double(&ned)[3]) { return axes.to_ecef(Velocity<Enu>(ned[1], ned[0], -ned[2])); };
    if ((truth.fields & SKY_VEL) != 0) sample.velocity = turned(truth.vel_ned);
    if ((truth.fields & SKY_ACC) != 0) sample.acceleration = turned(truth.acc_ned).vector();
    if ((truth.fields & SKY_RATE) != 0) sample.turn_rate = Eigen::Vector3d(truth.rate_frd);
    if ((truth.fields & SKY_ATT) == 0) return sample;
    const auto attitude = attitude_of(truth.q_nb);
    if (!attitude) return refuse(attitude.error());
    sample.attitude = *attitude;
    return sample;
}

constexpr Nanoseconds most_behind{2'000'000'000}, most_ahead{2'000'000'000};
constexpr Nanoseconds longest_stretch{86'400'000'000'000};
// Far inside what 64-bit nanoseconds since 1980 can count, which ends in 2272.
constexpr std::int64_t latest_ns = 9'150'000'000'000'000'000;

}  // namespace

void Session::log(std::int32_t level, const std::string& sentence) const {
    if (log_ != nullptr) log_(log_user_, level, sentence.c_str());
}

Answer<GpsTime> Session::run_time(std::int64_t sim_time_ns) const {
    std::int64_t since_start = 0, time = 0;
    if (__builtin_sub_overflow(sim_time_ns, start_sim_ns_, &since_start) ||
        __builtin_add_overflow(assembly_.start.time_since_epoch().count(), since_start, &time) || time < -latest_ns ||
        time > latest_ns)
        return refuse(SKY_E_TIME, fmt::format("{} ns is beyond what can be counted from start_sim_ns, {} ns",
                                              sim_time_ns, start_sim_ns_));
    return GpsTime(Nanoseconds(time));
}

std::int64_t Session::sim_time(GpsTime time) const {
    std::int64_t sim = 0;
    return __builtin_add_overflow((time - assembly_.start).count(), start_sim_ns_, &sim) ? INT64_MAX : sim;
}

Answer<void> Session::check_receiver(std::uint32_t receiver) const {
    const std::size_t count = assembly_.emulator->stations().size();
    if (receiver < count) return {};
    return refuse(SKY_E_ARG, fmt::format("receiver {}: the scenario has {}, counted from 0", receiver, count));
}

Answer<LedPort*> Session::port(std::uint32_t number) {
    if (number < ports_.size()) return ports_[number].led;
    return refuse(SKY_E_ARG, fmt::format("port {}: there are {}, counted from 0; sky_query(\"ports\") lists them",
                                         number, ports_.size()));
}

// As sky_truth counts them.
std::uint32_t Session::vehicle_of(std::size_t receiver) const {
    return scenario_.receivers[receiver].trajectory ? static_cast<std::uint32_t>(receiver) + 1 : 0;
}

// The receivers of a vehicle; none: there is no such vehicle.
std::vector<std::size_t> Session::riders(std::uint32_t vehicle) const {
    std::vector<std::size_t> receivers;
    for (std::size_t i = 0; i < scenario_.receivers.size(); ++i)
        if (vehicle_of(i) == vehicle) receivers.push_back(i);
    return receivers;
}

void Session::put_on(const std::vector<std::size_t>& receivers, const std::shared_ptr<LivePath>& path) {
    for (const std::size_t i : receivers)
        assembly_.emulator->stations()[i].lead_along(
            make_antenna_path(scenario_, i, std::make_unique<SharedPath>(path)));
}

Answer<std::shared_ptr<LivePath>> Session::path_of(const sky_truth& truth, const TruthSample& first) const {
    if (const auto found = vehicles_.find(truth.vehicle); found != vehicles_.end()) return found->second.path;
    if (riders(truth.vehicle).empty())
        return refuse(SKY_E_ARG,
                      fmt::format("vehicle {}: no receiver rides on it; expected 0, the scenario's, or n + 1 of a "
                                  "receiver n that has a [receiver.trajectory]",
                                  truth.vehicle));
    LivePathSettings settings;
    settings.before = to_geodetic(first.position);
    return std::make_shared<LivePath>(settings);
}

Answer<void> Session::set_truth(const sky_truth& truth) {
    if (const auto running = check_running(); !running) return running;
    const auto time = run_time(truth.sim_time_ns);
    if (!time) return refuse(time.error());
    if (*time < now() - most_behind || *time > now() + most_ahead)
        return refuse(SKY_E_TIME, fmt::format("truth of {} ns at {} ns; expected at most 2 s before or after that",
                                              truth.sim_time_ns, sim_time(now())));
    const auto sample = truth_sample(truth, {assembly_.geoid.get(), local_.get()});
    if (!sample) return refuse(sample.error());
    if (auto why = implausible(*sample)) return refuse(SKY_E_RANGE, std::move(*why));
    const auto path = path_of(truth, *sample);
    if (!path) return refuse(path.error());
    if ((*path)->newest() && *time < *(*path)->newest())
        return refuse(SKY_E_TIME, fmt::format("truth of {} ns after that of {} ns; expected times that ascend",
                                              truth.sim_time_ns, sim_time(*(*path)->newest())));
    (*path)->add(*time, *sample);
    const auto [known, first] = vehicles_.try_emplace(truth.vehicle, Vehicle{*path});
    Vehicle& vehicle = known->second;
    // A command of the scenario may have moved it: where it is put by hand, it is there.
    if (!first && !(sample->jump && vehicle.moves != watcher_->moves())) return {};
    vehicle.moves = watcher_->moves();
    put_on(riders(truth.vehicle), vehicle.path);
    return {};
}

Answer<void> Session::check_running() const {
    if (!assembly_.emulator->stopped()) return {};
    return refuse(SKY_E_STATE, "the run has ended: a command of the scenario, or of the caller, has stopped it");
}

Answer<void> Session::check_recordings() const {
    for (const Station& station : assembly_.emulator->stations())
        if (station.recorder() != nullptr && station.recorder()->failure())
            return refuse(*station.recorder()->failure());
    return {};
}

Answer<void> Session::advance(std::int64_t sim_time_ns) {
    const auto time = run_time(sim_time_ns);
    if (!time) return refuse(time.error());
    if (*time < now())
        return refuse(SKY_E_TIME, fmt::format("{} ns lies before the present, {} ns", sim_time_ns, sim_time(now())));
    if (*time - now() > longest_stretch)
        return refuse(SKY_E_TIME,
                      fmt::format("{} ns lies more than a day after the present, {} ns; is start_sim_ns the "
                                  "caller's time at the start?",
                                  sim_time_ns, sim_time(now())));
    if (const auto running = check_running(); !running) return running;
    if (const auto kept = check_recordings(); !kept) return kept;
    assembly_.emulator->advance_to(*time, never_, Emulator::LastInstant::included);
    watcher_->went_on();
    tell_news();
    return check_recordings();
}

void Session::tell_news() {
    const auto& stations = assembly_.emulator->stations();
    for (std::size_t i = 0; i < stations.size(); ++i) {
        const RayTracedScene* city = stations[i].simulation().city();
        if (city != nullptr && city->notice() && noticed_.insert(i).second)
            log(SKY_LOG_WARNING, stations[i].name() + ": " + *city->notice());
    }
    for (auto& [number, vehicle] : vehicles_) {
        if (vehicle.path->counts().holds == vehicle.holds) continue;
        vehicle.holds = vehicle.path->counts().holds;
        log(SKY_LOG_WARNING,
            fmt::format("vehicle {} stands still at {} ns: nothing was said of it since {} ns", number,
                        sim_time(std::min(now(), *vehicle.path->rests_at())), sim_time(*vehicle.path->newest())));
    }
}

sky_progress Session::progress() const {
    const Emulator& emulator = *assembly_.emulator;
    sky_progress told{};
    told.ports = static_cast<std::uint32_t>(ports_.size());
    GpsTime next = emulator.next_event();
    for (const Station& station : emulator.stations()) {
        told.epochs += station.counts().epochs;
        if (const auto drained = station.receiver().drained_at(); drained && *drained > now())
            next = std::min(next, *drained);
    }
    told.now_ns = sim_time(now());
    told.next_event_ns = sim_time(next);
    for (std::size_t i = 0; i < ports_.size(); ++i) {
        const std::size_t pending = ports_[i].led->pending();
        told.bytes_pending += pending;
        if (pending > 0 && i < 64) told.ports_pending |= std::uint64_t{1} << i;
    }
    return told;
}

}  // namespace skyloop::inline run
