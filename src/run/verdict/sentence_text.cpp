// A sentence back in words.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/core/words.hpp"
#include "detail/sentence_words.hpp"
#include "detail/subject_view.hpp"
#include "run/fault/command.hpp"
#include "run/fault/fault_kind.hpp"

namespace skyloop::inline run {
namespace {

std::string quoted_where_needed(const std::string& name) {
    if (!needs_quotes(name)) return name;
    const char quote = name.find('\'') == std::string::npos ? '\'' : '"';
    return quote + name + quote;
}

// In the order of Relation.
constexpr std::array<std::string_view, 6> comparison_words{"below",   "above",    "at least",
                                                           "at most", "equal to", "other than"};

std::string fix_words(FixType type) {
    switch (type) {
        case FixType::rtk_fixed:
            return "rtk fixed";
        case FixType::rtk_float:
            return "rtk float";
        case FixType::dead_reckoning:
            return "dead reckoning";
        case FixType::time_only:
            return "time only";
        default:
            return fmt::format("{} fix", fix_type_name(type));
    }
}

std::string quantity_words(const SubjectClause& subject) {
    const auto& [words, unit] = words_of(subject.subject);
    const std::string of = subject.satellite ? " of " + to_string(*subject.satellite) : "";
    // Their number is their own unit.
    const bool is_named = subject.subject == ExpectedSubject::satellites;
    return fmt::format("{}{} {} {}{}", words, of, comparison_words[static_cast<std::size_t>(subject.comparison)],
                       subject.limit, is_named ? "" : unit);
}

std::string event_words(const EventReference& event) {
    if (event.is_run()) return event.end ? "the end of run" : "the start of run";
    const std::string number = event.occurrence ? fmt::format("#{}", *event.occurrence) : "";
    return fmt::format("the {} of {}", event.end ? "end" : "start", quoted_where_needed(event.name + number));
}

// Of an event that lasts.
std::string lasting_words(const EventReference& event) {
    const std::string number = event.occurrence ? fmt::format("#{}", *event.occurrence) : "";
    return "the " + quoted_where_needed(event.name + number);
}

std::string rule_words(const TimeClause& time) {
    const double from = time.from.value(), until = time.until.value_or(Seconds(0)).value();
    const std::string behind = time.event ? " after " + event_words(*time.event) : std::string();
    switch (time.rule) {
        case TimeRule::some_time:
            return "";
        case TimeRule::within:
            return fmt::format("within {} s of {}", until, event_words(*time.event));
        case TimeRule::throughout:
            return "throughout " + lasting_words(*time.event);
        case TimeRule::during:
            return "during " + lasting_words(*time.event);
        case TimeRule::always:
            return time.never ? "" : "always";
        case TimeRule::at:
            return time.event ? fmt::format("{} s{}", from, behind) : fmt::format("at {} s", from);
        case TimeRule::from_to:
            return fmt::format("from {} s to {} s{}", from, until, behind);
        case TimeRule::until_event:
            return "until " + event_words(*time.event);
        case TimeRule::after:
            return behind.substr(1) + (time.until ? fmt::format(" for {} s", until) : "");
    }
    return "";
}

}  // namespace

std::string subject_text(const SubjectClause& subject) {
    const std::string_view words = words_of(subject.subject).words;
    if (subject.subject == ExpectedSubject::fix_type) return fix_words(subject.fix_type);
    if (is_quantity(subject.subject)) return quantity_words(subject);
    if (is_silence(subject.subject)) return fmt::format("{} for {} s", words, subject.silence.value());
    const bool sends =
        subject.subject == ExpectedSubject::client_sends || subject.subject == ExpectedSubject::receiver_sends;
    if (!sends) return std::string(words);
    const std::string every = subject.every ? fmt::format(" every {} s", subject.every->value()) : "";
    return fmt::format("{} {}{}", words, quoted_where_needed(subject.message), every);
}

std::string expectation_text(const ExpectedSentence& sentence) {
    std::string subject = subject_text(sentence.subject);
    if (is_silence(sentence.subject.subject) && means_a_stretch(sentence.time)) subject.resize(subject.find(" for "));
    if (sentence.time.never) subject += " never";
    const std::string rule = rule_words(sentence.time);
    return rule.empty() ? subject : subject + " " + rule;
}

std::string event_mistake(const ExpectedSentence& sentence, std::span<const std::string> entries) {
    if (!sentence.time.event || sentence.time.event->is_run()) return "";
    std::vector<std::string_view> known(entries.begin(), entries.end());
    for (const FaultKind& kind : fault_kinds())
        known.emplace_back(kind.name);
    for (const CommandKind& kind : command_kinds())
        known.emplace_back(kind.name);
    const std::string& name = sentence.time.event->name;
    if (std::find(known.begin(), known.end(), name) != known.end()) return "";
    return fmt::format("no fault or command is called '{}', and none is of that kind{}", name,
                       did_you_mean(name, known));
}

}  // namespace skyloop::inline run
