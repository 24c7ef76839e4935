#include "firmware/core/monitor_drift.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/core/bytes.hpp"

namespace skyloop::firmware {
namespace {

constexpr double full_gain = 8191;
constexpr double indicator_sigma = 4, gain_sigma = 50, noise_sigma = 2;
constexpr Seconds indicator_time{3}, gain_time{30}, noise_time{15};
constexpr double most_gain_drift = 100, most_noise_drift = 5, most_indicator = 30;

// Counts in records are multiples of 73 (a GR-701W, u-blox 7), 78 (a GR-8013, u-blox 8) and 117 (NEO-F9V and ZED-F9R).
// Inferred for u-blox 6 and 10.
double gain_step_of(int generation) { return generation <= 7 ? 73 : generation == 8 ? 78 : 117; }

std::uint64_t module_of(const BoardProfile& board) {
    const Bytes& id = board.identity.unique_id;
    if (!id.empty()) return fnv1a_64(std::string(id.begin(), id.end()));
    return fnv1a_64(board.usb && !board.usb->serial.empty() ? board.usb->serial : board.name);
}

double between(double least, double most, double share) { return least + (most - least) * share; }

}  // namespace

MonitorDrift::Band::Band(std::uint64_t module, std::uint64_t seed, const char* name, double gain_step)
    : indicator_({indicator_sigma, indicator_time}, {seed, std::string("monitors.indicator.") + name}),
      gain_({gain_sigma, gain_time}, {seed, std::string("monitors.gain.") + name}),
      noise_({noise_sigma, noise_time}, {seed, std::string("monitors.noise.") + name}) {
    RandomStream by_module(module, std::string("module.") + name);
    level_.indicator = between(8, 18, by_module.uniform());
    level_.gain = gain_step * std::round(between(2457, 4914, by_module.uniform()) / gain_step);
    level_.noise = between(65, 99, by_module.uniform());
}

void MonitorDrift::Band::advance(Seconds dt) {
    indicator_.advance(dt);
    gain_.advance(dt);
    noise_.advance(dt);
}

QuietBand MonitorDrift::Band::now() const {
    const auto within = [](double drift, double most) { return std::clamp(drift, -most, most); };
    return {std::clamp(level_.indicator + indicator_.value(), 0.0, most_indicator),
            level_.gain + within(gain_.value(), most_gain_drift),
            level_.noise + within(noise_.value(), most_noise_drift)};
}

MonitorDrift::MonitorDrift(const BoardProfile& board, std::uint64_t seed)
    : gain_step_(gain_step_of(board.identity.generation)),
      upper_(module_of(board), seed, "upper", gain_step_),
      lower_(module_of(board), seed, "lower", gain_step_),
      warmth_(between(-4, 4, RandomStream(module_of(board), "module.warmth").uniform())),
      temperature_({0.5, Seconds(600)}, {seed, "monitors.temperature"}),
      dice_stream_(seed, "monitors.span") {}

void MonitorDrift::advance(GpsTime now) {
    const Seconds dt = last_ ? difference(now, *last_) : Seconds(0);
    if (dt.value() < 0) return;
    last_ = now;
    upper_.advance(dt);
    lower_.advance(dt);
    temperature_.advance(dt);
    dice_ = dice_stream_.bits();
}

int MonitorDrift::gain_count(double gain) const {
    return static_cast<int>(gain_step_ * std::round(std::clamp(gain, 0.0, full_gain) / gain_step_));
}

double MonitorDrift::temperature(Seconds since_boot) const {
    constexpr double level = 28, warming = 5, warming_time_s = 180;
    return level + warmth_ - warming * std::exp(-std::max(0.0, since_boot.value()) / warming_time_s) +
           temperature_.value();
}

}  // namespace skyloop::firmware
