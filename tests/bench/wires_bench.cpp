/// Bytes on time: receivers in real time on pseudo-terminals, against a bare sleep and a bare write of the same run.
///
/// SKYLOOP_BENCH_SECONDS is how long each lasts, 20 unless given. The first two seconds do not count: clients
/// configure.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <thread>

#include "base/time/utc_time.hpp"
#include "real_time.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "run/emulator/assembly.hpp"
#include "support/oracle_table.hpp"
#include "wire/transport/pty.hpp"

namespace {

using namespace skyloop;
using namespace skyloop::bench;

// NAV-PVT and NAV-SAT each epoch, and nothing else: CFG-PRT (protocols UBX in, UBX out) and CFG-MSG.
Bytes configuration(unsigned baud) {
    const auto byte = [&](unsigned shift) { return static_cast<std::uint8_t>(baud >> shift); };
    Bytes all = encode_frame(
        {0x06, 0x00}, Bytes{1, 0, 0, 0, 0xD0, 8, 0, 0, byte(0), byte(8), byte(16), byte(24), 1, 0, 1, 0, 0, 0, 0, 0});
    for (const std::uint8_t message : {std::uint8_t{0x07}, std::uint8_t{0x35}}) {
        const Bytes frame = encode_frame({0x06, 0x01}, Bytes{0x01, message, 1});
        all.insert(all.end(), frame.begin(), frame.end());
    }
    return all;
}

// What every measurement of one run shares.
struct Clockwork {
    std::int64_t base = 0;    // steady clock at the first epoch
    std::int64_t period = 0;  // of the epochs
    std::atomic<bool> over{false};
    [[nodiscard]] bool settled(std::int64_t now) const { return now - base >= settled_after; }
    [[nodiscard]] std::int64_t since_epoch(std::int64_t now) const { return (now - base) % period; }
    [[nodiscard]] std::int64_t epoch(std::int64_t now) const { return (now - base) / period; }
};

// Sleeps as the loop does, half a period beside it, and writes 100 bytes on a terminal of its own each time.
struct BareLoop {
    std::unique_ptr<PtyTransport> wire = PtyTransport::open().value();
    std::atomic<std::int64_t> written_at{0};
    Durations lateness;

    void run(const Clockwork& clock) {
        (void)raise_thread_priority();
        const Bytes block(100, 0x55);
        for (std::int64_t due = clock.base + clock.period / 2; !clock.over; due += clock.period) {
            const timespec deadline{due / wire_second, due % wire_second};
            clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr);
            const std::int64_t now = steady_clock_ns();
            if (clock.settled(now)) lateness.add(now - due);
            wire->line();
            written_at = steady_clock_ns();
            wire->write(block);
        }
    }
};

// An epoch's bytes at the speed of the line, a block each millisecond, by nobody but the kernel: what gaps a reader
// sees on this machine in any case.
struct BarePacer {
    std::unique_ptr<PtyTransport> wire = PtyTransport::open().value();

    void run(const Clockwork& clock, unsigned baud) {
        (void)raise_thread_priority();
        constexpr std::size_t epoch_bytes = 400;
        const Bytes block(baud / 10'000, 0x55);
        for (std::int64_t epoch = clock.base; !clock.over; epoch += clock.period)
            for (std::size_t i = 0; i * block.size() < epoch_bytes && !clock.over; ++i) {
                const std::int64_t due = epoch + static_cast<std::int64_t>(i) * wire_ms;
                const timespec deadline{due / wire_second, due % wire_second};
                clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr);
                wire->line();
                wire->write(block);
            }
    }
};

// Epochs in which bytes of one stream stopped coming for too long for a client that takes silence for an epoch's end.
struct GapCount {
    std::uint64_t epochs = 0, with_gap = 0;
    [[nodiscard]] double share() const {
        return static_cast<double>(with_gap) / static_cast<double>(std::max<std::uint64_t>(epochs, 1));
    }
};

// All clients in one thread: when their bytes came.
class Readers {
public:
    Readers(const Emulator& emulator, const BarePacer& pacer, const BareLoop& bare, unsigned baud) {
        for (const Station& station : emulator.stations()) {
            const std::string description = station.wires().front().link.transport().description();
            open(description.substr(0, description.find(' ')));
            const Bytes commands = configuration(baud);
            if (::write(ends_.back().fd, commands.data(), commands.size()) < 0) ends_.back().events = 0;
        }
        pacer_ = ends_.size();
        open(pacer.wire->terminal());
        open(bare.wire->terminal());
        last_.resize(ends_.size(), 0);
    }
    ~Readers() {
        for (const pollfd& end : ends_)
            ::close(end.fd);
    }
    Readers(const Readers&) = delete;
    Readers& operator=(const Readers&) = delete;

    // At no raised priority: the kernel's thread that hands bytes from one end of a terminal to the other has none
    // either, and would wait for this one where there are two cores.
    void run(const Clockwork& clock, const BareLoop& bare) {
        while (!clock.over) {
            if (::poll(ends_.data(), ends_.size(), 100) <= 0) continue;
            const std::int64_t now = steady_clock_ns();
            for (std::size_t i = 0; i < ends_.size(); ++i)
                if ((ends_[i].revents & POLLIN) != 0) take(i, now, clock, bare);
        }
    }

