#include "firmware/ublox/assistance.hpp"

#include <algorithm>
#include <array>

namespace skyloop::firmware {
namespace {

constexpr std::uint8_t mga_gps = 0x00, mga_gal = 0x02, mga_bds = 0x03, mga_qzss = 0x05, mga_glo = 0x06, mga_ano = 0x20,
                       mga_flash = 0x21, mga_ini = 0x40, mga_dbd = 0x80;
constexpr std::uint8_t mga_ini_time_utc = 0x10, mga_ini_time_gnss = 0x11;

// One message of a fixed length: its id, and the type that its payload begins with.
struct AssistanceMessage {
    std::uint8_t id, type;
    std::size_t bytes;  ///< of payload
    bool needs_time = false;
};

// u-blox M8 interface description, 32.16; of generation 9 and 10 they are the same.
constexpr std::array assistance_messages{
    AssistanceMessage{mga_gps, 0x01, 68, true},   // EPH
    AssistanceMessage{mga_gps, 0x02, 36, true},   // ALM
    AssistanceMessage{mga_gps, 0x04, 40},         // HEALTH
    AssistanceMessage{mga_gps, 0x05, 20},         // UTC
    AssistanceMessage{mga_gps, 0x06, 16},         // IONO
    AssistanceMessage{mga_gal, 0x01, 76, true},   // EPH
    AssistanceMessage{mga_gal, 0x02, 32, true},   // ALM
    AssistanceMessage{mga_gal, 0x03, 12},         // TIMEOFFSET
    AssistanceMessage{mga_gal, 0x05, 20},         // UTC
    AssistanceMessage{mga_bds, 0x01, 88, true},   // EPH
    AssistanceMessage{mga_bds, 0x02, 40, true},   // ALM
    AssistanceMessage{mga_bds, 0x04, 68},         // HEALTH
    AssistanceMessage{mga_bds, 0x05, 20},         // UTC
    AssistanceMessage{mga_bds, 0x06, 16},         // IONO
    AssistanceMessage{mga_qzss, 0x01, 68, true},  // EPH
    AssistanceMessage{mga_qzss, 0x02, 36, true},  // ALM
    AssistanceMessage{mga_qzss, 0x04, 12},        // HEALTH
    AssistanceMessage{mga_glo, 0x01, 48, true},   // EPH
    AssistanceMessage{mga_glo, 0x02, 36, true},   // ALM
    AssistanceMessage{mga_glo, 0x03, 20},         // TIMEOFFSET
    AssistanceMessage{mga_ano, 0x00, 76, true},   // AssistNow Offline
    AssistanceMessage{mga_ini, 0x00, 20},         // POS_XYZ
    AssistanceMessage{mga_ini, 0x01, 20},         // POS_LLH
    AssistanceMessage{mga_ini, mga_ini_time_utc, 24},
    AssistanceMessage{mga_ini, mga_ini_time_gnss, 24},
    AssistanceMessage{mga_ini, 0x20, 12},  // CLKD
    AssistanceMessage{mga_ini, 0x21, 12},  // FREQ
    AssistanceMessage{mga_ini, 0x30, 72},  // EOP
};

// The navigation database as the receiver gave it out, opaque but for its length; empty: a poll.
AssistanceInfo judge_database(ByteSpan payload) {
    constexpr std::size_t head = 12;
    return payload.empty() || payload.size() >= head ? AssistanceInfo::accepted : AssistanceInfo::wrong_size;
}

}  // namespace

AssistanceInfo judge_assistance(const UbxFrameView& frame, bool time_known) {
    const std::uint8_t id = frame.id.id;
    if (id == mga_dbd) return judge_database(frame.payload);
    if (id == mga_flash) return AssistanceInfo::accepted;  // has an acknowledgement of its own
    const auto of_id = [id](const AssistanceMessage& m) { return m.id == id; };
    if (std::none_of(assistance_messages.begin(), assistance_messages.end(), of_id))
        return AssistanceInfo::unknown_type;
    if (frame.payload.size() < 2) return AssistanceInfo::wrong_size;  // no room for type and version
    const std::uint8_t type = frame.payload[0], version = frame.payload[1];
    const auto message = std::find_if(assistance_messages.begin(), assistance_messages.end(),
                                      [&](const AssistanceMessage& m) { return m.id == id && m.type == type; });
    if (message == assistance_messages.end()) return AssistanceInfo::unknown_type;
    if (version != 0) return AssistanceInfo::other_version;
    if (frame.payload.size() != message->bytes) return AssistanceInfo::wrong_size;
    return message->needs_time && !time_known ? AssistanceInfo::time_unknown : AssistanceInfo::accepted;
}

bool tells_time(const UbxFrameView& frame) {
    return frame.id.id == mga_ini && !frame.payload.empty() &&
           (frame.payload[0] == mga_ini_time_utc || frame.payload[0] == mga_ini_time_gnss);
}

}  // namespace skyloop::firmware
