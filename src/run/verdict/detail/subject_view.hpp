/// What is seen of a subject at one instant.
/// What a run must show before an absence in it is evidence.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "run/fault/run_observer.hpp"
#include "run/verdict/expectation.hpp"

namespace skyloop::inline run {

/// One look at a subject.
struct Reading {
    bool holds = false;
    std::optional<double> number{};  ///< in the unit of the subject
    std::string_view word{};         ///< where there is no number: "3d fix"
    bool reported = true;            ///< false: the receiver reports nothing, and the subject is judged by that
};

/// Whether the subject is read from epochs.
bool is_of_epochs(ExpectedSubject subject);
/// Whether it is what a scripted client believes.
bool is_belief(ExpectedSubject subject);
/// Whether it is read from messages: neither of the two.
bool is_of_messages(ExpectedSubject subject);
bool is_silence(ExpectedSubject subject);
/// Whether it is a number that is compared.
bool is_quantity(ExpectedSubject subject);

/// The subject at an epoch; it must be one of epochs.
Reading read_epoch(const SubjectClause& subject, const EpochSeen& seen);
/// The subject while the receiver tells nothing of its epochs.
Reading read_silence(const SubjectClause& subject);
/// Whether a message is one that the subject speaks of. Noise is no message.
bool speaks_of(const SubjectClause& subject, const MessageSeen& seen);
/// Whether a client's message changes the receiver's settings: UBX-CFG but for polls and CFG-VALGET, PUBX,40 and
/// PUBX,41, the setting packets of PMTK (2xx, 3xx) and PAIR (050, 062, 066, 864) (RECEIVER.md section 5).
bool is_reconfiguration(const MessageSeen& seen);

/// A subject in the words of the grammar, without what belongs to it.
struct SubjectWords {
    std::string_view words{};
    std::string_view unit{};  ///< " m", " dBHz" … behind its number
};
/// In the order of ExpectedSubject.
inline constexpr std::array<SubjectWords, 22> subject_words{{{"fix"},
                                                             {"no fix"},
                                                             {"fix"},
                                                             {"horizontal error", " m"},
                                                             {"vertical error", " m"},
                                                             {"speed error", " m/s"},
                                                             {"h_acc", " m"},
                                                             {"v_acc", " m"},
                                                             {"PDOP"},
                                                             {"HDOP"},
                                                             {"VDOP"},
                                                             {"satellites", " satellites"},
                                                             {"C/N0", " dBHz"},
                                                             {"jamming flagged"},
                                                             {"spoofing flagged"},
                                                             {"client sends"},
                                                             {"client reconfigures"},
                                                             {"client silent"},
                                                             {"client trusts"},
                                                             {"client distrusts"},
                                                             {"receiver sends"},
                                                             {"receiver silent"}}};
inline const SubjectWords& words_of(ExpectedSubject subject) {
    return subject_words[static_cast<std::size_t>(subject)];
}

template <class Value>
bool compares(const Value& found, Relation comparison, const Value& wanted) {
    switch (comparison) {
        case Relation::below:
            return found < wanted;
        case Relation::above:
            return found > wanted;
        case Relation::at_least:
            return found >= wanted;
        case Relation::at_most:
            return found <= wanted;
        case Relation::equal:
            return found == wanted;
        case Relation::not_equal:
            return found != wanted;
    }
    return false;
}

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

}  // namespace skyloop::inline run
