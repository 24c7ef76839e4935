#include "detail/stream_peer.hpp"

#include <algorithm>

namespace skyloop {

bool StreamPeer::flush(const Write& write) {
    if (rest_.empty()) return true;
    const std::size_t taken = std::min(write(rest_), rest_.size());
    rest_.erase(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(taken));
    return rest_.empty();
}

bool StreamPeer::flush_within(std::chrono::milliseconds patience, const Write& write, const Wait& wait) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (!flush(write)) {
        if (std::chrono::steady_clock::now() >= end) return false;
        wait();
    }
    return true;
}

bool StreamPeer::send(ByteSpan message, std::chrono::milliseconds patience, const Write& write, const Wait& wait) {
    const bool waits = patience.count() > 0 && !slow_;
    if (!(waits ? flush_within(patience, write, wait) : flush(write))) {
        slow_ = true;
        return false;
    }
    const std::size_t taken = std::min(write(message), message.size());
    rest_.assign(message.begin() + static_cast<std::ptrdiff_t>(taken), message.end());
    return true;
}

}  // namespace skyloop
