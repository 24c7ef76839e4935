/// Threads that take no signals.
#pragma once

#include <csignal>

namespace skyloop {

/// While it lives, the calling thread takes no signals, nor ever do the threads that it starts meanwhile: a signal that
/// ends the program must interrupt the thread that waits for it, not a helper.
class SignalsHeldBack {
public:
    SignalsHeldBack() {
        sigset_t all;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    ~SignalsHeldBack() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    SignalsHeldBack(const SignalsHeldBack&) = delete;
    SignalsHeldBack& operator=(const SignalsHeldBack&) = delete;

private:
    sigset_t before_{};
};

}  // namespace skyloop
