#include "base/core/signals_held_back.hpp"

#include <csignal>

namespace skyloop {

void with_signals_held_back(const std::function<void()>& start) {
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    start();
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace skyloop
