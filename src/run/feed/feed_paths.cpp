#include "detail/feed_paths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <utility>

namespace skyloop::inline run {
namespace {

constexpr std::size_t most_items_at_once = 4096;  // a flood must not hold the loop
constexpr std::size_t most_arrival_clocks = 256, most_pending_steps = 1024;
constexpr std::int64_t vehicle_silence_ns = 1'500'000'000;

}  // namespace

FeedPaths::FeedPaths(const FeedSettings& settings, FeedDesk& desk)
    : path_settings_(settings.path), mode_(settings.clock), desk_(desk), clock_(settings.clock, GpsTime(), 0) {}

std::shared_ptr<LivePath> FeedPaths::path(const std::string& vehicle, const LivePathSettings& settings) {
    std::shared_ptr<LivePath>& path = vehicle.empty() ? any_ : vehicles_[vehicle].path;
    if (!path) path = std::make_shared<LivePath>(settings);
    return path;
}

void FeedPaths::begin(GpsTime start, std::int64_t steady_ns) {
    clock_ = SourceClock(mode_, start, steady_ns);
    start_ = start;
    start_ns_ = steady_ns;
    begun_ = fresh_ = true;
}

void FeedPaths::set_run(GpsTime now, std::int64_t steady_ns) {
    start_ = now;
    start_ns_ = steady_ns;
    clock_.set_run(now, steady_ns);
    for (auto& [vehicle, untimed] : untimed_)
        untimed.clock.set_run(now, steady_ns);
}

std::vector<Command> FeedPaths::take(std::int64_t now_ns) {
    std::vector<Command> commands;
    if (!begun_) return commands;
    if (next_ >= taken_.size()) {
        taken_.clear();
        next_ = 0;
        if (desk_.inbox.try_take(taken_) && std::exchange(fresh_, false) && mode_ == ClockMode::follow)
            keep_newest(taken_);
    }
    const std::size_t end = std::min(taken_.size(), next_ + most_items_at_once);
    for (; next_ < end && !step_waits(); ++next_)
        take_item(taken_[next_], commands, now_ns);
    ended_ = ends_ns_ && now_ns >= *ends_ns_;
    look(now_ns);
    return commands;
}

// What a source says after a step belongs after it, however early it came: else the bytes of a run would depend on the
// network.
bool FeedPaths::step_waits() const {
    return mode_ == ClockMode::lock_step && !steps_.empty() && (!answered_ || steps_.front().time > *answered_);
}

// What a source said before the run began is over; a run that follows starts where it is now.
void FeedPaths::keep_newest(std::vector<FeedItem>& items) const {
    std::set<std::string> seen;
    std::vector<FeedItem> kept;
    for (auto item = items.rbegin(); item != items.rend(); ++item) {
        const auto* sample = std::get_if<TruthSample>(&*item);
        if (sample == nullptr || sample->received_ns >= start_ns_ || seen.insert(sample->vehicle).second)
            kept.push_back(std::move(*item));
    }
    std::reverse(kept.begin(), kept.end());
    items = std::move(kept);
}

void FeedPaths::take_item(FeedItem& item, std::vector<Command>& commands, std::int64_t now_ns) {
    if (auto* sample = std::get_if<TruthSample>(&item))
        take_sample(*sample);
    else if (auto* command = std::get_if<Command>(&item))
        commands.push_back(std::move(*command));
    else if (const auto* step = std::get_if<FeedStep>(&item))
        take_step(*step);
    else if (const auto* pause = std::get_if<FeedPause>(&item))
        paused_ = pause->paused;
    else
        take_end(now_ns);
}

// It is of one sender, and nobody knows which vehicles are his: where several were spoken of, others may go on.
void FeedPaths::take_end(std::int64_t now_ns) {
    const bool several = turned_ns_ && now_ns - *turned_ns_ < vehicle_silence_ns;
    ends_ns_ = now_ns + (several ? vehicle_silence_ns : 0);
}

void FeedPaths::take_sample(TruthSample& sample) {
    ends_ns_.reset();
    if (const auto why = implausible(sample)) {  // it starts no run
        desk_.tallies.refused += 1;
        desk_.news.tell(FeedNewsDesk::Kind::refusal, "refused: " + *why, sample.received_ns);
        return;
    }
    if (!first_) first_ = spoken_of_ = sample.vehicle;
    if (sample.vehicle != spoken_of_) {
        spoken_of_ = sample.vehicle;
        turned_ns_ = sample.received_ns;
    }
    if (!is_wanted(sample.vehicle)) return take_unwanted(sample);
    if (mode_ != ClockMode::follow || !waits_ || first_sample_) return place(sample);
    // All that are waited for begin together: else those that are heard later would stand where they are not yet, and
    // the path of the first would have forgotten its beginning.
    std::erase_if(begun_with_, [&](const TruthSample& other) { return other.vehicle == sample.vehicle; });
    begun_with_.push_back(std::move(sample));
    if (!all_have_begun()) return;
    for (TruthSample& first : std::exchange(begun_with_, {}))
        place(first);
}

bool FeedPaths::is_wanted(const std::string& vehicle) const {
    return vehicles_.contains(vehicle) || (any_ && *first_ == vehicle);
}

bool FeedPaths::all_have_begun() const {
    const auto has_begun = [this](const std::string& vehicle) {
        return std::any_of(begun_with_.begin(), begun_with_.end(),
                           [&](const TruthSample& sample) { return sample.vehicle == vehicle; });
    };
    return (!any_ || has_begun(*first_)) &&
           std::all_of(vehicles_.begin(), vehicles_.end(), [&](const auto& entry) { return has_begun(entry.first); });
}

// It tells of the source's clock, but starts no run that is about others.
void FeedPaths::take_unwanted(const TruthSample& sample) {
    const bool starts = mode_ == ClockMode::realtime || (mode_ == ClockMode::lock_step && !waits_);
    if (starts || first_sample_) note(stamp(sample), sample.received_ns);
    if (other_told_) return;
    other_told_ = desk_.news.tell_once(
        fmt::format("it also speaks of vehicle '{}', which nobody has asked for", sample.vehicle.substr(0, 40)));
}

void FeedPaths::place(TruthSample& sample) {
    const auto wanted = vehicles_.find(sample.vehicle);
    const SourceClock::Stamp stamped = stamp(sample);
    note(stamped, sample.received_ns);
    if (!first_sample_) {
        first_sample_ = stamped.time;
        first_sample_ns_ = sample.received_ns;
    }
    newest_sample_ = std::max(newest_sample_.value_or(stamped.time), stamped.time);
    if (wanted != vehicles_.end()) add(wanted->second, wanted->first, stamped.time, sample);
    if (!any_ || *first_ != sample.vehicle) return;
    // Kept beside the others under a name that no vehicle has.
    Vehicle& vehicle = vehicles_[""];
    vehicle.path = any_;
    add(vehicle, sample.vehicle, stamped.time, sample);
}

void FeedPaths::add(Vehicle& vehicle, const std::string& name, GpsTime time, TruthSample& sample) {
    const bool told = sample.jump;
    if (vehicle.restarts != restarts_ && vehicle.path->newest()) sample.jump = true;
    vehicle.restarts = restarts_;
    vehicle.heard_ns = sample.received_ns;
    if (std::exchange(vehicle.silent, false))
        desk_.news.tell(FeedNewsDesk::Kind::vehicle, fmt::format("vehicle '{}' is heard again", name.substr(0, 40)),
                        sample.received_ns);
    vehicle.path->add(time, sample);
    sample.jump = told;
    if (vehicle.path->counts().jumps == vehicle.jumps) return;
    vehicle.jumps = vehicle.path->counts().jumps;
    desk_.news.tell(FeedNewsDesk::Kind::jump, fmt::format("vehicle '{}' has jumped", name.substr(0, 40)),
                    sample.received_ns);
}

SourceClock::Stamp FeedPaths::stamp(const TruthSample& sample) {
    if (sample.source_time) {
        if (!first_timed_ns_) first_timed_ns_ = sample.received_ns;
        return clock_.stamp(sample.source_time, sample.received_ns);
    }
    // Vehicles of one source come at their own instants, each with its own rhythm.
    auto own = untimed_.find(sample.vehicle);
    if (own == untimed_.end() && untimed_.size() < most_arrival_clocks)
        own = untimed_.try_emplace(sample.vehicle, Untimed{SourceClock(mode_, start_, start_ns_), {}}).first;
    if (own == untimed_.end()) return clock_.stamp(std::nullopt, sample.received_ns);
    const auto step = own->second.last ? own_step(*own->second.last, sample) : std::nullopt;
    own->second.last = sample;
    if (mode_ != ClockMode::realtime)  // one time for all; between two vehicles there is no step
        return clock_.stamp(std::nullopt, sample.received_ns, untimed_.size() == 1 ? step : std::nullopt);
    return own->second.clock.stamp(std::nullopt, sample.received_ns, step);
}

void FeedPaths::note(const SourceClock::Stamp& stamp, std::int64_t now_ns) {
    if (stamp.restarted) {
        ++restarts_;
        desk_.tallies.restarts += 1;
        desk_.news.tell(FeedNewsDesk::Kind::clock, "the source's clock began anew", now_ns);
    } else if (stamp.stepped && mode_ == ClockMode::realtime) {
        desk_.news.tell(FeedNewsDesk::Kind::clock,
                        "the source's clock stepped against the wall clock by more than 0.25 s", now_ns);
    }
}

void FeedPaths::take_step(const FeedStep& step) {
    if (mode_ != ClockMode::lock_step) {
        desk_.news.tell(FeedNewsDesk::Kind::other,
                        "it steps, but clock is not \"lock_step\": nothing waits for its steps", step.received_ns);
        return;
    }
    const SourceClock::Stamp stamped = clock_.stamp(step.until, step.received_ns);
    note(stamped, step.received_ns);
    if (steps_.size() >= most_pending_steps) steps_.pop_front();
    steps_.push_back({step, stamped.time});
    newest_step_ = std::max(newest_step_.value_or(stamped.time), stamped.time);
}

std::vector<FeedStep> FeedPaths::take_steps(std::optional<GpsTime> until) {
    std::vector<FeedStep> taken;
    for (; until && !steps_.empty() && steps_.front().time <= *until; steps_.pop_front())
        taken.push_back(steps_.front().step);
    return taken;
}

std::vector<FeedStep> FeedPaths::steps_done() {
    const auto reached = horizon();
    if (reached) answered_ = reached;
    return take_steps(reached);
}

// What has been said until now is over; the next statement is the start.
std::vector<FeedStep> FeedPaths::skip_steps() {
    std::vector<FeedStep> skipped;
    if (steps_.empty()) return skipped;
    for (const PendingStep& pending : steps_)
        skipped.push_back(pending.step);
    steps_.clear();
    clock_ = SourceClock(mode_, start_, start_ns_);
    ++restarts_;
    first_sample_.reset();
    newest_sample_.reset();
    newest_step_.reset();
    answered_.reset();
    return skipped;
}

// Follow: as far as all of the vehicles are known. One that has not been heard for a second of the source's, or that
// is not there, is not waited for.
std::optional<GpsTime> FeedPaths::horizon() const {
    if (mode_ == ClockMode::lock_step) return newest_step_;
    if (!newest_sample_) return std::nullopt;
    const GpsTime old = *newest_sample_ - std::chrono::seconds(1);
    std::optional<GpsTime> reached;
    for (const auto& [name, vehicle] : vehicles_) {
        const auto newest = vehicle.path->newest();
        if (!newest && *first_sample_ > old) return std::nullopt;
        if (newest && *newest >= old) reached = std::min(reached.value_or(*newest), *newest);
    }
    return reached;
}

void FeedPaths::look(std::int64_t now_ns) {
    constexpr std::int64_t every_ns = 1'000'000'000;
    if (now_ns < looked_ns_ + every_ns) return;
    looked_ns_ = now_ns;
    std::int64_t heard_ns = 0;
    for (const auto& [name, vehicle] : vehicles_)
        heard_ns = std::max(heard_ns, vehicle.heard_ns);
    for (auto& [name, vehicle] : vehicles_) {
        // The silence of all of them is the feed's.
        if (vehicle.heard_ns == 0 || vehicle.silent || heard_ns - vehicle.heard_ns < vehicle_silence_ns) continue;
        vehicle.silent = true;
        desk_.news.tell(FeedNewsDesk::Kind::vehicle, fmt::format("vehicle '{}' is silent", name.substr(0, 40)), now_ns);
    }
    look_at_steps(heard_ns);
    look_at_rate(now_ns);
}

// Samples alone bring a run in lock-step nowhere, and nothing else tells why it stands still.
void FeedPaths::look_at_steps(std::int64_t heard_ns) {
    constexpr std::int64_t patience_ns = 5'000'000'000;
    if (mode_ != ClockMode::lock_step || newest_step_ || !first_sample_ || steps_missed_) return;
    if (heard_ns < first_sample_ns_ + patience_ns) return;
    steps_missed_ = desk_.news.tell_once(
        "it tells where it is and does not step; clock = \"lock_step\" waits for {\"type\":\"step\",\"t\":…}, "
        "clock = \"follow\" does not");
}

// Once it is known over five seconds, and three looks agree: after a pause or a step it is known over less.
void FeedPaths::look_at_rate(std::int64_t now_ns) {
    constexpr std::int64_t watched_ns = 5'000'000'000;
    constexpr double odd_rate = 0.02;  // FEEDS.md 3.2
    constexpr int enough = 3;
    if (mode_ != ClockMode::realtime || rate_told_ || !first_timed_ns_ || now_ns < *first_timed_ns_ + watched_ns)
        return;
    const auto rate = clock_.rate();
    odd_looks_ = rate && *rate > 0 && std::abs(*rate - 1) > odd_rate ? odd_looks_ + 1 : 0;
    if (odd_looks_ < enough) return;
    rate_told_ = desk_.news.tell_once(
        fmt::format("the source runs at {:.2f} of real time; expected 1; clock = \"follow\" keeps its time", *rate));
}

}  // namespace skyloop::inline run
