// Configuration keys by id and by name. The keys of the rates of periodic messages are those of CFG-MSGOUT (u-blox F9
// interface description HPG 1.32, section 6.9); keys of the group FE are our own: no interface description has one for
// these.
#include "firmware/ublox/config/config_keys.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <string>
#include <vector>

namespace skyloop::firmware {
namespace {

constexpr RateKeys rate_key_list[] = {
    {{{0x01, 0x01}, "NAV-POSECEF", 0x20910024}, "UBX_NAV_POSECEF"},
    {{{0x01, 0x02}, "NAV-POSLLH", 0x20910029}, "UBX_NAV_POSLLH"},
    {{{0x01, 0x03}, "NAV-STATUS", 0x2091001A}, "UBX_NAV_STATUS"},
    {{{0x01, 0x04}, "NAV-DOP", 0x20910038}, "UBX_NAV_DOP"},
    {{{0x01, 0x06}, "NAV-SOL", 0x20FE0010}, "UBX_NAV_SOL"},
    {{{0x01, 0x07}, "NAV-PVT", 0x20910006}, "UBX_NAV_PVT"},
    {{{0x01, 0x09}, "NAV-ODO", 0x2091007E}, "UBX_NAV_ODO"},
    {{{0x01, 0x11}, "NAV-VELECEF", 0x2091003D}, "UBX_NAV_VELECEF"},
    {{{0x01, 0x12}, "NAV-VELNED", 0x20910042}, "UBX_NAV_VELNED"},
    {{{0x01, 0x13}, "NAV-HPPOSECEF", 0x2091002E}, "UBX_NAV_HPPOSECEF"},
    {{{0x01, 0x14}, "NAV-HPPOSLLH", 0x20910033}, "UBX_NAV_HPPOSLLH"},
    {{{0x01, 0x20}, "NAV-TIMEGPS", 0x20910047}, "UBX_NAV_TIMEGPS"},
    {{{0x01, 0x21}, "NAV-TIMEUTC", 0x2091005B}, "UBX_NAV_TIMEUTC"},
    {{{0x01, 0x22}, "NAV-CLOCK", 0x20910065}, "UBX_NAV_CLOCK"},
    {{{0x01, 0x23}, "NAV-TIMEGLO", 0x2091004C}, "UBX_NAV_TIMEGLO"},
    {{{0x01, 0x24}, "NAV-TIMEBDS", 0x20910051}, "UBX_NAV_TIMEBDS"},
    {{{0x01, 0x25}, "NAV-TIMEGAL", 0x20910056}, "UBX_NAV_TIMEGAL"},
    {{{0x01, 0x26}, "NAV-TIMELS", 0x20910060}, "UBX_NAV_TIMELS"},
    {{{0x01, 0x27}, "NAV-TIMEQZSS", 0x20910386}, "UBX_NAV_TIMEQZSS"},
    {{{0x01, 0x30}, "NAV-SVINFO", 0x20FE0015}, "UBX_NAV_SVINFO"},
    {{{0x01, 0x31}, "NAV-DGPS", 0x20FE001A}, "UBX_NAV_DGPS"},
    {{{0x01, 0x32}, "NAV-SBAS", 0x2091006A}, "UBX_NAV_SBAS"},
    {{{0x01, 0x34}, "NAV-ORB", 0x20910010}, "UBX_NAV_ORB"},
    {{{0x01, 0x35}, "NAV-SAT", 0x20910015}, "UBX_NAV_SAT"},
    {{{0x01, 0x36}, "NAV-COV", 0x20910083}, "UBX_NAV_COV"},
    {{{0x01, 0x39}, "NAV-GEOFENCE", 0x209100A1}, "UBX_NAV_GEOFENCE"},
    {{{0x01, 0x3B}, "NAV-SVIN", 0x20910088}, "UBX_NAV_SVIN"},
    {{{0x01, 0x3C}, "NAV-RELPOSNED", 0x2091008D}, "UBX_NAV_RELPOSNED"},
    {{{0x01, 0x42}, "NAV-SLAS", 0x20910336}, "UBX_NAV_SLAS"},
    {{{0x01, 0x43}, "NAV-SIG", 0x20910345}, "UBX_NAV_SIG"},
    {{{0x01, 0x60}, "NAV-AOPSTATUS", 0x20910079}, "UBX_NAV_AOPSTATUS"},
    {{{0x01, 0x61}, "NAV-EOE", 0x2091015F}, "UBX_NAV_EOE"},
    {{{0x01, 0x62}, "NAV-PL", 0x20910415}, "UBX_NAV_PL"},
    {{{0x02, 0x10}, "RXM-RAW", 0x20FE0029}, "UBX_RXM_RAW"},
    {{{0x02, 0x11}, "RXM-SFRB", 0x20FE002E}, "UBX_RXM_SFRB"},
    {{{0x02, 0x13}, "RXM-SFRBX", 0x20910231}, "UBX_RXM_SFRBX"},
    {{{0x02, 0x14}, "RXM-MEASX", 0x20910204}, "UBX_RXM_MEASX"},
    {{{0x02, 0x15}, "RXM-RAWX", 0x209102A4}, "UBX_RXM_RAWX"},
    {{{0x02, 0x20}, "RXM-SVSI", 0x20FE001F}, "UBX_RXM_SVSI"},
    {{{0x02, 0x32}, "RXM-RTCM", 0x20910268}, "UBX_RXM_RTCM"},
    {{{0x02, 0x33}, "RXM-SPARTN", 0x20910605}, "UBX_RXM_SPARTN"},
    {{{0x02, 0x34}, "RXM-COR", 0x209106B6}, "UBX_RXM_COR"},
    {{{0x02, 0x59}, "RXM-RLM", 0x2091025E}, "UBX_RXM_RLM"},
    {{{0x02, 0x61}, "RXM-IMES", 0x20FE0024}, "UBX_RXM_IMES"},
    {{{0x02, 0x72}, "RXM-PMP", 0x2091031D}, "UBX_RXM_PMP"},
    {{{0x0A, 0x02}, "MON-IO", 0x209101A5}, "UBX_MON_IO"},
    {{{0x0A, 0x06}, "MON-MSGPP", 0x20910196}, "UBX_MON_MSGPP"},
    {{{0x0A, 0x07}, "MON-RXBUF", 0x209101A0}, "UBX_MON_RXBUF"},
    {{{0x0A, 0x08}, "MON-TXBUF", 0x2091019B}, "UBX_MON_TXBUF"},
    {{{0x0A, 0x09}, "MON-HW", 0x209101B4}, "UBX_MON_HW"},
    {{{0x0A, 0x0B}, "MON-HW2", 0x209101B9}, "UBX_MON_HW2"},
    {{{0x0A, 0x21}, "MON-RXR", 0x20910187}, "UBX_MON_RXR"},
    {{{0x0A, 0x2E}, "MON-SMGR", 0x20FE0033}, "UBX_MON_SMGR"},
    {{{0x0A, 0x31}, "MON-SPAN", 0x2091038B}, "UBX_MON_SPAN"},
    {{{0x0A, 0x36}, "MON-COMMS", 0x2091034F}, "UBX_MON_COMMS"},
    {{{0x0A, 0x37}, "MON-HW3", 0x20910354}, "UBX_MON_HW3"},
    {{{0x0A, 0x38}, "MON-RF", 0x20910359}, "UBX_MON_RF"},
    {{{0x0A, 0x39}, "MON-SYS", 0x2091069D}, "UBX_MON_SYS"},
    {{{0x0D, 0x01}, "TIM-TP", 0x2091017D}, "UBX_TIM_TP"},
    {{{0x0D, 0x03}, "TIM-TM2", 0x20910178}, "UBX_TIM_TM2"},
    {{{0x0D, 0x06}, "TIM-VRFY", 0x20910092}, "UBX_TIM_VRFY"},
    {{{0x10, 0x02}, "ESF-MEAS", 0x20910277}, "UBX_ESF_MEAS"},
    {{{0x10, 0x10}, "ESF-STATUS", 0x20910105}, "UBX_ESF_STATUS"},
    {{{0x21, 0x08}, "LOG-INFO", 0x20910259}, "UBX_LOG_INFO"},
    {{{0x27, 0x09}, "SEC-SIG", 0x20910634}, "UBX_SEC_SIG"},
    {{{0x27, 0x10}, "SEC-SIGLOG", 0x20910689}, "UBX_SEC_SIGLOG"},
    {{{0xF0, 0x00}, "GGA", 0x209100BA}, "NMEA_ID_GGA"},
    {{{0xF0, 0x01}, "GLL", 0x209100C9}, "NMEA_ID_GLL"},
    {{{0xF0, 0x02}, "GSA", 0x209100BF}, "NMEA_ID_GSA"},
    {{{0xF0, 0x03}, "GSV", 0x209100C4}, "NMEA_ID_GSV"},
    {{{0xF0, 0x04}, "RMC", 0x209100AB}, "NMEA_ID_RMC"},
    {{{0xF0, 0x05}, "VTG", 0x209100B0}, "NMEA_ID_VTG"},
    {{{0xF0, 0x06}, "GRS", 0x209100CE}, "NMEA_ID_GRS"},
    {{{0xF0, 0x07}, "GST", 0x209100D3}, "NMEA_ID_GST"},
    {{{0xF0, 0x08}, "ZDA", 0x209100D8}, "NMEA_ID_ZDA"},
    {{{0xF0, 0x09}, "GBS", 0x209100DD}, "NMEA_ID_GBS"},
    {{{0xF0, 0x0A}, "DTM", 0x209100A6}, "NMEA_ID_DTM"},
    {{{0xF0, 0x0D}, "GNS", 0x209100B5}, "NMEA_ID_GNS"},
    {{{0xF0, 0x0E}, "THS", 0x20FE0038}, "NMEA_ID_THS"},
    {{{0xF0, 0x0F}, "VLW", 0x209100E7}, "NMEA_ID_VLW"},
    {{{0xF0, 0x41}, "TXT", 0x20FE003D}, "NMEA_ID_TXT"},
    {{{0xF1, 0x00}, "PUBX-00", 0x209100EC}, "PUBX_ID_POLYP"},
    {{{0xF1, 0x03}, "PUBX-03", 0x209100F1}, "PUBX_ID_POLYS"},
    {{{0xF1, 0x04}, "PUBX-04", 0x209100F6}, "PUBX_ID_POLYT"},
    {{{0xF5, 0x05}, "RTCM-1005", 0x209102BD}, "RTCM_3X_TYPE1005"},
    {{{0xF5, 0x06}, "RTCM-1006", 0x209102C2}, "RTCM_3X_TYPE1006"},
    {{{0xF5, 0x4A}, "RTCM-1074", 0x2091035E}, "RTCM_3X_TYPE1074"},
    {{{0xF5, 0x4D}, "RTCM-1077", 0x209102CC}, "RTCM_3X_TYPE1077"},
    {{{0xF5, 0x54}, "RTCM-1084", 0x20910363}, "RTCM_3X_TYPE1084"},
    {{{0xF5, 0x57}, "RTCM-1087", 0x209102D1}, "RTCM_3X_TYPE1087"},
    {{{0xF5, 0x5E}, "RTCM-1094", 0x20910368}, "RTCM_3X_TYPE1094"},
    {{{0xF5, 0x61}, "RTCM-1097", 0x20910318}, "RTCM_3X_TYPE1097"},
    {{{0xF5, 0x7C}, "RTCM-1124", 0x2091036D}, "RTCM_3X_TYPE1124"},
    {{{0xF5, 0x7F}, "RTCM-1127", 0x209102D6}, "RTCM_3X_TYPE1127"},
    {{{0xF5, 0xE6}, "RTCM-1230", 0x20910303}, "RTCM_3X_TYPE1230"},
    {{{0xF5, 0xFD}, "RTCM-4072.1", 0x20910381}, "RTCM_3X_TYPE4072_1"},
    {{{0xF5, 0xFE}, "RTCM-4072.0", 0x209102FE}, "RTCM_3X_TYPE4072_0"},
};

}  // namespace

std::span<const RateKeys> rate_keys() { return rate_key_list; }

namespace {

constexpr NamedMessage polled_message_list[] = {
    {{0x02, 0x41}, "RXM-PMREQ"},  {{0x0A, 0x04}, "MON-VER"}, {{0x0A, 0x27}, "MON-PATCH"},
    {{0x0A, 0x28}, "MON-GNSS"},   {{0x09, 0x14}, "UPD-SOS"}, {{0x0B, 0x01}, "AID-INI"},
    {{0x0B, 0x02}, "AID-HUI"},    {{0x0B, 0x30}, "AID-ALM"}, {{0x0B, 0x31}, "AID-EPH"},
    {{0x0B, 0x32}, "AID-ALPSRV"}, {{0x0B, 0x33}, "AID-AOP"}, {{0x27, 0x03}, "SEC-UNIQID"},
    {{0xF0, 0x40}, "GPQ"},        {{0xF0, 0x42}, "GNQ"},     {{0xF0, 0x43}, "GLQ"},
    {{0xF0, 0x44}, "GBQ"},        {{0xF0, 0x45}, "GAQ"},     {{0xF0, 0x47}, "GQQ"},
};

constexpr NamedMessage legacy_message_list[] = {
    {{0x06, 0x00}, "CFG-PRT"},    {{0x06, 0x01}, "CFG-MSG"},    {{0x06, 0x02}, "CFG-INF"},
    {{0x06, 0x06}, "CFG-DAT"},    {{0x06, 0x07}, "CFG-TP"},     {{0x06, 0x0E}, "CFG-FXN"},
    {{0x06, 0x32}, "CFG-PM"},     {{0x06, 0x08}, "CFG-RATE"},   {{0x06, 0x09}, "CFG-CFG"},
    {{0x06, 0x11}, "CFG-RXM"},    {{0x06, 0x13}, "CFG-ANT"},    {{0x06, 0x16}, "CFG-SBAS"},
    {{0x06, 0x17}, "CFG-NMEA"},   {{0x06, 0x1B}, "CFG-USB"},    {{0x06, 0x1E}, "CFG-ODO"},
    {{0x06, 0x23}, "CFG-NAVX5"},  {{0x06, 0x24}, "CFG-NAV5"},   {{0x06, 0x31}, "CFG-TP5"},
    {{0x06, 0x34}, "CFG-RINV"},   {{0x06, 0x39}, "CFG-ITFM"},   {{0x06, 0x3B}, "CFG-PM2"},
    {{0x06, 0x3D}, "CFG-TMODE2"}, {{0x06, 0x3E}, "CFG-GNSS"},   {{0x06, 0x47}, "CFG-LOGFILTER"},
    {{0x06, 0x57}, "CFG-PWR"},    {{0x06, 0x5C}, "CFG-HNR"},    {{0x06, 0x69}, "CFG-GEOFENCE"},
    {{0x06, 0x70}, "CFG-DGNSS"},  {{0x06, 0x71}, "CFG-TMODE3"}, {{0x06, 0x86}, "CFG-PMS"},
};

}  // namespace

std::span<const NamedMessage> polled_messages() { return polled_message_list; }
std::span<const NamedMessage> legacy_messages() { return legacy_message_list; }

namespace {

// As the names of CFG-MSGOUT items end, in the order of PortId.
constexpr std::array<std::string_view, port_count> rate_key_endings{"_I2C", "_UART1", "_UART2", "_USB", "_SPI"};

// Six sentences leave every epoch from the factory on (RECEIVER.md 3.5.2).
bool is_factory_sentence(UbxMessageId id) {
    constexpr std::uint8_t nmea = 0xF0, last = 0x05;  // GGA, GLL, GSA, GSV, RMC, VTG
    return id.message_class == nmea && id.id <= last;
}

// The whole list with its indices. Built once; it never changes.
class KeyList {
public:
    KeyList() {
        for (const auto part : {navigation_keys(), ports_keys(), system_keys(), private_keys()})
            keys_.insert(keys_.end(), part.begin(), part.end());
        for (const RateKeys& rate : rate_keys())
            add_rates(rate);
        std::sort(keys_.begin(), keys_.end(),
                  [](const ConfigKey& a, const ConfigKey& b) { return group_and_item(a.id) < group_and_item(b.id); });
        for (const ConfigKey& key : keys_)
            by_name_.emplace(key.name, &key);
    }

