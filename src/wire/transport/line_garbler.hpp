/// What a UART makes of bytes that were sent at another speed than its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/core/bytes.hpp"

namespace skyloop::inline wire {

/// Lays bytes out on a line as 8N1 bits of the sender's length and reads them as the listener's UART does: a falling
/// edge starts a byte, every bit is sampled at the listener's bit centres, and a low stop bit is a framing error, which
/// gives a NUL and waits for the line to rise. From 96 to 105 % of the sender's speed bytes arrive whole (WIRES.md
/// section 1).
///
/// Bytes passed in follow one another without a gap until idle() is called; how they are split over calls makes no
/// difference. Time is counted in whole units, so the result is exact. State: the part of the line not yet read.
class LineGarbler {
public:
    /// Speeds in bit/s, above zero.
    LineGarbler(std::uint32_t sender_baud, std::uint32_t listener_baud);

    /// New speeds; anything else than the present ones loses the byte that is on its way.
    void set_bauds(std::uint32_t sender_baud, std::uint32_t listener_baud);
    /// What the listener has read by the end of these bytes' last stop bit. Equal speeds pass bytes on as they are.
    Bytes pass(ByteSpan sent);
    /// The line rests at its high level for longer than a byte: what the listener makes of what was still on its way.
    Bytes idle();
    /// Nothing is on its way: idle() would give nothing and change nothing.
    [[nodiscard]] bool resting() const { return line_.empty() && state_ == State::hunting; }
    /// Bytes whose stop bit was low.
    [[nodiscard]] std::uint64_t framing_errors() const { return framing_errors_; }

private:
    enum class State { hunting, receiving, waiting_for_high };

    void listen(Bytes& heard, bool idle);
    bool find(bool level, bool idle);
    bool sample(Bytes& heard, bool idle);
    void forget_passed();

    // One unit is 1 / (2 · sender · listener) s.
    std::int64_t sender_bit_ = 1;
    std::int64_t listener_half_bit_ = 1;
    std::vector<bool> line_;  // levels from `at` 0 on, one per sender bit
    std::int64_t at_ = 0;     // where the listener looks next
    State state_ = State::hunting;
    int bit_ = 0;  // 0 start, 1 … 8 data, 9 stop
    std::uint8_t byte_ = 0;
    std::uint64_t framing_errors_ = 0;
};

}  // namespace skyloop::inline wire
