/// Puts the power back when the program no longer can.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/watchdog_process.hpp"

namespace skyloop::inline wire {

/// A process of its own that outlives a crash, or a kill -9, of the program that started it: when that is gone, it
/// restores by fresh handles what had been cut, says so on stderr, and ends. It is in a session of its own and takes no
/// signal that ends programs in order, so that a Ctrl-C, or a signal to the program's process group, does not take it
/// along. What takes it along: whoever kills every process of a container or of a service, and the loss of the machine.
class PowerWatchdog {
public:
    /// Forks: to be called before the program has any other thread. @param wards URIs of open_actuator()
    /// Fails with `outside` when the system has no process to spare.
    static Result<std::unique_ptr<PowerWatchdog>> start(const std::vector<std::string>& wards);

    /// Before a ward is cut. Fails with `outside` when the watchdog is gone: then nothing should be cut.
    Result<void> note_cut(std::size_t ward);
    /// After it has been restored.
    void note_restored(std::size_t ward);
    /// The process group of a command that works on the ward; nothing: none does any more. What is left of it when the
    /// program is gone is killed before the ward is restored, lest it cut the power afterwards.
    void note_group(std::size_t ward, std::optional<int> group);

private:
    explicit PowerWatchdog(std::unique_ptr<WatchdogProcess> process) : process_(std::move(process)) {}
    [[nodiscard]] bool note(char what, std::size_t ward, int group = 0) const;

    std::unique_ptr<WatchdogProcess> process_;
};

}  // namespace skyloop::inline wire
