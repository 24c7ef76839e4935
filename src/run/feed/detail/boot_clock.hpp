// The clock that a vehicle counts from its start, known from some of its messages, read for the others.
#pragma once

#include <cstdint>
#include <optional>

#include "base/time/gps_time.hpp"

namespace skyloop {

// Runs at its own rate, which need not be ours: simulators hurry and dawdle. State: the last message, and the line
// through them.
class BootClock {
public:
    // Its messages in the order of their arrival.
    void heard(Nanoseconds boot, std::int64_t received_ns);
    // Nothing before the first message.
    [[nodiscard]] std::optional<Nanoseconds> at(std::int64_t received_ns) const;

private:
    std::optional<std::int64_t> boot_ns_;  // on the line, at received_ns_
    std::int64_t received_ns_ = 0;
    std::int64_t said_ns_ = 0;  // by the last message
    double rate_ = 1;
};

}  // namespace skyloop
