#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "detail/scenario_keys.hpp"
#include "run/fault/known_names.hpp"
#include "run/verdict/expectation.hpp"

namespace skyloop::inline run {
namespace {

constexpr double longest_probe_s = 1e6;

constexpr std::string_view probe_keys[] = {"expect_exit", "json", "at_s", "within_s", "timeout_s"};

void read_condition(TableReader& table, Probe& probe) {
    if (!table.has("json")) return;
    std::string text = "a == 0";  // stays where the value is no text, which has been told
    table.text("json", text, {"one JSON line that the command prints must fulfil this: \"tpv.mode >= 3\"", "none"});
    auto condition = parse_json_condition(text);
    if (condition)
        probe.condition = std::move(*condition);
    else
        table.mistake("json", fmt::format("at character {}: {}", condition.error().column, condition.error().sentence));
}

void read_probe(TableReader& table, Expectation& expectation) {
    Probe& probe = expectation.probe.emplace();
    table.text_or_texts("command", probe.command, {"a program and its arguments, or a text for /bin/sh", "none"});
    if (probe.command.empty()) probe.command = {""};  // no list of texts, which has been told, or an empty one
    if (probe.command.front().empty())
        table.mistake("command", "names no program; expected a program and its arguments, or a text for /bin/sh");
    table.integer("expect_exit", probe.expect_exit, {0, 255},
                  {"exit code that the command should have", "0, or any beside json"});
    read_condition(table, probe);
    table.quantity("at_s", probe.at, {0, longest_probe_s}, "when the command is started, after the start of the run");
    table.quantity("within_s", probe.within, {0, longest_probe_s},
                   {"it is started anew until it succeeds, for so long", "once"});
    table.quantity("timeout_s", probe.timeout, {0.01, longest_probe_s},
                   "of each start of the command; then it is killed");
    table.note_not_both("command", "receiver");
    if (!expectation.receiver.empty())
        table.mistake("receiver", "is of a sentence (what); a command asks whom it likes");
}

// A message or a satellite that there cannot be.
std::optional<std::string> impossible_subject(const SubjectClause& subject) {
    if (subject.satellite) return satellite_mistake(*subject.satellite);
    return subject.message.empty() ? std::nullopt : message_name_mistake(subject.message);
}

void read_sentence(TableReader& table, Expectation& expectation) {
    table.needs_one_of({"what", "command"}, "says nothing; expected what = \"…\" or command = …");
    if (!table.has("what") && !table.recording()) return;
    expectation.what = "fix";  // stays where the value is no text, which has been told
    table.text("what", expectation.what, {"a sentence: \"fix within 30 s of the end of outage\"", "none"});
    auto sentence = parse_expectation(expectation.what);
    if (sentence) {
        if (const auto mistake = impossible_subject(sentence->subject)) table.mistake("what", *mistake);
        expectation.sentence = std::move(*sentence);
    } else {
        table.mistake("what", fmt::format("at character {}: {}", sentence.error().column, sentence.error().sentence));
    }
    for (const std::string_view key : probe_keys) {
        table.note_not_both("what", key);
        if (!table.has(key)) continue;
        table.has_been_read(key);
        table.mistake(key, "is of a command; expected command = … beside it, or none of it beside what");
    }
}

void read_expectation(TableReader& table, Expectation& expectation) {
    table.text("name", expectation.name, {"what verdicts call it", "its sentence or its command"});
    table.text("receiver", expectation.receiver, {"name of the receiver that the sentence is about", "each"});
    if (!table.has("command")) return read_sentence(table, expectation);
    read_probe(table, expectation);
    table.not_both("command", "what");
    table.has_been_read("what");
}

// @param entries names of all faults and commands
void check_names(TableReader& table, const Expectation& expectation, std::span<const std::string> entries,
                 std::span<const std::string> receivers) {
    if (expectation.sentence)
        if (const std::string mistake = event_mistake(*expectation.sentence, entries); !mistake.empty())
            table.mistake("what", mistake);
    if (!expectation.receiver.empty()) names_receiver(table, "receiver", expectation.receiver, receivers);
}

}  // namespace

void read_expectations(TableReader& top, Scenario& scenario) {
    std::vector<std::string> entries;
    for (const TimelineEntry& entry : timeline_of(scenario))
        entries.push_back(entry.name);
    const std::vector<std::string> receivers = receiver_names(scenario);
    top.tables("expect", "what the run is judged by (docs/failsafe.md)", [&](TableReader& table) {
        Expectation& expectation = scenario.expectations.emplace_back();
        expectation.told_at = table.told_at();
        read_expectation(table, expectation);
        check_names(table, expectation, entries, receivers);
    });
}

}  // namespace skyloop::inline run
