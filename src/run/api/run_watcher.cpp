#include "detail/run_watcher.hpp"

#include <utility>

#include "run/control/status_json.hpp"

namespace skyloop::inline run {
namespace {

std::shared_ptr<const firmware::NavigationState> without_fix(firmware::NavigationState state) {
    state.epoch.fix.type = FixType::none;
    state.epoch.fix.satellites.clear();
    state.fix_ok = false;
    return std::make_shared<const firmware::NavigationState>(std::move(state));
}

}  // namespace

RunWatcher::RunWatcher(StatusSetup setup, const std::vector<Station>& stations, StatusSources sources)
    : stations_(stations),
      traces_(stations.size()),
      reports_(stations.size()),
      silence_(setup.start),
      board_(std::move(setup), &stations, [&] {
          constexpr std::int64_t a_while_ns = 10'000'000'000;
          sources.clock = [this] { return clock_ns_ += a_while_ns; };
          return std::move(sources);
      }()) {}

void RunWatcher::on_epoch(const EpochSeen& seen) {
    traces_[seen.station] = seen.trace;
    std::optional<Report>& report = reports_[seen.station];
    const bool silent = silence_.is_silent(seen, seen.now);
    if (seen.leaves)
        report = Report{stations_[seen.station].receiver().kept_state(), seen.trace.truth};
    else if (silent && report && !report->expired)
        report = Report{without_fix(*report->state), report->truth, true};
}

const Report* RunWatcher::report(std::size_t station) const {
    return reports_[station] ? &*reports_[station] : nullptr;
}

void RunWatcher::on_fault(const FaultSeen& seen) {
    faults_.emplace(seen.name);
    board_.on_fault(seen);
}

void RunWatcher::on_command(const CommandSeen& seen) {
    if (seen.command.verb == CommandVerb::move_to) ++moves_;
    board_.on_command(seen);
}

std::string RunWatcher::status(GpsTime now) {
    if (!std::exchange(stale_, false)) return recent_status_json(*board_.latest());
    for (std::size_t i = 0; i < traces_.size(); ++i)
        if (traces_[i]) {
            const firmware::NavigationState& told = reports_[i] ? *reports_[i]->state : stations_[i].receiver().state();
            const GpsTime time = traces_[i]->truth.time;
            board_.on_epoch(
                {time, i, *traces_[i], told, Nanoseconds(0), reports_[i] ? std::optional(time) : std::nullopt});
        }
    board_.publish_now(now);
    return recent_status_json(*board_.latest());
}

}  // namespace skyloop::inline run
