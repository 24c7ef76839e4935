#include "base/core/steady_clock.hpp"

#include <ctime>

namespace skyloop {

std::int64_t steady_clock_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

}  // namespace skyloop
