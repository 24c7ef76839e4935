#include "run/emulator/osnma_files.hpp"

#include <fmt/format.h>

namespace skyloop::inline run {

std::shared_ptr<const OsnmaKeys> osnma_keys_of(const Scenario& scenario, GpsTime start) {
    if (!scenario.sky.osnma) return nullptr;
    OsnmaSettings settings{scenario.run.seed_of_sky(), start};
    if (scenario.sky.osnma_new_key) settings.new_key = advanced(start, *scenario.sky.osnma_new_key);
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
