/// What a run must show before an absence in it is evidence.
#pragma once

#include <string_view>

#include "run/verdict/expectation.hpp"
#include "subject_view.hpp"

namespace skyloop {

/// Distrust, silence, "no fix" and "never" are also true of a client or receiver that is not there. They count only in
/// a run in which the client once trusted, or the sender once sent, or the receiver once reported.
///
/// State: whether the run has shown it.
class PresenceWatch {
public:
    explicit PresenceWatch(const ExpectedSentence& sentence);

    /// A look at the subject.
    void note_reading(const Reading& reading);
    /// No epoch has come for long: nothing is known of the subject.
    void note_no_epochs() { reported_ = false; }
    /// The sentence holds at present, within a stretch of time of its own.
    void note_held();
    /// A message of the subject.
    void note_message();
    /// Any message of either side, and any belief of a scripted client.
    void note_sender(bool is_client);

    [[nodiscard]] bool is_missing() const { return need_ != Need::nothing && !shown_; }
    /// "the client never trusted the receiver, which its distrust needs as evidence"
    [[nodiscard]] std::string_view why_missing() const;

private:
    // The last two have to be shown within the stretches of the sentence.
    enum class Need { nothing, trust, message, sender, epoch, epoch_then, number_then };
    static Need need_of(const ExpectedSentence& sentence);

    ExpectedSubject subject_;
    Need need_;
    bool reported_ = false;  // the last look was at something
    bool shown_ = false;
};

}  // namespace skyloop
