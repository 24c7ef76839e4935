#include "run_watcher.hpp"

#include <utility>

#include "skyloop/control/status_json.hpp"

namespace skyloop {

RunWatcher::RunWatcher(StatusSetup setup, const std::vector<Station>& stations, StatusSources sources)
    : stations_(stations), traces_(stations.size()), board_(std::move(setup), &stations, [&] {
          constexpr std::int64_t a_while_ns = 10'000'000'000;
          sources.clock = [this] { return clock_ns_ += a_while_ns; };
          return std::move(sources);
      }()) {}

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
        if (traces_[i])
            board_.on_epoch({traces_[i]->truth.time, i, *traces_[i], stations_[i].receiver().state(), Nanoseconds(0)});
    board_.publish_now(now);
    return recent_status_json(*board_.latest());
}

}  // namespace skyloop
