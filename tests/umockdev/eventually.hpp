/// Waiting for what other threads do.
#pragma once

#include <chrono>
#include <thread>

namespace skyloop::mock {

/// Asks until the answer is yes, for up to five seconds: whether it was.
template <class Question>
bool eventually(const Question& question) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    while (!question()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
}

}  // namespace skyloop::mock
