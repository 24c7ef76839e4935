#include "run/client/careful_ubx_client.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "receiver/protocol/ubx_hardware.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_security.hpp"
#include "receiver/protocol/ubx_time.hpp"
#include "run/client/ubx_configuration.hpp"

namespace skyloop {
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
        gps_time_ = GpsTimeHeard{time->i_tow, time->week * 604800.0 + time->i_tow * 1e-3};
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

}  // namespace skyloop
