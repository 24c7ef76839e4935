// [[fault]] and [[command]]: their own keys by the tables of faults and commands, and those of the timeline.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

#include "base/core/words.hpp"
#include "detail/scenario_keys.hpp"
#include "detail/table_reader.hpp"
#include "run/fault/fault_kind.hpp"
#include "run/fault/timeline_keys.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop::inline run {
namespace {

using GivenValues = std::map<std::string, ParameterValue, std::less<>>;
using LaterMistake = std::function<void(std::string_view key, const std::string& sentence)>;

// Of each entry, in the order of timeline_of().
struct EntryMistakes {
    std::vector<LaterMistake> faults, commands;
};

template <class Kind>
const Kind* read_kind(TableReader& table, KeyText text, std::span<const Kind> kinds) {
    std::vector<std::string_view> names;
    for (const Kind& kind : kinds)
        names.push_back(kind.name);
    const auto recorded = table.note_kinds(names, text);
    table.needs_one_of({"kind"}, fmt::format("has no kind; expected one of {}", fmt::join(names, ", ")));
    if (recorded) return &kinds[*recorded];
    std::string name;
    table.text("kind", name);
    const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& kind) { return kind.name == name; });
    if (found != kinds.end()) return &*found;
    if (table.has("kind"))
        table.mistake("kind", fmt::format("is '{}'{}; expected one of {}", name, did_you_mean(name, names),
                                          fmt::join(names, ", ")));
    return nullptr;
}

// What stands in the table besides kind and receiver, those of the timeline and its own apart.
struct GivenKeys {
    GivenValues timeline, own;
};
GivenKeys given_keys(TableReader& table, std::span<const ParameterSpec> timeline) {
    GivenKeys given;
    for (const std::string& key : table.keys()) {
        if (key == "kind" || key == "receiver") continue;
        const bool of_timeline =
            std::any_of(timeline.begin(), timeline.end(), [&](const ParameterSpec& spec) { return spec.name == key; });
        if (auto value = table.value(key)) (of_timeline ? given.timeline : given.own).emplace(key, std::move(*value));
    }
    return given;
}

void tell(TableReader& table, const std::vector<ParameterMistake>& mistakes) {
    for (const ParameterMistake& mistake : mistakes)
        if (mistake.name.empty())
            table.mistake_here(mistake.sentence);
        else
            table.mistake(mistake.name, mistake.sentence);
}

// What making a fault of its parameters is refused for. A sentence about one of the table's keys begins with it:
// "satellites: 'G99' is no satellite", "messages names nothing".
void tell_refusal(TableReader& table, const std::string& sentence) {
    const std::string key = sentence.substr(0, sentence.find_first_of(": "));
    const std::vector<std::string> keys = table.keys();
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) return table.mistake_here(sentence);
    const std::size_t rest = sentence.find_first_not_of(": ", key.size());
    table.mistake(key, rest < sentence.size() ? sentence.substr(rest) : std::string());
}

// Unknown keys suggest those of the timeline too.
CheckedParameters own_parameters(TableReader& table, std::span<const ParameterSpec> own,
                                 std::span<const ParameterSpec> timeline, const GivenValues& given) {
    table.note_parameters(own);
    CheckedParameters checked = check_parameters(own, given);
    std::vector<std::string_view> known{"kind", "receiver"};
    for (const auto specs : {own, timeline})
        for (const ParameterSpec& spec : specs)
            known.push_back(spec.name);
    for (ParameterMistake& mistake : checked.mistakes)
        if (std::find(known.begin(), known.end(), mistake.name) == known.end())
            mistake.sentence = "unknown key" + did_you_mean(mistake.name, known);
    tell(table, checked.mistakes);
    return checked;
}

TimelineEntry read_times(TableReader& table, std::span<const ParameterSpec> keys, const GivenValues& given) {
    table.note_parameters(keys);
    const CheckedParameters checked = check_parameters(keys, given);
    tell(table, checked.mistakes);
    const auto name = given.find("name");
    if (name != given.end() && name->second == ParameterValue(std::string()))
        table.mistake("name", "is empty; expected a name, or none");
    TimelineReading reading = read_timeline_entry(checked.parameters);
    tell(table, reading.mistakes);
    return reading.entry;
}

template <class Entry>
void name_entry(TimelineEntry& entry, std::string_view kind, const std::vector<Entry>& others) {
    if (!entry.name.empty()) return;
    std::vector<std::string> names;
    for (const Entry& other : others)
        names.push_back(other.when.name);
    entry.name = default_entry_name(kind, names);
}

std::vector<std::size_t> read_receiver_choice(TableReader& table, const Scenario& scenario, std::string_view meaning) {
    std::vector<std::string> names;
    const std::vector<std::string> known = receiver_names(scenario);
    table.text_or_texts("receiver", names, {meaning, "all"});
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < known.size(); ++i)
        if (names.empty() || std::find(names.begin(), names.end(), known[i]) != names.end()) chosen.push_back(i);
    for (const std::string& name : names)
        if (std::find(known.begin(), known.end(), name) == known.end())
            table.mistake("receiver", fmt::format("'{}' is no receiver of this scenario; expected some of {}", name,
                                                  fmt::join(known, ", ")));
    return chosen;
}

