/// When the messages of an epoch begin to leave, and which.
#pragma once

#include <memory>
#include <optional>

#include "base/core/random.hpp"
#include "firmware/core/parts.hpp"

namespace skyloop::firmware {

/// State: when the last ones began, and what the last text said of the antenna.
class EpochReporter {
public:
    /// @param seed of the jitter of the latency
    EpochReporter(ReceiverParts& parts, std::uint64_t seed) : parts_(parts), latency_noise_(seed, "receiver.latency") {}

    /// Plans the messages of an epoch, as often as it is to be reported.
    /// @param epoch when it was, whatever the state says that it was
    /// @return when they begin to leave
    GpsTime plan(const std::shared_ptr<const NavigationState>& state, GpsTime epoch);
    void restart(GpsTime now) { last_burst_ = now, reported_antenna_.reset(); }
    /// The texts of a start. @param woken it was off, not without power
    void send_banner(GpsTime now, bool woken);

private:
    [[nodiscard]] GpsTime burst_time(GpsTime epoch);
    void send(const NavigationState& state, GpsTime now);
    void report_overflow(PortUnit& unit, GpsTime now);
    void report_antenna(AntennaStatus status, GpsTime now);

    ReceiverParts& parts_;
    RandomStream latency_noise_;
    GpsTime last_burst_{};
    std::optional<AntennaStatus> reported_antenna_;
};

}  // namespace skyloop::firmware
