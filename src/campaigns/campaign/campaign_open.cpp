#include <fmt/format.h>

#include <set>

#include "base/core/text_file.hpp"
#include "campaigns/campaign/campaign_folder.hpp"
#include "detail/campaign_check.hpp"
#include "run/scenario/board_file.hpp"
#include "run/scenario/scenario_file.hpp"

namespace skyloop {
namespace {

// Of a board by its name. One by its path is among the files that the scenario names. Nothing: there is none.
std::optional<std::string> board_digest(const std::string& board, const DataFolders& data, KeyedFiles& files) {
    if (is_board_path(board)) return std::nullopt;
    for (const auto& folder : board_folders(data))
        if (const auto digest = files.digest(folder / "receivers" / (board + ".toml"))) return *digest;
    return std::nullopt;
}

void add_boards(const Scenario& scenario, const DataFolders& data, CampaignBase& base, KeyedFiles& files) {
    for (const ReceiverEntry& receiver : scenario.receivers)
        if (const auto digest = board_digest(receiver.board, data, files))
            base.more["board " + receiver.board] = *digest;
}

// A line for each file and board that a value of a parameter names.
Result<std::string> content_of_value(const CampaignRequest& request, const ScenarioChange& change, KeyedFiles& files) {
    std::string content;
    for (const std::string& name : files_of_change(change, request.scenario)) {
        const auto digest = files.digest(request.scenario.parent_path() / name);
        if (!digest) return fail(digest.error());
        content += fmt::format("file {} {}\n", name, *digest);
    }
    if (change.key.ends_with(".board"))
        if (const auto digest = board_digest(change.value.shown, request.data, files))
            content += fmt::format("board {} {}\n", change.value.shown, *digest);
    return content;
}

Result<ValueContents> contents_of_values(const CampaignRequest& request, const CampaignSettings& settings,
                                         KeyedFiles& files) {
    ValueContents contents;
    for (const CampaignParameter& parameter : settings.parameters) {
        const auto* values = std::get_if<std::vector<CampaignValue>>(&parameter.spread);
        for (std::size_t i = 0; values != nullptr && i < values->size(); ++i) {
            const auto content = content_of_value(request, {parameter.key, (*values)[i]}, files);
            if (!content) return fail(content.error());
            if (!content->empty()) contents[fmt::format("{} = {}", parameter.key, (*values)[i].toml)] = *content;
        }
    }
    return contents;
}

// A campaign takes the power of its receivers away, with a vehicle too: hardware would be switched by many runs at
// once.
std::vector<std::string> unswitched_power(const Scenario& scenario) {
    std::vector<std::string> warnings;
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i)
        if (const std::string& power = scenario.receivers[i].power; !power.empty())
            warnings.push_back(
                fmt::format("{}: power {}: runs of a campaign switch nothing real; skyloop run does, one run at a time",
                            receiver_name(scenario, i), power));
    return warnings;
}

Result<Scenario> base_scenario(const CampaignRequest& request, const std::string& text, CampaignSettings& settings,
                               std::vector<std::string>& warnings) {
    auto scenario = read_scenario(text, request.scenario);
    if (!scenario) return fail(scenario.error());
    settings = scenario->campaign.value_or(CampaignSettings{});
    if (request.seeds)
        if (const auto applied = apply_seeds(*request.seeds, settings); !applied) return fail(applied.error());
    std::set<std::string> varied;
    for (const std::string& vary : request.vary) {
        if (const auto applied = apply_vary(vary, settings); !applied) return fail(applied.error());
        const std::string key = vary.substr(0, vary.find('='));
        if (!varied.insert(key).second)
            return fail(ErrorCode::usage,
                        fmt::format("--vary {}: is given twice; expected it once, with all values", key));
    }
    scenario->campaign = settings;
    warnings = unswitched_power(*scenario);
    return campaign_scenario(*scenario);
}

Result<std::string> digest_of_base(const CampaignRequest& request, const std::string& text, const Scenario& scenario,
                                   std::vector<std::string>& warnings, KeyedFiles& files) {
    auto content = scenario_content(text, request.scenario);
    if (!content) return fail(content.error());
    const auto assembly = checked_assembly(scenario, request.data);
    if (!assembly) return fail(assembly.error());
    CampaignBase base{request.version, std::move(*content), request.scenario.parent_path(), {}};
    warnings.insert(warnings.end(), assembly->warnings.begin(), assembly->warnings.end());
    add_boards(scenario, request.data, base, files);
    base.more["geoid"] = assembly->geoid ? "EGM96" : "none";
    if (assembly->scene.digest != 0) base.more["scene"] = fmt::format("{:016x}", assembly->scene.digest);
    return campaign_base_digest(base, *scenario.campaign, files);
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
    std::vector<std::string> warnings;
    const auto scenario = base_scenario(request, *text, settings, warnings);
    if (!scenario) return fail(scenario.error());
    const std::vector<std::string> options = options_of(request);
    if (const auto once = check_parameter_keys({*text, request.scenario, options}, settings); !once)
        return fail(once.error());
    KeyedFiles files;
    const auto digest = digest_of_base(request, *text, *scenario, warnings, files);
    if (!digest) return fail(digest.error());
    auto contents = contents_of_values(request, settings, files);
    if (!contents) return fail(contents.error());
    auto plan = CampaignPlan::make(settings, *digest, std::move(*contents));
    if (!plan) return fail(plan.error().code, fmt::format("{}: {}", request.scenario.string(), plan.error().message));
    const auto columns = result_columns(*scenario, plan->parameters());
    if (!columns) return fail(columns.error());
    return OpenedCampaign{{*text, request.scenario, request.data, *columns},
                          std::move(*plan),
                          settings.name.empty() ? request.scenario.stem().string() : settings.name,
                          options,
                          request.version,
                          std::move(warnings),
                          settings.vehicle ? settings.vehicle->command : std::string(),
                          std::move(files)};
}

}  // namespace skyloop
