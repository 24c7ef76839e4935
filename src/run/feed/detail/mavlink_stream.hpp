// MAVLink frames out of datagrams and streams alike.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "receiver/protocol/mavlink.hpp"

namespace skyloop {

// Cuts bytes into frames. Frames of messages that are not known are passed over by their length where another frame or
// nothing follows them; anything else is searched byte by byte. State: at most the beginning of one frame.
class MavlinkStream {
public:
    // Calls take(const MavlinkFrameView&) for every whole frame of a known message; the view lives during the call.
    template <class Take>
    void feed(ByteSpan bytes, Take&& take) {
        pending_.insert(pending_.end(), bytes.begin(), bytes.end());
        std::size_t at = 0;
        while (at < pending_.size()) {
            const ByteSpan rest = ByteSpan(pending_).subspan(at);
            if (rest[0] != mavlink_v1_start && rest[0] != mavlink_v2_start) {
                ++at;
                continue;
            }
            const auto size = mavlink_frame_size(rest);
            if (!size || *size > rest.size()) break;
            const auto frame = parse_mavlink(rest.first(*size));
            const bool whole = frame || is_passed_over(rest, *size);
            if (whole) ++frames_;
            if (frame) take(*frame);
            at += whole ? *size : 1;
        }
        pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(at));
    }
    void clear() { pending_.clear(); }
    // Whole frames so far, of messages that are not known, too.
    [[nodiscard]] std::uint64_t frames() const { return frames_; }
    // Frames of known messages with a wrong checksum or flags that are not known, since this was asked.
    std::size_t take_broken() { return std::exchange(broken_, 0); }

private:
    bool is_passed_over(ByteSpan rest, std::size_t size) {
        if (mavlink_crc_extra(*mavlink_message_id(rest))) {
            ++broken_;
            return false;
        }
        return rest.size() == size || rest[size] == mavlink_v1_start || rest[size] == mavlink_v2_start;
    }

    Bytes pending_;
    std::uint64_t frames_ = 0;
    std::size_t broken_ = 0;
};

}  // namespace skyloop
