#include "wire/transport/line_garbler.hpp"

#include <algorithm>

namespace skyloop::inline wire {

LineGarbler::LineGarbler(std::uint32_t sender_baud, std::uint32_t listener_baud) {
    set_bauds(sender_baud, listener_baud);
}

void LineGarbler::set_bauds(std::uint32_t sender_baud, std::uint32_t listener_baud) {
    const std::int64_t sender_bit = 2 * std::int64_t{std::max(listener_baud, 1U)};
    const std::int64_t listener_half_bit = std::max(sender_baud, 1U);
    if (sender_bit == sender_bit_ && listener_half_bit == listener_half_bit_) return;
    sender_bit_ = sender_bit;
    listener_half_bit_ = listener_half_bit;
    line_.clear();
    at_ = 0;
    state_ = State::hunting;
}

Bytes LineGarbler::pass(ByteSpan sent) {
    if (sender_bit_ == 2 * listener_half_bit_) return {sent.begin(), sent.end()};
    Bytes heard;
    for (const std::uint8_t byte : sent) {
        line_.push_back(false);
        for (unsigned bit = 0; bit < 8; ++bit)
            line_.push_back(((byte >> bit) & 1U) != 0);
        line_.push_back(true);
        listen(heard, false);
    }
    return heard;
}

Bytes LineGarbler::idle() {
    Bytes heard;
    listen(heard, true);
    line_.clear();
    at_ = 0;
    state_ = State::hunting;
    return heard;
}

void LineGarbler::listen(Bytes& heard, bool idle) {
    for (bool more = true; more;) {
        switch (state_) {
            case State::hunting:
                more = find(false, idle);
                if (more) {
                    state_ = State::receiving;
                    bit_ = 0;
                    byte_ = 0;
                    at_ += listener_half_bit_;
                }
                break;
            case State::waiting_for_high:
                more = find(true, idle);
                if (more) state_ = State::hunting;
                break;
            case State::receiving:
                more = sample(heard, idle);
                break;
        }
    }
    forget_passed();
}

// Moves to the first moment from now on at which the line has this level; false when that has not come yet.
bool LineGarbler::find(bool level, bool idle) {
    const auto size = static_cast<std::int64_t>(line_.size());
    std::int64_t index = at_ / sender_bit_;
    while (index < size && line_[static_cast<std::size_t>(index)] != level)
        ++index;
    at_ = std::max(at_, index * sender_bit_);
    return index < size || (idle && level);
}

bool LineGarbler::sample(Bytes& heard, bool idle) {
    const std::int64_t index = at_ / sender_bit_;
    const bool on_line = index < static_cast<std::int64_t>(line_.size());
    if (!on_line && !idle) return false;
    const bool high = !on_line || line_[static_cast<std::size_t>(index)];
    if (bit_ == 0 && high) {  // too short a pulse for a start bit
        state_ = State::hunting;
        return true;
    }
    if (bit_ == 9) {
        if (!high) ++framing_errors_;
        heard.push_back(high ? byte_ : std::uint8_t{0});
        state_ = high ? State::hunting : State::waiting_for_high;
        return true;
    }
    if (bit_ > 0 && high) byte_ = static_cast<std::uint8_t>(byte_ | (1U << (bit_ - 1)));
    ++bit_;
    at_ += 2 * listener_half_bit_;
    return true;
}

// Drops the levels before the place the listener looks at next, and counts time from the first that is left.
void LineGarbler::forget_passed() {
    const std::int64_t passed = std::min(at_ / sender_bit_, static_cast<std::int64_t>(line_.size()));
    line_.erase(line_.begin(), line_.begin() + passed);
    at_ -= passed * sender_bit_;
}

}  // namespace skyloop::inline wire
