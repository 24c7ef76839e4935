#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <chrono>
#include <cmath>

#include "base/core/json.hpp"
#include "base/core/number_text.hpp"
#include "base/core/process.hpp"
#include "base/core/words.hpp"
#include "detail/probe_run.hpp"
#include "detail/subject_view.hpp"
#include "run/verdict/expectation.hpp"

namespace skyloop::inline run {
namespace {

using ConditionValue = std::variant<double, bool, std::string>;

struct Operator {
    std::string_view sign;
    Relation comparison;
};
// The longer ones first: "<=" begins as "<".
constexpr std::array<Operator, 6> operators{{{"==", Relation::equal},
                                             {"!=", Relation::not_equal},
                                             {"<=", Relation::at_most},
                                             {">=", Relation::at_least},
                                             {"<", Relation::below},
                                             {">", Relation::above}}};

constexpr std::string_view word_blanks = " \t";

tl::unexpected<SentenceMistake> condition_mistake(std::size_t column, std::string sentence) {
    return tl::make_unexpected(SentenceMistake{column, std::move(sentence)});
}

bool is_path_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

// "tpv.mode": nothing when a part is empty or has other characters.
std::optional<std::vector<std::string>> parse_path(std::string_view text) {
    std::vector<std::string> path(1);
    for (const char c : text) {
        if (c == '.')
            path.emplace_back();
        else if (is_path_character(c))
            path.back() += c;
        else
            return std::nullopt;
    }
    for (const std::string& part : path)
        if (part.empty()) return std::nullopt;
    return path;
}

std::optional<ConditionValue> parse_condition_value(std::string_view text) {
    if (text == "true") return true;
    if (text == "false") return false;
    const bool quoted =
        text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front();
    if (quoted) return std::string(text.substr(1, text.size() - 2));
    if (const auto number = number_in<double>(text)) return *number;
    if (const auto word = parse_path(text); word && word->size() == 1 && !(text[0] >= '0' && text[0] <= '9'))
        return std::string(text);
    return std::nullopt;
}

// The value at the path from `first` on, or null.
const JsonData* value_at(const JsonData& object, const std::vector<std::string>& path, std::size_t first) {
    const JsonData* value = &object;
    for (std::size_t i = first; i < path.size(); ++i) {
        if (value->is_array()) {
            const auto index = number_in<std::size_t>(path[i]);
            if (!index || *index >= value->size()) return nullptr;
            value = &(*value)[*index];
            continue;
        }
        const auto found = value->is_object() ? value->find(path[i]) : value->end();
        if (!value->is_object() || found == value->end()) return nullptr;
        value = &*found;
    }
    return value;
}

// Values of different kinds are unequal, and nothing else.
bool value_fulfils(const JsonCondition& condition, const JsonData& value) {
    if (const auto* number = std::get_if<double>(&condition.value); number != nullptr && value.is_number())
        return compares(value.get<double>(), condition.comparison, *number);
    if (const auto* text = std::get_if<std::string>(&condition.value); text != nullptr && value.is_string())
        return compares(value.get_ref<const std::string&>(), condition.comparison, *text);
    if (const auto* flag = std::get_if<bool>(&condition.value); flag != nullptr && value.is_boolean())
        return compares(value.get<bool>(), condition.comparison, *flag);
    return condition.comparison == Relation::not_equal;
}

bool names_class(const JsonData& object, const std::string& part) {
    const auto found = object.find("class");
    return found != object.end() && found->is_string() &&
           lower_case(found->get_ref<const std::string&>()) == lower_case(part);
}

std::string value_text(const ConditionValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
    if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
    const std::string& text = std::get<std::string>(value);
    const char quote = text.find('\'') == std::string::npos ? '\'' : '"';
    return quote + text + quote;
}

}  // namespace

tl::expected<JsonCondition, SentenceMistake> parse_json_condition(std::string_view text) {
    if (text.size() > 1000) return condition_mistake(1, "is longer than 1000 characters");
    const std::size_t sign = text.find_first_of("=!<>");
    const std::string_view path_words = trimmed(text.substr(0, sign), word_blanks);
    const auto path = parse_path(path_words);
    if (!path)
        return condition_mistake(
            1, fmt::format("'{}' is no path; expected names with points between: tpv.mode", path_words));
    if (sign == std::string_view::npos)
        return condition_mistake(text.size() + 1, "the condition ends here; expected one of == != < <= > >=");
    JsonCondition condition{*path, Relation::equal, 0.0};
    std::size_t length = 0;
    for (const Operator& known : operators)
        if (length == 0 && text.substr(sign).starts_with(known.sign)) {
            condition.comparison = known.comparison;
            length = known.sign.size();
        }
    if (length == 0)
        return condition_mistake(
            sign + 1, fmt::format("'{}' is no comparison; expected one of == != < <= > >=", text.substr(sign, 1)));
    const std::string_view value_words = trimmed(text.substr(sign + length), word_blanks);
    const auto value = parse_condition_value(value_words);
    if (!value)
        return condition_mistake(sign + length + 1, fmt::format("'{}' is no value; expected a number, true, false or a "
                                                                "text in quotes",
                                                                value_words));
    condition.value = *value;
    const bool ordered = condition.comparison != Relation::equal && condition.comparison != Relation::not_equal;
    if (ordered && !std::holds_alternative<double>(*value))
        return condition_mistake(sign + 1, "only numbers are larger or smaller; expected == or !=");
    return condition;
}

std::string condition_text(const JsonCondition& condition) {
    std::string text = condition.path.front();
    for (std::size_t i = 1; i < condition.path.size(); ++i)
        text += "." + condition.path[i];
    for (const Operator& known : operators)
        if (known.comparison == condition.comparison) text += fmt::format(" {} ", known.sign);
    return text + value_text(condition.value);
}

bool fulfils(const JsonCondition& condition, std::string_view line) {
    if (line.empty() || line.size() > (std::size_t{1} << 16)) return false;
    const JsonData object = JsonData::parse(line, nullptr, false);
    if (!object.is_object()) return false;
    if (const JsonData* value = value_at(object, condition.path, 0)) return value_fulfils(condition, *value);
    if (condition.path.size() < 2 || !names_class(object, condition.path.front())) return false;
    const JsonData* value = value_at(object, condition.path, 1);
    return value != nullptr && value_fulfils(condition, *value);
}

namespace {

using HostClock = std::chrono::steady_clock;  // probes look at the world outside, which has no other

constexpr std::size_t shown_output = 200;  // characters

// The end of what was printed, on one line.
std::string shown(const ProcessOutcome& outcome) {
    std::string text = outcome.errors.empty() ? outcome.output : outcome.errors;
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r'))
        text.pop_back();
    if (text.size() > shown_output) text = "…" + text.substr(text.size() - shown_output);
    for (char& c : text)
        if (c == '\n' || c == '\r') c = ' ';
    return text.empty() ? "; it printed nothing" : "; it printed: " + text;
}

// One that ended by itself between the last look and the kill has an exit code.
bool was_cut_short(const ProcessOutcome& outcome) { return outcome.cancelled && !outcome.enough && !outcome.exit_code; }

std::string ending(const ProcessOutcome& outcome, Seconds timeout) {
    if (outcome.timed_out) return "was killed after " + span_text(timeout);
    if (was_cut_short(outcome)) return "was killed as the run ended first";
    if (outcome.exit_code) return fmt::format("ended with exit code {}", *outcome.exit_code);
    return fmt::format("was ended by signal {}", outcome.signal.value_or(0));
}

std::vector<std::string> command_of(const Probe& probe) {
    if (probe.command.size() == 1) return {"/bin/sh", "-c", probe.command.front()};
    return probe.command;
}

}  // namespace

std::string probe_text(const Probe& probe) {
    std::string text = fmt::format("command '{}'", fmt::join(probe.command, " "));
    if (probe.condition) text += " prints " + condition_text(*probe.condition);
    if (probe.condition && probe.expect_exit) text += " and";
    if (!probe.condition || probe.expect_exit) text += fmt::format(" exits {}", probe.expect_exit.value_or(0));
    if (probe.within) text += " within " + span_text(*probe.within);
    return text;
}

ProbeRun::ProbeRun(Probe probe, std::vector<std::string> environment, ProcessGroupListener group)
    : probe_(std::move(probe)),
      environment_(std::move(environment)),
      group_(std::move(group)),
      thread_([this] { work(); }) {}

ProbeRun::~ProbeRun() { finish(); }

Finding ProbeRun::finish() {
    cancelled_ = true;
    if (thread_.joinable()) thread_.join();
    const std::scoped_lock lock(mutex_);
    return finding_;
}

void ProbeRun::work() {
    const auto end = HostClock::now() + std::chrono::duration<double>(probe_.within.value_or(Seconds(0)).value());
    constexpr auto pause = std::chrono::milliseconds(20);
    constexpr int pauses_between = 10;
    // A failure is final when no time is left to try again.
    while (try_once() == false && HostClock::now() < end) {
        for (int i = 0; i < pauses_between && !cancelled_; ++i)
            std::this_thread::sleep_for(pause);
        if (HostClock::now() >= end) break;
        if (!cancelled_) continue;
        keep_undecided();
        break;
    }
    over_ = true;
}

std::optional<bool> ProbeRun::try_once() {
    bool fulfilled = false;
    std::string line_seen;
    ProcessRequest request;
    request.command = command_of(probe_);
    request.environment = environment_;
    request.timeout = probe_.timeout;
    request.cancelled = [this] { return cancelled_.load(); };
    request.group = group_;
    if (probe_.condition)
        request.line = [&](std::string_view line) {
            if (!fulfilled && fulfils(*probe_.condition, line)) {
                fulfilled = true;
                line_seen = line.substr(0, shown_output);
            }
            return fulfilled && !probe_.expect_exit;
        };
    const auto outcome = run_process(request);
    if (!outcome) return keep(Outcome::failed, outcome.error().message), false;
    const bool exit_right = outcome->exit_code == probe_.expect_exit.value_or(0);
    const bool success = probe_.condition ? fulfilled && (!probe_.expect_exit || exit_right) : exit_right;
    std::string evidence = "the command " + ending(*outcome, probe_.timeout);
    if (fulfilled)
        evidence = (outcome->enough ? std::string() : evidence + "; ") + "it printed " + line_seen;
    else if (probe_.condition)
        evidence += "; no line of it fulfilled the condition" + shown(*outcome);
    else if (!success)
        evidence += shown(*outcome);
    if (was_cut_short(*outcome)) return keep(Outcome::undecided, std::move(evidence)), std::nullopt;
    keep(success ? Outcome::passed : Outcome::failed, std::move(evidence));
    return success;
}

void ProbeRun::keep(Outcome outcome, std::string evidence) {
    const std::scoped_lock lock(mutex_);
    finding_ = {outcome, std::move(evidence), std::nullopt};
}

// What the last try showed stays the evidence.
void ProbeRun::keep_undecided() {
    const std::scoped_lock lock(mutex_);
    finding_.outcome = Outcome::undecided;
    finding_.evidence = "the run ended before the time to try again was over; " + finding_.evidence;
}

}  // namespace skyloop::inline run
