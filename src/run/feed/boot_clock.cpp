#include "detail/boot_clock.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop {
namespace {

constexpr double boot_gain = 0.1, boot_step_ns = 100e6;
constexpr double least_boot_rate = 0, most_boot_rate = 100;
constexpr std::int64_t least_measured_ns = 10'000'000, longest_measured_ns = 5'000'000'000;

}  // namespace

// A loop of second order, as that of arrivals; beyond a tenth of a second it is set, with the rate of the last two.
void BootClock::heard(Nanoseconds boot, std::int64_t received_ns) {
    const auto predicted = at(received_ns);
    const std::int64_t since_ns = received_ns - received_ns_, told_ns = boot.count() - said_ns_;
    said_ns_ = boot.count();
    received_ns_ = received_ns;
    const double error_ns = predicted ? static_cast<double>((boot - *predicted).count()) : 0;
    if (predicted && std::abs(error_ns) < boot_step_ns) {
        boot_ns_ = predicted->count() + std::llround(boot_gain * error_ns);
        if (since_ns >= least_measured_ns)
            rate_ = std::clamp(rate_ + boot_gain * boot_gain / 4 * error_ns / static_cast<double>(since_ns),
                               least_boot_rate, most_boot_rate);
        return;
    }
    boot_ns_ = boot.count();
    if (!predicted || told_ns < 0 || since_ns > longest_measured_ns)
        rate_ = 1;
    else if (since_ns >= least_measured_ns)
        rate_ = std::min(static_cast<double>(told_ns) / static_cast<double>(since_ns), most_boot_rate);
}

std::optional<Nanoseconds> BootClock::at(std::int64_t received_ns) const {
    constexpr double longest_ns = 1e15;
    if (!boot_ns_) return std::nullopt;
    const double since = std::clamp(static_cast<double>(received_ns - received_ns_), -longest_ns, longest_ns);
    return Nanoseconds(*boot_ns_ + std::llround(rate_ * since));
}

}  // namespace skyloop
