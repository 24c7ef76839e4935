#include "run_session.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <atomic>
#include <chrono>

#include "progress.hpp"
#include "skyloop/emulator/run_summary.hpp"
#include "skyloop/time/utc_time.hpp"

namespace skyloop::host {
namespace {

// The one door between a signal and the loop.
std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

void ask_to_stop(int) { stop_asked = true; }

}  // namespace

void catch_stop_signals() {
    struct sigaction action {};
    action.sa_handler = ask_to_stop;  // without SA_RESTART, so that a wait ends at once
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        sigaction(signal, &action, nullptr);
    // A reader that goes away is a wire that is unplugged, not a reason to die.
    signal(SIGPIPE, SIG_IGN);
}

bool stop_was_asked() { return stop_asked; }

GpsTime wall_clock() {
    using namespace std::chrono;
    constexpr seconds gps_epoch_unix(315964800);  // 1980-01-06T00:00:00Z
    const Nanoseconds utc = duration_cast<Nanoseconds>(system_clock::now().time_since_epoch()) - gps_epoch_unix;
    return from_utc_count(utc, LeapSeconds::announced());
}

RunSession::RunSession(const Messages& messages, Assembly& assembly) : messages_(messages), assembly_(assembly) {
    for (const std::string& detail : assembly.details)
        messages.detail(detail);
    for (const std::string& warning : assembly.warnings)
        messages.warning(warning);
}

int RunSession::run(const Scenario& scenario) {
    Emulator& emulator = *assembly_.emulator;
    {
        Progress progress(!messages_.verbosity().quiet && !messages_.verbosity().json, assembly_.start, assembly_.end);
        emulator.on_status([&](const Status& status) { progress.show(status, emulator); });
        emulator.run_until(assembly_.end.value_or(GpsTime::max()), stop_asked);
    }
    Recorder* recorder = emulator.recorder();
    if (recorder) recorder->record_summary(run_summary(scenario, assembly_, SKYLOOP_VERSION));
    tell_counts();
    int code = 0;
    for (const Link& link : emulator.links())
        if (const std::string failure = link.transport().failure(); !failure.empty())
            code = messages_.error({ErrorCode::outside, failure});
    if (recorder && recorder->failure()) code = messages_.error(*recorder->failure());
    return code;
}

void RunSession::tell_counts() const {
    const Emulator& emulator = *assembly_.emulator;
    const RunCounts& counts = emulator.counts();
    messages_.info(fmt::format("{} epochs, {} with a fix, {} messages", counts.epochs, counts.epochs_with_fix,
                               emulator.receiver().counters().messages_sent));
    for (std::size_t i = 0; i < emulator.links().size(); ++i) {
        const LinkCounters& wire = emulator.links()[i].counters();
        messages_.info(fmt::format("port {}: {} bytes out, {} in, {} while nobody listened", i, wire.bytes_out,
                                   wire.bytes_in, wire.bytes_unheard));
        if (wire.bytes_garbled > 0)
            messages_.warning(fmt::format("port {}: {} bytes went out garbled: the client's line speed was not {} baud",
                                          i, wire.bytes_garbled, emulator.receiver().baud()));
        if (wire.bytes_lost > 0)
            messages_.warning(
                fmt::format("port {}: {} bytes were lost: the client read too slowly", i, wire.bytes_lost));
    }
    if (const std::uint64_t dropped = emulator.receiver().counters().messages_dropped; dropped > 0)
        messages_.warning(
            fmt::format("{} messages did not fit the receiver's transmit buffer: {} baud is too slow for this output",
                        dropped, emulator.receiver().baud()));
    if (counts.lateness.largest() > Nanoseconds(0))
        messages_.info(fmt::format("epochs came {:.3f} ms late on average, {:.3f} ms at worst",
                                   counts.lateness.mean_ms(),
                                   static_cast<double>(counts.lateness.largest().count()) * 1e-6));
}

}  // namespace skyloop::host
