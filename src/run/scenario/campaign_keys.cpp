#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "detail/scenario_keys.hpp"
#include "detail/toml_values.hpp"

namespace skyloop::inline run {
namespace {

constexpr double most_runs = static_cast<double>(most_campaign_runs);
constexpr double longest_vehicle_s = 1e6;
constexpr double most_exact_whole = 9007199254740992;  // 2^53

void read_seed_list(TableReader& table, CampaignSettings& campaign) {
    const auto seeds = table.whole_numbers("seed_list", NumberRange::not_negative(),
                                           {"the seeds themselves, instead of their number", "none"});
    table.not_both("seeds", "seed_list");
    if (!seeds) return;
    std::set<std::int64_t> seen;
    for (const std::int64_t seed : *seeds) {
        if (!seen.insert(seed).second)
            return table.mistake("seed_list", fmt::format("holds {} twice; expected it once", seed));
        campaign.seed_list.push_back(static_cast<std::uint64_t>(seed));
    }
    if (campaign.seed_list.size() > most_campaign_runs)
        table.mistake("seed_list", fmt::format("has {} seeds; expected at most {}", seeds->size(), most_campaign_runs));
}

void read_value_list(TableReader& table, CampaignSpread& spread) {
    const toml::node* node = table.node("values", KeyType::values, {"what it takes", "none"});
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list == nullptr || list->empty()) return table.mistake("values", "is no list of values; expected at least one");
    std::vector<CampaignValue> values;
    std::set<std::string> seen;
    for (const toml::node& item : *list) {
        auto value = campaign_value(item);
        if (!value) return table.mistake("values", "holds a table; expected numbers, texts, flags, dates or lists");
        if (!seen.insert(sense_of(*value)).second)
            return table.mistake("values", fmt::format("holds {} twice; expected it once", value->toml));
        values.push_back(std::move(*value));
    }
    spread = std::move(values);
}

// Two numbers that ascend.
std::optional<std::pair<double, double>> read_ends(TableReader& table, std::string_view key, std::string_view meaning) {
    const auto ends = table.numbers(key, 2, {meaning, "none"});
    if (!ends) return std::nullopt;
    if ((*ends)[0] < (*ends)[1] && std::isfinite((*ends)[1] - (*ends)[0])) return std::pair((*ends)[0], (*ends)[1]);
    table.mistake(key, fmt::format("is [{}, {}]; expected the least and the greatest", (*ends)[0], (*ends)[1]));
    return std::nullopt;
}

void read_log_uniform(TableReader& table, CampaignSpread& spread) {
    const auto ends = read_ends(table, "log_uniform", "drawn so that its logarithm is uniform between those of these");
    if (!ends) return;
    if (ends->first <= 0)
        return table.mistake("log_uniform", fmt::format("begins at {}; expected ends above 0", ends->first));
    spread = LogUniformSpread{ends->first, ends->second};
}

void read_normal(TableReader& table, CampaignSpread& spread) {
    const auto numbers = table.numbers("normal", 2, {"drawn with this mean and standard deviation", "none"});
    if (!numbers) return;
    if ((*numbers)[1] <= 0)
        return table.mistake("normal",
                             fmt::format("has a standard deviation of {}; expected one above 0", (*numbers)[1]));
    spread = NormalSpread{(*numbers)[0], (*numbers)[1]};
}

void read_whole(TableReader& table, CampaignSpread& spread) {
    const auto ends = read_ends(table, "whole", "whole numbers from the first to the second");
    if (!ends) return;
    for (const double end : {ends->first, ends->second})
        if (end != std::floor(end) || std::abs(end) > most_exact_whole)
            return table.mistake("whole", fmt::format("has an end at {}; expected whole ones within 2^53", end));
    spread = WholeSpread{static_cast<std::int64_t>(ends->first), static_cast<std::int64_t>(ends->second)};
}

void read_spread(TableReader& table, CampaignSpread& spread) {
    read_value_list(table, spread);
    if (const auto ends = read_ends(table, "uniform", "drawn between these"))
        spread = UniformSpread{ends->first, ends->second};
    read_log_uniform(table, spread);
    read_normal(table, spread);
    read_whole(table, spread);
    std::string first;
    for (const char* key : {"values", "uniform", "log_uniform", "normal", "whole"}) {
        if (table.recording() || !table.has(key)) continue;
        if (!first.empty()) table.mistake(key, fmt::format("stands beside {}; expected one of them", first));
        first = key;
    }
    table.needs_one_of({"values", "uniform", "log_uniform", "normal", "whole"},
                       "says nothing of its values; expected values, uniform, log_uniform, normal or whole");
}

// A grid takes each value with each, and comes to an end.
void check_spread_of_grid(TableReader& table, const CampaignParameter& parameter) {
    if (std::holds_alternative<std::vector<CampaignValue>>(parameter.spread) ||
        std::holds_alternative<WholeSpread>(parameter.spread))
        return;
    for (const char* key : {"uniform", "log_uniform", "normal"})
        if (table.has(key))
            table.mistake(key, fmt::format("'{}' has no end of values; expected values or whole in a grid, or another "
                                           "design",
                                           parameter.key));
}

void read_parameter(TableReader& table, CampaignSettings& campaign) {
    CampaignParameter parameter;
    table.needs_one_of({"key"}, "names no key; expected key = \"run.duration_s\"");
    table.text("key", parameter.key, {"with dots: `model.name`, `fault.NAME.for_s`, `receiver.0.rate_hz`", "none"});
    read_spread(table, parameter.spread);
    if (campaign.design == CampaignDesign::grid && !table.recording()) check_spread_of_grid(table, parameter);
    const auto same = [&](const CampaignParameter& other) { return other.key == parameter.key; };
    if (std::any_of(campaign.parameters.begin(), campaign.parameters.end(), same))
        table.mistake("key", fmt::format("'{}' is that of another parameter too; expected it once", parameter.key));
    if (parameter.key == "run.seed")
        table.mistake("key", "is run.seed; expected the seeds in campaign.seeds or campaign.seed_list");
    if (parameter.key == "campaign" || parameter.key.starts_with("campaign."))
        table.mistake("key", fmt::format("is '{}'; expected a key outside of [campaign]", parameter.key));
    campaign.parameters.push_back(std::move(parameter));
}

void read_vehicle(TableReader& table, CampaignSettings& campaign) {
    CampaignVehicle vehicle;
    table.needs_one_of({"command"}, "names no command; expected command = \"./sitl {pty}\"");
    table.text("command", vehicle.command, {"for /bin/sh; `{pty}`, `{seed}` and `{number}` are replaced", "none"});
    if (table.has("command") && vehicle.command.find_first_not_of(" \t\r\n") == std::string::npos && !table.recording())
        table.mistake("command", "is empty; expected a program, such as \"./sitl {pty}\"");
    table.texts("files", vehicle.files,
                {"what the program loads: its runs are done anew when one of these has changed", "none"});
    table.quantity("timeout_s", vehicle.timeout, {0.1, longest_vehicle_s},
                   {"how long it may run", "length of the run and 10"});
    campaign.vehicle = std::move(vehicle);
}

// What the design and the number of its samples say of each other.
void check_design(TableReader& table, const CampaignSettings& campaign) {
    const bool grid = campaign.design == CampaignDesign::grid;
    if (table.recording()) return;
    if (grid && table.has("samples"))
        table.mistake("samples", "is of designs that draw; expected design = \"random\" or \"latin_hypercube\"");
    if (!grid && !table.has("samples")) table.mistake("design", "draws samples; expected samples = their number");
}

}  // namespace

