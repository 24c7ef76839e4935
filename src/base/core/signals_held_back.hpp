/// Threads that take no signals.
#pragma once

#include <functional>

namespace skyloop {

/// Runs `start` while the calling thread takes no signals; the threads that it starts never will. A signal that ends
/// the program must interrupt the thread that waits for it, not a helper.
void with_signals_held_back(const std::function<void()>& start);

}  // namespace skyloop
