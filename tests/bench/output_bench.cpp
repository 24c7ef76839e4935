// From an epoch to the datagram that tells it, beside a datagram that one thread sends to itself.
#include <arpa/inet.h>
#include <benchmark/benchmark.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <vector>

#include "base/core/file_descriptor.hpp"
#include "run/output/run_output.hpp"
#include "unit/output/epochs.hpp"

namespace skyloop {
namespace {

using std::chrono::steady_clock;

// A socket of this process that hears itself.
struct Loopback {
    Loopback() : socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        ::bind(socket.value(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
        socklen_t size = sizeof address;
        ::getsockname(socket.value(), reinterpret_cast<sockaddr*>(&address), &size);
        const timeval patience{1, 0};  // an epoch that was left out sends nothing
        ::setsockopt(socket.value(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    }
    // Bytes; 0: none came.
    [[nodiscard]] std::size_t hear() {
        const ssize_t size = ::recv(socket.value(), buffer.data(), buffer.size(), 0);
        return size > 0 ? static_cast<std::size_t>(size) : 0;
    }
    FileDescriptor socket;
    sockaddr_in address{};
    std::array<char, 65536> buffer{};
};

// p50 and p99 of single turns, us, beside the mean.
void tell_percentiles(benchmark::State& state, std::vector<double>& us) {
    std::sort(us.begin(), us.end());
    if (us.empty()) return;
    state.counters["p50_us"] = us[us.size() / 2];
    state.counters["p99_us"] = us[us.size() * 99 / 100];
}

double us_since(steady_clock::time_point begin) {
    return std::chrono::duration<double, std::micro>(steady_clock::now() - begin).count();
}

void bare_udp_loop(benchmark::State& state) {
    Loopback loop;
    const std::array<char, 75> datagram{};  // a GPS_INPUT frame
    std::vector<double> us;
    for (auto _ : state) {
        const auto begin = steady_clock::now();
        ::sendto(loop.socket.value(), datagram.data(), datagram.size(), 0,
                 reinterpret_cast<const sockaddr*>(&loop.address), sizeof loop.address);
        benchmark::DoNotOptimize(loop.hear());
        us.push_back(us_since(begin));
    }
    tell_percentiles(state, us);
}

// @param format of the output; its epochs come faster than its heartbeats
void epoch_to_datagram(benchmark::State& state, const std::string& format) {
    Loopback loop;
    const auto settings =
        parse_output_uri(format + ":127.0.0.1:" + std::to_string(ntohs(loop.address.sin_port)) + ",when=epoch");
    const auto output = settings ? RunOutput::open(*settings, {{"only"}, {}, false}) : fail(settings.error());
    if (!output) return state.SkipWithError(output.error().message.c_str());
    const test::SampleEpoch epoch;
    (*output)->on_epoch(epoch.seen());
    if (loop.hear() < 40) benchmark::DoNotOptimize(loop.hear());  // MAVLink begins with a heartbeat
    std::vector<double> us;
    double lost = 0;
    for (auto _ : state) {
        const auto begin = steady_clock::now();
        (*output)->on_epoch(epoch.seen());
        if (loop.hear() == 0) {
            ++lost;
            continue;
        }
        us.push_back(us_since(begin));
        state.PauseTiming();
        ::usleep(200);  // the thread sleeps again, as it does between epochs
        state.ResumeTiming();
    }
    state.counters["lost"] = lost;
    tell_percentiles(state, us);
}

// What the loop itself pays for an output.
void loops_share(benchmark::State& state, const std::string& format) {
    Loopback loop;
    const auto settings = parse_output_uri(format + "-file:/dev/null,when=epoch");
    const auto output = settings ? RunOutput::open(*settings, {{"only"}, {}, false}) : fail(settings.error());
    if (!output) return state.SkipWithError(output.error().message.c_str());
    const test::SampleEpoch epoch;
    for (auto _ : state)
        (*output)->on_epoch(epoch.seen());
}

BENCHMARK(bare_udp_loop);
BENCHMARK_CAPTURE(epoch_to_datagram, gps_input, "gps-input")->Iterations(5000);
BENCHMARK_CAPTURE(epoch_to_datagram, json, "json-udp")->Iterations(5000);
BENCHMARK_CAPTURE(loops_share, gps_input, "gps-input");
BENCHMARK_CAPTURE(loops_share, json, "json");

}  // namespace
}  // namespace skyloop
