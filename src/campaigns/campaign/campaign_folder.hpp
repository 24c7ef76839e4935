/// What a campaign is, opened from its scenario; and as its folder keeps it, so that gathering needs the folder alone.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/file_descriptor.hpp"
#include "base/core/result.hpp"
#include "campaigns/campaign/campaign_plan.hpp"
#include "campaigns/campaign/campaign_run.hpp"
#include "run/emulator/data_folders.hpp"

namespace skyloop::inline campaigns {

/// What is asked for.
struct CampaignRequest {
    std::filesystem::path scenario;
    std::optional<std::string> seeds{};  ///< apply_seeds()
    std::vector<std::string> vary{};     ///< apply_vary()
    std::string version;                 ///< of the program
    DataFolders data{};
};

/// A campaign ready to be run.
struct OpenedCampaign {
    CampaignRunSetup setup;  ///< of each of its runs
    CampaignPlan plan;
    std::string name;
    std::vector<std::string> options{};  ///< of the command line, that replaying a run takes too: "--seeds 5-7"
    std::string version;
    std::vector<std::string> warnings{};  ///< of its run without changes, for people
    std::string vehicle{};                ///< command of its vehicle; empty: it has none
    KeyedFiles files{};                   ///< whose content is in the keys of its runs
};

/// Reads the scenario and everything that its run reads, without changes. A file without [campaign] is a campaign of
/// one run. Fails as reading a scenario does.
Result<OpenedCampaign> open_campaign(const CampaignRequest& request);

/// Reads the scenario with the values of each run in the part that is `wanted`, and reads all that runs would read
/// which have between them each of a parameter's first 200 listed values, and the ends of what was drawn of a range.
/// Fails with the first mistake, naming the parameter's line or option; nothing has been run then.
/// @param stopped ends it early when it says so
/// @return what people should be told of values, beside the warnings of the campaign itself, each once
Result<std::vector<std::string>> check_runs(const OpenedCampaign& campaign, const std::vector<std::uint64_t>& wanted,
                                            const std::function<bool()>& stopped);

/// What campaign.json holds.
struct KeptCampaign {
    std::string name, version, scenario, base;
    std::vector<std::string> options{};
    std::string vehicle{};  ///< OpenedCampaign::vehicle
    ResultColumns columns{};
    std::vector<PlannedRun> runs{};  ///< by number; of their values what people read
};
/// Whether a folder may keep this campaign. Fails with `input` where the campaign.json that is there is that of another
/// one, with other parameters, metrics or expectations, or none of ours.
Result<void> check_folder(const std::filesystem::path& folder, const OpenedCampaign& campaign);
/// Writes DIR/campaign.json, under another name first. Nothing is written where it is the same already, or where
/// check_folder() fails; nor where somebody holds one with the same runs, on whose machine the scenario may have
/// another name. Fails with `input` where somebody holds one with other runs.
/// @return holds it against other plans as long as it is open; where a file system has no locks nothing is held
Result<FileDescriptor> keep_campaign(const std::filesystem::path& folder, const OpenedCampaign& campaign);
/// Fails with `outside` where there is none, with `input` where it is not understood.
Result<KeptCampaign> kept_campaign(const std::filesystem::path& folder);
/// The same from its text. @param name of the file, for messages
Result<KeptCampaign> parse_kept_campaign(std::string_view text, const std::string& name);

}  // namespace skyloop::inline campaigns
