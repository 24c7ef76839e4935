/// When a receiver's navigation epochs are.
/// How simulated time passes.
/// How late epochs came, in real time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/core/threads.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline run {

/// Epochs stand on a grid of GPS time: where the navigation period divides the week, the time of week is a multiple of
/// it. A period that changes gives a new grid, from the next epoch on (RECEIVER.md 4.4, 4.6): the first instant of the
/// new grid that has not passed and lies after the last epoch.
class EpochGrid {
public:
    /// Begins anew; the first epoch is at `now` or later.
    void start(GpsTime now, Nanoseconds period);
    /// Follows a period that may have changed by `now`. A period below a millisecond counts as one.
    void follow(GpsTime now, Nanoseconds period);
    /// The epoch at `next()` is had.
    void pass();
    [[nodiscard]] GpsTime next() const { return next_; }

private:
    Nanoseconds period_{1'000'000'000};
    GpsTime next_{};
    std::optional<GpsTime> last_;
};

/// An instant on the clocks of a run.
struct LoopTime {
    GpsTime now;                    ///< simulated
    std::int64_t monotonic_ns = 0;  ///< Pacer::monotonic_ns()
};

/// Waits for instants of simulated time. Nothing else in the loop reads a clock.
class Pacer {
public:
    virtual ~Pacer() = default;
    /// Returns at `time` or later and gives how late, never negative; nothing when a signal cut the wait short.
    virtual std::optional<Nanoseconds> wait_until(GpsTime time) = 0;
    /// How long the loop may leave the wires alone, in simulated time, while bytes are on their way or none are;
    /// zero: until the next epoch.
    [[nodiscard]] virtual Nanoseconds tick(bool bytes_pending) const = 0;
    /// True when instants pass as fast as they can be computed.
    [[nodiscard]] bool is_virtual() const { return tick(true) == Nanoseconds(0); }
    /// The steady clock's reading, ns, at which `time` is due at the present speed; nothing where time does not
    /// follow that clock.
    [[nodiscard]] virtual std::optional<std::int64_t> due_at(GpsTime) const { return std::nullopt; }
    /// Nanoseconds of a clock that never goes back, for the times of recorded bytes.
    [[nodiscard]] virtual std::int64_t monotonic_ns(GpsTime now) const = 0;

    /// From now on so many simulated seconds pass in a second; nothing where time does not wait.
    virtual void set_speed(double, GpsTime) {}
    /// Time stands still until resume(); meanwhile nobody calls wait_until().
    virtual void pause(GpsTime) { paused_ = true; }
    virtual void resume(GpsTime) { paused_ = false; }
    [[nodiscard]] bool paused() const { return paused_; }
    /// Lets a paused run look for commands again after a while.
    static void rest();

private:
    bool paused_ = false;
};

/// Does not wait: a day runs in seconds, and its clock is the simulated one. It cannot be paused: nobody stands by who
/// could let it go on, and where a program leads the run, time goes where the program leads it.
class VirtualPacer : public Pacer {
public:
    explicit VirtualPacer(GpsTime start) : start_(start) {}
    std::optional<Nanoseconds> wait_until(GpsTime) override { return Nanoseconds(0); }
    [[nodiscard]] Nanoseconds tick(bool) const override { return Nanoseconds(0); }
    [[nodiscard]] std::int64_t monotonic_ns(GpsTime now) const override { return (now - start_).count(); }
    void pause(GpsTime) override {}

private:
    GpsTime start_;
};

/// Time that a live source leads: the loop asks it before each instant, and instants pass as soon as they may. The
/// wires are looked at as often as in real time, in simulated time.
class SourcePacer : public Pacer {
public:
    explicit SourcePacer(GpsTime start) : start_(start) {}
    std::optional<Nanoseconds> wait_until(GpsTime) override { return Nanoseconds(0); }
    [[nodiscard]] Nanoseconds tick(bool bytes_pending) const override;
    [[nodiscard]] std::int64_t monotonic_ns(GpsTime now) const override { return (now - start_).count(); }

private:
    GpsTime start_;
};

/// Maps simulated time to the steady clock, at a chosen rate.
class RealtimePacer : public Pacer {
public:
    /// @param start_steady_ns the steady clock's reading at which `start` is due
    /// @param speed simulated seconds per second
    RealtimePacer(GpsTime start, std::int64_t start_steady_ns, double speed);
    std::optional<Nanoseconds> wait_until(GpsTime time) override;
    [[nodiscard]] Nanoseconds tick(bool bytes_pending) const override;
    [[nodiscard]] std::optional<std::int64_t> due_at(GpsTime time) const override { return due_ns(time); }
    [[nodiscard]] std::int64_t monotonic_ns(GpsTime now) const override;
    void set_speed(double speed, GpsTime now) override;
    void resume(GpsTime now) override;

private:
    [[nodiscard]] std::int64_t due_ns(GpsTime time) const;

    GpsTime start_;  // since speed_ holds
    std::int64_t start_ns_;
    double speed_;
};

/// Counts of epochs by lateness.
class LatenessHistogram {
public:
    /// Upper bounds of the bins, ms; the last bin has none.
    static constexpr std::array<double, 9> bounds_ms{0.1, 0.3, 1, 3, 10, 30, 100, 300, 1000};

    void add(Nanoseconds lateness);
    [[nodiscard]] const std::array<std::uint64_t, bounds_ms.size() + 1>& counts() const { return counts_; }
    [[nodiscard]] Nanoseconds largest() const { return largest_; }
    /// Mean over all epochs, ms.
    [[nodiscard]] double mean_ms() const;

private:
    std::array<std::uint64_t, bounds_ms.size() + 1> counts_{};
    Nanoseconds largest_{0};
    std::uint64_t epochs_ = 0;
    double sum_ms_ = 0;
};

}  // namespace skyloop::inline run
