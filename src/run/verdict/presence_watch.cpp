#include "detail/presence_watch.hpp"

namespace skyloop {
namespace {

bool is_quantity(ExpectedSubject subject) {
    return subject >= ExpectedSubject::horizontal_error && subject <= ExpectedSubject::cn0;
}

bool is_of_receiver(ExpectedSubject subject) {
    return subject == ExpectedSubject::receiver_sends || subject == ExpectedSubject::receiver_silent;
}

}  // namespace

PresenceWatch::PresenceWatch(const ExpectedSentence& sentence)
    : subject_(sentence.subject.subject), need_(need_of(sentence)) {}

PresenceWatch::Need PresenceWatch::need_of(const ExpectedSentence& sentence) {
    const ExpectedSubject subject = sentence.subject.subject;
    const bool never = sentence.time.never;
    if (is_belief(subject)) return never == (subject == ExpectedSubject::client_trusts) ? Need::trust : Need::nothing;
    if (is_silence(subject)) return never ? Need::nothing : Need::message;
    if (is_of_messages(subject)) {
        if (never) return Need::sender;
        return sentence.subject.every ? Need::message : Need::nothing;
    }
    if (subject == ExpectedSubject::no_fix) return never ? Need::nothing : Need::epoch;
    if (!never) return Need::nothing;
    return is_quantity(subject) ? Need::number_then : Need::epoch_then;
}

void PresenceWatch::note_reading(const Reading& reading) {
    reported_ = reading.reported && (need_ != Need::number_then || reading.number);
    if (need_ == Need::trust && reading.holds == (subject_ == ExpectedSubject::client_trusts)) shown_ = true;
    if (need_ == Need::epoch && reported_) shown_ = true;
}

void PresenceWatch::note_held() {
    if ((need_ == Need::epoch_then || need_ == Need::number_then) && reported_) shown_ = true;
}

void PresenceWatch::note_message() {
    if (need_ == Need::message) shown_ = true;
}

void PresenceWatch::note_sender(bool is_client) {
    if (need_ == Need::sender && is_client != is_of_receiver(subject_)) shown_ = true;
}

std::string_view PresenceWatch::why_missing() const {
    switch (need_) {
        case Need::trust:
            return "the client never trusted the receiver, without which its distrust shows nothing";
        case Need::epoch:
            return "the receiver never reported an epoch, without which a missing fix shows nothing";
        case Need::epoch_then:
            return "the receiver reported no epoch in that time";
        case Need::number_then:
            return "the receiver reported no such number in that time";
        default:
            break;
    }
    if (need_ == Need::message && !is_silence(subject_)) return "no such message came in the whole run";
    return is_of_receiver(subject_) ? "the receiver sent nothing in the whole run, so that its silence shows nothing"
                                    : "no client sent anything in the whole run, so that its silence shows nothing";
}

}  // namespace skyloop
