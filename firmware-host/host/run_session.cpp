#include "run_session.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <map>

#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"
#include "progress.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/load_track.hpp"
#include "run/emulator/wires.hpp"
#include "run_watch.hpp"

namespace skyloop::host {
namespace {

// The one door between a signal and the loop; a run that is in vain ends by it, too.
std::atomic<bool> stop_asked{false}, signalled{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

void ask_to_stop(int) { signalled = stop_asked = true; }

// A signal ends a run that has no end of its own as its user does; one that has an end is cut by it, or by being in
// vain.
RunEnd end_of(const Scenario& scenario, const Assembly& assembly) {
    if (!stop_asked) return RunEnd::over;
    if (!scenario.run.duration) return ends_with_its_path(scenario) ? RunEnd::cut : RunEnd::over;
    return assembly.emulator->now() < advanced(assembly.start, *scenario.run.duration) ? RunEnd::cut : RunEnd::over;
}

}  // namespace

void catch_stop_signals() {
    struct sigaction action {};
    action.sa_handler = ask_to_stop;  // without SA_RESTART, so that a wait ends at once
    for (const int signal : {SIGINT, SIGTERM})
        sigaction(signal, &action, nullptr);
    // Whoever has it ignored, as nohup does, wants the program to outlive its terminal.
    struct sigaction inherited {};
    if (sigaction(SIGHUP, nullptr, &inherited) != 0 || inherited.sa_handler != SIG_IGN)
        sigaction(SIGHUP, &action, nullptr);
    // A reader that goes away is a wire that is unplugged, not a reason to die.
    signal(SIGPIPE, SIG_IGN);
}

bool stop_was_asked() { return stop_asked; }

GpsTime wall_clock() {
    using namespace std::chrono;
    return from_posix(duration_cast<Nanoseconds>(system_clock::now().time_since_epoch()), LeapSeconds::announced());
}

RunSession::RunSession(const Messages& messages, Assembly& assembly) : messages_(messages), assembly_(assembly) {
    for (const std::string& detail : assembly.details)
        messages.detail(detail);
    for (const std::string& note : assembly.notes)
        messages.info(note);
    messages.warnings(assembly.warnings);
}

void RunSession::await_feeds() const {
    LiveFeeds* feeds = assembly_.emulator->feeds();
    if (feeds == nullptr) return;
    for (const std::string& source : feeds->descriptions())
        say(fmt::format("truth: {}\n", source));
    if (feeds->all_heard()) return;
    messages_.info(feeds->waits_for());
    assembly_.emulator->await_feeds(stop_asked, [&] {
        for (const std::string& news : feeds->take_news())
            messages_.warning(news);
    });
}

void RunSession::await_clients() const {
    messages_.info("waiting for a client on each port");
    assembly_.emulator->await_clients(stop_asked);
}

// What such a run leaves must not be taken for the whole.
void RunSession::tell_that_it_was_cut() const {
    const Seconds done = difference(assembly_.emulator->now(), assembly_.start);
    messages_.warning(
        fmt::format("stopped by a signal after {:.3f} s of the run: what is recorded ends there", done.value()));
}

int RunSession::run(const Scenario& scenario, RunWatch& watch) {
    Emulator& emulator = *assembly_.emulator;
    go(emulator, watch);
    watch.finish_outputs();
    const RunEnd end = end_of(scenario, assembly_);
    if (Recorder* recorder = emulator.recorder())
        recorder->record_summary(run_summary(scenario, assembly_, SKYLOOP_VERSION,
                                             end == RunEnd::cut ? SummaryOf::cut_end : SummaryOf::end));
    if (end == RunEnd::cut && signalled) tell_that_it_was_cut();
    int code = watch.finish(messages_, end);
    for (std::size_t i = 0; i < emulator.stations().size(); ++i)
        for (const std::string& news : wire_news(i))
            messages_.warning(news);
    tell_feeds();
    if (const int failed = tell_outputs(watch); failed != 0) code = failed;
    for (const Station& station : emulator.stations()) {
        tell_counts(station);
        tell_power(station);
        if (station.power() != nullptr && station.power()->counts().failures > 0)
            code = messages_.error(
                {ErrorCode::outside,
                 fmt::format("{}power {}: what was to be cut was not, or not restored, {} times", prefix(station),
                             station.power()->name(), station.power()->counts().failures)});
        for (const Wire& wire : station.wires())
            if (const std::string failure = wire.link.transport().failure(); !failure.empty())
                code = messages_.error({ErrorCode::outside, failure});
        if (station.recorder() && station.recorder()->failure()) code = messages_.error(*station.recorder()->failure());
        if (station.state() && station.state()->failure()) code = messages_.error(*station.state()->failure());
    }
    return code;
}

int RunSession::tell_outputs(RunWatch& watch) const {
    int code = 0;
    for (const std::string& news : watch.take_news())
        messages_.warning(news);
    for (std::size_t i = 0; i < watch.outputs().size(); ++i) {
        const auto& [description, counts] = assembly_.outputs.at(i);
        messages_.info(fmt::format("output {} ({}): {} messages, {} bytes, {} messages while nobody listened", i,
                                   description, counts.sent.messages, counts.sent.bytes, counts.sent.unheard));
        if (counts.sent.lost > 0)
            messages_.warning(fmt::format("output {}: {} messages were lost: refused, or the other end read too slowly",
                                          i, counts.sent.lost));
        if (counts.left_out > 0)
            messages_.warning(
                fmt::format("output {}: {} epochs were left out: the way out was too slow", i, counts.left_out));
        if (const std::string failure = watch.outputs()[i]->failure(); !failure.empty())
            code = messages_.error({ErrorCode::outside, failure});
    }
    return code;
}

bool RunSession::in_vain(const RunWatch& watch) const {
    bool wired = false;
    for (const Station& station : assembly_.emulator->stations()) {
        if (station.power() != nullptr) return false;  // a real device is switched
        for (const Wire& wire : station.wires()) {
            if (wire.one_way) continue;
            if (!wire.link.ended()) return false;
            wired = true;
        }
    }
    return wired && !watch.serves();
}

void RunSession::go(Emulator& emulator, RunWatch& watch) {
    constexpr std::size_t most_lines = 1000;
    JobThread writer(most_lines);
    Progress progress(!messages_.verbosity().quiet && !messages_.verbosity().json, assembly_.start, assembly_.end,
                      writer);
    const auto tell = [&](std::string news) {
        progress.clear();
        writer.run([this, news = std::move(news)] { messages_.warning(news); });
    };
    emulator.on_status([&](const Status& status) {
        if (auto notice = new_notice(status.station)) tell(std::move(*notice));
        for (std::string& news : wire_news(status.station))
            tell(std::move(news));
        if (LiveFeeds* feeds = emulator.feeds())
            for (std::string& news : feeds->take_news())
                tell(std::move(news));
        for (std::string& news : watch.take_news())
            tell(std::move(news));
        progress.show(status, emulator);
        if (in_vain(watch)) stop_asked = true;
    });
    emulator.run_until(assembly_.end.value_or(GpsTime::max()), stop_asked);
    emulator.on_status({});
    if (const std::size_t lines = writer.left_out(); lines > 0)
        tell(fmt::format("{} lines were left out: what the run said was read too slowly", lines));
}

std::optional<std::string> RunSession::new_notice(std::size_t index) {
    const Station& station = assembly_.emulator->stations()[index];
    const RayTracedScene* city = station.simulation().city();
    if (city == nullptr || !city->notice()) return std::nullopt;
    if (!noticed_.insert(index).second) return std::nullopt;
    return prefix(station) + *city->notice();
}

std::vector<std::string> RunSession::wire_news(std::size_t index) {
    Station& station = assembly_.emulator->stations()[index];
    std::vector<std::string> all;
    for (std::size_t i = 0; i < station.wires().size(); ++i)
        for (const std::string& news : station.transport(i).take_news())
            all.push_back(fmt::format("{}: {}", port_name(station, i), news));
    if (station.power() != nullptr)
        for (const std::string& news : station.power()->take_news())
            all.push_back(fmt::format("{}power {}: {}", prefix(station), station.power()->name(), news));
    return all;
}

void RunSession::tell_power(const Station& station) const {
    if (station.power() == nullptr) return;
    const PowerCounts counts = station.power()->counts();
    messages_.info(fmt::format("{}power {}: {} times cut, {} times restored, {} failures, {:.1f} ms at worst",
                               prefix(station), station.power()->name(), counts.cuts, counts.restores, counts.failures,
                               counts.slowest_ms));
}

void RunSession::tell_feeds() const {
    LiveFeeds* feeds = assembly_.emulator->feeds();
    if (feeds == nullptr) return;
    for (const std::string& news : feeds->take_news())
        messages_.warning(news);
    for (const FeedReport& report : feeds->reports()) {
        const auto& [description, clock, counts, paths, rate, age] = report;
        const double mean_ms = age.epochs > 0 ? age.sum_ms / static_cast<double>(age.epochs) : 0;
        messages_.info(fmt::format(
            "{}: {} samples in {} messages, {} lost, {} refused, {} late, {} jumps, {} silences{}; at epochs "
            "the newest was {:.1f} ms old on average, {:.1f} ms at worst",
            description, counts.samples, counts.messages, counts.lost, counts.refused + paths.refused, paths.late,
            paths.jumps, paths.holds, rate ? fmt::format(", {:.3f} of its seconds in one of ours", *rate) : "", mean_ms,
            age.largest_ms));
        if (const std::uint64_t lost = counts.overflowed + counts.dropped_by_kernel; lost > 0)
            messages_.warning(
                fmt::format("{}: {} messages were lost: they came faster than they were read", description, lost));
    }
}

std::string RunSession::prefix(const Station& station) const {
    return assembly_.emulator->stations().size() > 1 ? station.name() + ": " : "";
}

std::string RunSession::port_name(const Station& station, std::size_t wire) const {
    const firmware::PortId port = station.wires().at(wire).port;
    const std::string of_port = port == firmware::PortId::uart1
                                    ? ""
                                    : fmt::format(" ({})", firmware::port_names[static_cast<std::size_t>(port)]);
    return fmt::format("{}port {}{}", prefix(station), wire, of_port);
}

void RunSession::tell_corrections(const CorrectionsWire& wire, const std::string& name) const {
    const NtripClientCounts counts = wire.counts();
    messages_.info(fmt::format("{}: {} messages of corrections in {} bytes, {} connections", name, wire.messages(),
                               counts.bytes, counts.connections));
    if (counts.bytes_lost > 0)
        messages_.warning(
            fmt::format("{}: {} bytes of corrections were lost: time stood still", name, counts.bytes_lost));
}

void RunSession::tell_wire(const Station& station, std::size_t wire) const {
    const Link& link = station.wires()[wire].link;
    const LinkCounters& counted = link.counters();
    const std::string name = port_name(station, wire);
    if (const CorrectionsWire* corrections = station.wires()[wire].corrections)
        return tell_corrections(*corrections, name);
    messages_.info(fmt::format("{}: {} bytes out, {} in, {} while nobody listened", name, counted.bytes_out,
                               counted.bytes_in, counted.bytes_unheard));
    if (counted.bytes_garbled > 0)
        messages_.warning(fmt::format("{}: {} bytes went out garbled: the client's line speed was not the receiver's",
                                      name, counted.bytes_garbled));
    if (counted.bytes_lost > 0)
        messages_.warning(fmt::format("{}: {} bytes were lost: the client read too slowly", name, counted.bytes_lost));
    if (const std::string notice = link.transport().notice(); !notice.empty())
        messages_.warning(fmt::format("{}: {}", name, notice));
}

void RunSession::tell_overload(const Station& station) const {
    std::map<firmware::PortId, std::string> names;
    for (std::size_t i = 0; i < station.wires().size(); ++i)
        names.emplace(station.wires()[i].port, port_name(station, i));
    if (names.empty()) {
        const firmware::PortId port = default_port(station.receiver().board());
        names.emplace(port, fmt::format("{}port {}", prefix(station), firmware::port_names[std::size_t(port)]));
    }
    for (const auto& [port, name] : names) {
        const firmware::PortTotals totals = station.receiver().port_totals(port);
        // The speed then: by now a client may have changed it.
        const std::string line =
            firmware::is_uart(port) ? fmt::format("{} baud", totals.dropped_at_baud) : std::string("the line");
        if (totals.messages_dropped > 0)
            messages_.warning(fmt::format(
                "{}: {} messages did not fit the receiver's transmit buffer: {} is too slow for this output", name,
                totals.messages_dropped, line));
    }
}

void RunSession::tell_counts(const Station& station) const {
    const RunCounts& counts = station.counts();
    messages_.info(fmt::format("{}{} epochs, {} with a fix, {} messages", prefix(station), counts.epochs,
                               counts.epochs_with_fix, station.messages_sent()));
    for (std::size_t i = 0; i < station.wires().size(); ++i)
        tell_wire(station, i);
    tell_overload(station);
    if (counts.lateness.largest() > Nanoseconds(0))
        messages_.info(fmt::format("{}epochs came {:.3f} ms late on average, {:.3f} ms at worst", prefix(station),
                                   counts.lateness.mean_ms(),
                                   static_cast<double>(counts.lateness.largest().count()) * 1e-6));
}

}  // namespace skyloop::host
