/// A wire that ends in the program itself.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "wire/transport/transport.hpp"

namespace skyloop {

/// Keeps what is written and hands out what is fed; the other end is whatever the owner says it is.
class MemoryTransport : public Transport {
public:
    std::size_t write(ByteSpan bytes) override {
        if (!state_.connected) return bytes.size();
        const std::size_t taken = std::min(bytes.size(), room_);
        room_ -= taken;
        const ByteSpan accepted = bytes.first(taken);
        written_.insert(written_.end(), accepted.begin(), accepted.end());
        return taken;
    }
    Bytes read() override { return std::exchange(incoming_, {}); }
    LineState line() override { return state_; }
    void set_receiver_baud(std::uint32_t baud) override { receiver_baud_ = baud; }
    [[nodiscard]] std::string description() const override { return "memory"; }

    /// Everything taken since the start.
    [[nodiscard]] const Bytes& written() const { return written_; }
    [[nodiscard]] std::uint32_t receiver_baud() const { return receiver_baud_; }
    /// The next read() gives these bytes too.
    void feed(ByteSpan bytes) { incoming_.insert(incoming_.end(), bytes.begin(), bytes.end()); }
    void set_line(LineState state) { state_ = state; }
    /// A slow other end: takes this many more bytes and then none.
    void set_room(std::size_t bytes) { room_ = bytes; }

private:
    Bytes written_;
    Bytes incoming_;
    LineState state_{true, std::nullopt};
    std::size_t room_ = std::numeric_limits<std::size_t>::max();
    std::uint32_t receiver_baud_ = 0;
};

}  // namespace skyloop
