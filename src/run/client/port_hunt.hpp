/// Finding the speed of a receiver's line.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/time/gps_time.hpp"

namespace skyloop {

/// Tries one speed after the other until it is told that something whole was heard.
///
/// ArduPilot tries each of its speeds for 1.2 s, Betaflight for about a second (RECEIVER.md 6.2, 6.4).
class PortHunt {
public:
    /// @param speeds bit/s, in the order of trial, at least one
    /// @param dwell how long each is tried
    PortHunt(std::vector<std::uint32_t> speeds, Nanoseconds dwell) : speeds_(std::move(speeds)), dwell_(dwell) {}

    /// Begins with the speed at which there was something last, then tries them all, again and again.
    void start(GpsTime now);
    /// Whether it is time to speak up at a new speed.
    bool advance(GpsTime now);
    /// Something whole was heard at this speed.
    void found();
    [[nodiscard]] bool hunting() const { return hunting_; }
    [[nodiscard]] std::uint32_t speed() const { return speed_; }
    /// The client has made the receiver change to another speed.
    void set_speed(std::uint32_t speed) { speed_ = speed; }

private:
    std::vector<std::uint32_t> speeds_;
    Nanoseconds dwell_;
    bool hunting_ = false, first_ = true;
    std::size_t next_ = 0;
    std::uint32_t speed_ = 9600;
    std::optional<std::uint32_t> known_;
    GpsTime since_{};
};

/// The speeds at which receivers are found, the usual factory settings first, bit/s.
std::vector<std::uint32_t> usual_speeds();

}  // namespace skyloop
