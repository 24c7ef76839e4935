#include "campaigns/campaign/campaign_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "base/core/number_text.hpp"
#include "campaigns/campaign/campaign_design.hpp"
#include "campaigns/campaign/sha256.hpp"
#include "detail/vehicle_run.hpp"

namespace skyloop::inline campaigns {
namespace {

Result<void> add_named_content(Sha256& digest, const std::string& name, const Result<std::string>& content) {
    if (!content) return fail(content.error());
    digest.add(fmt::format("file {} {}\n", name, *content));
    return {};
}

Result<void> add_vehicle(Sha256& digest, const CampaignVehicle& vehicle, const std::filesystem::path& folder,
                         KeyedFiles& files) {
    digest.add(fmt::format("vehicle {}\ntimeout_s {}\n", vehicle.command, vehicle.timeout.value()));
    for (const std::string& name : programs_of_command(vehicle.command))
        if (const auto added = add_named_content(digest, name, files.digest(name)); !added) return added;
    for (const std::string& name : vehicle.files)
        if (const auto added = add_named_content(digest, name, files.digest(folder / name)); !added) return added;
    return {};
}

}  // namespace

Result<std::string> campaign_base_digest(const CampaignBase& base, const CampaignSettings& campaign,
                                         KeyedFiles& files) {
    Sha256 digest;
    digest.add(fmt::format("skyloop campaign, form 1\nversion {}\n{}", base.version, base.content.keys));
    for (const std::string& name : base.content.files)
        if (const auto added = add_named_content(digest, name, files.digest(base.folder / name)); !added)
            return fail(added.error());
    for (const auto& [name, other] : base.more)
        digest.add(fmt::format("{} {}\n", name, other));
    for (const std::string& metric : campaign.metrics)
        digest.add(fmt::format("metric {}\n", metric));
    if (campaign.vehicle)
        if (const auto added = add_vehicle(digest, *campaign.vehicle, base.folder, files); !added)
            return fail(added.error());
    return digest.hex();
}

namespace {

std::optional<std::uint64_t> whole_of(std::string_view text) {
    constexpr std::uint64_t most = 9007199254740992;  // 2^53, as in scenario files
    const auto value = number_in<std::uint64_t>(text);
    return value && *value <= most ? value : std::nullopt;
}

Result<std::uint64_t> grid_points(const CampaignSettings& campaign) {
    std::uint64_t points = 1;
    for (const CampaignParameter& parameter : campaign.parameters) {
        const std::uint64_t size = grid_size(parameter.spread);
        if (size == 0)
            return fail(ErrorCode::usage,
                        fmt::format("campaign parameter '{}' has no end of values, and the design is a grid; expected "
                                    "values, or design = \"random\"",
                                    parameter.key));
        if (size > most_campaign_runs || points * size > most_campaign_runs)
            return fail(ErrorCode::usage, fmt::format("the grid has more than {} points at parameter '{}'; expected "
                                                      "fewer values",
                                                      most_campaign_runs, parameter.key));
        points *= size;
    }
    return points;
}

std::vector<double> samples_for(const CampaignSettings& campaign, std::string_view key) {
    return campaign.design == CampaignDesign::random
               ? random_samples(campaign.samples, campaign.design_seed, key)
               : latin_hypercube_samples(campaign.samples, campaign.design_seed, key);
}

Result<void> take_seed_list(std::string_view text, CampaignSettings& campaign) {
    std::set<std::uint64_t> seen;
    for (std::string_view rest = text;;) {
        const std::size_t comma = rest.find(',');
        const auto seed = whole_of(rest.substr(0, comma));
        if (!seed || !seen.insert(*seed).second)
            return fail(ErrorCode::usage, fmt::format("--seeds {}: '{}' is {}; expected a number of seeds (100), the "
                                                      "first and the last (5-20), or a list (1,7,9)",
                                                      text, rest.substr(0, comma), seed ? "there twice" : "no seed"));
        campaign.seed_list.push_back(*seed);
        if (comma == std::string_view::npos) return {};
        rest.remove_prefix(comma + 1);
    }
}

}  // namespace

Result<Shard> parse_shard(std::string_view text) {
    const std::size_t slash = text.find('/');
    const auto index = whole_of(text.substr(0, slash));
    const auto count = slash == std::string_view::npos ? std::nullopt : whole_of(text.substr(slash + 1));
    if (!index || !count || *index >= *count || *count > most_campaign_runs)
        return fail(ErrorCode::usage,
                    fmt::format("--shard {}: expected I/N with I from 0 to N - 1, such as 0/8", text));
    return Shard{*index, *count};
}

Result<void> apply_seeds(std::string_view text, CampaignSettings& campaign) {
    campaign.seed_count = 0;
    campaign.seed_list.clear();
    if (text.find(',') != std::string_view::npos) return take_seed_list(text, campaign);
    const std::size_t dash = text.find('-');
    const auto first = whole_of(text.substr(0, dash));
    const auto last = dash == std::string_view::npos ? first : whole_of(text.substr(dash + 1));
    const bool range = dash != std::string_view::npos;
    if (!first || !last || (range && *last < *first) || (!range && *first == 0))
        return fail(ErrorCode::usage, fmt::format("--seeds {}: expected a number of seeds (100), the first and the "
                                                  "last (5-20), or a list (1,7,9)",
                                                  text));
    if (range) campaign.first_seed = *first;
    campaign.seed_count = range ? *last - *first + 1 : *first;
    return {};
}

Result<void> apply_vary(std::string_view text, CampaignSettings& campaign) {
    const std::size_t equals = text.find('=');
    const std::string key(text.substr(0, equals));
    if (equals == std::string_view::npos || key.empty())
        return fail(ErrorCode::usage, fmt::format("--vary {}: expected KEY=a,b,c", text));
    if (key == "run.seed" || key == "campaign" || key.starts_with("campaign."))
        return fail(ErrorCode::usage,
                    fmt::format("--vary {}: expected a key outside of [campaign]; seeds are told by --seeds", key));
    auto values = parse_campaign_values(text.substr(equals + 1));
    if (!values) return fail(values.error().code, fmt::format("--vary {}: {}", key, values.error().message));
    std::set<std::string> seen;
    for (const CampaignValue& value : *values)
        if (!seen.insert(sense_of(value)).second)
            return fail(ErrorCode::usage,
                        fmt::format("--vary {}: {} is there twice; expected it once", key, value.toml));
    auto at = std::find_if(campaign.parameters.begin(), campaign.parameters.end(),
                           [&](const CampaignParameter& p) { return p.key == key; });
    if (at == campaign.parameters.end()) at = campaign.parameters.insert(at, CampaignParameter{key, {}});
    at->spread = std::move(*values);
    return {};
}

Result<CampaignPlan> CampaignPlan::make(const CampaignSettings& campaign, std::string base, ValueContents contents) {
    CampaignPlan plan;
    plan.campaign_ = campaign;
    plan.base_ = std::move(base);
    plan.contents_ = std::move(contents);
    const bool draws = campaign.design != CampaignDesign::grid;
    if (draws) {
        plan.points_ = campaign.samples;
    } else {
        const auto points = grid_points(campaign);
        if (!points) return fail(points.error());
        plan.points_ = *points;
    }
    plan.seed_a_sample_ = draws && campaign.seed_list.empty() && campaign.seed_count == 0;
    plan.seeds_a_point_ =
        campaign.seed_list.empty() ? std::max<std::uint64_t>(1, campaign.seed_count) : campaign.seed_list.size();
    if (plan.points_ == 0 || plan.seeds_a_point_ > most_campaign_runs || plan.size() > most_campaign_runs)
        return fail(ErrorCode::usage,
                    fmt::format("the campaign has {} points with {} seeds each; expected 1 to {} runs", plan.points_,
                                plan.seeds_a_point_, most_campaign_runs));
    constexpr std::uint64_t most_numbers = 10'000'000;  // 80 MB
    if (draws && campaign.parameters.size() > most_numbers / plan.points_)
        return fail(ErrorCode::usage, "samples times parameters are more than 10 million; expected fewer");
    for (const CampaignParameter& parameter : campaign.parameters)
        if (draws) plan.samples_.push_back(samples_for(campaign, parameter.key));
    return plan;
}

std::uint64_t CampaignPlan::seed_of(std::uint64_t number) const {
    if (!campaign_.seed_list.empty()) return campaign_.seed_list.at(number % seeds_a_point_);
    return campaign_.first_seed + (seed_a_sample_ ? number : number % seeds_a_point_);
}

std::vector<CampaignValue> CampaignPlan::values_of(std::uint64_t point) const {
    const std::vector<CampaignParameter>& parameters = campaign_.parameters;
    std::vector<CampaignValue> values(parameters.size());
    for (std::size_t i = parameters.size(); i-- > 0;) {
        const CampaignSpread& spread = parameters[i].spread;
        if (samples_.empty()) {
            values[i] = grid_value(spread, point % grid_size(spread));
            point /= grid_size(spread);
        } else {
            values[i] = value_at(spread, samples_[i][point]);
        }
    }
    return values;
}

PlannedRun CampaignPlan::run(std::uint64_t number) const {
    PlannedRun run{number, {}, seed_of(number), values_of(number / seeds_a_point_)};
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < run.values.size(); ++i) {
        const std::string line = fmt::format("{} = {}", campaign_.parameters[i].key, run.values[i].toml);
        const auto content = contents_.find(line);
        lines.push_back(content == contents_.end() ? line + "\n" : fmt::format("{}\n{}", line, content->second));
    }
    std::sort(lines.begin(), lines.end());  // whatever order the campaign names them in
    Sha256 digest;
    digest.add(fmt::format("skyloop campaign run, form 1\n{}\n", base_));
    for (const std::string& line : lines)
        digest.add(line);
    digest.add(fmt::format("seed {}\n", run.seed));
    // Samples of few values may be alike; each counts.
    if (campaign_.design != CampaignDesign::grid && !seed_a_sample_)
        digest.add(fmt::format("sample {}\n", number / seeds_a_point_));
    run.key = digest.hex().substr(0, 32);
    return run;
}

std::vector<std::string> CampaignPlan::parameters() const {
    std::vector<std::string> keys;
    for (const CampaignParameter& parameter : campaign_.parameters)
        keys.push_back(parameter.key);
    return keys;
}

std::vector<ScenarioChange> CampaignPlan::changes_of(const PlannedRun& run) const {
    std::vector<ScenarioChange> changes;
    for (std::size_t i = 0; i < run.values.size(); ++i)
        changes.push_back({campaign_.parameters[i].key, run.values[i]});
    changes.push_back({"run.seed", campaign_value(static_cast<std::int64_t>(run.seed))});
    return changes;
}

}  // namespace skyloop::inline campaigns
