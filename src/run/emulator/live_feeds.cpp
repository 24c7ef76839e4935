#include "run/emulator/live_feeds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "base/core/threads.hpp"
#include "run/fault/command.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::array<std::string_view, 3> clock_names{"realtime", "follow", "lock_step"};

constexpr double longest_without_place_s = 5;

Command plain_command(CommandVerb verb, std::string_view source = "feed") {
    return {verb, {}, {}, std::string(source)};
}

LivePathSettings path_settings(const LiveSettings& live) {
    return {.before = live.at.value_or(FixedSettings().at), .begins_at_first = !live.at, .delay = live.delay};
}

FeedSettings feed_settings(const LiveSettings& live, const Geoid* geoid) {
    FeedSettings settings;
    settings.context.geoid = geoid;
    settings.context.sea_level = live.sea_is_ellipsoid ? SeaLevel::ellipsoid : SeaLevel::geoid;
    settings.context.origin = live.origin;
    settings.context.map = live.local_map;
    settings.context.smooth = live.filtered;
    settings.context.vehicle = live.vehicle;
    settings.context.rate_hz = live.rate_hz;
    settings.clock = live.clock;
    settings.path = path_settings(live);
    return settings;
}

// Where the source is, if it can keep the clock that is asked for.
Result<FeedAddress> address_of(const LiveSettings& live) {
    auto address = parse_feed_address(live.source);
    if (!address) return fail(address.error().code, live.source_told_at + address.error().message);
    if (live.clock == ClockMode::lock_step && !knows_steps(address->dialect))
        return fail(ErrorCode::usage,
                    fmt::format("{}'{}' sends no steps, which clock = \"lock_step\" waits for; expected clock = "
                                "\"follow\", or a source that steps: udp-json, tcp-json, json-to",
                                live.source_told_at, live.source));
    return address;
}

std::vector<LiveSettings*> live_settings(Scenario& scenario) {
    std::vector<LiveSettings*> wanted;
    // The vehicle that every receiver has left is nobody's.
    const bool all_own = std::all_of(scenario.receivers.begin(), scenario.receivers.end(),
                                     [](const ReceiverEntry& r) { return r.trajectory.has_value(); });
    if (auto* live = std::get_if<LiveSettings>(&scenario.trajectory); live && !all_own) wanted.push_back(live);
    for (ReceiverEntry& receiver : scenario.receivers)
        if (receiver.trajectory)
            if (auto* live = std::get_if<LiveSettings>(&*receiver.trajectory)) wanted.push_back(live);
    return wanted;
}

}  // namespace

struct LiveFeeds::Source {
    LiveSettings settings;  // of the first that named it
    std::unique_ptr<TruthFeed> feed;
    std::vector<std::shared_ptr<LivePath>> paths;
    bool waited_for = false;       // somebody has no place without it
    std::uint64_t statements = 0;  // at the last look
    std::int64_t heard_ns = 0;     // when they had become more, or the source waited for us
    bool lost = false;
    bool pause_told = false;
    std::int64_t opened_ns = 0;
    bool no_place_told = false;
    int times_lost = 0;
    std::string outage;                    // the fault that its silence has begun; empty: none
    std::optional<GpsTime> known_at_loss;  // known_until() then
    std::optional<GpsTime> outage_end;     // in the run, once it is heard again
    SampleAge age;

    // Everybody who has no place without it has one.
    [[nodiscard]] bool is_known() const {
        return !waited_for ||
               std::all_of(paths.begin(), paths.end(), [](const auto& path) { return path->newest().has_value(); });
    }

    [[nodiscard]] bool pauses() const { return settings.when_lost == LostSource::pause; }
    [[nodiscard]] bool leads() const { return settings.clock != ClockMode::realtime; }

    [[nodiscard]] std::optional<GpsTime> known_until() const {
        std::optional<GpsTime> newest;
        for (const auto& path : paths)
            if (const auto own = path->newest()) newest = std::max(newest.value_or(*own), *own);
        return newest;
    }
};

