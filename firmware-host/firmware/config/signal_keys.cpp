#include "firmware/config/signal_keys.hpp"

namespace skyloop::firmware {

std::vector<Constellation> enabled_systems(const ConfigStore& config) {
    std::vector<Constellation> systems;
    for (const SystemKeys& system : system_keys_of_signals)
        if (config.flag(system.enable)) systems.push_back(system.constellation);
    return systems;
}

}  // namespace skyloop::firmware
