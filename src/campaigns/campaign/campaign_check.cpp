#include "detail/campaign_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/core/number_in.hpp"
#include "campaigns/campaign/campaign_folder.hpp"

namespace skyloop {
namespace {

// Of a longer list not every value costs an assembly.
constexpr std::size_t most_values_assembled = 200;

double number_of(const CampaignValue& value) { return number_in<double>(value.toml).value_or(0); }

// Runs that have between them each value of the lists, and of each range the least and the greatest value.
class RunsToAssemble {
public:
    RunsToAssemble(const CampaignPlan& plan, const std::vector<std::uint64_t>& wanted) {
        const std::vector<CampaignParameter>& parameters = plan.varied();
        std::vector<std::set<std::string>> seen(parameters.size());
        std::vector<std::pair<PlannedRun, PlannedRun>> ends(parameters.size());
        for (const std::uint64_t number : wanted) {
            const PlannedRun run = plan.run(number);
            if (number == wanted.front()) {
                numbers_.insert(number);
                std::fill(ends.begin(), ends.end(), std::pair(run, run));
            }
            for (std::size_t i = 0; i < parameters.size(); ++i)
                if (!std::holds_alternative<std::vector<CampaignValue>>(parameters[i].spread))
                    widen(ends[i], run, i);
                else if (seen[i].size() < most_values_assembled && seen[i].insert(run.values[i].toml).second)
                    numbers_.insert(number);
        }
        for (std::size_t i = 0; i < parameters.size(); ++i)
            if (!wanted.empty()) numbers_.insert({ends[i].first.number, ends[i].second.number});
    }
    [[nodiscard]] bool has(std::uint64_t number) const { return numbers_.contains(number); }

private:
    static void widen(std::pair<PlannedRun, PlannedRun>& ends, const PlannedRun& run, std::size_t i) {
        const double number = number_of(run.values[i]);
        if (number < number_of(ends.first.values[i])) ends.first = run;
        if (number > number_of(ends.second.values[i])) ends.second = run;
    }

    std::set<std::uint64_t> numbers_;
};

// Tries the values of runs, and says which of them are to blame for what is wrong.
class ValueCheck {
public:
    explicit ValueCheck(const OpenedCampaign& campaign) : campaign_(campaign) {}

    Result<void> check(const PlannedRun& run, bool assembled) {
        const auto changes = campaign_.plan.changes_of(run);
        const auto asked = read_changed_scenario(campaign_.setup.text, campaign_.setup.file, changes);
        if (!asked) return fail(at_option(asked.error()));
        const auto scenario = campaign_scenario(*asked);
        if (!scenario) return fail(blamed(scenario.error(), run));
        if (!assembled) return {};
        const auto read = checked_assembly(*scenario, campaign_.setup.data);
        if (!read) return fail(blamed(read.error(), run));
        for (const std::string& warning : read->warnings)
            warn(warning, run);
        for (std::size_t i = 0; i < run.values.size(); ++i)
            good_.insert({i, run.values[i].toml});
        return {};
    }

    [[nodiscard]] std::vector<std::string> warnings() const {
        std::vector<std::string> told = warnings_;
        if (untold_ > 0) told.push_back(fmt::format("{} more warnings of other values", untold_));
        return told;
    }

private:
    static constexpr std::size_t most_warnings = 10;