void SampleAge::add(Nanoseconds age) {
    const double ms = std::max(0.0, static_cast<double>(age.count()) * 1e-6);
    ++epochs;
    sum_ms += ms;
    largest_ms = std::max(largest_ms, ms);
}

LiveFeeds::LiveFeeds() = default;
LiveFeeds::~LiveFeeds() = default;

Result<LiveFeeds::Source*> LiveFeeds::source_of(const LiveSettings& settings, const Geoid* geoid) {
    for (const auto& source : sources_) {
        if (source->settings.source != settings.source) continue;
        if (source->settings.clock != settings.clock)
            return fail(ErrorCode::usage,
                        fmt::format("{}\"{}\" is asked for with clock = \"{}\" and with clock = \"{}\"; expected one "
                                    "of them",
                                    settings.source_told_at, settings.source,
                                    clock_names[static_cast<std::size_t>(source->settings.clock)],
                                    clock_names[static_cast<std::size_t>(settings.clock)]));
        return source.get();
    }
    const auto address = address_of(settings);
    if (!address) return fail(address.error());
    const bool leads = settings.clock != ClockMode::realtime;
    if (leads && leader_ != nullptr)
        return fail(ErrorCode::usage,
                    fmt::format("{}two sources would lead the run's time, {} and {}; expected clock = \"realtime\" "
                                "for all but one",
                                settings.source_told_at, leader_->description(), settings.source));
    auto feed = TruthFeed::open(*address, feed_settings(settings, geoid));
    if (!feed) return fail(feed.error());
    auto source = std::make_unique<Source>();
    source->settings = settings;
    source->feed = std::move(*feed);
    source->opened_ns = steady_clock_ns();
    if (leads) leader_ = source->feed.get();
    sources_.push_back(std::move(source));
    return sources_.back().get();
}

Result<std::unique_ptr<LiveFeeds>> LiveFeeds::open(Scenario& scenario, const Geoid* geoid) {
    const std::vector<LiveSettings*> wanted = live_settings(scenario);
    if (wanted.empty()) return nullptr;
    std::unique_ptr<LiveFeeds> feeds(new LiveFeeds);
    feeds->receivers_ = receiver_names(scenario);
    for (LiveSettings* live : wanted) {
        const auto source = feeds->source_of(*live, geoid);
        if (!source) return fail(source.error());
        live->path = (*source)->feed->path(live->vehicle, path_settings(*live));
        (*source)->paths.push_back(live->path);
        (*source)->waited_for = (*source)->waited_for || !live->at;
        if (!live->at) (*source)->feed->wait_for_all();
    }
    if (feeds->leader_ == nullptr && scenario.run.speed != 1)
        return fail(
            ErrorCode::usage,
            fmt::format("{}is {:g}, and {}; expected clock = \"follow\" where the source runs at another",
                        told_place(scenario, "run.speed", "--speed"), scenario.run.speed, feeds->keeps_speed()));
    return feeds;
}

Result<void> LiveFeeds::check(Scenario& scenario) {
    for (LiveSettings* live : live_settings(scenario)) {
        if (const auto address = address_of(*live); !address) return fail(address.error());
        live->path = std::make_shared<LivePath>(path_settings(*live));
    }
    return {};
}

void LiveFeeds::begin(GpsTime start, std::optional<std::int64_t> due_ns) {
    const std::int64_t now_ns = steady_clock_ns();
    for (const auto& source : sources_) {
        source->heard_ns = now_ns;
        source->feed->begin(start, due_ns.value_or(now_ns));
    }
}

