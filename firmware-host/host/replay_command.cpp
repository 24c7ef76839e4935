#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "base/core/files.hpp"
#include "base/core/words.hpp"
#include "commands.hpp"
#include "messages.hpp"
#include "run/emulator/real_time.hpp"
#include "run/emulator/replay.hpp"
#include "run_options.hpp"
#include "run_session.hpp"
#include "wire/transport/open_transport.hpp"

namespace skyloop::host {
namespace {

struct ReplayOptions {
    std::string recording;
    std::vector<std::string> ports;
    double speed = 1, from = 0;
    double duration = 1e9;  // s: longer than any recording
    std::uint32_t baud = 0;
    bool no_wait = false;
    Verbosity verbosity;
};

Result<std::vector<RecordedPort>> recorded_ports(const ReplayOptions& options) {
    std::error_code error;
    if (std::filesystem::is_directory(options.recording, error)) return read_recorded_output(options.recording);
    constexpr std::size_t most_bytes = std::size_t{1} << 30;
    const auto bytes = read_text_file(options.recording, most_bytes);
    if (!bytes) return fail(bytes.error());
    if (options.baud == 0)
        return fail(
            ErrorCode::usage,
            fmt::format("{}: a file of bytes has no times; expected --baud with its line speed", options.recording));
    return std::vector<RecordedPort>{paced_output(to_bytes(*bytes), options.baud)};
}

// A port that writes into what is played would end it.
Result<void> check_ports(const ReplayOptions& options) {
    std::vector<std::filesystem::path> played{options.recording};
    std::error_code none;
    for (const auto& there : std::filesystem::directory_iterator(options.recording, none))
        played.push_back(there.path());
    for (const std::string& uri : options.ports)
        if (const auto parsed = parse_port_uri(uri); parsed && parsed->kind == WireKind::file)
            if (const auto spared = check_spares("--port", parsed->path, played); !spared) return spared;
    return {};
}

Result<Replay::Parts> replay_parts(const ReplayOptions& options, const Messages& messages) {
    if (const auto fine = check_ports(options); !fine) return fail(fine.error());
    auto ports = recorded_ports(options);
    if (!ports) return fail(ports.error());
    if (options.ports.size() > ports->size())
        return fail(ErrorCode::usage, fmt::format("--port is there {} times; expected {}, one for each port of {}",
                                                  options.ports.size(), ports->size(), options.recording));
    for (const RecordedPort& port : *ports)
        if (!port.warning.empty()) messages.warning(port.warning);
    auto part =
        part_of(std::move(*ports), to_nanoseconds(Seconds(options.from)), to_nanoseconds(Seconds(options.duration)));
    if (!part) return fail(part.error().code, fmt::format("{}: {}", options.recording, part.error().message));
    Replay::Parts parts;
    parts.ports = std::move(*part);
    if (options.baud > 0) parts.baud = options.baud;
    parts.speed = options.speed;
    for (std::size_t i = 0; i < parts.ports.size(); ++i) {
        auto wire = open_transport(i < options.ports.size() ? options.ports[i] : "pty");
        if (!wire) return fail(wire.error());
        parts.wires.push_back(std::move(*wire));
    }
    return parts;
}

int tell_end(const Messages& messages, Replay& replay) {
    int code = 0;
    for (std::size_t i = 0; i < replay.links().size(); ++i) {
        Link& link = replay.links()[i];
        for (const std::string& news : link.transport().take_news())
            messages.warning(fmt::format("port {}: {}", i, news));
        const LinkCounters& counted = link.counters();
        messages.info(fmt::format("port {}: {} bytes out, {} in, {} while nobody listened", i, counted.bytes_out,
                                  counted.bytes_in, counted.bytes_unheard));
        if (counted.bytes_lost > 0)
            messages.warning(
                fmt::format("port {}: {} bytes were lost: the client read too slowly", i, counted.bytes_lost));
        if (counted.bytes_garbled > 0)
            messages.warning(fmt::format("port {}: {} bytes went out garbled: the client's line speed was another", i,
                                         counted.bytes_garbled));
        if (const std::string notice = link.transport().notice(); !notice.empty())
            messages.warning(fmt::format("port {}: {}", i, notice));
        if (const std::string failure = link.transport().failure(); !failure.empty())
            code = messages.error({ErrorCode::outside, failure});
    }
    if (replay.writes() > 0)
        messages.info(fmt::format("{} writes left {:.3f} ms late on average, {:.3f} ms at worst", replay.writes(),
                                  replay.lateness().mean_ms(),
                                  static_cast<double>(replay.lateness().largest().count()) * 1e-6));
    return code;
}

int replay_recording(const ReplayOptions& options) {
    const Messages messages(options.verbosity);
    catch_stop_signals();
    auto parts = replay_parts(options, messages);
    if (!parts) return messages.error(parts.error());
    Replay replay(std::move(*parts));
    // Scripts wait for these lines to know the tty: they are said even when quiet.
    for (std::size_t i = 0; i < replay.links().size(); ++i)
        say(fmt::format("port {}: {}\n", i, replay.links()[i].transport().description()));
    messages.detail(fmt::format("priority of the loop: {}", to_string(raise_thread_priority())));
    if (!options.no_wait) replay.await_clients(stop_was_asked);
    replay.play(stop_was_asked);
    return tell_end(messages, replay);
}

}  // namespace

Action add_replay_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("replay", "Play a recording again: exact bytes at the recorded times");
    auto options = std::make_shared<ReplayOptions>();
    command->add_option("RECORDING", options->recording, "Folder of run --record or simulate --out, or a file of bytes")
        ->required();
    command->add_option(
        "--port", options->ports,
        fmt::format("Where the bytes go: {} or -; one a recorded port, in order", fmt::join(port_shapes(), " ")));
    command->add_option("--speed", options->speed, "Recorded seconds per second")->check(CLI::Range(1e-3, 1e3));
    command->add_option("--from", options->from, "Seconds after the first recorded byte")->check(CLI::Range(0.0, 1e9));
    command->add_option("--duration", options->duration, "Recorded seconds")->check(CLI::Range(1e-3, 1e9));
    command
        ->add_option("--baud", options->baud,
                     "Line speed; paces a file of bytes, and garbles what a client hears at another speed")
        ->check(CLI::Range(110U, 12'000'000U));
    command->add_flag("--no-wait", options->no_wait, "Begin at once; else when each port has a client");
    add_verbosity_options(*command, options->verbosity);
    return [options] { return replay_recording(*options); };
}

}  // namespace skyloop::host