    void warn(const std::string& warning, const PlannedRun& run) {
        const std::vector<std::string>& own = campaign_.warnings;
        if (std::find(own.begin(), own.end(), warning) != own.end() || !warned_.insert(warning).second) return;
        if (warnings_.size() == most_warnings) return void(++untold_);
        std::string words;
        for (std::size_t i = 0; i < run.values.size(); ++i)
            words +=
                fmt::format("{}{} = {}", i == 0 ? "; with " : ", ", campaign_.plan.varied()[i].key, run.values[i].toml);
        warnings_.push_back(warning + words);
    }
    // It names the place itself; where an option gives the values, the file has no place for them, or another's.
    [[nodiscard]] Error at_option(Error error) const {
        const CampaignSource source{campaign_.setup.text, campaign_.setup.file, campaign_.options};
        for (const CampaignParameter& parameter : campaign_.plan.varied()) {
            const std::string told = place_of_parameter(source.text, source.file, parameter.key) + ": ";
            if (!error.message.starts_with(told)) continue;
            const std::string sentence = error.message.substr(told.size());
            if (!speaks_of(sentence, parameter.key)) continue;
            error.message = fmt::format("{}: {}", place_of_varied(source, parameter.key), sentence);
            return error;
        }
        return error;
    }
    // Values that another run has been assembled with are good.
    [[nodiscard]] Error blamed(Error error, const PlannedRun& run) const {
        std::string first, words;
        for (const bool all : {false, true})
            for (std::size_t i = 0; i < run.values.size() && (!all || words.empty()); ++i) {
                if (!all && good_.contains({i, run.values[i].toml})) continue;
                const std::string& key = campaign_.plan.varied()[i].key;
                if (first.empty()) first = key;
                words += fmt::format("{}{} = {}", words.empty() ? "" : ", ", key, run.values[i].toml);
            }
        if (words.empty()) return error;
        const std::string name = campaign_.setup.file.string() + ": ";
        if (error.message.starts_with(name)) error.message.erase(0, name.size());
        const CampaignSource source{campaign_.setup.text, campaign_.setup.file, campaign_.options};
        error.message = fmt::format("{}: {}; with {}", place_of_varied(source, first), error.message, words);
        return error;
    }

    const OpenedCampaign& campaign_;
    std::set<std::pair<std::size_t, std::string>> good_;
    std::set<std::string> warned_;
    std::vector<std::string> warnings_;
    std::size_t untold_ = 0;
};

bool meets(const std::string& place, const std::string& other) {
    return place == other || place.starts_with(other + ".") || other.starts_with(place + ".");
}

}  // namespace

Result<Assembly> checked_assembly(const Scenario& scenario, const DataFolders& data) {
    RunMode mode = campaign_mode(scenario);
    mode.open_ports = false;
    mode.only_checked = true;
    // What a value is refused for is told of the value, not of the key that it has taken the place of.
    Scenario unplaced = scenario;
    for (ReceiverEntry& receiver : unplaced.receivers)
        receiver.told_at.clear();
    for (auto& [key, place] : unplaced.told_at)
        place = key + ": ";
    unplaced.scene.origin_told_at = SceneEntry().origin_told_at;
    for (FaultEntry& fault : unplaced.faults)
        fault.told_at = scenario.name + ": ";
    for (CommandEntry& command : unplaced.commands)
        command.told_at = scenario.name + ": ";
    return assemble(unplaced, data, mode);
}

std::string place_of_varied(const CampaignSource& source, std::string_view key) {
    for (std::size_t i = 1; i < source.options.size(); ++i)
        if (source.options[i - 1] == "--vary" && source.options[i].starts_with(fmt::format("{}=", key)))
            return fmt::format("--vary {}", key);
    return place_of_parameter(source.text, source.file, key);
}

Result<void> check_parameter_keys(const CampaignSource& source, const CampaignSettings& settings) {
    std::vector<std::string> places;
    for (const CampaignParameter& parameter : settings.parameters) {
        const std::string place = place_of_key(source.text, parameter.key);
        for (std::size_t i = 0; i < places.size(); ++i)
            if (meets(place, places[i]))
                return fail(ErrorCode::input, fmt::format("{}: campaign parameter '{}' sets what '{}' sets, too; "
                                                          "expected each key of the scenario once",
                                                          place_of_varied(source, parameter.key), parameter.key,
                                                          settings.parameters[i].key));
        places.push_back(place);
    }
    return {};
}

Result<std::vector<std::string>> check_runs(const OpenedCampaign& campaign, const std::vector<std::uint64_t>& wanted,
                                            const std::function<bool()>& stopped) {
    const std::uint64_t seeds = campaign.plan.size() / campaign.plan.points();
    const RunsToAssemble assembled(campaign.plan, wanted);
    ValueCheck values(campaign);
    std::optional<std::uint64_t> checked;
    for (const std::uint64_t number : wanted) {
        if (stopped()) break;
        if (checked && *checked / seeds == number / seeds && !assembled.has(number)) continue;
        if (const auto good = values.check(campaign.plan.run(number), assembled.has(number)); !good)
            return fail(good.error());
        checked = number;
    }
    return values.warnings();
}

}  // namespace skyloop
