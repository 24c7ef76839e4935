#include "run/emulator/osnma_files.hpp"

#include <fmt/format.h>

#include <utility>

namespace skyloop::inline run {

std::shared_ptr<const OsnmaKeys> osnma_keys_of(const Scenario& scenario, GpsTime start) {
    if (!scenario.sky.osnma) return nullptr;
    OsnmaSettings settings{scenario.run.seed_of_sky(), start};
    const OsnmaEvents& events = scenario.sky.osnma_events;
    for (const auto& [change, when] : {std::pair(OsnmaChange::new_key, events.new_key),
                                       {OsnmaChange::new_chain, events.new_chain},
                                       {OsnmaChange::revoked_chain, events.revoked_chain},
                                       {OsnmaChange::revoked_key, events.revoked_key},
                                       {OsnmaChange::alert, events.alert}})
        if (when) settings.change = change, settings.at = advanced(start, *when);
    return std::make_shared<const OsnmaKeys>(settings);
}

std::map<std::string, std::string> osnma_files(const OsnmaKeys* keys) {
    std::map<std::string, std::string> files;
    if (keys == nullptr) return files;
    files["osnma_keys.xml"] = keys->tree_xml();
    for (int number = 1; number <= keys->public_keys(); ++number)
        files[fmt::format("osnma_public_key_{}.pem", number)] = keys->public_pem(number);
    return files;
}

}  // namespace skyloop::inline run
