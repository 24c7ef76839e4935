#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "detail/config_items.hpp"
#include "detail/scenario_keys.hpp"
#include "run/scenario/board_file.hpp"

namespace skyloop {
namespace {

void add_once(std::vector<firmware::NmeaSentence>& sentences, firmware::NmeaSentence sentence) {
    if (std::find(sentences.begin(), sentences.end(), sentence) == sentences.end()) sentences.push_back(sentence);
}

void read_output_keys(TableReader& receiver, ReceiverEntry& entry, const std::filesystem::path& folder) {
    receiver.text("board", entry.board);
    if (is_board_path(entry.board)) entry.board = (folder / entry.board).string();
    receiver.text_or_texts("port", entry.ports);
    receiver.text("power", entry.power);
    for (const char* key :
         {"board", "port", "power", "config", "state_file", "rate_hz", "baud", "constellations", "dual_frequency"})
        entry.told_at[key] = receiver.told_at(key);
    if (receiver.has("rate_hz")) {
        double rate = 1;
        receiver.number("rate_hz", rate, {0.01, 100});
        entry.rate_hz = rate;
    }
    if (receiver.has("baud")) {
        std::uint32_t baud = 9600;
        receiver.integer("baud", baud, {300, 4e6});
        entry.baud = baud;
    }
    if (const auto sentences = receiver.choices("sentences", firmware::nmea_sentence_names))
        for (const std::size_t index : *sentences)
            add_once(entry.sentences, static_cast<firmware::NmeaSentence>(index));
}

void read_navigation_keys(TableReader& receiver, ReceiverEntry& entry) {
    receiver.named_values("config", [&](TableReader& config) { entry.config = read_config_items(config); });
    read_constellation_list(receiver, "constellations", entry.constellations);
    receiver.boolean("dual_frequency", entry.dual_frequency);
    static constexpr std::array<Word<StartKind>, 3> starts{
        {{"hot", StartKind::hot}, {"warm", StartKind::warm}, {"cold", StartKind::cold}}};
    receiver.word("start", starts, entry.start);
    static constexpr std::array<Word<DynamicModel>, 8> models{{{"portable", DynamicModel::portable},
                                                               {"stationary", DynamicModel::stationary},
                                                               {"pedestrian", DynamicModel::pedestrian},
                                                               {"automotive", DynamicModel::automotive},
                                                               {"sea", DynamicModel::sea},
                                                               {"airborne-1g", DynamicModel::airborne_1g},
                                                               {"airborne-2g", DynamicModel::airborne_2g},
                                                               {"airborne-4g", DynamicModel::airborne_4g}}};
    receiver.word("dynamic_model", models, entry.dynamic_model);
    if (receiver.has("export_limits")) {
        firmware::ExportLimits limits = firmware::ExportLimits::off;
        receiver.word("export_limits", export_limit_words, limits);
        entry.export_limits = limits;
    }
    receiver.quantity("static_hold_mps", entry.static_hold_below, {0, 100});
}

void read_place_and_power_keys(TableReader& receiver, ReceiverEntry& entry, const std::filesystem::path& folder) {
    receiver.boolean("power_up", entry.power_up);
    std::string state_file;
    receiver.text("state_file", state_file);
    if (!state_file.empty()) entry.state_file = folder / state_file;
    constexpr double longest_arm_m = 1000;
    if (const auto offset = receiver.numbers("antenna_offset_m", 3, entry.antenna_offset)) {
        std::copy(offset->begin(), offset->end(), entry.antenna_offset.begin());
        if (std::any_of(offset->begin(), offset->end(), [](double part) { return !(std::abs(part) <= longest_arm_m); }))
            receiver.mistake("antenna_offset_m", fmt::format("is [{0:g}]; expected numbers from -{1:g} to {1:g}",
                                                             fmt::join(*offset, ", "), longest_arm_m));
    }
}

// A name stands for the table in messages and in `base`.
void read_name(TableReader& receiver, Scenario& scenario) {
    ReceiverEntry& entry = scenario.receivers.back();
    receiver.text("name", entry.name);
    if (receiver.has("name") && entry.name.empty()) receiver.mistake("name", "is empty; expected a name");
    const std::size_t own = scenario.receivers.size() - 1;
    for (std::size_t i = 0; i < own; ++i)
        if (receiver_name(scenario, i) == receiver_name(scenario, own))
            receiver.mistake_here(
                fmt::format("is the second receiver called '{}'; expected another name", receiver_name(scenario, own)));
}

// @param names of all receivers of the scenario
void read_base(TableReader& receiver, std::span<const std::string> names, Scenario& scenario) {
    std::string base;
    receiver.text("base", base);
    if (base.empty()) return;
    const auto found = std::find(names.begin(), names.end(), base);
    const auto index = static_cast<std::size_t>(found - names.begin());
    if (found == names.end())
        receiver.mistake("base", fmt::format("'{}' is no receiver of this scenario; expected one of {}", base,
                                             fmt::join(names, ", ")));
    else if (index + 1 == scenario.receivers.size())
        receiver.mistake("base", fmt::format("'{}' is this receiver itself; expected another one", base));
    else
        scenario.receivers.back().base = index;
}

}  // namespace

std::string default_receiver_name(std::size_t index) { return fmt::format("receiver{}", index); }

std::string receiver_name(const Scenario& scenario, std::size_t index) {
    const std::string& name = scenario.receivers.at(index).name;
    return name.empty() ? default_receiver_name(index) : name;
}

const TrajectorySettings& trajectory_of(const Scenario& scenario, std::size_t index) {
    const std::optional<TrajectorySettings>& own = scenario.receivers.at(index).trajectory;
    return own ? *own : scenario.trajectory;
}

void read_receivers(TableReader& top, Scenario& scenario, const TrajectoryContext& context) {
    // A rover may stand before its base, so the names are read before the rest.
    std::vector<std::string> names;
    top.look_at_tables("receiver", [&](const toml::table& table) {
        const auto name = table["name"].value<std::string>().value_or("");
        names.push_back(name.empty() ? default_receiver_name(names.size()) : name);
    });
    std::size_t count = 0;
    top.tables("receiver", [&](TableReader& receiver) {
        if (count++ > 0) scenario.receivers.emplace_back();
        read_name(receiver, scenario);
        ReceiverEntry& entry = scenario.receivers.back();
        read_output_keys(receiver, entry, context.folder);
        read_navigation_keys(receiver, entry);
        read_place_and_power_keys(receiver, entry, context.folder);
        entry.trajectory = read_trajectory_keys(receiver, context, scenario.warnings);
        read_base(receiver, names, scenario);
    });
}

}  // namespace skyloop
