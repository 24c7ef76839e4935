/// Bytes that wait until whoever they are for takes them.
#pragma once

#include <cstddef>

#include "base/core/bytes.hpp"

namespace skyloop {

/// A queue of bytes in one piece, from whose front any number leaves.
///
/// An other end that is always a little behind never empties it: what has left goes with the next bytes that come once
/// it is more than what waits, so that no byte is moved more than once and twice what waits is held.
class SendBuffer {
public:
    void add(ByteSpan bytes) {
        if (sent_ > size()) {
            bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(sent_));
            sent_ = 0;
        }
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    /// So many have left, at most size().
    void sent(std::size_t count) {
        sent_ += count;
        if (sent_ >= bytes_.size()) clear();
    }
    void clear() {
        bytes_.clear();
        sent_ = 0;
    }

    [[nodiscard]] ByteSpan waiting() const { return ByteSpan(bytes_).subspan(sent_); }
    [[nodiscard]] std::size_t size() const { return bytes_.size() - sent_; }
    [[nodiscard]] bool empty() const { return size() == 0; }
    /// With those that have left and are not given up yet.
    [[nodiscard]] std::size_t held() const { return bytes_.size(); }

private:
    Bytes bytes_;
    std::size_t sent_ = 0;  // of them
};

}  // namespace skyloop
