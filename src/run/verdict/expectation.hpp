/// What a scenario expects of a run, as plain data.
/// The sentences of `[[expect]]`.
#pragma once

#include <tl/expected.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/core/units.hpp"
#include "world/flow/fix.hpp"
#include "world/gnss/satellite.hpp"

namespace skyloop::inline run {

/// What a sentence speaks of. "Reported" is what the receiver tells its clients, right or wrong.
enum class ExpectedSubject {
    fix,                  ///< a position is reported as valid
    no_fix,               ///< none is, or no epoch has come for 5 s
    fix_type,             ///< the valid fix is of `fix_type`; 3d stands for all that have a height by themselves
    horizontal_error,     ///< reported against true position, m
    vertical_error,       ///< … height above the ellipsoid, m, without sign
    speed_error,          ///< … velocity over ground and up, length of the difference, m/s
    horizontal_accuracy,  ///< as reported, 1 σ, m
    vertical_accuracy,    ///< as reported, 1 σ, m
    pdop,                 ///< as reported
    hdop,
    vdop,
    satellites,           ///< used in the reported fix
    cn0,                  ///< mean of the tracked satellites, or of one, dB-Hz
    jamming_flagged,      ///< the jamming state is warning or critical
    spoofing_flagged,     ///< spoofing is indicated
    client_sends,         ///< a message of this name, as the receiver heard it
    client_reconfigures,  ///< any message that changes the receiver's settings
    client_silent,        ///< sends no whole message
    client_trusts,        ///< a scripted client would navigate by the receiver
    client_distrusts,
    receiver_sends,  ///< a message of this name
    receiver_silent  ///< sends no whole message
};

/// How a number is compared. A number that is not there (an error without a fix) compares as false.
enum class Relation { below, above, at_least, at_most, equal, not_equal };

/// The subject of a sentence with what belongs to it.
struct SubjectClause {
    ExpectedSubject subject = ExpectedSubject::fix;
    FixType fix_type = FixType::fix_3d;  ///< of fix_type
    Relation comparison = Relation::below;
    double limit = 0;                        ///< m, m/s, dB-Hz, satellites or DOP
    std::optional<SatelliteId> satellite{};  ///< of cn0; nothing: the mean of all tracked
    std::string message{};                   ///< of …_sends; "CFG-*" for all that begin so, "anything"
    std::optional<Seconds> every{};          ///< of …_sends: no gap is longer
    Seconds silence{2};                      ///< of …_silent, where it has to come true: so long without a message
};

/// An entry of the timeline, or the run itself, at its start or its end.
struct EventReference {
    std::string name;               ///< of a fault or a command, or its kind; "run"
    std::optional<int> occurrence;  ///< "outage#2"; nothing: each
    bool end = false;
    [[nodiscard]] bool is_run() const { return name == "run"; }
};

/// When the subject has to be true.
enum class TimeRule {
    some_time,    ///< once in the run: no time was named
    within,       ///< some time from the event to `until` s later
    throughout,   ///< all the time from the event's start to its end
    during,       ///< as throughout; of messages: one of them at least
    always,       ///< all the time of the run
    at,           ///< at `from` s of the run, or after the event when there is one
    from_to,      ///< all the time from `from` s to `until` s of the run, or after the event when there is one
    until_event,  ///< all the time from the start of the run to the event
    after         ///< all the time from the event on, for `until` s when that is given
};

/// The time clause of a sentence.
struct TimeClause {
    TimeRule rule = TimeRule::some_time;
    bool never = false;  ///< at no time of these
    std::optional<EventReference> event{};
    Seconds from{0};
    std::optional<Seconds> until{};
};

/// A sentence, understood.
struct ExpectedSentence {
    SubjectClause subject;
    TimeClause time;
};

/// A condition on the JSON objects that a probe prints, one a line: `tpv.mode >= 3`. A line fulfils it when the value
/// at the path does; a first part that equals the object's "class" (in any case) names the object.
struct JsonCondition {
    std::vector<std::string> path;
    Relation comparison = Relation::equal;
    std::variant<double, bool, std::string> value;
};

/// A program that is asked about the world outside. Only in runs against the clock.
struct Probe {
    std::vector<std::string> command;          ///< a program and its arguments, or a single text for /bin/sh
    std::optional<int> expect_exit{};          ///< nothing: 0, or any when there is a condition
    std::optional<JsonCondition> condition{};  ///< one printed line must fulfil it
    Seconds at{0};                             ///< of the run: when it is started
    std::optional<Seconds> within{};           ///< started anew until it succeeds, so long by the host's clock
    Seconds timeout{10};  ///< of each start, by the host's clock; then it is killed with its children
};

/// One `[[expect]]`: a sentence or a probe.
struct Expectation {
    std::string name;      ///< for people; empty: `what`, or the probe's command
    std::string what;      ///< the sentence as it was written
    std::string receiver;  ///< whom it is about; empty: each
    std::optional<ExpectedSentence> sentence{};
    std::optional<Probe> probe{};
    std::string told_at{};  ///< "FILE:LINE:COLUMN: ", for messages; empty: in no file

