/// The sentences of `[[expect]]`.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "run/verdict/expectation.hpp"

namespace skyloop {

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
///                | ("h_acc" | "v_acc") compare NUMBER "m" | "satellites" compare NUMBER
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

}  // namespace skyloop
