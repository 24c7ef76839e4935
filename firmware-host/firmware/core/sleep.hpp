/// Being off: what has been asked for, what is under way, and what ends it (u-blox M8 receiver description
/// UBX-13003221, 13; NEO-M9N integration manual UBX-19014286, 3.11).
#pragma once

#include <algorithm>
#include <functional>
#include <optional>

#include "firmware/core/parts.hpp"

namespace skyloop::firmware {

/// A time of being off, planned or under way.
struct Sleep {
    std::optional<GpsTime> until{};  ///< nothing: until it is woken
    std::uint32_t wakes = 0;         ///< what does
    bool saves_power = false;        ///< by itself; otherwise a client has asked for it
    GpsTime since{};                 ///< once under way
};

/// State: one such time.
class SleepControl {
public:
    /// @param entered what happens when it goes off
    SleepControl(ReceiverParts& parts, std::function<void()> entered) : parts_(parts), entered_(std::move(entered)) {}

    [[nodiscard]] bool is_off() const { return under_way_.has_value(); }
    /// Whether nothing more is measured: it is off, or will be when all has left that is to be sent.
    [[nodiscard]] bool is_planned() const { return planned_ || under_way_; }
    /// Goes off when all has left that is queued by `from`.
    void plan(const Sleep& sleep, GpsTime from);
    /// It does not go off by itself.
    void cancel_saving() {
        if (planned_ && planned_->saves_power) planned_.reset();
    }
    [[nodiscard]] bool is_over(GpsTime now) const { return is_off() && under_way_->until && *under_way_->until <= now; }
    /// When it was over, if it is.
    [[nodiscard]] std::optional<GpsTime> over_at(GpsTime now) const {
        return is_over(now) ? std::optional(std::max(*under_way_->until, under_way_->since)) : std::nullopt;
    }
    /// Whether what a port receives wakes it.
    [[nodiscard]] bool is_ended_by(PortId port) const;
    /// It is on again, or is not to go off.
    Sleep end();
    void clear() { planned_.reset(), under_way_.reset(); }
    [[nodiscard]] std::optional<GpsTime> next_change() const;

private:
    void try_at(GpsTime at);
    void enter(GpsTime now);

    ReceiverParts& parts_;
    std::function<void()> entered_;
    std::optional<Sleep> planned_, under_way_;
    GpsTime tried_at_{};  ///< when the planned one is looked at next
};

}  // namespace skyloop::firmware