    Durations first_byte, bare_read, gaps;
    std::map<std::int64_t, std::int64_t> first_of_epoch;  // of the first port: ns since the epoch
    std::uint64_t bytes = 0;
    GapCount ours, paced;

private:
    void open(const std::string& path) {
        ends_.push_back({::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC), POLLIN, 0});
    }
    void take(std::size_t index, std::int64_t now, const Clockwork& clock, const BareLoop& bare) {
        std::array<char, 4096> piece{};
        const ssize_t count = ::read(ends_[index].fd, piece.data(), piece.size());
        if (count <= 0 || !clock.settled(now)) return;
        if (index + 1 == ends_.size()) return bare_read.add(now - bare.written_at);
        const bool is_ours = index < pacer_;
        if (is_ours) bytes += static_cast<std::uint64_t>(count);
        const std::int64_t last = std::exchange(last_[index], now);
        if (last == 0 || clock.epoch(last) != clock.epoch(now)) {
            if (is_ours) first_byte.add(clock.since_epoch(now));
            if (index == 0) first_of_epoch[clock.epoch(now)] = clock.since_epoch(now);
            ++(is_ours ? ours : paced).epochs;
            gap_seen_.erase(index);
            return;
        }
        if (is_ours) gaps.add(now - last);
        constexpr std::int64_t longest_gap = 5 * wire_ms;
        if (now - last > longest_gap && gap_seen_.insert(index).second) ++(is_ours ? ours : paced).with_gap;
    }

    std::vector<pollfd> ends_;
    std::vector<std::int64_t> last_;  // byte of each
    std::size_t pacer_ = 0;
    std::set<std::size_t> gap_seen_;
};

Scenario fleet_scenario(const Fleet& fleet, const std::filesystem::path& folder) {
    Scenario scenario;
    scenario.run.start = to_gps_time({2026, 3, 1, 12, 0, 0, 0}, LeapSeconds::announced());
    scenario.run.duration = Seconds(wire_seconds());
    ReceiverEntry entry;
    entry.board = board_for(fleet, folder);
    entry.rate_hz = fleet.rate_hz;
    entry.baud = fleet.baud;
    scenario.receivers.assign(fleet.receivers, entry);
    for (std::size_t i = 0; i < fleet.receivers; ++i) {
        Circle::Shape shape;
        shape.centre = Geodetic::degrees(46.5, 30.7 + 0.001 * static_cast<double>(i), 100);
        scenario.receivers[i].trajectory = CircleSettings{shape, {}};
    }
    return scenario;
}

// A run whose time begins when everything is ready: a first assembly shows how long one takes.
Assembly assemble_fleet(const Scenario& scenario, Clockwork& clock) {
    const DataFolders data{{SKYLOOP_SOURCE_DIR, test::built_data()}};
    RunMode mode;
    mode.now = *scenario.run.start;
    mode.now_steady_ns = steady_clock_ns();
    (void)assemble(scenario, data, mode).value();
    const std::int64_t one = steady_clock_ns() - mode.now_steady_ns;
    mode.now_steady_ns = clock.base = steady_clock_ns() + 3 * one + wire_second;
    return std::move(assemble(scenario, data, mode).value());
}

void receivers_on_time(benchmark::State& state, const Fleet& fleet) {
    const auto folder = std::filesystem::temp_directory_path() / fmt::format("skyloop-bench-{}", ::getpid());
    std::filesystem::create_directories(folder);
    Clockwork clock;
    clock.period = fleet.period();
    const Assembly assembly = assemble_fleet(fleet_scenario(fleet, folder), clock);
    Emulator& emulator = *assembly.emulator;
    BareLoop bare;
    BarePacer pacer;
    Readers readers(emulator, pacer, bare, fleet.baud);
    Durations lateness, from_truth;
    std::map<std::int64_t, std::int64_t> late;  // of each epoch
    emulator.on_status([&](const Status& status) {
        const std::int64_t due = clock.base + (status.now - assembly.start).count();
        if (status.station != 0 || !clock.settled(due)) return;
        lateness.add(status.lateness.count());
        late[clock.epoch(due)] = status.lateness.count();
    });
    double cpu = 0;
    for (auto _ : state) {
        std::thread reader([&] { readers.run(clock, bare); }), sleeper([&] { bare.run(clock); }),
            paced([&] { pacer.run(clock, fleet.baud); });
        std::thread([&] {
            state.counters["real_time_priority"] = prepare_for_deadlines().priority == ThreadPriority::realtime;
            const double before = cpu_of_thread();
            emulator.run_until(*assembly.end, clock.over);
            cpu = cpu_of_thread() - before;
        }).join();
        clock.over = true;
        sleeper.join();
        paced.join();
        reader.join();
    }
    std::filesystem::remove_all(folder);
    for (const auto& [epoch, first] : readers.first_of_epoch)
        if (const auto found = late.find(epoch); found != late.end()) from_truth.add(first - found->second);
    tell(state, "lateness", lateness, bare.lateness);
    tell(state, "first_byte", readers.first_byte, readers.bare_read);
    tell(state, "truth_to_byte", from_truth, readers.bare_read);
    state.counters["core_share"] = cpu / wire_seconds();
    state.counters["epochs_with_gap_over_5ms"] = readers.ours.share();
    state.counters["epochs_with_gap_over_5ms_bare"] = readers.paced.share();
    state.counters["longest_gap_us"] = readers.gaps.at(1);
    state.counters["epochs_heard"] = static_cast<double>(readers.ours.epochs);
    state.counters["bytes_per_epoch"] =
        static_cast<double>(readers.bytes) / static_cast<double>(std::max<std::uint64_t>(readers.ours.epochs, 1));
    state.counters["samples"] = static_cast<double>(lateness.count());
}
BENCHMARK_CAPTURE(receivers_on_time, m9_64_ptys_10_hz, Fleet{64, "ublox-m9", 10, 115200})
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(receivers_on_time, f9p_1_pty_25_hz, Fleet{1, "ublox-f9p", 25, 230400})
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

}  // namespace
