#include "wire/actuator/power_watchdog.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <thread>

#include "base/core/words.hpp"
#include "wire/actuator/actuator_uri.hpp"

namespace skyloop::inline wire {
namespace {

// One record of the socket, which keeps their borders.
struct WatchdogNote {
    char what = 0;
    std::uint32_t ward = 0;
    std::int32_t group = 0;  // of processes; 0: none
};
constexpr char noted_cut = 'c', noted_restored = 'r', noted_group = 'g';

constexpr int tries_to_restore = 5;
constexpr std::chrono::milliseconds between_tries{300};  // a hub may take that long to come back

// What the program left behind of a ward.
struct WardLeft {
    bool cut = false;
    pid_t group = 0;  // of the command that was at work on it
};

// How things stand when the program is gone.
std::vector<WardLeft> follow_notes(int socket, std::size_t wards) {
    std::vector<WardLeft> left(wards);
    WatchdogNote note;
    while (hear_record(socket, &note, sizeof note)) {
        if (note.ward >= wards) continue;
        if (note.what == noted_group)
            left[note.ward].group = note.group;
        else
            left[note.ward].cut = note.what == noted_cut;
    }
    return left;
}

// Restored, and still so when what was under way before has had its time.
Result<void> restore_for_good(const std::string& uri) {
    const auto actuator = open_actuator(uri);
    if (!actuator) return fail(actuator.error());
    if (auto done = (*actuator)->restore(); !done) return done;
    std::this_thread::sleep_for(between_tries);
    const auto state = (*actuator)->state();
    if (state && *state == PowerState::cut) return fail(ErrorCode::outside, "it was cut again by something else");
    return {};
}

void restore_ward(const std::string& uri) {
    std::string reason;
    for (int i = 0; i < tries_to_restore; ++i) {
        if (i > 0) std::this_thread::sleep_for(between_tries);
        const Result<void> done = restore_for_good(uri);
        if (done) return say(fmt::format("skyloop: power {}: restored, as the run had not done so\n", uri));
        reason = done.error().message;
    }
    say(fmt::format("skyloop: power {}: the run left it cut, and it cannot be restored: {}\n", uri, reason));
}

void watch_over(int socket, const std::vector<std::string>& wards) {
    const std::vector<WardLeft> left = follow_notes(socket, wards.size());
    // A command that outlives the program would cut the power after it has been restored.
    for (const WardLeft& ward : left)
        if (ward.cut && ward.group > 0) end_process_group(ward.group);
    for (std::size_t i = 0; i < wards.size(); ++i)
        if (left[i].cut) restore_ward(wards[i]);
}

}  // namespace

Result<std::unique_ptr<PowerWatchdog>> PowerWatchdog::start(const std::vector<std::string>& wards) {
    auto process = WatchdogProcess::start("skyloop-power", [&](int socket) { watch_over(socket, wards); });
    if (!process)
        return fail(ErrorCode::outside, fmt::format("no watchdog over the power: {}", process.error().message));
    return std::unique_ptr<PowerWatchdog>(new PowerWatchdog(std::move(*process)));
}

bool PowerWatchdog::note(char what, std::size_t ward, int group) const {
    const WatchdogNote note{what, static_cast<std::uint32_t>(ward), group};
    return process_->tell(&note, sizeof note);
}

Result<void> PowerWatchdog::note_cut(std::size_t ward) {
    if (note(noted_cut, ward)) return {};
    return fail(ErrorCode::outside,
                fmt::format("the watchdog that would restore it is gone: {}", std::strerror(errno)));
}

void PowerWatchdog::note_restored(std::size_t ward) { static_cast<void>(note(noted_restored, ward)); }

void PowerWatchdog::note_group(std::size_t ward, std::optional<int> group) {
    static_cast<void>(note(noted_group, ward, group.value_or(0)));
}

}  // namespace skyloop::inline wire
