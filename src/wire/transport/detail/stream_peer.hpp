/// Whole messages into a stream that takes as many bytes as it likes.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>

#include "base/core/bytes.hpp"

namespace skyloop {

/// One other end of a stream.
///
/// State: what it has not taken of its last message, and whether it has been too slow to be waited for.
class StreamPeer {
public:
    /// Offers bytes to the stream; gives how many were taken.
    using Write = std::function<std::size_t(ByteSpan)>;
    /// Returns when the stream may take more, or after a few milliseconds.
    using Wait = std::function<void()>;

    /// False: the message is not sent, since a part of an earlier one still is before it.
    /// @param patience to wait for an other end that has not been too slow before
    bool send(ByteSpan message, std::chrono::milliseconds patience, const Write& write, const Wait& wait);
    /// Goes on with the rest; true: there is none any more.
    bool flush(const Write& write);
    /// flush() until it is true or the patience is over.
    bool flush_within(std::chrono::milliseconds patience, const Write& write, const Wait& wait);
    /// The stream is a new one.
    void forget() { rest_.clear(); }
    [[nodiscard]] bool slow() const { return slow_; }

private:
    Bytes rest_;
    bool slow_ = false;
};

}  // namespace skyloop
