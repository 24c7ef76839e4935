#include "run/emulator/command_queue.hpp"

#include <utility>

namespace skyloop {

bool CommandQueue::push(Command command) {
    const std::scoped_lock lock(mutex_);
    if (waiting_.size() >= most) return false;
    waiting_.push_back(std::move(command));
    return true;
}

std::vector<Command> CommandQueue::take() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(waiting_, {});
}

}  // namespace skyloop