void read_fault(TableReader& table, Scenario& scenario) {
    const FaultKind* kind = read_kind<FaultKind>(table, "which fault, see docs/faults.md", fault_kinds());
    FaultEntry entry;
    entry.told_at = table.told_at();
    entry.receivers = read_receiver_choice(table, scenario, "names of the receivers that it is for");
    GivenKeys given = given_keys(table, timeline_keys());
    entry.when = read_times(table, timeline_keys(), given.timeline);
    const auto allowed = given.timeline.find("allow_idle");
    entry.allow_idle = allowed != given.timeline.end() && allowed->second == ParameterValue(true);
    if (kind != nullptr) {
        entry.kind = kind->name;
        const CheckedParameters own = own_parameters(table, kind->parameters, timeline_keys(), given.own);
        entry.parameters = own.parameters;
        tell(table, ramp_mistakes(*kind, Parameters(given.timeline)));
        const auto made = kind->make(entry.parameters, {1, "check"});
        if (!made && own.mistakes.empty())
            tell_refusal(table, made.error().message);
        else if (made && made->pace && entry.receivers.size() < scenario.receivers.size())
            table.mistake("receiver", fmt::format("stands beside kind = \"{}\", and the receivers of a run have one "
                                                  "clock; expected no 'receiver'",
                                                  kind->name));
    }
    name_entry(entry.when, entry.kind, scenario.faults);
    scenario.faults.push_back(std::move(entry));
}

void read_command(TableReader& table, Scenario& scenario) {
    const CommandKind* kind = read_kind<CommandKind>(table, "which command, see docs/faults.md", command_kinds());
    CommandEntry entry;
    entry.told_at = table.told_at();
    const GivenKeys given = given_keys(table, timeline_keys_of_commands());
    entry.when = read_times(table, timeline_keys_of_commands(), given.timeline);
    entry.when.once = true;
    if (kind != nullptr) {
        entry.command.verb = kind->verb;
        entry.command.parameters =
            own_parameters(table, kind->parameters, timeline_keys_of_commands(), given.own).parameters;
        if (const auto mistake = place_mistake(entry.command)) table.mistake("at", *mistake);
        if (!kind->of_receiver) {
            table.refuse("receiver",
                         fmt::format("'{}' is not for one receiver alone; expected no 'receiver'", kind->name));
        } else if (table.has("receiver")) {
            const auto chosen = read_receiver_choice(table, scenario, "name of the receiver that it is for");
            if (chosen.size() == 1)
                entry.command.receivers = {receiver_name(scenario, chosen.front())};
            else if (chosen.size() < scenario.receivers.size())
                table.mistake("receiver",
                              fmt::format("names {} receivers; expected one, or none for all of them", chosen.size()));
        }
    }
    entry.command.source = "scenario";
    name_entry(entry.when, kind != nullptr ? kind->name : std::string_view(), scenario.commands);
    scenario.commands.push_back(std::move(entry));
}

std::optional<TimelineOrder> order_of(const Command& command) {
    const bool begins = command.verb == CommandVerb::start_fault;
    if (!begins && command.verb != CommandVerb::stop_fault) return std::nullopt;
    TimelineOrder order{command.parameters.text("fault"), begins};
    if (const auto length = command.parameters.optional_number("for_s")) order.length = Seconds(*length);
    return order;
}

// A command that names a fault must find it.
void check_fault_names(const Scenario& scenario, const EntryMistakes& mistakes) {
    std::vector<std::string_view> names;
    for (const FaultEntry& fault : scenario.faults)
        names.push_back(fault.when.name);
    for (std::size_t i = 0; i < scenario.commands.size(); ++i) {
        const Command& command = scenario.commands[i].command;
        const bool starts = command.verb == CommandVerb::start_fault;
        if (!starts && command.verb != CommandVerb::stop_fault) continue;
        const std::string name = command.parameters.text("fault");
        if (!starts && name.empty()) continue;
        if (std::find(names.begin(), names.end(), name) == names.end())
            mistakes.commands[i]("fault", fmt::format("is '{}'; no fault of this scenario has this name{}", name,
                                                      did_you_mean(name, names)));
    }
}

}  // namespace

std::string default_entry_name(std::string_view kind, std::span<const std::string> before) {
    std::string name(kind);
    for (int number = 2; std::find(before.begin(), before.end(), name) != before.end(); ++number)
        name = fmt::format("{} {}", kind, number);
    return name;
}

std::vector<TimelineEntry> timeline_of(const Scenario& scenario) {
    std::vector<TimelineEntry> entries;
    for (const FaultEntry& fault : scenario.faults)
        entries.push_back(fault.when);
    for (const CommandEntry& command : scenario.commands) {
        entries.push_back(command.when);
        entries.back().order = order_of(command.command);
    }
    return entries;
}

void read_timeline(TableReader& top, Scenario& scenario) {
    EntryMistakes mistakes;
    top.tables("fault", "what goes wrong; lasts (docs/failsafe.md)", [&](TableReader& table) {
        mistakes.faults.push_back(table.mistake_later());
        read_fault(table, scenario);
    });
    top.tables("command", "what happens once (docs/failsafe.md)", [&](TableReader& table) {
        mistakes.commands.push_back(table.mistake_later());
        read_command(table, scenario);
    });
    for (const auto& [index, mistake] : timeline_mistakes(timeline_of(scenario))) {
        const bool of_fault = index < mistakes.faults.size();
        const LaterMistake& later =
            of_fault ? mistakes.faults[index] : mistakes.commands.at(index - mistakes.faults.size());
        later(mistake.name, mistake.sentence);
    }
    check_fault_names(scenario, mistakes);
}

}  // namespace skyloop::inline run
