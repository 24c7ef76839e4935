/// Follows one sentence at one receiver.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "run/verdict/expectation.hpp"
#include "run/verdict/verdict.hpp"
#include "subject_view.hpp"

namespace skyloop::inline run {

/// How a sentence came out.
struct Finding {
    Outcome outcome = Outcome::undecided;
    std::string evidence;
    std::optional<GpsTime> decided_at{};
};

/// "1.2 s", at most three decimals.
std::string span_text(Seconds span);

/// A sentence makes stretches of time, and its subject is a value that is true or false at each instant. Within a
/// stretch the value must come true once, or stay true all along; `never` turns the value round. Times never go back.
class ExpectationTracker {
public:
    ExpectationTracker(const ExpectedSentence& sentence, GpsTime start);

    /// What lies before or at `now`: deadlines, silences. To be called before what is seen at `now` is told.
    void advance(GpsTime now);
    /// A look at the subject, of epochs or of beliefs.
    void look(GpsTime now, const Reading& reading);
    /// A message that the subject speaks of. @param name of it
    void hear(GpsTime now, std::string_view name);
    /// Somebody is there: a message of either side, whatever it is, or a belief of a client.
    void note_sender(bool is_client) { presence_.note_sender(is_client); }
    /// Something begins or ends; a command does both at once.
    void event(GpsTime now, const FaultSeen& seen);
    Finding finish(GpsTime now, RunEnd end);

    /// How it stands: failed for good; passed where every stretch that has come was, though another may come;
    /// undecided, without evidence, while one lasts or none has come.
    [[nodiscard]] Finding so_far() const;

    [[nodiscard]] const SubjectClause& subject() const { return sentence_.subject; }
    /// True when nothing can change it any more.
    [[nodiscard]] bool is_decided() const { return finding_.has_value(); }

private:
    struct Stretch {
        GpsTime opens{};
        std::optional<GpsTime> closes{};  // inclusive; nothing: the end of the run, or of the event
        GpsTime origin{};                 // of the event, for the evidence
        bool instant = false;             // looked at once
    };
    struct Begun {
        std::string entry;
        int of_entry = 1, number = 1;  // counted of this entry alone, and of all that the event's name fits
    };
    struct Turn {  // the value changes by itself
        GpsTime at{};
        bool to = false;
    };
    // Whether the value has to come true once.
    [[nodiscard]] bool once() const;
    [[nodiscard]] bool strict_silence() const;
    [[nodiscard]] bool timely_silence() const;
    [[nodiscard]] bool is_named(const FaultSeen& seen) const;
    int number_of(const FaultSeen& seen);
    [[nodiscard]] std::optional<GpsTime> next_step() const;
    void step(GpsTime now);
    void plan_at_start();
    void plan_at(GpsTime event);
    void plan(const Stretch& stretch);
    void open(const Stretch& stretch);
    void turn(GpsTime now);
    void close(GpsTime now);
    void judge(GpsTime now, bool value);
    void remember();
    void come_true(GpsTime now);
    void leave_unshown();
    void fail(GpsTime now, std::string evidence);
    void happen(GpsTime now, bool begins);
    void last_until_end(GpsTime now, RunEnd end);
    [[nodiscard]] Finding summary() const;
    [[nodiscard]] std::string event_never_came() const;
    [[nodiscard]] std::string moment(GpsTime now, const Stretch& stretch) const;
    [[nodiscard]] std::string last_seen() const;
    [[nodiscard]] std::string seen_all_along() const;

    ExpectedSentence sentence_;
    GpsTime start_;
    PresenceWatch presence_;
    std::optional<bool> value_;       // of the subject, before `never` turns it
    std::optional<Turn> turn_;        // to come
    std::optional<Stretch> stretch_;  // that is open
    std::deque<Stretch> planned_;     // ascending
    int under_way_ = 0;               // occurrences of the event
    int begun_ = 0;                   // of all that the event's name fits
    std::vector<Begun> not_ended_;    // of them
    bool event_came_ = false, looked_at_ = false, ever_seen_ = false;
    bool unshown_ = false;  // a stretch in which what came true is no evidence
    std::uint64_t stretches_ = 0, seen_ = 0, came_true_ = 0;
    std::uint64_t waiting_ = 0;  // stretches that have opened since the open one, and are fulfilled with it
    Seconds slowest_{0};
    std::string slowest_moment_;
    std::optional<GpsTime> came_true_at_;
    std::optional<double> last_number_;
    std::string last_word_;
    // What was right within the stretches: the evidence of those that had to hold.
    std::optional<std::array<double, 2>> right_numbers_;  // the least and the greatest
    std::string right_word_;                              // the last one
    std::optional<Finding> finding_;
};

}  // namespace skyloop::inline run
