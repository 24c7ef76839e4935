#include "run/client/ubx_solution.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_hardware.hpp"
#include "receiver/protocol/ubx_mon.hpp"
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
constexpr std::uint8_t resolved = 0x07;  // NAV-PVT valid bits 0 to 2

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

// As near as the type comes.
template <class Number>
Number millimetres(Number centimetres) {
    const auto whole = std::int64_t{10} * centimetres;
    return static_cast<Number>(
        std::clamp<std::int64_t>(whole, std::numeric_limits<Number>::min(), std::numeric_limits<Number>::max()));
}

std::optional<double> utc_seconds(const NavPvt& pvt) {
    const auto day = std::chrono::year(pvt.year) / std::chrono::month(pvt.month) / std::chrono::day(pvt.day);
    if (!day.ok()) return std::nullopt;
    const auto midnight = std::chrono::sys_days(day).time_since_epoch();
    return static_cast<double>(std::chrono::duration_cast<std::chrono::seconds>(midnight).count()) + pvt.hour * 3600.0 +
           pvt.minute * 60.0 + pvt.second + pvt.nano * 1e-9;
}

}  // namespace

HeardSolution heard_solution(const NavPvt& pvt) {
    HeardSolution s;
    s.valid = (pvt.flags & 1) != 0 && pvt.fix_type >= 2 && pvt.fix_type <= 4;
    s.has_place = (pvt.flags3 & 1) == 0;
    s.three_dimensional = pvt.fix_type == 3 || pvt.fix_type == 4;
    s.satellites = pvt.num_sv;
    s.latitude_deg = pvt.lat * 1e-7;
    s.longitude_deg = pvt.lon * 1e-7;
    s.height_m = pvt.height * 1e-3;
    s.horizontal_accuracy_m = pvt.h_acc * 1e-3;
    s.vertical_accuracy_m = pvt.v_acc * 1e-3;
    s.speed_accuracy_mps = pvt.s_acc * 1e-3;
    s.velocity_mps = {pvt.vel_n * 1e-3, pvt.vel_e * 1e-3, pvt.vel_d * 1e-3};
    s.has_vertical_velocity = true;
    s.seconds = pvt.i_tow * 1e-3;
    s.counts_gps_weeks = true;
    if ((pvt.valid & resolved) == resolved) s.utc_s = utc_seconds(pvt);
    return s;
}

NavPvt& SolutionParts::of_epoch(std::uint32_t i_tow) {
    if (heard_.empty() || whole_.i_tow != i_tow) {
        whole_ = {};
        heard_.clear();
    }
    whole_.i_tow = i_tow;
    return whole_;
}

void SolutionParts::add(const NavPosllh& position) {
    NavPvt& whole = of_epoch(position.i_tow);
    whole.lon = position.lon;
    whole.lat = position.lat;
    whole.height = position.height;
    whole.h_msl = position.h_msl;
    whole.h_acc = position.h_acc;
    whole.v_acc = position.v_acc;
}

void SolutionParts::add(const NavSol& solution) {
    NavPvt& whole = of_epoch(solution.i_tow);
    whole.fix_type = solution.gps_fix;
    whole.flags = solution.flags & 1;
    whole.num_sv = solution.num_sv;
    whole.p_dop = solution.p_dop;
}

void SolutionParts::add(const NavVelned& velocity) {
    NavPvt& whole = of_epoch(velocity.i_tow);
    whole.vel_n = millimetres(velocity.vel_n);
    whole.vel_e = millimetres(velocity.vel_e);
    whole.vel_d = millimetres(velocity.vel_d);
    whole.s_acc = millimetres(velocity.s_acc);
}

void SolutionParts::add(const NavTimeutc& time) {
    NavPvt& whole = of_epoch(time.i_tow);
    whole.year = time.year;
    whole.month = time.month;
    whole.day = time.day;
    whole.hour = time.hour;
    whole.minute = time.minute;
    whole.second = time.second;
    whole.nano = time.nano;
    whole.valid = (time.valid & resolved) == resolved ? resolved : 0;
}

template <class Message>
bool SolutionParts::take(UbxMessageId id, ByteSpan payload) {
    if (id != Message::message_id) return false;
    const auto message = decode_payload<Message>(payload);
    if (message) add(*message);
    return message.has_value();
}

std::optional<NavPvt> SolutionParts::hear(UbxMessageId id, ByteSpan payload) {
    if (!take<NavPosllh>(id, payload) && !take<NavSol>(id, payload) && !take<NavVelned>(id, payload) &&
        !take<NavTimeutc>(id, payload))
        return std::nullopt;
    heard_.insert(id);
    constexpr std::size_t parts = 4;
    if (heard_.size() < parts) return std::nullopt;
    heard_.clear();
    return whole_;
}

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