    /// What verdicts call it.
    [[nodiscard]] std::string title() const;
};

/// What is wrong with a sentence.
struct SentenceMistake {
    std::size_t column = 1;  ///< of the word, from 1
    std::string sentence;    ///< "'fixx' is not understood; expected one of …"
};

/// Reads a sentence of this grammar; words may be of any case, blanks separate them:
///
///     sentence   = subject [time]
///     subject    = "no" "fix" | "fix" | ("2d" | "3d" | "dgnss") "fix" | "rtk" ("fixed" | "float")
///                | "dead" "reckoning" | "time" "only"
///                | ("horizontal" | "vertical") "error" compare NUMBER "m" | "speed" "error" compare NUMBER "m/s"
///                | ("h_acc" | "v_acc") compare NUMBER "m" | ("PDOP" | "HDOP" | "VDOP" | "satellites") compare NUMBER
///                | "C/N0" ["of" SATELLITE] compare NUMBER "dBHz" | ("jamming" | "spoofing") "flagged"
///                | "client" ("sends" message | "reconfigures" | "silent" ["for" span] | "trusts" | "distrusts")
///                | "receiver" ("sends" message | "silent" ["for" span])
///     message    = (NAME | "anything") ["every" span]
///     compare    = "below" | "above" | "at" ("least" | "most")
///     time       = "always" | "never" [window] | "at" span | span "after" event | "within" span "of" event | window
///     window     = ("throughout" | "during") event | "from" span "to" span ["after" event]
///                | "until" event | "after" event ["for" span]
///     event      = ["the"] [("start" | "end") "of" ["the"]] (NAME | "run")
///     span       = NUMBER "s"
///
/// An event's time is its start unless "end of" is said. A NAME with blanks stands in quotes; `NAME#2` is its second
/// occurrence alone; without that, each occurrence has to be answered. A message without "every" fulfils a window by
/// coming once; "throughout" and "always" need "every". Without a time, once in the run is enough.
tl::expected<ExpectedSentence, SentenceMistake> parse_expectation(std::string_view text);

/// The sentence in the words of the grammar, with nothing left out: what was understood.
std::string expectation_text(const ExpectedSentence& sentence);
/// Its subject alone.
std::string subject_text(const SubjectClause& subject);

/// What is wrong with the event that a sentence names, or an empty text.
/// @param entries names of the faults and commands of the scenario; the kinds are known anyway
std::string event_mistake(const ExpectedSentence& sentence, std::span<const std::string> entries);

/// Reads a condition: PATH, one of == != < <= > >=, and a number, true, false or a text (in quotes when it has blanks).
tl::expected<JsonCondition, SentenceMistake> parse_json_condition(std::string_view text);
/// The condition as parse_json_condition() takes it.
std::string condition_text(const JsonCondition& condition);
/// Whether a line is a JSON object that fulfils the condition. Lines that are no JSON do not.
bool fulfils(const JsonCondition& condition, std::string_view line);

}  // namespace skyloop::inline run
