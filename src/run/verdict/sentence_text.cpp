// A sentence back in words.
#include <fmt/format.h>

#include <algorithm>

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

std::string_view comparison_words(Relation comparison) {
    switch (comparison) {
        case Relation::below:
            return "below";
        case Relation::above:
            return "above";
        case Relation::at_least:
            return "at least";
        case Relation::at_most:
            return "at most";
        case Relation::equal:
            return "equal to";
        case Relation::not_equal:
            return "other than";
    }
    return "";
}

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

std::string quantity_name(const SubjectClause& subject) {
    switch (subject.subject) {
        case ExpectedSubject::horizontal_error:
            return "horizontal error";
        case ExpectedSubject::vertical_error:
            return "vertical error";
        case ExpectedSubject::speed_error:
            return "speed error";
        case ExpectedSubject::horizontal_accuracy:
            return "h_acc";
        case ExpectedSubject::vertical_accuracy:
            return "v_acc";
        case ExpectedSubject::satellites:
            return "satellites";
        default:
            return subject.satellite ? "C/N0 of " + to_string(*subject.satellite) : "C/N0";
    }
}

std::string quantity_words(const SubjectClause& subject) {
    const std::string_view unit = subject.subject == ExpectedSubject::satellites ? "" : unit_of(subject.subject);
    return fmt::format("{} {} {}{}", quantity_name(subject), comparison_words(subject.comparison), subject.limit, unit);
}

std::string sender_words(const SubjectClause& subject, std::string_view sender) {
    const std::string every = subject.every ? fmt::format(" every {} s", subject.every->value()) : "";
    return fmt::format("{} sends {}{}", sender, quoted_where_needed(subject.message), every);
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
    const std::string silence = fmt::format("silent for {} s", subject.silence.value());
    switch (subject.subject) {
        case ExpectedSubject::fix:
            return "fix";
        case ExpectedSubject::no_fix:
            return "no fix";
        case ExpectedSubject::fix_type:
            return fix_words(subject.fix_type);
        case ExpectedSubject::jamming_flagged:
            return "jamming flagged";
        case ExpectedSubject::spoofing_flagged:
            return "spoofing flagged";
        case ExpectedSubject::client_sends:
            return sender_words(subject, "client");
        case ExpectedSubject::client_reconfigures:
            return "client reconfigures";
        case ExpectedSubject::client_silent:
            return "client " + silence;
        case ExpectedSubject::client_trusts:
            return "client trusts";
        case ExpectedSubject::client_distrusts:
            return "client distrusts";
        case ExpectedSubject::receiver_sends:
            return sender_words(subject, "receiver");
        case ExpectedSubject::receiver_silent:
            return "receiver " + silence;
        default:
            return quantity_words(subject);
    }
}

std::string expectation_text(const ExpectedSentence& sentence) {
    std::string subject = subject_text(sentence.subject);
    const bool silent = sentence.subject.subject == ExpectedSubject::client_silent ||
                        sentence.subject.subject == ExpectedSubject::receiver_silent;
    if (silent && means_a_stretch(sentence.time)) subject.resize(subject.find(" for "));
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
