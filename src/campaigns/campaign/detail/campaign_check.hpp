/// What is wrong with a campaign before any of its runs.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "run/emulator/assembly.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop {

/// Everything is read, nothing is run.
Result<Assembly> checked_assembly(const Scenario& scenario, const DataFolders& data);

/// Where the values of a campaign come from.
struct CampaignSource {
    const std::string& text;                  ///< of the scenario
    const std::filesystem::path& file;        ///< its name
    const std::vector<std::string>& options;  ///< OpenedCampaign::options
};

/// Where a key is varied: "--vary KEY", else FILE:LINE:COLUMN of its parameter.
std::string place_of_varied(const CampaignSource& source, std::string_view key);

/// Fails with `input` where two parameters set the same key of the scenario, under whatever names.
Result<void> check_parameter_keys(const CampaignSource& source, const CampaignSettings& settings);

}  // namespace skyloop
