#include "run/client/careful_client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "receiver/protocol/ubx_hardware.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_time.hpp"
#include "run/client/configuration_dialogue.hpp"

namespace skyloop::inline run {

std::vector<std::uint32_t> usual_speeds() { return {9600, 38400, 115200, 57600, 230400, 19200, 460800, 4800}; }

void PortHunt::start(GpsTime now) {
    hunting_ = true;
    first_ = true;
    next_ = 0;
    since_ = now;
}

bool PortHunt::advance(GpsTime now) {
    if (!hunting_ || (!first_ && now - since_ < dwell_)) return false;
    since_ = now;
    if (first_ && known_) {
        first_ = false;
        speed_ = *known_;
        return true;
    }
    first_ = false;
    speed_ = speeds_[next_];
    next_ = (next_ + 1) % speeds_.size();
    return true;
}

void PortHunt::found() {
    hunting_ = false;
    known_ = speed_;
}

namespace {

// INAV gives a receiver up after 1 s, Betaflight after 2.5 s, ArduPilot after 4 s (RECEIVER.md section 6).
constexpr Nanoseconds longest_silence = std::chrono::seconds(2);
// A receiver at 1 Hz must have a chance at each speed.
constexpr Nanoseconds dwell_time = std::chrono::milliseconds(1200);
// PX4 asks for 10 s of good checks (EKF2_REQ_GPS_H) before it uses a receiver; half of it keeps scenarios short.
constexpr Nanoseconds settling_time = std::chrono::seconds(5);
// So many damaged messages within so long are more than a spark.
constexpr std::size_t damages_allowed = 3;
constexpr Nanoseconds damage_memory = std::chrono::seconds(5);
constexpr std::uint64_t loose_bytes_of_damage = 16;

}  // namespace

CarefulClient::CarefulClient(std::string name) : ScriptedClient(std::move(name)), hunt_(usual_speeds(), dwell_time) {}

void CarefulClient::start() {
    health_ = HealthChecks(HealthLimits::made_before(now()));
    hunt();
}

void CarefulClient::hunt() {
    hunt_.start(now());
    forget_timing();
    damages_.clear();
}

void CarefulClient::follow_speed(std::uint32_t speed) {
    hunt_.set_speed(speed);
    set_speed(speed);
    damaged_before_ = skipped_before_ = 0;
    damages_.clear();
}

void CarefulClient::hear(const StreamPiece& piece) {
    if (piece.kind == StreamKind::noise || !shows_speed(piece)) return;
    last_message_ = now();
    if (hunt_.hunting()) {
        hunt_.found();
        damaged_before_ = counts().bad[0] + counts().bad[1];
        skipped_before_ = counts().skipped;
        damages_.clear();
        speed_found();
    }
    hear_message(piece);
}

void CarefulClient::pass_time() {
    if (hunt_.advance(now())) {
        set_speed(hunt_.speed());
        at_new_speed();
    }
    if (hunt_.hunting()) return;
    if (now() - last_message_ > longest_silence) {
        doubt("no message for 2 s");
        hunt();
        return;
    }
    watch_damage();
    watch();
}

void CarefulClient::watch_damage() {
    const std::uint64_t damaged = counts().bad[0] + counts().bad[1];
    const std::uint64_t skipped = counts().skipped;
    if (damaged > damaged_before_ || skipped >= skipped_before_ + loose_bytes_of_damage) {
        damages_.push_back(now());
        damaged_before_ = damaged;
        skipped_before_ = skipped;
    }
    while (!damages_.empty() && now() - damages_.front() > damage_memory)
        damages_.pop_front();
    if (damages_.size() > damages_allowed) doubt(fmt::format("{} damaged messages within 5 s", damages_.size()));
}

void CarefulClient::judge(const HeardSolution& solution) {
    if (auto reason = health_.doubt(solution)) {
        doubt(std::move(*reason));
        return;
    }
    if (damages_.size() > damages_allowed) return;
    if (!sound_since_) sound_since_ = now();
    if (now() - *sound_since_ >= settling_time) believe(true, "all checks passed for 5 s");
}

void CarefulClient::doubt(std::string reason) {
    sound_since_.reset();
    believe(false, std::move(reason));
}

namespace {

constexpr Nanoseconds longest_without_pair = std::chrono::seconds(3);

// Quality 6 is dead reckoning, 7 typed in by hand, 8 simulated, 3 military: none is a fix to fly by.
bool is_good_quality(int quality) { return quality == 1 || quality == 2 || quality == 4 || quality == 5; }

}  // namespace

void CarefulNmeaClient::speed_found() {
    epochs_ = NmeaEpochs();
    parts_ = 0;
    solution_at_ = now();
}

void CarefulNmeaClient::watch() {
    if (now() - solution_at_ > longest_without_pair) doubt("no GGA and RMC of the same time for 3 s");
}

void CarefulNmeaClient::hear_message(const StreamPiece& piece) {
    constexpr unsigned pair = NmeaEpochs::says_gga | NmeaEpochs::says_rmc;
    const NmeaEpochs::Taken taken = epochs_.take(to_string(piece.bytes));
    if (taken.ended) parts_ = 0;
    parts_ |= taken.part & pair;
    if (parts_ != pair) return;
    parts_ = 0;
    combine(*epochs_.epoch());
}

void CarefulNmeaClient::combine(const NmeaEpoch& epoch) {
    const ObservedEpoch& told = epoch.told;
    HeardSolution solution = heard_solution(told, now());
    const bool good = is_good_quality(told.quality.value_or(0));
    const bool valid = told.claims_fix.value_or(false);
    solution.valid = good && valid;
    solution.has_place = solution.has_place && told.type != FixType::none;  // RMC's place is not GGA's
    solution.three_dimensional = epochs_.fix_mode().value_or(3) == 3;
    solution.seconds_wrap = to_seconds(std::chrono::hours(24)).value();
    if (epoch.of_day) solution.seconds = to_seconds(*epoch.of_day).value();
    solution_at_ = now();
    judge(solution);
    if (good != valid) doubt("GGA and RMC disagree on whether there is a fix");
}

namespace {

constexpr Nanoseconds longest_without_solution = std::chrono::seconds(2);
constexpr Nanoseconds longest_without_others = std::chrono::seconds(5);
constexpr Nanoseconds between_configurations = std::chrono::seconds(10);
// Flags of interference come and go (PX4 #21244): one that was seen counts for so long.
constexpr Nanoseconds warning_memory = std::chrono::seconds(5);
constexpr unsigned jamming_critical = 3;    // MON-HW, MON-RF, SEC-SIG; "warning" is too common to count (PX4 #21330)
constexpr unsigned spoofing_indicated = 2;  // NAV-STATUS; 3: by several signs
constexpr std::size_t mon_hw_jamming_byte = 22;

}  // namespace

bool CarefulUbxClient::shows_speed(const StreamPiece& piece) const {
    return piece.kind == StreamKind::ubx || piece.kind == StreamKind::nmea;
}

void CarefulUbxClient::at_new_speed() {
    dialogue_.reset();
    send(encode_frame(MonVer::message_id, {}));
}

void CarefulUbxClient::speed_found() { configure("found"); }

void CarefulUbxClient::configure(const char* reason) {
    doubt(fmt::format("being configured: {}", reason));
    dialogue_.emplace(ubx_configuration());
    heard_at_.clear();
    gps_time_.reset();
    forget_timing();
}

void CarefulUbxClient::watch() {
    if (dialogue_) {
        if (const auto request = dialogue_->advance(now())) send(*request);
        if (const auto speed = dialogue_->take_speed()) follow_speed(*speed);
        if (!dialogue_->failure().empty()) {
            doubt(dialogue_->failure());
            dialogue_.reset();
            hunt();
        } else if (dialogue_->done()) {
            dialogue_.reset();
            configured_at_ = solution_at_ = now();
            forget_timing();
        }
        return;
    }
    watch_messages();
    watch_interference();
}

void CarefulUbxClient::watch_messages() {
    if (now() - solution_at_ > longest_without_solution) {
        configure("solutions have stopped");
        return;
    }
    if (now() - configured_at_ < between_configurations) return;
    for (const auto& [id, at] : heard_at_)
        if (now() - at > longest_without_others) {
            configure("a message has stopped that it was told to send");
            return;
        }
}

void CarefulUbxClient::watch_interference() {
    if (!warned_at_) return;
    if (now() - *warned_at_ > warning_memory)
        warned_at_.reset();
    else
        doubt(warning_);
}

void CarefulUbxClient::hear_message(const StreamPiece& piece) {
    if (piece.kind == StreamKind::nmea) {
        if (!dialogue_ && now() - configured_at_ > std::chrono::seconds(1))
            configure("sentences come that it was told not to send");
        return;
    }
    if (const auto frame = parse_frame(piece.bytes)) hear_frame(*frame);
}

// Before protocol version 14 there is no NAV-PVT: the last one of NAV-POSLLH, NAV-SOL, NAV-VELNED and NAV-TIMEUTC makes
// the solution.
void CarefulUbxClient::hear_epoch(const UbxFrameView& frame) {
    constexpr unsigned old_parts =
        UbxEpochs::says_place | UbxEpochs::says_old_solution | UbxEpochs::says_velocity | UbxEpochs::says_utc;
    const UbxEpochs::Taken taken = epochs_.take(frame);
    if (taken.ended) parts_ = 0;
    parts_ |= taken.part & old_parts;
    const bool whole = (taken.part & UbxEpochs::says_solution) != 0 ||
                       (parts_ == old_parts && !heard_at_.contains(NavPvt::message_id));
    if (!whole) return;
    parts_ = 0;
    hear_solution(*epochs_.epoch());
}

void CarefulUbxClient::hear_frame(const UbxFrameView& frame) {
    const auto& [id, payload] = frame;
    if (dialogue_) dialogue_->hear(id, payload);
    if (id.message_class == NavPvt::message_id.message_class) heard_at_[id] = now();
    if (id == NavTimegps::message_id) hear_time(payload);
    hear_epoch(frame);
    if (id == NavStatus::message_id) hear_status(payload);
    if (id == UbxMessageId{0x0A, 0x09} && payload.size() > mon_hw_jamming_byte)
        hear_warning((payload[mon_hw_jamming_byte] >> 2 & 3u) == jamming_critical, "interference (MON-HW)");
    if (id == MonRf::message_id)
        if (const auto rf = decode_front<MonRf>(payload))
            hear_warning(std::any_of(rf->blocks.begin(), rf->blocks.end(),
                                     [](const MonRfItem& block) { return (block.flags & 3u) == jamming_critical; }),
                         "interference (MON-RF)");
    if (id != SecSig2::message_id) return;
    if (const auto sig = decode_payload<SecSig1>(payload); sig && sig->version == 1)
        hear_warning((sig->jam_flags >> 1 & 3u) == jamming_critical, "interference (SEC-SIG)");
    else if (payload.size() > 1 && payload[0] == 2)
        hear_warning((payload[1] >> 1 & 3u) == jamming_critical, "interference (SEC-SIG)");
}

void CarefulUbxClient::hear_warning(bool critical, const char* what) {
    if (!critical) return;
    warned_at_ = now();
    warning_ = what;
    if (!dialogue_) doubt(warning_);
}

void CarefulUbxClient::hear_status(ByteSpan payload) {
    const auto status = decode_payload<NavStatus>(payload);
    if (status) hear_warning((status->flags2 >> 3 & 3u) >= spoofing_indicated, "spoofing (NAV-STATUS)");
}

void CarefulUbxClient::hear_time(ByteSpan payload) {
    gps_time_.reset();
    const auto time = decode_payload<NavTimegps>(payload);
    if (time && (time->valid & 3u) == 3)
        gps_time_ = GpsTimeHeard{time->i_tow, time->week * 604800.0 + time->i_tow.value()};
}

void CarefulUbxClient::hear_solution(const ObservedEpoch& epoch) {
    solution_at_ = now();
    if (dialogue_) return;
    HeardSolution solution = heard_solution(epoch, now());
    solution.seconds = week_and_tow(epoch.time).tow_seconds();
    solution.counts_gps_weeks = true;
    // NAV-TIMEGPS may come before or after NAV-PVT: the last one is carried on by the time of week that has passed.
    if (gps_time_) {
        const double passed = wrapped_difference(*solution.seconds, gps_time_->i_tow * 1e-3, 604800);
        solution.gps_s = gps_time_->seconds + passed;
    }
    judge(solution);
}

}  // namespace skyloop::inline run
