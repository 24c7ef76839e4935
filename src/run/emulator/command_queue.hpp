/// The door by which other threads ask the loop for something.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

#include "run/fault/command.hpp"

namespace skyloop::inline run {

/// Commands on their way from other threads to the loop, which takes them between two instants.
class CommandQueue {
public:
    /// False when too many wait already; the command is not taken then.
    bool push(Command command);
    /// All that have come, in the order of coming.
    std::vector<Command> take();

private:
    static constexpr std::size_t most = 256;
    std::mutex mutex_;
    std::vector<Command> waiting_;
};

}  // namespace skyloop::inline run
