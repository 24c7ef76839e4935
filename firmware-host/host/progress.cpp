#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "skyloop/time/utc_time.hpp"

namespace skyloop::host {
namespace {

std::string count_text(std::uint64_t bytes) {
    if (bytes < 10'000) return fmt::format("{} B", bytes);
    if (bytes < 10'000'000) return fmt::format("{:.1f} kB", static_cast<double>(bytes) * 1e-3);
    return fmt::format("{:.1f} MB", static_cast<double>(bytes) * 1e-6);
}

}  // namespace

Progress::Progress(bool wanted, GpsTime start, std::optional<GpsTime> end)
    : active_(wanted && isatty(STDERR_FILENO) == 1), start_(start), end_(end) {}

Progress::~Progress() { clear(); }

void Progress::show(const Status& status, const Emulator& emulator) {
    constexpr std::int64_t pause_ns = 200'000'000;
    if (!active_) return;
    const std::int64_t now_ns = std::chrono::steady_clock::now().time_since_epoch().count();
    if (on_screen_ && now_ns - shown_ns_ < pause_ns) return;
    shown_ns_ = now_ns;

    const Fix& fix = status.trace->epoch.fix;
    std::string line =
        fmt::format("{}  fix {:<4} {:>2}/{:<2} satellites", format_utc(to_utc(status.now, LeapSeconds::announced()), 0),
                    fix_type_name(fix.type), fix.satellites_used(), fix.satellites.size());
    if (fix.has_position()) line += fmt::format("  HDOP {:.2f}", fix.dop.hdop);
    line += fmt::format("  {:g} Hz  late {:.2f} ms",
                        1e9 / static_cast<double>(emulator.receiver().settings().navigation_period.count()),
                        static_cast<double>(status.lateness.count()) * 1e-6);
    std::uint64_t bytes = 0;
    for (const Link& link : emulator.links())
        bytes += link.counters().bytes_out;
    if (!emulator.links().empty()) line += "  " + count_text(bytes);
    if (end_)
        line +=
            fmt::format("  {:.0f} %", 100 * difference(status.now, start_).value() / difference(*end_, start_).value());
    std::fprintf(stderr, "\r\033[K%s", line.c_str());
    std::fflush(stderr);
    on_screen_ = true;
}

void Progress::clear() {
    if (!on_screen_) return;
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
    on_screen_ = false;
}

}  // namespace skyloop::host
