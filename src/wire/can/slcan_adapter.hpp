/// An adapter between a serial line and a CAN bus that is not there: its end of SLCAN.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/can_frame.hpp"

namespace skyloop::inline wire {

/// Takes what a host writes to its adapter, and answers as one (Lawicel CANUSB manual, version 1.03; the commands that
/// pydronecan, slcand and ArduPilot's SLCAN use). A line that is done is answered with a carriage return, one that is
/// not with BEL; a frame that goes out with "z" or "Z" before the carriage return. Speeds are taken and make no
/// difference. While the channel is closed no frame passes. Listening alone (L) lets none out.
///
/// State: the channel, time stamps, the unfinished line, frames that were refused since F was asked.
class SlcanAdapter {
public:
    /// What comes of bytes of the host.
    struct Taken {
        std::string answers;             ///< to the host
        std::vector<CanFrame> frames{};  ///< to the bus
    };
    Taken take(ByteSpan bytes);
    /// The line of a frame from the bus; empty while the channel is closed. @param time_ms for its time stamp
    [[nodiscard]] std::string line_of(const CanFrame& frame, std::uint64_t time_ms) const;
    [[nodiscard]] bool is_open() const { return open_; }
    /// As when its host has gone.
    void close() { open_ = listens_ = stamps_ = false; }

private:
    std::string answer(std::string_view line, std::vector<CanFrame>& frames);
    std::string open_channel(bool listens);
    std::string send(std::string_view line, std::vector<CanFrame>& frames) const;

    SlcanLines lines_;
    bool open_ = false, listens_ = false, stamps_ = false;
};

}  // namespace skyloop::inline wire
