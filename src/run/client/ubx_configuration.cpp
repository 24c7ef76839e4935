#include "run/client/ubx_configuration.hpp"

#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_hardware.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_security.hpp"
#include "receiver/protocol/ubx_time.hpp"

namespace skyloop {
namespace {

constexpr std::uint32_t client_speed = 115200;  // what PX4 sets
constexpr std::uint8_t uart1 = 1;
constexpr std::uint32_t frame_8n1 = 0x8D0;  // CFG-PRT mode, as PX4 sends it
constexpr std::uint16_t in_ubx_nmea_rtcm3 = 0x23;
constexpr std::uint16_t out_ubx = 0x01;
constexpr std::uint8_t airborne_4g = 8;
constexpr std::uint8_t fix_3d_only = 2;
constexpr std::uint16_t model_and_fix_mode = 0x0005;

template <class Message>
DialogueStep setting(const Message& message) {
    return {Message::message_id, encode_frame(message)};
}

DialogueStep message_on(UbxMessageId id, std::uint8_t every) {
    return setting(CfgMsgCurrentPort{id.message_class, id.id, every});
}

DialogueStep poll(UbxMessageId id, Bytes payload = {}) {
    DialogueStep step{id, encode_frame(id, payload)};
    step.answer = id;
    return step;
}

DialogueStep port_setting() {
    CfgPrtItem port;
    port.port_id = uart1;
    port.mode = frame_8n1;
    port.baud_rate = client_speed;
    port.in_proto_mask = in_ubx_nmea_rtcm3;
    port.out_proto_mask = out_ubx;
    DialogueStep step = setting(CfgPrt{{port}});
    step.next_speed = client_speed;
    return step;
}

DialogueStep rate_read_back() {
    DialogueStep step = poll(CfgRate::message_id);
    step.accept = [](ByteSpan payload) {
        const auto rate = decode_payload<CfgRate>(payload);
        return rate && rate->meas_rate == ubx_client_period_ms;
    };
    return step;
}

DialogueStep message_read_back(UbxMessageId id) {
    DialogueStep step = poll(CfgMsg::message_id, {id.message_class, id.id});
    step.accept = [id](ByteSpan payload) {
        const auto message = decode_payload<CfgMsg>(payload);
        return message && UbxMessageId{message->message_class, message->id} == id && message->rates[uart1] == 1;
    };
    return step;
}

DialogueStep solution_on() {
    DialogueStep old = message_on(NavSol::message_id, 1);
    old.needed = true;
    DialogueStep step = message_on(NavPvt::message_id, 1);
    step.otherwise = {old, message_on(NavPosllh::message_id, 1), message_on(NavVelned::message_id, 1),
                      message_on(NavTimeutc::message_id, 1), message_read_back(NavSol::message_id)};
    return step;
}

}  // namespace

std::vector<DialogueStep> ubx_configuration() {
    DialogueStep version = poll(MonVer::message_id);
    version.acknowledged = false;
    DialogueStep model = setting([] {
        CfgNav5 nav5;
        nav5.mask = model_and_fix_mode;
        nav5.dyn_model = airborne_4g;
        nav5.fix_mode = fix_3d_only;
        return nav5;
    }());
    return {version,
            port_setting(),
            setting(CfgRate{ubx_client_period_ms, 1, 1}),
            model,
            solution_on(),
            message_on(NavStatus::message_id, 1),
            message_on(NavTimegps::message_id, 1),
            message_on({0x0A, 0x09}, 5),  // MON-HW, of M8
            message_on(MonRf::message_id, 5),
            message_on(SecSig2::message_id, 5),
            rate_read_back(),
            message_read_back(NavPvt::message_id)};
}

}  // namespace skyloop
