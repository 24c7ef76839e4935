// Opens a campaign, and finds what is wrong with it before any of its runs.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/files.hpp"
#include "base/core/number_text.hpp"
#include "base/core/result.hpp"
#include "campaigns/campaign/campaign_folder.hpp"
#include "run/emulator/assembly.hpp"
#include "run/scenario/board_files.hpp"
#include "run/scenario/scenario.hpp"
#include "run/scenario/scenario_file.hpp"

namespace skyloop::inline campaigns {

namespace {

// Everything is read, nothing is run.
Result<Assembly> checked_assembly(const Scenario& scenario, const DataFolders& data);

// Where the values of a campaign come from.
struct CampaignSource {
    const std::string& text;                  ///< of the scenario
    const std::filesystem::path& file;        ///< its name
    const std::vector<std::string>& options;  ///< OpenedCampaign::options
};

// Where a key is varied: "--vary KEY", else FILE:LINE:COLUMN of its parameter.
std::string place_of_varied(const CampaignSource& source, std::string_view key);

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
        const auto asked = read_scenario(campaign_.setup.text, campaign_.setup.file, changes);
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

// Fails with `input` where two parameters set the same key of the scenario, under whatever names.
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

}  // namespace

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

}  // namespace skyloop::inline campaigns
