#include <algorithm>
#include <cmath>

#include "base/geo/local_frame.hpp"
#include "detail/subject_view.hpp"
#include "run/fault/known_names.hpp"

namespace skyloop::inline run {
namespace {

bool reports_fix(const firmware::NavigationState& state) { return state.fix_ok && state.epoch.fix.has_position(); }

std::string_view fix_word(const firmware::NavigationState& state) {
    if (state.epoch.fix.type == FixType::time_only) return "time only";
    if (!state.epoch.fix.has_position()) return "no fix";
    return state.fix_ok ? fix_type_name(state.epoch.fix.type) : "a fix that is not valid";
}

bool is_of_type(const SubjectClause& subject, const firmware::NavigationState& state) {
    const FixType type = state.epoch.fix.type;
    if (subject.fix_type == FixType::time_only) return type == FixType::time_only;
    if (!reports_fix(state)) return false;
    if (subject.fix_type != FixType::fix_3d) return type == subject.fix_type;
    return type == FixType::fix_3d || type == FixType::dgnss || type == FixType::rtk_float ||
           type == FixType::rtk_fixed;
}

// Reported less true, east, north and up, m.
Eigen::Vector3d position_error(const EpochSeen& seen) {
    const LocalFrame frame(seen.trace.truth.geodetic);
    return frame.to_enu(to_ecef(seen.reported.epoch.fix.position)).vector();
}

double velocity_error(const EpochSeen& seen) {
    const LocalFrame frame(seen.trace.truth.geodetic);
    const VelocityNed& reported = seen.reported.epoch.fix.velocity;
    const Eigen::Vector3d enu(reported.east, reported.north, -reported.down);
    return (enu - frame.to_enu(seen.trace.truth.velocity).vector()).norm();
}

std::optional<double> signal_strength(const SubjectClause& subject, const Fix& fix) {
    double sum = 0;
    int count = 0;
    for (const SatelliteStatus& status : fix.satellites) {
        if (!status.cn0 || (subject.satellite && status.id != *subject.satellite)) continue;
        sum += status.cn0->value();
        ++count;
    }
    return count == 0 ? std::nullopt : std::optional(sum / count);
}

// The number that the subject compares, where there is one.
std::optional<double> quantity_of(const SubjectClause& subject, const EpochSeen& seen) {
    const Fix& fix = seen.reported.epoch.fix;
    if (subject.subject == ExpectedSubject::satellites) return reports_fix(seen.reported) ? fix.satellites_used() : 0;
    if (subject.subject == ExpectedSubject::cn0) return signal_strength(subject, fix);
    if (!reports_fix(seen.reported)) return std::nullopt;
    switch (subject.subject) {
        case ExpectedSubject::horizontal_error:
            return position_error(seen).head<2>().norm();
        case ExpectedSubject::vertical_error:
            return std::abs(
                (fix.position.height.above_ellipsoid - seen.trace.truth.geodetic.height.above_ellipsoid).value());
        case ExpectedSubject::speed_error:
            return velocity_error(seen);
        case ExpectedSubject::horizontal_accuracy:
            return fix.horizontal_accuracy.value();
        case ExpectedSubject::vertical_accuracy:
            return fix.vertical_accuracy.value();
        case ExpectedSubject::pdop:
            return fix.dop.pdop;
        case ExpectedSubject::hdop:
            return fix.dop.hdop;
        case ExpectedSubject::vdop:
            return fix.dop.vdop;
        default:
            return std::nullopt;
    }
}

Reading read_quantity(const SubjectClause& subject, const EpochSeen& seen) {
    const std::optional<double> number = quantity_of(subject, seen);
    if (!number) return {false, std::nullopt, subject.subject == ExpectedSubject::cn0 ? "nothing tracked" : "no fix"};
    return {compares(*number, subject.comparison, subject.limit), number};
}

// A UBX frame is its payload and eight bytes. A poll has no payload, or names no more than what it asks for.
bool is_poll(std::string_view name, std::size_t payload) {
    if (payload == 0 || name == "CFG-VALGET") return true;
    if (name == "CFG-PRT" || name == "CFG-INF" || name == "CFG-TP5") return payload == 1;
    return name == "CFG-MSG" && payload == 2;
}

}  // namespace

bool is_of_epochs(ExpectedSubject subject) { return subject < ExpectedSubject::client_sends; }

bool is_belief(ExpectedSubject subject) {
    return subject == ExpectedSubject::client_trusts || subject == ExpectedSubject::client_distrusts;
}

bool is_of_messages(ExpectedSubject subject) { return !is_of_epochs(subject) && !is_belief(subject); }

bool is_silence(ExpectedSubject subject) {
    return subject == ExpectedSubject::client_silent || subject == ExpectedSubject::receiver_silent;
}

bool is_quantity(ExpectedSubject subject) {
    return subject >= ExpectedSubject::horizontal_error && subject <= ExpectedSubject::cn0;
}

Reading read_epoch(const SubjectClause& subject, const EpochSeen& seen) {
    const firmware::NavigationState& reported = seen.reported;
    switch (subject.subject) {
        case ExpectedSubject::fix:
            return {reports_fix(reported), std::nullopt, fix_word(reported)};
        case ExpectedSubject::no_fix:
            return {!reports_fix(reported), std::nullopt, fix_word(reported)};
        case ExpectedSubject::fix_type:
            return {is_of_type(subject, reported), std::nullopt, fix_word(reported)};
        case ExpectedSubject::jamming_flagged: {
            const bool flagged = reported.monitors.told_jamming_state() >= 2;  // 2 warning, 3 critical
            return {flagged, std::nullopt, flagged ? "flagged" : "not flagged"};
        }
        case ExpectedSubject::spoofing_flagged: {
            const bool flagged = reported.monitors.spoofing >= SpoofingIndication::indicated;
            return {flagged, std::nullopt, flagged ? "flagged" : "not flagged"};
        }
        default:
            return read_quantity(subject, seen);
    }
}

Reading read_silence(const SubjectClause& subject) {
    return {subject.subject == ExpectedSubject::no_fix, std::nullopt, "nothing is reported", false};
}

bool is_reconfiguration(const MessageSeen& seen) {
    if (seen.kind == StreamKind::ubx)
        return seen.name.starts_with("CFG-") && seen.bytes.size() >= 8 && !is_poll(seen.name, seen.bytes.size() - 8);
    if (seen.kind == StreamKind::command) return is_setting_command(seen.name);
    if (seen.kind != StreamKind::nmea) return false;
    static constexpr std::string_view setting[] = {"PUBX,40", "PUBX,41", "PMTK2",   "PMTK3",   "PAIR050", "PAIR062",
                                                   "PAIR066", "PAIR080", "PAIR400", "PAIR410", "PAIR513", "PAIR864"};
    return std::any_of(std::begin(setting), std::end(setting),
                       [&seen](std::string_view prefix) { return seen.name.starts_with(prefix); });
}

bool speaks_of(const SubjectClause& subject, const MessageSeen& seen) {
    if (seen.kind == StreamKind::noise) return false;
    switch (subject.subject) {
        case ExpectedSubject::client_sends:
            return seen.from_client && is_message_named(seen.name, subject.message);
        case ExpectedSubject::receiver_sends:
            return !seen.from_client && is_message_named(seen.name, subject.message);
        case ExpectedSubject::client_reconfigures:
            return seen.from_client && is_reconfiguration(seen);
        case ExpectedSubject::client_silent:
            return seen.from_client;
        case ExpectedSubject::receiver_silent:
            return !seen.from_client;
        default:
            return false;
    }
}

namespace {

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

}  // namespace skyloop::inline run
