// When what a receiver says of one epoch is whole.
#pragma once

#include <utility>

namespace skyloop {

// An epoch's messages come one after the other and none says that it is the last. An epoch is whole when every kind of
// message has come that the one before had, so that nobody waits for the next; the first is whole when the second
// begins. Kinds are bits.
class EpochGate {
public:
    EpochGate() = default;
    // @param expected of the first epoch, which then is whole by it
    explicit EpochGate(unsigned expected) : expected_(expected) {}
    // Another message of the epoch. @return the epoch has become whole by it
    bool take(unsigned kind) {
        seen_ |= kind;
        const bool whole = expected_ != 0 && (seen_ & expected_) == expected_;
        return whole && !std::exchange(done_, true);
    }
    // The next epoch begins. @return the one before had messages and never became whole
    bool next() {
        const bool left = seen_ != 0 && !done_;
        if (seen_ != 0) expected_ = seen_;
        seen_ = 0;
        done_ = false;
        return left;
    }

private:
    unsigned seen_ = 0, expected_ = 0;
    bool done_ = false;
};

}  // namespace skyloop
