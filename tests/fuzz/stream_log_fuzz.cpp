// Any bytes as a stream of UBX and NMEA: a clear error or epochs in order, never a crash, a hang or a place that is
// none.
#include <cmath>
#include <cstdint>

#include "require.hpp"
#include "skyloop/logs/log_events.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const auto log = read_receiver_log({data, size}, "fuzz.log", {});
    if (!log) {
        require(log.error().message.starts_with("fuzz.log: "));
        require(log.error().message.find('\n') == std::string::npos);
        return 0;
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
    return 0;
}
