#include "firmware/ublox/config/signal_keys.hpp"

#include <algorithm>

namespace skyloop::firmware {
namespace {

bool has_signal_on(const ConfigStore& config, Constellation system) {
    return std::any_of(signal_keys.begin(), signal_keys.end(),
                       [&](const SignalKey& s) { return s.signal.constellation == system && config.flag(s.enable); });
}

}  // namespace

std::set<SystemSignal> enabled_signals(const ConfigStore& config) {
    std::set<SystemSignal> enabled;
    for (const SystemKeys& system : system_keys_of_signals) {
        if (!config.flag(system.enable)) continue;
        for (const SignalKey& s : signal_keys)
            if (s.signal.constellation == system.constellation && config.flag(s.enable)) enabled.insert(s.signal);
    }
    return enabled;
}

std::vector<Constellation> enabled_systems(const ConfigStore& config) {
    std::vector<Constellation> systems;
    for (const SystemKeys& system : system_keys_of_signals)
        if (config.flag(system.enable) && has_signal_on(config, system.constellation))
            systems.push_back(system.constellation);
    return systems;
}

bool is_enabled(const ConfigStore& config, Constellation system) {
    return std::any_of(system_keys_of_signals.begin(), system_keys_of_signals.end(), [&](const SystemKeys& s) {
        return s.constellation == system && config.flag(s.enable) && has_signal_on(config, system);
    });
}

}  // namespace skyloop::firmware
