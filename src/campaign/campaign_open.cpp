#include <fmt/format.h>

#include "skyloop/base/text_file.hpp"
#include "skyloop/campaign/campaign_folder.hpp"
#include "skyloop/campaign/sha256.hpp"
#include "skyloop/scenario/scenario_file.hpp"

namespace skyloop {
namespace {

// Those that the program finds by name; the path of one stands in the scenario.
void add_boards(const Scenario& scenario, const DataFolders& data, CampaignBase& base) {
    for (const ReceiverEntry& receiver : scenario.receivers)
        for (const auto& folder : board_folders(data))
            if (const auto text = read_text_file(folder / "receivers" / (receiver.board + ".toml"))) {
                base.more["board " + receiver.board] = sha256_hex(*text);
                break;
            }
}

// Everything is read, nothing is run.
Result<Assembly> checked_assembly(const Scenario& scenario, const DataFolders& data) {
    RunMode mode = campaign_mode(scenario);
    mode.open_ports = false;
    mode.only_checked = true;
    return assemble(scenario, data, mode);
}

Result<Scenario> base_scenario(const CampaignRequest& request, const std::string& text, CampaignSettings& settings) {
    auto scenario = read_scenario(text, request.scenario);
    if (!scenario) return fail(scenario.error());
    settings = scenario->campaign.value_or(CampaignSettings{});
    if (request.seeds)
        if (const auto applied = apply_seeds(*request.seeds, settings); !applied) return fail(applied.error());
    for (const std::string& vary : request.vary)
        if (const auto applied = apply_vary(vary, settings); !applied) return fail(applied.error());
    scenario->campaign = settings;
    return campaign_scenario(*scenario);
}

Result<std::string> digest_of_base(const CampaignRequest& request, const std::string& text, const Scenario& scenario,
                                   std::vector<std::string>& warnings) {
    auto content = scenario_content(text, request.scenario);
    if (!content) return fail(content.error());
    const auto assembly = checked_assembly(scenario, request.data);
    if (!assembly) return fail(assembly.error());
    CampaignBase base{request.version, std::move(*content), request.scenario.parent_path(), {}};
    warnings = assembly->warnings;
    add_boards(scenario, request.data, base);
    base.more["geoid"] = assembly->geoid ? "EGM96" : "none";
    if (assembly->scene.digest != 0) base.more["scene"] = fmt::format("{:016x}", assembly->scene.digest);
    return campaign_base_digest(base, *scenario.campaign);
}

std::vector<std::string> options_of(const CampaignRequest& request) {
    std::vector<std::string> options;
    if (request.seeds) options.insert(options.end(), {"--seeds", *request.seeds});
    for (const std::string& vary : request.vary)
        options.insert(options.end(), {"--vary", vary});
    return options;
}

}  // namespace

Result<OpenedCampaign> open_campaign(const CampaignRequest& request) {
    constexpr std::size_t largest = std::size_t{16} << 20;
    const auto text = read_text_file(request.scenario, largest);
    if (!text) return fail(text.error());
    CampaignSettings settings;
    const auto scenario = base_scenario(request, *text, settings);
    if (!scenario) return fail(scenario.error());
    std::vector<std::string> warnings;
    const auto digest = digest_of_base(request, *text, *scenario, warnings);
    if (!digest) return fail(digest.error());
    auto plan = CampaignPlan::make(settings, *digest);
    if (!plan) return fail(plan.error().code, fmt::format("{}: {}", request.scenario.string(), plan.error().message));
    const auto columns = result_columns(*scenario, plan->parameters());
    if (!columns) return fail(columns.error());
    return OpenedCampaign{{*text, request.scenario, request.data, *columns},
                          std::move(*plan),
                          settings.name.empty() ? request.scenario.stem().string() : settings.name,
                          options_of(request),
                          request.version,
                          std::move(warnings)};
}

Result<void> check_runs(const OpenedCampaign& campaign, const std::vector<std::uint64_t>& wanted) {
    const std::uint64_t seeds = campaign.plan.size() / campaign.plan.points();
    std::optional<std::uint64_t> checked;
    for (const std::uint64_t number : wanted) {
        if (checked && *checked / seeds == number / seeds) continue;
        const PlannedRun run = campaign.plan.run(number);
        const auto asked =
            read_changed_scenario(campaign.setup.text, campaign.setup.file, campaign.plan.changes_of(run));
        if (!asked) return fail(asked.error());
        const auto scenario = campaign_scenario(*asked);
        if (!scenario) return fail(scenario.error());
        if (!checked)
            if (const auto read = checked_assembly(*scenario, campaign.setup.data); !read) return fail(read.error());
        checked = number;
    }
    return {};
}

}  // namespace skyloop