void read_campaign(TableReader& top, std::optional<CampaignSettings>& campaign) {
    top.table("campaign", {"many runs of the scenario (docs/campaigns.md)", "none"}, [&](TableReader& table) {
        CampaignSettings& settings = campaign.emplace();
        table.text("name", settings.name, {"what reports call it", "the file's"});
        table.integer(
            "seeds", settings.seed_count, {1, most_runs},
            {"how many seeds each set of parameters is run with", "1; of designs that draw, a seed for each sample"});
        table.integer("first_seed", settings.first_seed, {0, most_exact_whole}, "the first of them");
        read_seed_list(table, settings);
        table.word("design",
                   {{"grid", CampaignDesign::grid},
                    {"random", CampaignDesign::random},
                    {"latin_hypercube", CampaignDesign::latin_hypercube}},
                   settings.design, "each value with each, or samples that are drawn");
        table.integer("samples", settings.samples, {1, most_runs}, {"how many sets of parameters are drawn", "none"});
        table.integer("design_seed", settings.design_seed, NumberRange::not_negative(), "what they are drawn with");
        table.texts("metrics", settings.metrics, {"which figures of a run are kept", "all"});
        settings.metrics_told_at = table.told_at("metrics");
        table.tables("parameter", "a key that differs from run to run",
                     [&](TableReader& entry) { read_parameter(entry, settings); });
        table.table("vehicle", "a program that is tested, in real time",
                    [&](TableReader& entry) { read_vehicle(entry, settings); });
        check_design(table, settings);
    });
}

}  // namespace skyloop::inline run
