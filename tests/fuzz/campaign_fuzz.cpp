// Any bytes as a campaign: the plan of a scenario, and the files of a campaign's folder.
#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "campaigns/campaign/campaign_folder.hpp"
#include "campaigns/campaign/shard_results.hpp"
#include "require.hpp"
#include "run/scenario/scenario_file.hpp"

namespace {

using namespace skyloop;

void check_plan(std::string_view text) {
    const auto scenario = read_scenario(text, "fuzz.toml");
    if (!scenario || !scenario->campaign) return;
    const CampaignSettings& campaign = *scenario->campaign;
    if (campaign.samples * (campaign.parameters.size() + 1) > 100'000) return;  // only time
    const auto plan = CampaignPlan::make(campaign, "fuzz");
    if (!plan) {
        require(plan.error().code == ErrorCode::usage);
        return;
    }
    require(plan->size() > 0 && plan->size() <= most_campaign_runs);
    std::set<std::string> keys;
    const std::uint64_t looked_at = std::min<std::uint64_t>(plan->size(), 20);
    for (std::uint64_t i = 0; i < looked_at; ++i) {
        const PlannedRun run = plan->run(i);
        require(run.key.size() == 32 && run.values.size() == plan->parameters().size());
        keys.insert(run.key);
        const auto changed = read_scenario(text, "fuzz.toml", plan->changes_of(run));
        require(changed || changed.error().message.starts_with("fuzz.toml:"));
    }
    require(keys.size() == looked_at);
}

void check_tables(std::string_view text) {
    const std::size_t end = text.find('\n');
    const auto columns = parse_result_header(text.substr(0, end));
    if (!columns || end == std::string_view::npos) return;
    const auto row = parse_result_row(text.substr(end + 1), *columns);
    if (!row) return;
    std::string again = result_row(*row);
    again.pop_back();
    const auto back = parse_result_row(again, *columns);
    require(back && back->key == row->key && back->verdicts.size() == row->verdicts.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    check_plan(text);
    check_tables(text);
    const auto kept = parse_kept_campaign(text, "campaign.json");
    require(kept || kept.error().message.starts_with("campaign.json: "));
    const auto values = parse_campaign_values(text.substr(0, 200));
    require(!values || !values->empty());
    return 0;
}
