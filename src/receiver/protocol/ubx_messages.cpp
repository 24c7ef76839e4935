#include "receiver/protocol/ubx_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "receiver/protocol/field_lister.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_cfg_device.hpp"
#include "receiver/protocol/ubx_cfg_navigation.hpp"
#include "receiver/protocol/ubx_hardware.hpp"
#include "receiver/protocol/ubx_inertial.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_raw.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "receiver/protocol/ubx_services.hpp"
#include "receiver/protocol/ubx_time.hpp"

namespace skyloop::inline receiver {
namespace {

using ListedFields = std::optional<std::vector<DecodedField>>;

template <class Layout>
ListedFields list_layout(ByteSpan payload) {
    if constexpr (requires { Layout::layout_version; })
        if (payload[0] != Layout::layout_version) return std::nullopt;
    const auto message = decode_payload<Layout>(payload);
    if (!message) return std::nullopt;
    FieldLister lister;
    walk_fields(*message, lister);
    return lister.take();
}

template <class... Layout>
ListedFields list_layouts(ByteSpan payload) {
    ListedFields fields;
    static_cast<void>(((fields = list_layout<Layout>(payload)).has_value() || ...));
    return fields;
}

// A message with its layouts, the first that fits holds.
template <class First, class... Other>
constexpr UbxMessage with(std::string_view name) {
    static_assert(((Other::message_id == First::message_id) && ...));
    return {First::message_id, name, list_layouts<First, Other...>};
}

// One row a message, for both directions; searched by halves, so ascending.
constexpr auto known_messages = std::to_array<UbxMessage>({
    with<NavPosecef>("NAV-POSECEF"),
    with<NavPosllh>("NAV-POSLLH"),
    with<NavStatus>("NAV-STATUS"),
    with<NavDop>("NAV-DOP"),
    with<NavAtt>("NAV-ATT"),
    with<NavSol>("NAV-SOL"),
    with<NavPvt>("NAV-PVT"),
    with<NavOdo>("NAV-ODO"),
    {{0x01, 0x10}, "NAV-RESETODO"},
    with<NavVelecef>("NAV-VELECEF"),
    with<NavVelned>("NAV-VELNED"),
    with<NavHpposecef>("NAV-HPPOSECEF"),
    with<NavHpposllh>("NAV-HPPOSLLH"),
    with<NavPvat>("NAV-PVAT"),
    with<NavTimegps>("NAV-TIMEGPS"),
    with<NavTimeutc>("NAV-TIMEUTC"),
    with<NavClock>("NAV-CLOCK"),
    with<NavTimeglo>("NAV-TIMEGLO"),
    with<NavTimebds>("NAV-TIMEBDS"),
    with<NavTimegal>("NAV-TIMEGAL"),
    with<NavTimels>("NAV-TIMELS"),
    with<NavTimeqzss>("NAV-TIMEQZSS"),
    {{0x01, 0x28}, "NAV-NMI"},
    with<NavSvinfo>("NAV-SVINFO"),
    with<NavDgps>("NAV-DGPS"),
    with<NavSbas>("NAV-SBAS"),
    with<NavOrb>("NAV-ORB"),
    with<NavSat>("NAV-SAT"),
    with<NavCov>("NAV-COV"),
    with<NavGeofence>("NAV-GEOFENCE"),
    with<NavSvin>("NAV-SVIN"),
    with<NavRelposned, NavRelposned0>("NAV-RELPOSNED"),
    with<NavEell>("NAV-EELL"),
    {{0x01, 0x40}, "NAV-EKFSTATUS"},
    with<NavSlas>("NAV-SLAS"),
    with<NavSig>("NAV-SIG"),
    with<NavAopstatus>("NAV-AOPSTATUS"),
    with<NavEoe>("NAV-EOE"),
    with<NavPl>("NAV-PL"),
    {{0x01, 0x64}, "NAV-TIMETRUSTED"},
    {{0x02, 0x10}, "RXM-RAW"},
    {{0x02, 0x11}, "RXM-SFRB"},
    with<RxmSfrbx>("RXM-SFRBX"),
    with<RxmMeasx>("RXM-MEASX"),
    with<RxmRawx>("RXM-RAWX"),
    with<RxmSvsi>("RXM-SVSI"),
    {{0x02, 0x30}, "RXM-ALM"},
    {{0x02, 0x31}, "RXM-EPH"},
    with<RxmRtcm>("RXM-RTCM"),
    {{0x02, 0x33}, "RXM-SPARTN"},
    with<RxmCor>("RXM-COR"),
    {{0x02, 0x36}, "RXM-SPARTNKEY"},
    with<RxmPmreqShort, RxmPmreq>("RXM-PMREQ"),
    with<RxmRlm>("RXM-RLM"),
    {{0x02, 0x61}, "RXM-IMES"},
    {{0x02, 0x72}, "RXM-PMP"},
    {{0x02, 0x73}, "RXM-QZSSL6"},
    {{0x02, 0x80}, "RXM-MEASC12"},
    {{0x02, 0x82}, "RXM-MEASD12"},
    {{0x02, 0x84}, "RXM-MEAS20"},
    {{0x02, 0x86}, "RXM-MEAS50"},
    with<InfError>("INF-ERROR"),
    with<InfWarning>("INF-WARNING"),
    with<InfNotice>("INF-NOTICE"),
    with<InfTest>("INF-TEST"),
    with<InfDebug>("INF-DEBUG"),
    with<AckNak>("ACK-NAK"),
    with<AckAck>("ACK-ACK"),
    with<CfgPrtPoll, CfgPrt>("CFG-PRT"),
    with<CfgMsgPoll, CfgMsgCurrentPort, CfgMsg>("CFG-MSG"),
    with<CfgInf>("CFG-INF"),
    with<CfgRst>("CFG-RST"),
    with<CfgDat, CfgDatSet>("CFG-DAT"),
    with<CfgRate>("CFG-RATE"),
    with<CfgCfg>("CFG-CFG"),
    with<CfgRxm>("CFG-RXM"),
    with<CfgAnt>("CFG-ANT"),
    with<CfgSbas>("CFG-SBAS"),
    with<CfgNmeaShort, CfgNmeaV0, CfgNmea>("CFG-NMEA"),
    with<CfgUsb>("CFG-USB"),
    with<CfgOdo>("CFG-ODO"),
    with<CfgNavx5>("CFG-NAVX5"),
    with<CfgNav5>("CFG-NAV5"),
    with<CfgTp5>("CFG-TP5"),
    {{0x06, 0x34}, "CFG-RINV"},
    with<CfgItfm>("CFG-ITFM"),
    with<CfgPm2>("CFG-PM2"),
    {{0x06, 0x3D}, "CFG-TMODE2"},
    with<CfgGnss>("CFG-GNSS"),
    with<CfgLogfilter>("CFG-LOGFILTER"),
    {{0x06, 0x53}, "CFG-TXSLOT"},
    {{0x06, 0x56}, "CFG-ESFALG"},
    with<CfgPwr>("CFG-PWR"),
    {{0x06, 0x5C}, "CFG-HNR"},
    {{0x06, 0x60}, "CFG-ESRC"},
    {{0x06, 0x61}, "CFG-DOSC"},
    {{0x06, 0x62}, "CFG-SMGR"},
    {{0x06, 0x64}, "CFG-SPT"},
    with<CfgGeofence>("CFG-GEOFENCE"),
    with<CfgDgnss>("CFG-DGNSS"),
    with<CfgTmode3>("CFG-TMODE3"),
    {{0x06, 0x82}, "CFG-ESFWT"},
    {{0x06, 0x84}, "CFG-FIXSEED"},
    {{0x06, 0x85}, "CFG-DYNSEED"},
    with<CfgPms>("CFG-PMS"),
    {{0x06, 0x88}, "CFG-SENIF"},
    with<CfgValset>("CFG-VALSET"),
    with<CfgValgetPoll, CfgValget>("CFG-VALGET"),
    with<CfgValdel>("CFG-VALDEL"),
    {{0x06, 0x8D}, "CFG-SLAS"},
    {{0x06, 0x93}, "CFG-BATCH"},
    with<UpdSos, UpdSosStatus>("UPD-SOS"),
    with<MonIo>("MON-IO"),
    with<MonVer>("MON-VER"),
    with<MonMsgpp>("MON-MSGPP"),
    with<MonRxbuf>("MON-RXBUF"),
    with<MonTxbuf>("MON-TXBUF"),
    with<MonHw, MonHwLong, MonHwShort>("MON-HW"),
    with<MonHw2>("MON-HW2"),
    with<MonRxr>("MON-RXR"),
    with<MonPatch>("MON-PATCH"),
    with<MonGnss>("MON-GNSS"),
    {{0x0A, 0x2E}, "MON-SMGR"},
    {{0x0A, 0x2F}, "MON-SPT"},
    with<MonSpan>("MON-SPAN"),
    {{0x0A, 0x32}, "MON-BATCH"},
    {{0x0A, 0x35}, "MON-PMP"},
    with<MonComms>("MON-COMMS"),
    with<MonHw3>("MON-HW3"),
    with<MonRf>("MON-RF"),
    with<MonSys>("MON-SYS"),
    {{0x0B, 0x00}, "AID-REQ"},
    {{0x0B, 0x01}, "AID-INI"},
    {{0x0B, 0x02}, "AID-HUI"},
    {{0x0B, 0x10}, "AID-DATA"},
    {{0x0B, 0x30}, "AID-ALM"},
    {{0x0B, 0x31}, "AID-EPH"},
    {{0x0B, 0x32}, "AID-ALPSRV"},
    {{0x0B, 0x33}, "AID-AOP"},
    {{0x0B, 0x50}, "AID-ALP"},
    with<TimTp>("TIM-TP"),
    with<TimTm2>("TIM-TM2"),
    {{0x0D, 0x04}, "TIM-SVIN"},
    with<TimVrfy>("TIM-VRFY"),
    {{0x0D, 0x11}, "TIM-DOSC"},
    {{0x0D, 0x12}, "TIM-TOS"},
    {{0x0D, 0x13}, "TIM-SMEAS"},
    {{0x0D, 0x15}, "TIM-VCOCAL"},
    {{0x0D, 0x16}, "TIM-FCHG"},
    {{0x0D, 0x17}, "TIM-HOC"},
    {{0x10, 0x02}, "ESF-MEAS"},
    {{0x10, 0x03}, "ESF-RAW"},
    with<EsfStatus>("ESF-STATUS"),
    {{0x10, 0x13}, "ESF-RESETALG"},
    {{0x10, 0x14}, "ESF-ALG"},
    {{0x10, 0x15}, "ESF-INS"},
    {{0x13, 0x00}, "MGA-GPS"},
    {{0x13, 0x02}, "MGA-GAL"},
    {{0x13, 0x03}, "MGA-BDS"},
    {{0x13, 0x05}, "MGA-QZSS"},
    {{0x13, 0x06}, "MGA-GLO"},
    {{0x13, 0x10}, "MGA-SF"},
    {{0x13, 0x20}, "MGA-ANO"},
    {{0x13, 0x21}, "MGA-FLASH"},
    {{0x13, 0x40}, "MGA-INI"},
    with<MgaAck>("MGA-ACK"),
    {{0x13, 0x80}, "MGA-DBD"},
    {{0x21, 0x03}, "LOG-ERASE"},
    {{0x21, 0x04}, "LOG-STRING"},
    {{0x21, 0x07}, "LOG-CREATE"},
    {{0x21, 0x08}, "LOG-INFO"},
    {{0x21, 0x09}, "LOG-RETRIEVE"},
    {{0x21, 0x0B}, "LOG-RETRIEVEPOS"},
    {{0x21, 0x0D}, "LOG-RETRIEVESTRING"},
    {{0x21, 0x0E}, "LOG-FINDTIME"},
    {{0x21, 0x0F}, "LOG-RETRIEVEPOSEXTRA"},
    {{0x21, 0x10}, "LOG-RETRIEVEBATCH"},
    {{0x21, 0x11}, "LOG-BATCH"},
    {{0x27, 0x01}, "SEC-SIGN"},
    with<SecUniqid>("SEC-UNIQID"),
    with<SecSig1, SecSig2>("SEC-SIG"),
    {{0x27, 0x0A}, "SEC-OSNMA"},
    with<SecSiglog>("SEC-SIGLOG"),
    with<HnrPvt>("HNR-PVT"),
    with<HnrAtt>("HNR-ATT"),
    with<HnrIns>("HNR-INS"),
    {{0xF0, 0x00}, "GGA"},
    {{0xF0, 0x01}, "GLL"},
    {{0xF0, 0x02}, "GSA"},
    {{0xF0, 0x03}, "GSV"},
    {{0xF0, 0x04}, "RMC"},
    {{0xF0, 0x05}, "VTG"},
    {{0xF0, 0x06}, "GRS"},
    {{0xF0, 0x07}, "GST"},
    {{0xF0, 0x08}, "ZDA"},
    {{0xF0, 0x09}, "GBS"},
    {{0xF0, 0x0A}, "DTM"},
    {{0xF0, 0x0B}, "RLM"},
    {{0xF0, 0x0D}, "GNS"},
    {{0xF0, 0x0E}, "THS"},
    {{0xF0, 0x0F}, "VLW"},
    {{0xF0, 0x30}, "HDT"},
    {{0xF0, 0x31}, "HDG"},
    {{0xF0, 0x32}, "ROT"},
    {{0xF0, 0x40}, "GPQ"},
    {{0xF0, 0x41}, "TXT"},
    {{0xF0, 0x42}, "GNQ"},
    {{0xF0, 0x43}, "GLQ"},
    {{0xF0, 0x44}, "GBQ"},
    {{0xF0, 0x45}, "GAQ"},
    {{0xF0, 0x47}, "GQQ"},
    {{0xF1, 0x00}, "PUBX-00"},
    {{0xF1, 0x03}, "PUBX-03"},
    {{0xF1, 0x04}, "PUBX-04"},
    {{0xF1, 0x40}, "PUBX-40"},
    {{0xF1, 0x41}, "PUBX-41"},
    {{0xF5, 0x05}, "RTCM-1005"},
    {{0xF5, 0x06}, "RTCM-1006"},
    {{0xF5, 0x4A}, "RTCM-1074"},
    {{0xF5, 0x4D}, "RTCM-1077"},
    {{0xF5, 0x54}, "RTCM-1084"},
    {{0xF5, 0x57}, "RTCM-1087"},
    {{0xF5, 0x5E}, "RTCM-1094"},
    {{0xF5, 0x61}, "RTCM-1097"},
    {{0xF5, 0x7C}, "RTCM-1124"},
    {{0xF5, 0x7F}, "RTCM-1127"},
    {{0xF5, 0xE6}, "RTCM-1230"},
    {{0xF5, 0xFD}, "RTCM-4072.1"},
    {{0xF5, 0xFE}, "RTCM-4072.0"},
});

static_assert(std::ranges::is_sorted(known_messages, {}, &UbxMessage::id));

const UbxMessage* find_message(UbxMessageId id) {
    const auto* found = std::ranges::lower_bound(known_messages, id, {}, &UbxMessage::id);
    return found == known_messages.end() || found->id != id ? nullptr : found;
}

}  // namespace

std::span<const UbxMessage> ubx_messages() { return known_messages; }

std::optional<std::string_view> ubx_message_name(UbxMessageId id) {
    const UbxMessage* message = find_message(id);
    return message == nullptr ? std::nullopt : std::optional(message->name);
}

std::optional<UbxMessageId> ubx_message_from_name(std::string_view name) {
    for (const UbxMessage& message : known_messages)
        if (message.name == name) return message.id;
    return std::nullopt;
}

std::string to_string(UbxMessageId id) {
    if (const auto name = ubx_message_name(id)) return std::string(*name);
    return fmt::format("{:02X}-{:02X}", id.message_class, id.id);
}

void list_ubx(const UbxFrameView& frame, DecodedMessage& message) {
    message.id = fmt::format("{:02X}-{:02X}", frame.id.message_class, frame.id.id);
    const UbxMessage* known = find_message(frame.id);
    if (known != nullptr) message.name = known->name;
    if (frame.payload.empty()) {
        message.fields.push_back({"poll", {std::uint64_t{1}}});
        return;
    }
    if (known != nullptr && known->list != nullptr) {
        if (auto fields = known->list(frame.payload)) {
            message.fields = std::move(*fields);
            return;
        }
    }
    message.payload.assign(frame.payload.begin(), frame.payload.end());
}

}  // namespace skyloop::inline receiver
