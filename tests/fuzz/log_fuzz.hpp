/// Any bytes as the log of a receiver: a clear error or epochs in order, never a crash, a hang or a place that is none.
#pragma once

#include <cmath>
#include <cstdint>

#include "receiver/observed/log_events.hpp"
#include "require.hpp"

namespace skyloop {

inline void read_any_log(ByteSpan bytes) {
    const auto log = read_observed(bytes, "fuzz.log", {});
    if (!log) {
        require(log.error().message.starts_with("fuzz.log: "));
        require(log.error().message.find('\n') == std::string::npos);
        return;
    }
    require(!log->epochs.empty());
    for (std::size_t i = 0; i < log->epochs.size(); ++i) {
        require(i == 0 || log->epochs[i - 1].time < log->epochs[i].time);
        if (log->epochs[i].place) require(to_ecef(*log->epochs[i].place).vector().allFinite());
    }
    const LogEvents found = find_events(*log, {});
    for (const LogEvent& event : found.events)
        require(event.at.count() >= 0 && event.lasts.count() > 0);
    (void)scenario_of_log(*log, found);
}

}  // namespace skyloop