    [[nodiscard]] std::span<const ConfigKey> keys() const { return keys_; }
    [[nodiscard]] const ConfigKey* find(std::uint32_t id) const {
        const auto found = std::lower_bound(
            keys_.begin(), keys_.end(), group_and_item(id),
            [](const ConfigKey& key, std::uint32_t wanted) { return group_and_item(key.id) < wanted; });
        return found != keys_.end() && found->id == id ? &*found : nullptr;
    }
    [[nodiscard]] const ConfigKey* find(std::string_view name) const {
        const auto found = by_name_.find(name);
        return found == by_name_.end() ? nullptr : found->second;
    }

private:
    void add_rates(const RateKeys& rate) {
        const bool on_the_wire = (rate.message.i2c_key >> 16 & 0xFF) != private_message_group;
        const std::uint64_t factory = is_factory_sentence(rate.message.id) ? 1 : 0;
        for (std::uint32_t port = 0; port < port_count; ++port) {
            names_.push_back("CFG-MSGOUT-" + std::string(rate.stem) + std::string(rate_key_endings[port]));
            keys_.push_back({rate.message.i2c_key + port, names_.back(), ConfigType::u1, factory, on_the_wire});
        }
    }

    std::deque<std::string> names_;  // of the items of CFG-MSGOUT; a deque does not move them
    std::vector<ConfigKey> keys_;
    std::map<std::string_view, const ConfigKey*> by_name_;
};

const KeyList& key_list() {
    static const KeyList list;
    return list;
}

}  // namespace

std::span<const ConfigKey> config_keys() { return key_list().keys(); }
const ConfigKey* find_config_key(std::uint32_t id) { return key_list().find(id); }
const ConfigKey* find_config_key(std::string_view name) { return key_list().find(name); }

std::span<const OutputMessage> output_messages() {
    static const std::vector<OutputMessage> messages = [] {
        std::vector<OutputMessage> all;
        for (const RateKeys& rate : rate_keys())
            all.push_back(rate.message);
        return all;
    }();
    return messages;
}

const OutputMessage* find_output_message(UbxMessageId id) {
    const auto all = output_messages();
    const auto found = std::lower_bound(all.begin(), all.end(), id,
                                        [](const OutputMessage& m, UbxMessageId wanted) { return m.id < wanted; });
    return found != all.end() && found->id == id ? &*found : nullptr;
}

const OutputMessage* find_output_message(std::string_view name) {
    const auto all = output_messages();
    const auto found =
        std::find_if(all.begin(), all.end(), [name](const OutputMessage& message) { return message.name == name; });
    return found != all.end() ? &*found : nullptr;
}

std::optional<std::uint32_t> rate_key(UbxMessageId message, PortId port) {
    const OutputMessage* found = find_output_message(message);
    if (found == nullptr) return std::nullopt;
    return found->i2c_key + static_cast<std::uint32_t>(port);
}

}  // namespace skyloop::firmware