std::vector<Command> LiveFeeds::pump(GpsTime now, std::optional<std::int64_t> due_ns) {
    std::vector<Command> commands;
    for (const auto& source : sources_) {
        if (due_ns) source->feed->set_run(now, *due_ns);
        for (Command& command : source->feed->pump())
            if (const auto mistake = receiver_mistake(command, receivers_))
                news_.push_back(fmt::format("{}: {} is not done: {}", source->feed->description(),
                                            command_name(command.verb), *mistake));
            else
                commands.push_back(std::move(command));
        if (source->settings.clock == ClockMode::lock_step && !source->is_known()) source->feed->skip_steps();
        report_no_place(*source);
        look_for_silence(*source, commands);
        end_outage(*source, now, commands);
        for (std::string& news : source->feed->take_news())
            news_.push_back(std::move(news));
    }
    return commands;
}

// A source that leads takes the run's time with it into its pause. In real time the run goes on, unless it shall pause
// where it has no truth.
bool LiveFeeds::halts(Source& source) {
    if (source.leads() || !source.feed->paused()) return false;
    if (source.pauses()) return true;
    if (!std::exchange(source.pause_told, true))
        news_.push_back(
            fmt::format("{}: has paused; the run goes on, and the vehicle comes to rest farther on: "
                        "when_lost = \"pause\" and clock = \"follow\" stand still, too",
                        source.feed->description()));
    return false;
}

// Once: a source that never gives one is misunderstood, or another program.
void LiveFeeds::report_no_place(Source& source) {
    const FeedCounts counts = source.feed->counts();
    const double waited_s = static_cast<double>(steady_clock_ns() - source.opened_ns) * 1e-9;
    if (source.no_place_told || counts.samples > 0) return;
    if (waited_s < std::min(source.settings.lost_after.value(), longest_without_place_s)) return;
    source.no_place_told = true;
    std::string received = "nothing was received";
    if (counts.bytes > 0) received = fmt::format("{} bytes were received, none of them a position", counts.bytes);
    if (counts.refused > 0) received += fmt::format("; {} messages were refused", counts.refused);
    news_.push_back(
        fmt::format("{}: no position in the first {:.1f} s: {}", source.feed->description(), waited_s, received));
}

// The run stands still for one that is lost.
bool LiveFeeds::is_waited_for() const {
    return std::any_of(sources_.begin(), sources_.end(), [](const auto& s) { return s->lost && s->pauses(); });
}

// By the wall clock: a source that leads stops the run's own.
void LiveFeeds::look_for_silence(Source& source, std::vector<Command>& commands) {
    const std::int64_t now_ns = steady_clock_ns();
    const FeedCounts counts = source.feed->counts();
    if (counts.statements != source.statements || source.feed->is_waited_on()) source.heard_ns = now_ns;
    source.statements = counts.statements;
    const double silent_s = static_cast<double>(now_ns - source.heard_ns) * 1e-9;
    const bool over = source.feed->ended(), halted = halts(source);
    const bool speaks = !over && !halted && silent_s < source.settings.lost_after.value();
    if (source.lost && speaks) {
        source.lost = false;
        news_.push_back(fmt::format("{}: heard again", source.feed->description()));
        if (source.pauses() && !is_waited_for()) commands.push_back(plain_command(CommandVerb::resume, silence_source));
    }
    // What has never told a place is waited for, not lost.
    if (source.lost || speaks || counts.samples == 0) return;
    source.lost = true;
    ++source.times_lost;
    static constexpr std::array<std::string_view, 4> consequences{"the vehicle stands still", "the signals are gone",
                                                                  "time stands still", "the run ends"};
    news_.push_back(fmt::format("{}: {}; {}", source.feed->description(),
                                over     ? "has said goodbye"
                                : halted ? "has paused"
                                         : fmt::format("nothing heard for {:.1f} s", silent_s),
                                consequences[static_cast<std::size_t>(source.settings.when_lost)]));
    switch (source.settings.when_lost) {
        case LostSource::hold:
            return;
        case LostSource::outage:
            source.known_at_loss = source.known_until();
            source.outage_end.reset();
            if (!source.outage.empty()) return;  // the run has not come to the end of the one before
            source.outage = fmt::format("{} lost {}", source.settings.source, source.times_lost);
            return commands.push_back(
                checked_live_fault({{"kind", std::string("outage")}, {"name", source.outage}}, "feed").value());
        case LostSource::pause:
            return commands.push_back(plain_command(CommandVerb::pause, silence_source));
        case LostSource::stop:
            return commands.push_back(plain_command(CommandVerb::stop));
    }
}

