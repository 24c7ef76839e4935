#include "detail/expectation_tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "detail/sentence_words.hpp"
#include "run/verdict/expectation.hpp"

namespace skyloop::inline run {
namespace {

// A receiver of which no epoch has been seen for so long reports nothing: longer than any pause between two epochs.
constexpr Seconds longest_pause{5};
constexpr std::size_t most_planned = 1024;
constexpr Nanoseconds just_after{1};

}  // namespace

std::string span_text(Seconds span) {
    std::string text = fmt::format("{:.3f}", span.value());
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return (text == "-0" ? "0" : text) + " s";
}

ExpectationTracker::ExpectationTracker(const ExpectedSentence& sentence, GpsTime start)
    : sentence_(sentence), start_(start), presence_(sentence) {
    const SubjectClause& subject = sentence_.subject;
    if (is_of_epochs(subject.subject))
        turn_ = Turn{advanced(start, longest_pause), subject.subject == ExpectedSubject::no_fix};
    else if (is_silence(subject.subject) && !strict_silence())
        turn_ = Turn{advanced(start, subject.silence), true};
    if (!is_of_epochs(subject.subject)) value_ = strict_silence();
    plan_at_start();
    advance(start);
}

bool ExpectationTracker::once() const {
    const TimeClause& time = sentence_.time;
    if (time.never || time.rule == TimeRule::at) return false;
    if (time.rule == TimeRule::some_time || time.rule == TimeRule::within) return true;
    return is_message(sentence_.subject.subject) && !sentence_.subject.every;
}

// Where silence has to last all along, the first message breaks it; elsewhere it comes true after a while.
bool ExpectationTracker::strict_silence() const {
    return is_silence(sentence_.subject.subject) && means_a_stretch(sentence_.time);
}

// A silence that has to begin within a time: it shows when it has lasted, which may be later.
bool ExpectationTracker::timely_silence() const {
    return is_silence(sentence_.subject.subject) && sentence_.time.rule == TimeRule::within;
}

bool ExpectationTracker::is_named(const FaultSeen& seen) const {
    const auto& event = sentence_.time.event;
    return event && !event->is_run() && (event->name == seen.name || event->name == seen.kind);
}

// Occurrences are counted as they begin, whichever entry they are of; what ends is what has begun. 0: it has not.
int ExpectationTracker::number_of(const FaultSeen& seen) {
    if (seen.begins) {
        not_ended_.push_back({std::string(seen.name), seen.occurrence, ++begun_});
        return begun_;
    }
    const auto begun = std::find_if(not_ended_.begin(), not_ended_.end(), [&](const Begun& b) {
        return b.entry == seen.name && b.of_entry == seen.occurrence;
    });
    if (begun == not_ended_.end()) return 0;
    const int number = begun->number;
    not_ended_.erase(begun);
    return number;
}

void ExpectationTracker::plan_at_start() {
    const TimeClause& time = sentence_.time;
    switch (time.rule) {
        case TimeRule::some_time:
        case TimeRule::always:
        case TimeRule::until_event:
            return plan({start_, std::nullopt, start_});
        case TimeRule::throughout:
        case TimeRule::during:
        case TimeRule::after:
            return;
        case TimeRule::within:
        case TimeRule::at:
        case TimeRule::from_to:
            if (!time.event || time.event->is_run()) plan_at(start_);
    }
}

// The stretch that belongs to an event at this time.
void ExpectationTracker::plan_at(GpsTime event) {
    const TimeClause& time = sentence_.time;
    const GpsTime from = advanced(event, time.from);
    if (time.rule == TimeRule::at) return plan({from, from, event, true});
    auto until = time.until ? std::optional(advanced(event, *time.until)) : std::nullopt;
    if (timely_silence()) until = advanced(*until, sentence_.subject.silence);
    plan({from, until, event});
}

void ExpectationTracker::plan(const Stretch& stretch) {
    if (planned_.size() >= most_planned)
        return fail(stretch.origin, fmt::format("more than {} instants wait to be looked at", most_planned));
    planned_.push_back(stretch);
}

std::optional<GpsTime> ExpectationTracker::next_step() const {
    std::optional<GpsTime> next;
    const auto earliest = [&next](GpsTime time) { next = next ? std::min(*next, time) : time; };
    if (!planned_.empty()) earliest(planned_.front().opens);
    if (turn_) earliest(turn_->at);
    if (stretch_ && stretch_->closes) earliest(*stretch_->closes + just_after);
    return next;
}

void ExpectationTracker::advance(GpsTime now) {
    while (!finding_) {
        const auto next = next_step();
        if (!next || *next > now) return;
        step(*next);
    }
}

// What closes is closed first: an instant that is over does not see what comes next.
void ExpectationTracker::step(GpsTime now) {
    if (stretch_ && stretch_->closes && *stretch_->closes < now) return close(now);
    if (!planned_.empty() && planned_.front().opens <= now) {
        const Stretch stretch = planned_.front();
        planned_.pop_front();
        return open(stretch);
    }
    turn(now);
}

void ExpectationTracker::open(const Stretch& stretch) {
    ++stretches_;
    if (stretch_) {
        // Whatever fulfils the older one fulfils this too, and the older deadline comes first.
        if (once()) {
            ++waiting_;
            return;
        }
        stretch_->closes = stretch_->closes && stretch.closes
                               ? std::optional(std::max(*stretch_->closes, *stretch.closes))
                               : std::nullopt;
        return;
    }
    stretch_ = stretch;
    looked_at_ = false;
    const SubjectClause& subject = sentence_.subject;
    if (subject.every) {
        value_ = true;
        turn_ = Turn{advanced(stretch.opens, *subject.every) + just_after, false};
    }
    if (timely_silence()) {
        value_ = false;
        turn_ = Turn{advanced(stretch.opens, subject.silence), true};
    }
    // What a client believes or leaves unsaid is true now; the last epoch is of before.
    const bool lasting = is_belief(subject.subject) || (is_silence(subject.subject) && !strict_silence());
    if (lasting && !stretch.instant) judge(stretch.opens, *value_);
}

void ExpectationTracker::turn(GpsTime now) {
    value_ = turn_->to;
    turn_.reset();
    if (is_of_epochs(sentence_.subject.subject)) {
        presence_.note_no_epochs();
        last_number_.reset();
        last_word_ = "no epoch for " + span_text(longest_pause);
    } else {
        last_word_ = "nothing sent";
    }
    judge(now, *value_);
}

void ExpectationTracker::look(GpsTime now, const Reading& reading) {
    if (finding_) return;
    presence_.note_reading(reading);
    value_ = reading.holds;
    ever_seen_ = true;
    ++seen_;
    last_number_ = reading.number;
    last_word_ = reading.word;
    if (is_of_epochs(sentence_.subject.subject))
        turn_ = Turn{advanced(now, longest_pause), sentence_.subject.subject == ExpectedSubject::no_fix};
    judge(now, *value_);
}

void ExpectationTracker::hear(GpsTime now, std::string_view name) {
    if (finding_) return;
    presence_.note_message();
    ++seen_;
    last_word_ = name;
    const SubjectClause& subject = sentence_.subject;
    if (subject.every) {
        value_ = true;
        turn_ = Turn{advanced(now, *subject.every) + just_after, false};
        return judge(now, true);
    }
    if (!is_silence(subject.subject)) return judge(now, true);  // a message is true for its instant
    if (!strict_silence()) {
        value_ = false;
        turn_ = Turn{advanced(now, subject.silence), true};
        if (timely_silence() && stretch_ && turn_->at > *stretch_->closes)
            return fail(now,
                        fmt::format("did not begin by {}{}",
                                    moment(advanced(*stretch_->closes, -subject.silence), *stretch_), last_seen()));
    }
    judge(now, false);
}

void ExpectationTracker::judge(GpsTime now, bool value) {
    if (!stretch_ || stretch_->instant) return;
    looked_at_ = true;
    const bool right = value != sentence_.time.never;
    if (right && !once()) return remember();
    if (right && !presence_.is_missing()) return come_true(now);
    // Trust may still come, and be lost; a silence of one who never spoke is over.
    if (right && timely_silence()) return leave_unshown();
    if (once()) return;
    fail(now, fmt::format("{} {}{}", sentence_.time.never ? "was true" : "did not hold", moment(now, *stretch_),
                          last_seen()));
}

// Of what holds all along, what is seen while it has to hold is the evidence, not what comes after.
void ExpectationTracker::remember() {
    presence_.note_held();
    if (strict_silence() && !sentence_.time.never) {
        right_word_ = "nothing sent";  // the last message was before
        return;
    }
    if (!last_number_) {
        right_word_ = last_word_;
        return;
    }
    if (!right_numbers_) right_numbers_ = {*last_number_, *last_number_};
    auto& [least, greatest] = *right_numbers_;
    least = std::min(least, *last_number_);
    greatest = std::max(greatest, *last_number_);
}

void ExpectationTracker::come_true(GpsTime now) {
    const GpsTime since = timely_silence() ? advanced(now, -sentence_.subject.silence) : now;
    const Seconds delay = difference(since, stretch_->origin);
    if (came_true_ == 0 || delay > slowest_) {
        slowest_ = delay;
        slowest_moment_ = moment(since, *stretch_) + last_seen();
    }
    came_true_ += 1 + std::exchange(waiting_, 0);
    came_true_at_ = now;
    if (sentence_.time.rule == TimeRule::some_time) finding_ = summary();
    stretch_.reset();
}

void ExpectationTracker::leave_unshown() {
    unshown_ = true;
    waiting_ = 0;
    stretch_.reset();
}

// The stretch is over: what had to last and was not looked at within it is as it was before.
void ExpectationTracker::close(GpsTime now) {
    const Stretch stretch = *stretch_;
    const GpsTime end = stretch.closes.value_or(now);
    if (once() && presence_.is_missing() && value_.value_or(false)) return leave_unshown();
    // An epoch of before fulfils nothing; that there have been none for long does, since it is still so.
    if (!looked_at_ && once() && is_of_epochs(sentence_.subject.subject) && turn_)
        return fail(end, fmt::format("did not come true by {}: no epoch came in that time", moment(end, stretch)));
    if (stretch.instant || !looked_at_) {
        if (!value_) return fail(end, "nothing was reported by then");
        const bool right = *value_ != sentence_.time.never;
        if (once() && right) return come_true(end);
        if (!once() && !right) return fail(end, "did not hold " + moment(end, stretch) + last_seen());
        if (!once()) remember();
    }
    if (once()) return fail(end, fmt::format("did not come true by {}{}", moment(end, stretch), last_seen()));
    came_true_at_ = end;
    stretch_.reset();
}

void ExpectationTracker::fail(GpsTime now, std::string evidence) {
    finding_ = Finding{Outcome::failed, std::move(evidence), now};
}

void ExpectationTracker::event(GpsTime now, const FaultSeen& seen) {
    if (finding_ || !is_named(seen)) return;
    const std::optional<int> wanted = sentence_.time.event->occurrence;
    const int number = number_of(seen);
    if (!wanted || *wanted == number) happen(now, seen.begins);
}

void ExpectationTracker::happen(GpsTime now, bool begins) {
    const TimeClause& time = sentence_.time;
    if (time.rule == TimeRule::throughout || time.rule == TimeRule::during) {
        under_way_ = std::max(0, under_way_ + (begins ? 1 : -1));
        event_came_ = event_came_ || begins;
        if (begins && under_way_ == 1) plan({now, std::nullopt, now});
        if (!begins && under_way_ == 0 && stretch_) close(now);  // what is seen now, but later, is of after
    } else if (begins != time.event->end) {
        const bool first = !event_came_;
        event_came_ = true;
        if (time.rule != TimeRule::until_event)
            plan_at(now);
        else if (first && stretch_)
            close(now);
    }
    advance(now);
}

Finding ExpectationTracker::so_far() const {
    if (finding_) return *finding_;
    if (stretches_ == 0 || stretch_ || !planned_.empty()) return {};
    Finding finding = summary();
    return finding.outcome == Outcome::undecided ? Finding{} : finding;
}

Finding ExpectationTracker::finish(GpsTime now, RunEnd end) {
    advance(now);
    if (!finding_) last_until_end(now, end);
    return finding_ ? *finding_ : summary();
}

// What the end of the run makes of what is still open.
void ExpectationTracker::last_until_end(GpsTime now, RunEnd end) {
    const TimeClause& time = sentence_.time;
    if (is_belief(sentence_.subject.subject) && !ever_seen_)
        return fail(now, "no client told whether it trusts the receiver");
    const bool cut = end == RunEnd::cut;
    if (time.event && !time.event->is_run() && !event_came_) {
        if (!cut) return fail(now, event_never_came());
        finding_ = Finding{Outcome::undecided,
                           fmt::format("the run was stopped after {}; until then {}",
                                       span_text(difference(now, start_)), event_never_came()),
                           std::nullopt};
        return;
    }
    // What lasts to the end of the run is not over where something else has ended it.
    if (stretch_ && (stretch_->closes ? *stretch_->closes <= now : !cut)) close(now);
    if (finding_ || (!stretch_ && planned_.empty())) return;
    std::string ended =
        fmt::format("the run ended after {}, before the time was over", span_text(difference(now, start_)));
    if (stretch_ && once()) ended += "; it had not come true" + last_seen();
    finding_ = Finding{Outcome::undecided, std::move(ended), std::nullopt};
}

Finding ExpectationTracker::summary() const {
    if (unshown_ || (!once() && presence_.is_missing()))
        return {Outcome::undecided, std::string(presence_.why_missing()), std::nullopt};
    if (once()) {
        const std::string often = came_true_ > 1 ? fmt::format(" {} times, at the latest", came_true_) : "";
        return {Outcome::passed, fmt::format("came true{} {}", often, slowest_moment_), came_true_at_};
    }
    const bool never = sentence_.time.never;
    if (is_message(sentence_.subject.subject) && never) return {Outcome::passed, "no such message then", came_true_at_};
    const std::string times = stretches_ > 1 ? fmt::format(" in {} stretches of time", stretches_) : "";
    return {Outcome::passed, fmt::format("{}{}{}", never ? "was not true" : "held", times, seen_all_along()),
            came_true_at_};
}

std::string ExpectationTracker::event_never_came() const {
    const EventReference& event = *sentence_.time.event;
    const std::string number = event.occurrence ? fmt::format("#{}", *event.occurrence) : "";
    return fmt::format("{}{} never {}", event.name, number, event.end ? "ended" : "began");
}

std::string ExpectationTracker::moment(GpsTime now, const Stretch& stretch) const {
    const auto& event = sentence_.time.event;
    if (!event || sentence_.time.rule == TimeRule::until_event || event->is_run())
        return span_text(difference(now, start_)) + " after the start of the run";
    return fmt::format("{} after {} {}", span_text(difference(now, stretch.origin)), event->name,
                       event->end ? "ended" : "began");
}

std::string ExpectationTracker::last_seen() const {
    if (last_number_) return fmt::format(" (seen: {:.2f}{})", *last_number_, words_of(sentence_.subject.subject).unit);
    if (!last_word_.empty()) return fmt::format(" (seen: {})", last_word_);
    return is_of_epochs(sentence_.subject.subject) ? "" : " (seen: nothing)";
}

std::string ExpectationTracker::seen_all_along() const {
    std::string seen;
    if (right_numbers_) {
        const auto [least, greatest] = *right_numbers_;
        const std::string low = fmt::format("{:.2f}", least), high = fmt::format("{:.2f}", greatest);
        seen = low == high ? low : low + " to " + high;
        seen += words_of(sentence_.subject.subject).unit;
    }
    if (!right_word_.empty()) seen += (seen.empty() ? "" : ", ") + right_word_;
    if (!seen.empty()) return fmt::format(" (seen: {})", seen);
    return is_of_epochs(sentence_.subject.subject) ? "" : " (seen: nothing)";
}

}  // namespace skyloop::inline run
