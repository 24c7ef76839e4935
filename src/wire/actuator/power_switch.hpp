/// An actuator that a run switches without waiting for it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/core/file_descriptor.hpp"
#include "base/core/result.hpp"
#include "wire/actuator/actuator.hpp"
#include "wire/actuator/power_watchdog.hpp"

namespace skyloop::inline wire {

/// What a switch has done.
struct PowerCounts {
    std::uint64_t cuts = 0, restores = 0;  ///< that succeeded
    std::uint64_t failures = 0;            ///< orders not carried out, after several tries; cuts that did not last
    double slowest_ms = 0;                 ///< of one order, its further tries among it
};

/// How a switch comes by its actuator, and by a fresh one when the first has failed.
using OpenActuator = std::function<Result<std::unique_ptr<Actuator>>()>;

/// Switches in a thread of its own, in the order in which it was asked.
///
/// State: what is wanted, what has been reached, the actuator. When it goes, the power is on, or has been tried for.
class PowerSwitch {
public:
    struct Parts {
        std::string name;  ///< for messages: the URI
        OpenActuator open;
        PowerWatchdog* watchdog = nullptr;  ///< outlives the switch; null: nobody restores after a crash
        std::size_t ward = 0;               ///< the switch's place among those of the watchdog
    };
    /// Opens the actuator, keeps other switches off it, and restores, so that a run begins with the power on. Fails as
    /// OpenActuator and Actuator::restore() do, with `outside` when another switch has it. Waits for the hardware.
    static Result<std::unique_ptr<PowerSwitch>> start(Parts parts);
    ~PowerSwitch();
    PowerSwitch(const PowerSwitch&) = delete;
    PowerSwitch& operator=(const PowerSwitch&) = delete;

    /// Called by one thread, that of the loop; never waits. Asking for what is wanted already changes nothing.
    void want(PowerState state);
    /// What went wrong since the last call, in sentences; nothing while the other thread is about to write one.
    std::vector<std::string> take_news();
    /// Gives up what is still waiting, restores where the power is not known to be on, and ends the thread. Waits.
    void finish();
    [[nodiscard]] PowerCounts counts() const;
    [[nodiscard]] const std::string& name() const { return parts_.name; }
    /// Of the actuator that it began with.
    [[nodiscard]] const std::string& description() const { return description_; }

private:
    explicit PowerSwitch(Parts parts);
    [[nodiscard]] Result<void> open();
    [[nodiscard]] Result<void> lock();
    void work();
    void follow(PowerState wanted);
    void look_at_cut();
    [[nodiscard]] bool is_outdated(PowerState wanted) const;
    Result<void> try_once(PowerState wanted);
    [[nodiscard]] Result<void> try_repeatedly(PowerState wanted);
    void tell(std::string news);

    Parts parts_;
    std::string description_;
    FileDescriptor lock_;
    std::unique_ptr<Actuator> actuator_;  // of the thread alone once that runs; null: to be opened anew
    bool known_on_ = true;                // likewise
    std::uint64_t followed_ = 0;          // likewise: orders, that which is being carried out among them
    std::optional<std::chrono::steady_clock::time_point> cut_at_{};  // likewise: since a cut succeeded
    // Orders alternate, so that their number says everything: odd, and a cut is wanted. The top bit ends the thread.
    std::atomic<std::uint64_t> orders_{0};
    mutable std::mutex told_mutex_;
    std::vector<std::string> news_;
    PowerCounts counts_;
    std::thread thread_;
};

}  // namespace skyloop::inline wire