// A run that is led stood still meanwhile, and has the time of the silence yet to go.
void LiveFeeds::end_outage(Source& source, GpsTime now, std::vector<Command>& commands) {
    if (source.outage.empty() || source.lost) return;
    if (!source.outage_end) {
        const auto known = source.known_until();
        if (source.leads() && known == source.known_at_loss) return;  // heard, and not on the path yet
        source.outage_end = source.leads() ? known : now;
    }
    if (now < *source.outage_end) return;
    source.outage_end.reset();
    commands.push_back(plain_command(CommandVerb::stop_fault));
    commands.back().parameters = Parameters({{"fault", std::exchange(source.outage, {})}});
}

std::string_view LiveFeeds::keeps_speed() const {
    return leads() ? "the live source leads the run's time" : "a live trajectory with clock = \"realtime\" runs at 1";
}

std::optional<GpsTime> LiveFeeds::horizon() const { return leader_->horizon(); }

void LiveFeeds::rest(std::uint64_t bytes_out) {
    constexpr std::chrono::milliseconds little_while{50};
    const auto reached = leader_->horizon();
    if (reached && reached != answered_) {
        answered_ = reached;
        leader_->stepped(bytes_out - bytes_told_);
        bytes_told_ = bytes_out;
    }
    (void)leader_->wait(little_while);
}

bool LiveFeeds::all_heard() const {
    return std::all_of(sources_.begin(), sources_.end(), [](const auto& source) { return source->is_known(); });
}

std::string LiveFeeds::waits_for() const {
    std::string names;
    for (const auto& source : sources_)
        if (source->waited_for) names += (names.empty() ? "waiting for " : ", ") + source->feed->description();
    return names;
}

void LiveFeeds::on_command(const CommandSeen& seen) {
    if (seen.ignored.empty() || seen.command.source != "feed") return;
    const std::string speaker = sources_.size() == 1 ? sources_.front()->feed->description() : "a live source";
    news_.push_back(fmt::format("{}: {} is not done: {}", speaker, command_name(seen.command.verb), seen.ignored));
}

void LiveFeeds::note_epoch(GpsTime now) {
    for (const auto& source : sources_)
        for (const auto& path : source->paths)
            if (const auto newest = path->newest()) source->age.add(now - *newest);
}

std::vector<std::string> LiveFeeds::take_news() { return std::exchange(news_, {}); }

std::vector<std::string> LiveFeeds::descriptions() const {
    std::vector<std::string> all;
    for (const auto& source : sources_)
        all.push_back(source->feed->description());
    return all;
}

std::vector<FeedReport> LiveFeeds::reports() const {
    std::vector<FeedReport> reports;
    for (const auto& source : sources_) {
        FeedReport report{
            source->feed->description(),  std::string(clock_names[static_cast<std::size_t>(source->settings.clock)]),
            source->feed->counts(),       {},
            source->feed->clock().rate(), source->age};
        std::vector<const LivePath*> counted;
        for (const auto& path : source->paths) {
            if (std::find(counted.begin(), counted.end(), path.get()) != counted.end()) continue;
            counted.push_back(path.get());
            const LivePathCounts& c = path->counts();
            report.paths.samples += c.samples;
            report.paths.late += c.late;
            report.paths.refused += c.refused;
            report.paths.jumps += c.jumps;
            report.paths.coasts += c.coasts;
            report.paths.holds += c.holds;
        }
        reports.push_back(std::move(report));
    }
    return reports;
}

}  // namespace skyloop::inline run
