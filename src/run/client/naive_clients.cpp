#include "run/client/naive_clients.hpp"

#include "receiver/protocol/nmea_decode.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"

namespace skyloop {

namespace {

constexpr Nanoseconds start_up_time = std::chrono::milliseconds(100);  // from its power to its first message

}  // namespace

void NaiveUbxClient::pass_time() {
    if (asked_ || now() - begun_at_ < start_up_time) return;
    asked_ = true;
    send(encode_frame(MonVer::message_id, {}));
}

void NaiveUbxClient::hear(const StreamPiece& piece) {
    const auto frame = piece.kind == StreamKind::ubx ? parse_frame(piece.bytes) : std::nullopt;
    if (!frame) return;
    if (!identified_ && frame->id == MonVer::message_id) {
        identified_ = true;
        send(encode_frame(CfgMsgCurrentPort{NavPvt::message_id.message_class, NavPvt::message_id.id, 1}));
    }
    if (!identified_ || frame->id != NavPvt::message_id) return;
    const auto pvt = decode_payload<NavPvt>(frame->payload);
    if (!pvt) return;
    const bool has_fix = pvt->fix_type >= 2 && pvt->fix_type <= 4;
    believe(has_fix, has_fix ? "there is a fix" : "there is no fix");
}

void NaiveNmeaClient::hear(const StreamPiece& piece) {
    if (piece.kind != StreamKind::nmea) return;
    const auto message = decode_nmea(to_string(piece.bytes));
    if (!message) return;
    if (const auto* gga = std::get_if<Gga>(&*message))
        believe(gga->position.has_value(), gga->position ? "there is a position" : "there is no position");
}

}  // namespace skyloop
