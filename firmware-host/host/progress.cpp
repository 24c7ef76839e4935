#include "progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

#include "base/core/threads.hpp"
#include "base/time/utc_time.hpp"

namespace skyloop::host {
namespace {

std::string count_text(std::uint64_t bytes) {
    if (bytes < 10'000) return fmt::format("{} B", bytes);
    if (bytes < 10'000'000) return fmt::format("{:.1f} kB", static_cast<double>(bytes) * 1e-3);
    return fmt::format("{:.1f} MB", static_cast<double>(bytes) * 1e-6);
}

// What buildings leave of the sky: satellites in sight of those above the horizon, and echoes.
std::string city_text(const RayTracedScene& city) {
    std::size_t in_sight = 0, reflected = 0;
    for (const SatellitePaths& satellite : city.paths()) {
        in_sight += satellite.line_of_sight ? 1 : 0;
        reflected += satellite.paths.size();
    }
    return fmt::format("  {}/{} in sight, {} reflections, {} rays", in_sight, city.paths().size(), reflected,
                       city.counters().rays_last);
}

std::string fix_text(const Status& status, const Station& station, bool of_several) {
    const Fix& fix = status.trace->epoch.fix;
    std::string text = of_several ? station.name() + " " : "";
    text += fmt::format("fix {:<4} {:>2}/{:<2} satellites", fix_type_name(fix.type), fix.satellites_used(),
                        fix.satellites.size());
    if (fix.has_position()) text += fmt::format("  HDOP {:.2f}", fix.dop.hdop);
    if (const RayTracedScene* city = station.simulation().city()) text += city_text(*city);
    const auto period = static_cast<double>(station.receiver().settings().navigation_period.count());
    return text + fmt::format("  {:g} Hz", 1e9 / period);
}

// What all wires have taken; nothing when there are none.
std::string bytes_text(const std::vector<Station>& stations) {
    std::uint64_t bytes = 0;
    bool wired = false;
    for (const Station& station : stations)
        for (const Wire& wire : station.wires()) {
            bytes += wire.link.counters().bytes_out;
            wired = true;
        }
    return wired ? "  " + count_text(bytes) : "";
}

// A line that wraps cannot be rewritten: each would leave its beginning behind.
std::string fitted(std::string line) {
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 2) return line;
    std::size_t columns = 0, end = 0;
    while (end < line.size() && columns + 1 < size.ws_col) {
        ++columns;
        // A letter of several bytes, as in a receiver's name, stays whole.
        do
            ++end;
        while (end < line.size() && (static_cast<unsigned char>(line[end]) & 0xC0) == 0x80);
    }
    line.resize(end);
    return line;
}

void rewrite_line(const std::string& line) {
    std::fprintf(stderr, "\r\033[K%s", fitted(line).c_str());
    std::fflush(stderr);
}

}  // namespace

Progress::Progress(bool wanted, GpsTime start, std::optional<GpsTime> end, JobThread& writer)
    : active_(wanted && isatty(STDERR_FILENO) == 1), start_(start), end_(end), writer_(writer) {}

Progress::~Progress() { clear(); }

void Progress::show(const Status& status, const Emulator& emulator) {
    constexpr std::int64_t pause_ns = 200'000'000;
    if (!active_) return;
    const auto& stations = emulator.stations();
    fixes_.resize(stations.size());
    fixes_[status.station] = fix_text(status, stations[status.station], stations.size() > 1);
    const std::int64_t now_ns = steady_clock_ns();
    if (on_screen_ && now_ns - shown_ns_ < pause_ns) return;
    shown_ns_ = now_ns;

    std::string line = utc_text(status.now);
    for (const std::string& fix : fixes_)
        if (!fix.empty()) line += "  " + fix;
    line += fmt::format("  late {:.2f} ms", static_cast<double>(status.lateness.count()) * 1e-6);
    line += bytes_text(stations);
    if (end_)
        line +=
            fmt::format("  {:.0f} %", 100 * difference(status.now, start_).value() / difference(*end_, start_).value());
    writer_.run([line = std::move(line)] { rewrite_line(line); });
    on_screen_ = true;
}

void Progress::clear() {
    if (!on_screen_) return;
    writer_.run([] { rewrite_line({}); });
    on_screen_ = false;
}

}  // namespace skyloop::host
