/// Truth from outside: how long until the first byte, against a bare pseudo-terminal of the same run, and what a sender
/// of 64 vehicles costs.
///
/// SKYLOOP_BENCH_SECONDS is how long each lasts, 20 unless given; the first two seconds do not count.
#include <arpa/inet.h>
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <thread>

#include "base/time/utc_time.hpp"
#include "real_time.hpp"
#include "run/emulator/assembly.hpp"
#include "support/oracle_table.hpp"
#include "wire/transport/pty.hpp"

namespace {

using namespace skyloop;
using namespace skyloop::bench;

// A port that nobody has at this moment.
std::uint16_t free_port(int kind) {
    const int probe = ::socket(AF_INET, kind, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    (void)::bind(probe, reinterpret_cast<sockaddr*>(&address), size);
    (void)::getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size);
    ::close(probe);
    return ntohs(address.sin_port);
}

int connected(int kind, std::uint16_t port) {
    const int end = ::socket(AF_INET, kind, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    (void)::connect(end, reinterpret_cast<sockaddr*>(&address), sizeof address);
    const int at_once = 1;
    if (kind == SOCK_STREAM) ::setsockopt(end, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
    return end;
}

Scenario live_scenario(const std::string& source, ClockMode clock, std::size_t vehicles, const std::string& board) {
    Scenario scenario;
    scenario.run.start = to_gps_time({2026, 3, 1, 12, 0, 0, 0}, LeapSeconds::announced());
    ReceiverEntry entry;
    entry.board = board;
    entry.rate_hz = 10;
    entry.baud = 115200;
    scenario.receivers.assign(vehicles, entry);
    for (std::size_t i = 0; i < vehicles; ++i) {
        LiveSettings live;
        live.source = source;
        live.vehicle = std::to_string(i);
        live.at = Geodetic::degrees(46.5, 30.7 + 0.001 * static_cast<double>(i), 100);
        live.clock = clock;
        scenario.receivers[i].trajectory = live;
    }
    return scenario;
}

std::string truth_line(std::size_t vehicle, std::int64_t t_ns) {
    const double t = static_cast<double>(t_ns) * 1e-9;
    return fmt::format(
        "{{\"type\":\"truth\",\"v\":1,\"id\":\"{}\",\"t_ns\":{},\"lla\":[{:.9f},{:.9f},100.0],\"h_ref\":"
        "\"ell\",\"vel_ned\":[{:.6f},0.0,0.0]}}\n",
        vehicle, t_ns, 46.5 + t * 10 / 111195, 30.7 + 0.001 * static_cast<double>(vehicle), 10.0);
}

// Opened as a client does, so that bytes flow.
int open_terminal(const std::string& description) {
    const std::string path = description.substr(0, description.find(' '));
    const int fd = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    termios settings{};
    ::tcgetattr(fd, &settings);
    cfmakeraw(&settings);
    cfsetspeed(&settings, B115200);
    ::tcsetattr(fd, TCSANOW, &settings);
    return fd;
}

void drain(int fd) {
    std::array<char, 8192> piece{};
    while (::read(fd, piece.data(), piece.size()) > 0) {
    }
}

// When something can be read, ns; 0: nothing within a second.
std::int64_t readable_at(int fd) {
    pollfd end{fd, POLLIN, 0};
    return ::poll(&end, 1, 1000) == 1 ? steady_clock_ns() : 0;
}

Assembly assemble_live(const Scenario& scenario) {
    const DataFolders data{{SKYLOOP_SOURCE_DIR, test::built_data()}};
    RunMode mode;
    mode.now = *scenario.run.start;
    mode.now_steady_ns = steady_clock_ns();
    return std::move(assemble(scenario, data, mode).value());
}

// Until the source has answered "stepped"; hello lines are passed over.
void await_step(int source) {
    std::string heard;
    std::array<char, 4096> piece{};
    while (heard.find("\"stepped\"") == std::string::npos) {
        const ssize_t count = ::recv(source, piece.data(), piece.size(), 0);
        if (count <= 0) return;
        heard.append(piece.data(), static_cast<std::size_t>(count));
    }
}

void feed_to_first_byte(benchmark::State& state) {
    const auto folder = std::filesystem::temp_directory_path() / fmt::format("skyloop-feeds-{}", ::getpid());
    std::filesystem::create_directories(folder);
    const std::uint16_t port = free_port(SOCK_STREAM);
    const Assembly assembly = assemble_live(live_scenario(fmt::format("tcp-json:{}", port), ClockMode::lock_step, 1,
                                                          board_for({1, "ublox-m9", 10, 115200}, folder)));
    Emulator& emulator = *assembly.emulator;
    const int terminal = open_terminal(emulator.wires().front().link.transport().description());
    const auto bare = PtyTransport::open().value();
    const int bare_end = open_terminal(bare->terminal());
    std::atomic<bool> over{false};
    std::thread loop([&] { emulator.run_until(GpsTime::max(), over); });
    const int source = connected(SOCK_STREAM, port);
    Durations ours, bares;
    const Bytes block(100, 0x55);
    const auto epochs = static_cast<std::int64_t>(wire_seconds() * 10);
    const auto go_to = [&](std::int64_t t_ns) {
        const std::string lines = truth_line(0, t_ns) + fmt::format("{{\"type\":\"step\",\"t_ns\":{}}}\n", t_ns);
        const std::int64_t sent = steady_clock_ns();
        (void)!::send(source, lines.data(), lines.size(), MSG_NOSIGNAL);
        return sent;
    };
    // The first time that the source names is the start of the run.
    (void)go_to(0);
    await_step(source);
    for (auto _ : state)
        for (std::int64_t k = 0; k < epochs; ++k) {
            // Over the epoch, until its first bytes have crossed the wire; then until all of them have.
            const std::int64_t epoch_ns = k * 100 * wire_ms;
            const std::int64_t sent = go_to(epoch_ns + 2 * wire_ms);
            if (k > 20)
                if (const std::int64_t came = readable_at(terminal); came != 0) ours.add(came - sent);
            await_step(source);
            (void)go_to(epoch_ns + 95 * wire_ms);
            await_step(source);
            drain(terminal);
            drain(bare_end);
            bare->line();
            const std::int64_t written = steady_clock_ns();
            bare->write(block);
            if (const std::int64_t came = readable_at(bare_end); came != 0) bares.add(came - written);
        }
    over = true;
    ::close(source);
    loop.join();
    ::close(terminal);
    ::close(bare_end);
    std::filesystem::remove_all(folder);
    tell(state, "truth_to_byte", ours, bares);
    state.counters["samples"] = static_cast<double>(ours.count());
}
BENCHMARK(feed_to_first_byte)->Iterations(1)->UseRealTime()->Unit(benchmark::kSecond);

double cpu_of_process() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

// One sender of 100 samples a second for each of 64 vehicles, in a process of its own so that its time is its own.
pid_t send_from_apart(std::uint16_t port, std::size_t vehicles, double seconds) {
    const pid_t child = ::fork();
    if (child != 0) return child;
    const int source = connected(SOCK_DGRAM, port);
    const std::int64_t begin = steady_clock_ns();
    constexpr std::int64_t period = 10 * wire_ms;
    for (std::int64_t k = 0; k * period < static_cast<std::int64_t>(seconds * 1e9); ++k) {
        const std::int64_t due = begin + k * period;
        const timespec deadline{due / wire_second, due % wire_second};
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr);
        for (std::size_t i = 0; i < vehicles; ++i) {
            const std::string line = truth_line(i, k * period);
            (void)!::send(source, line.data(), line.size(), 0);
        }
    }
    ::_exit(0);
}

void feed_of_64_vehicles(benchmark::State& state) {
    constexpr std::size_t vehicles = 64;
    const std::uint16_t port = free_port(SOCK_DGRAM);
    const pid_t sender = send_from_apart(port, vehicles, wire_seconds());
    const Assembly assembly =
        assemble_live(live_scenario(fmt::format("udp-json:{}", port), ClockMode::realtime, vehicles, "ublox-m9"));
    Emulator& emulator = *assembly.emulator;
    std::atomic<bool> over{false};
    double cpu = 0, lasted = 0;
    for (auto _ : state) {
        std::thread ender([&] {
            const timespec while_sent{static_cast<time_t>(wire_seconds() - 2), 0};
            nanosleep(&while_sent, nullptr);
            over = true;
        });
        const double cpu_before = cpu_of_process();
        const std::int64_t before = steady_clock_ns();
        emulator.run_until(GpsTime::max(), over);
        cpu = cpu_of_process() - cpu_before;
        lasted = static_cast<double>(steady_clock_ns() - before) * 1e-9;
        ender.join();
    }
    ::kill(sender, SIGKILL);
    const FeedReport report = emulator.feeds()->reports().front();
    state.counters["core_share"] = cpu / lasted;
    state.counters["samples_per_s"] = static_cast<double>(report.counts.samples) / lasted;
    state.counters["dropped_by_kernel"] = static_cast<double>(report.counts.dropped_by_kernel);
    state.counters["overflowed"] = static_cast<double>(report.counts.overflowed);
    state.counters["refused"] = static_cast<double>(report.counts.refused + report.paths.refused);
    state.counters["late"] = static_cast<double>(report.paths.late);
    state.counters["age_mean_ms"] = report.age.sum_ms / static_cast<double>(report.age.epochs);
    state.counters["age_largest_ms"] = report.age.largest_ms;
}
BENCHMARK(feed_of_64_vehicles)->Iterations(1)->UseRealTime()->Unit(benchmark::kSecond);

}  // namespace
