#include "wire/actuator/power_switch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <utility>

#include "base/core/bytes.hpp"
#include "base/core/threads.hpp"

namespace skyloop::inline wire {
namespace {

// Relays click at the pace of the machine's clock, whatever that of the simulation is.
using SwitchClock = std::chrono::steady_clock;

constexpr std::uint64_t end_of_thread = std::uint64_t{1} << 63;
constexpr std::uint64_t most_waiting = 64;  // orders: what is further behind leaves out pairs
constexpr int tries_of_an_order = 3;
constexpr std::chrono::milliseconds before_next_try{100};

PowerState wanted_after(std::uint64_t orders) { return (orders & 1) != 0 ? PowerState::cut : PowerState::on; }

}  // namespace

Result<std::unique_ptr<PowerSwitch>> PowerSwitch::start(Parts parts) {
    std::unique_ptr<PowerSwitch> one(new PowerSwitch(std::move(parts)));
    // Libraries of USB start threads of their own, too.
    Result<void> opened;
    with_signals_held_back([&] { opened = one->open(); });
    if (!opened) return fail(opened.error());
    one->description_ = one->actuator_->description();
    if (const auto alone = one->lock(); !alone) return fail(alone.error());
    if (const auto restored = one->actuator_->restore(); !restored) return fail(restored.error());
    with_signals_held_back([&] { one->thread_ = std::thread([self = one.get()] { self->work(); }); });
    return one;
}

PowerSwitch::PowerSwitch(Parts parts) : parts_(std::move(parts)) {}

PowerSwitch::~PowerSwitch() { finish(); }

void PowerSwitch::want(PowerState state) {
    const std::uint64_t orders = orders_.load(std::memory_order_relaxed);
    if (wanted_after(orders) == state) return;
    orders_.fetch_add(1);
    orders_.notify_one();
}

void PowerSwitch::finish() {
    if (!thread_.joinable()) return;
    orders_.fetch_or(end_of_thread);
    orders_.notify_one();
    thread_.join();
}

void PowerSwitch::work() {
    for (;;) {
        orders_.wait(followed_);
        const std::uint64_t orders = orders_.load();
        if ((orders & end_of_thread) != 0) break;
        if (orders == followed_) continue;
        if (orders - followed_ > most_waiting) {
            const std::uint64_t left_out = (orders - followed_ - most_waiting + 1) & ~std::uint64_t{1};
            followed_ += left_out;
            tell(fmt::format("{} orders were left out: it switches too slowly for them", left_out));
        }
        follow(wanted_after(++followed_));
    }
    if (!known_on_) follow(PowerState::on);
    actuator_.reset();
}

// What has come back by itself has not been without power for as long as the scenario says.
void PowerSwitch::look_at_cut() {
    const auto cut_at = std::exchange(cut_at_, std::nullopt);
    if (!cut_at || !actuator_) return;
    const auto state = actuator_->state();
    if (!state || *state != PowerState::on) return;
    const std::chrono::duration<double> after = SwitchClock::now() - *cut_at;
    const std::lock_guard lock(told_mutex_);
    ++counts_.failures;
    news_.push_back(
        fmt::format("the power came back by itself: it was on again {:.1f} s after its cut, before it was restored",
                    after.count()));
}

void PowerSwitch::follow(PowerState wanted) {
    if (wanted == PowerState::on) look_at_cut();
    const auto begin = SwitchClock::now();
    const Result<void> done = try_repeatedly(wanted);
    const std::chrono::duration<double, std::milli> took = SwitchClock::now() - begin;
    const std::lock_guard lock(told_mutex_);
    counts_.slowest_ms = std::max(counts_.slowest_ms, took.count());
    if (done) {
        ++(wanted == PowerState::cut ? counts_.cuts : counts_.restores);
        return;
    }
    ++counts_.failures;
    news_.push_back(
        fmt::format("the power was not {}: {}", wanted == PowerState::cut ? "cut" : "restored", done.error().message));
}

// A cut that a wish to restore follows, or the end, is not tried for again. A restore is, whatever follows.
bool PowerSwitch::is_outdated(PowerState wanted) const {
    return wanted == PowerState::cut && orders_.load() != followed_;
}

Result<void> PowerSwitch::try_repeatedly(PowerState wanted) {
    // Before the first bit moves: from then on somebody has to put it back, whatever becomes of this process.
    if (wanted == PowerState::cut && parts_.watchdog != nullptr)
        if (auto noted = parts_.watchdog->note_cut(parts_.ward); !noted) return noted;
    if (wanted == PowerState::cut) known_on_ = false;
    Result<void> done;
    for (int i = 0; i < tries_of_an_order; ++i) {
        if (i > 0) std::this_thread::sleep_for(before_next_try);
        if (i > 0 && is_outdated(wanted)) break;
        done = try_once(wanted);
        if (done) break;
        actuator_.reset();  // what is plugged in again needs a fresh one
    }
    if (done && wanted == PowerState::cut) cut_at_ = SwitchClock::now();
    if (!done || wanted == PowerState::cut) return done;
    known_on_ = true;
    if (parts_.watchdog != nullptr) parts_.watchdog->note_restored(parts_.ward);
    return done;
}

Result<void> PowerSwitch::open() {
    auto opened = parts_.open();
    if (!opened) return fail(opened.error());
    actuator_ = std::move(*opened);
    actuator_->ask_while_cutting([this] { return !is_outdated(PowerState::cut); });
    if (parts_.watchdog != nullptr)
        actuator_->tell_process_groups(
            [this](std::optional<int> group) { parts_.watchdog->note_group(parts_.ward, group); });
    return {};
}

// Where the system has no such names to give nobody is kept off.
Result<void> PowerSwitch::lock() {
    const std::string name = actuator_->lock_name();
    if (name.empty()) return {};
    lock_ = claim_name(fmt::format("skyloop/power/{:016x}", fnv1a_64(name)));
    if (lock_.open() || errno != EADDRINUSE) return {};
    return fail(ErrorCode::outside,
                fmt::format("{} is switched by another run already, or by another receiver of this one", name));
}

Result<void> PowerSwitch::try_once(PowerState wanted) {
    if (!actuator_)
        if (auto opened = open(); !opened) return opened;
    return wanted == PowerState::cut ? actuator_->cut() : actuator_->restore();
}

void PowerSwitch::tell(std::string news) {
    const std::lock_guard lock(told_mutex_);
    news_.push_back(std::move(news));
}

std::vector<std::string> PowerSwitch::take_news() {
    const std::unique_lock lock(told_mutex_, std::try_to_lock);
    if (!lock) return {};
    return std::exchange(news_, {});
}

PowerCounts PowerSwitch::counts() const {
    const std::lock_guard lock(told_mutex_);
    return counts_;
}

}  // namespace skyloop::inline wire
