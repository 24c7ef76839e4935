#include "run/verdict/reports.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <pugixml.hpp>
#include <sstream>

#include "base/core/json.hpp"
#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";  // U+FFFD

std::size_t count_of(std::span<const Verdict> verdicts, Outcome outcome) {
    return static_cast<std::size_t>(
        std::count_if(verdicts.begin(), verdicts.end(), [outcome](const Verdict& v) { return v.outcome == outcome; }));
}

// The length of the UTF-8 character at the front of a text that XML 1.0 may have (section 2.2, Char), or 0.
std::size_t xml_character(std::string_view text) {
    const auto first = static_cast<unsigned char>(text.front());
    if (first < 0x20 && first != '\t' && first != '\n') return 0;
    const bool is_none = text.starts_with("\xEF\xBF\xBE") || text.starts_with("\xEF\xBF\xBF");  // U+FFFE, U+FFFF
    return is_none ? 0 : utf8_length(text);
}

std::string xml_text(std::string_view text) {
    std::string clean;
    while (!text.empty()) {
        const std::size_t length = xml_character(text);
        clean += length == 0 ? replacement : text.substr(0, length);
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return clean;
}

void set(pugi::xml_node node, const char* name, const std::string& value) {
    node.append_attribute(name).set_value(xml_text(value).c_str());
}

void add_property(pugi::xml_node properties, const std::string& name, const std::string& value) {
    pugi::xml_node property = properties.append_child("property");
    set(property, "name", name);
    set(property, "value", value);
}

void add_counts(pugi::xml_node node, std::span<const Verdict> verdicts, const ReportedRun& run) {
    set(node, "tests", std::to_string(verdicts.size()));
    set(node, "failures", std::to_string(count_of(verdicts, Outcome::failed)));
    set(node, "errors", std::to_string(count_of(verdicts, Outcome::undecided)));
    set(node, "skipped", std::to_string(count_of(verdicts, Outcome::not_run)));
    set(node, "time", fmt::format("{:.3f}", run.length.value()));
}

void add_case(pugi::xml_node suite, const Verdict& verdict, const ReportedRun& run) {
    pugi::xml_node node = suite.append_child("testcase");
    set(node, "classname", run.scenario);
    set(node, "name", verdict.name);
    set(node, "time", fmt::format("{:.3f}", verdict.run_time.value()));
    const char* child = verdict.outcome == Outcome::failed      ? "failure"
                        : verdict.outcome == Outcome::undecided ? "error"
                        : verdict.outcome == Outcome::not_run   ? "skipped"
                                                                : nullptr;
    const std::string evidence = fmt::format("expected: {}\nseen: {}", verdict.expected, verdict.evidence);
    if (child == nullptr) {
        node.append_child("system-out").text().set(xml_text(evidence).c_str());
        return;
    }
    pugi::xml_node result = node.append_child(child);
    set(result, "message", verdict.evidence);
    if (verdict.outcome != Outcome::not_run) set(result, "type", std::string(outcome_name(verdict.outcome)));
    std::string text = evidence;
    if (!run.evidence.empty()) text += fmt::format("\nevidence: {}", fmt::join(run.evidence, " "));
    result.text().set(xml_text(text).c_str());
}

Json verdict_object(const Verdict& verdict) {
    Json object{{"name", verdict.name},
                {"expected", verdict.expected},
                {"outcome", outcome_name(verdict.outcome)},
                {"evidence", verdict.evidence},
                {"run_time_s", verdict.run_time.value()}};
    if (verdict.decided_at) {
        object["decided_at_utc"] = utc_text(*verdict.decided_at, 3);
        object["decided_at_gps_ns"] = verdict.decided_at->time_since_epoch().count();
    }
    return object;
}

}  // namespace

std::string verdict_text(std::span<const Verdict> verdicts, const ReportedRun& run) {
    std::string text;
    for (const Verdict& verdict : verdicts)
        text += fmt::format("{:9}  {}: {} (at {:.3f} s)\n", upper_case(outcome_name(verdict.outcome)),
                            on_a_terminal(verdict.name), on_a_terminal(verdict.evidence), verdict.run_time.value());
    text += fmt::format("{} of {} expectations met in {} (seed {}, {:.3f} s)", count_of(verdicts, Outcome::passed),
                        verdicts.size(), on_a_terminal(run.scenario), run.seed, run.length.value());
    for (const Outcome outcome : {Outcome::failed, Outcome::undecided, Outcome::not_run})
        if (const std::size_t count = count_of(verdicts, outcome); count > 0)
            text += fmt::format(", {} {}", count, outcome_name(outcome));
    if (!verdicts.empty() && count_of(verdicts, Outcome::not_run) == verdicts.size())
        text += ": nothing was judged, so the run is no success";
    return text + "\n";
}

std::string verdict_json(std::span<const Verdict> verdicts, const ReportedRun& run) {
    Json list = Json::array();
    for (const Verdict& verdict : verdicts)
        list.push_back(verdict_object(verdict));
    const std::optional<bool> met = all_met(verdicts);
    const Json report{{"scenario", run.scenario},
                      {"seed", run.seed},
                      {"start_utc", utc_text(run.start, 3)},
                      {"length_s", run.length.value()},
                      {"met", met ? Json(*met) : Json()},
                      {"evidence", run.evidence},
                      {"verdicts", std::move(list)}};
    return json_text(report, 2) + "\n";
}

std::string junit_xml(std::span<const Verdict> verdicts, const ReportedRun& run) {
    pugi::xml_document document;
    pugi::xml_node declaration = document.append_child(pugi::node_declaration);
    set(declaration, "version", "1.0");
    set(declaration, "encoding", "UTF-8");
    pugi::xml_node suites = document.append_child("testsuites");
    set(suites, "name", "skyloop");
    add_counts(suites, verdicts, run);
    pugi::xml_node suite = suites.append_child("testsuite");
    set(suite, "name", run.scenario);
    add_counts(suite, verdicts, run);
    // The time zone stays out: the form has none, and its readers take UTC.
    set(suite, "timestamp", utc_text(run.start).substr(0, 19));
    pugi::xml_node properties = suite.append_child("properties");
    add_property(properties, "seed", std::to_string(run.seed));
    add_property(properties, "start_utc", utc_text(run.start, 3));
    for (const std::string& file : run.evidence)
        add_property(properties, "evidence", file);
    for (const Verdict& verdict : verdicts)
        add_case(suite, verdict, run);
    std::ostringstream text;
    document.save(text, "  ", pugi::format_indent, pugi::encoding_utf8);
    return text.str();
}

}  // namespace skyloop::inline run
