#include "run/verdict/expectation_reach.hpp"

#include <fmt/format.h>

namespace skyloop::inline run {
namespace {

std::string lack_of(const ReceiverNeed& need, const UsedReceiver& receiver) {
    return need.met(receiver) ? std::string() : std::string(need.lack);
}

std::string why_never_of_type(FixType type, const UsedReceiver& receiver) {
    switch (type) {
        case FixType::dgnss:
            return lack_of(correction_input, receiver);
        case FixType::rtk_float:
        case FixType::rtk_fixed:
            return lack_of(rtk_solution, receiver);
        case FixType::dead_reckoning:
            return lack_of(dead_reckoning_report, receiver);
        case FixType::time_only:
            return lack_of(time_mode, receiver);
        default:
            return {};
    }
}

}  // namespace

std::string why_never_true(const SubjectClause& subject, const UsedReceiver& receiver) {
    switch (subject.subject) {
        case ExpectedSubject::fix_type:
            return why_never_of_type(subject.fix_type, receiver);
        case ExpectedSubject::jamming_flagged:
            return lack_of(jamming_report, receiver);
        case ExpectedSubject::spoofing_flagged:
            return lack_of(spoofing_report, receiver);
        case ExpectedSubject::cn0:
            if (!subject.satellite || can_track(receiver.board, subject.satellite->constellation)) return {};
            return fmt::format("does not receive {}", constellation_name(subject.satellite->constellation));
        case ExpectedSubject::receiver_sends:
            return why_never_sent(receiver, subject.message);
        default:
            return {};
    }
}

}  // namespace skyloop::inline run
