// Configuration keys by id and by name. The keys of the rates of periodic messages are those of CFG-MSGOUT; keys of the
// group FE are our own: no interface description has one for these.
#include "firmware/ublox/config/config_keys.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <string>
#include <vector>

namespace skyloop::firmware {
namespace {

using namespace listed;

// What u-blox's interface descriptions list; that of HPG 1.51 (UBXDOC-963802114-13124) is that of HPG 1.50. Besides: of
// SPG 4.04, three flags of CFG-ODO, which PX4 sets in a batch that NEO-M9N acknowledge in the field; of
// F10, the rate of RXM-RAWX, which ArduPilot's driver asks of every receiver with one UART, and CFG-SIGNAL-HEALTH_L5,
// as of the F9P-15B (PX4-GPSDrivers #181); of HPG 1.32, what a ZED-F9P was seen to have: the rates of SEC-SIG and
// SEC-SIGLOG, CFG-HW-ANT_ON_SHORT_US and an item without a name, 0x10310027.
constexpr FirmwareList firmware_list_table[] = {
    {m9, "SPG 4.04", "UBX-21022436"},
    {m10_510, "SPG 5.10", "UBX-21035062"},
    {m10_530, "SPG 5.30", "UBXDOC-304424225-20395"},
    {f10, "SPGL1L5 6.00", "UBX-23002975"},
    {f9p_113, "HPG 1.13", "UBX-21023318"},
    {f9p_132, "HPG 1.32", "UBX-22008968"},
    {f9p_150, "HPG 1.50", "UBXDOC-963802114-12815"},
    {f9p_15b, "HPGL1L5 1.40", "UBX-23006991"},
    {x20p, "HPG 2.00", "UBXDOC-304424225-19888"},
};

constexpr RateKeys rate_key_list[] = {
    {{{0x01, 0x01}, "NAV-POSECEF", 0x20910024}, "UBX_NAV_POSECEF", all},
    {{{0x01, 0x02}, "NAV-POSLLH", 0x20910029}, "UBX_NAV_POSLLH", all},
    {{{0x01, 0x03}, "NAV-STATUS", 0x2091001A}, "UBX_NAV_STATUS", all},
    {{{0x01, 0x04}, "NAV-DOP", 0x20910038}, "UBX_NAV_DOP", all},
    {{{0x01, 0x06}, "NAV-SOL", 0x20FE0010}, "UBX_NAV_SOL", kept},
    {{{0x01, 0x07}, "NAV-PVT", 0x20910006}, "UBX_NAV_PVT", all},
    {{{0x01, 0x09}, "NAV-ODO", 0x2091007E}, "UBX_NAV_ODO", all},
    {{{0x01, 0x11}, "NAV-VELECEF", 0x2091003D}, "UBX_NAV_VELECEF", all},
    {{{0x01, 0x12}, "NAV-VELNED", 0x20910042}, "UBX_NAV_VELNED", all},
    {{{0x01, 0x13}, "NAV-HPPOSECEF", 0x2091002E}, "UBX_NAV_HPPOSECEF", f9 | x20p},
    {{{0x01, 0x14}, "NAV-HPPOSLLH", 0x20910033}, "UBX_NAV_HPPOSLLH", f9 | x20p},
    {{{0x01, 0x20}, "NAV-TIMEGPS", 0x20910047}, "UBX_NAV_TIMEGPS", all},
    {{{0x01, 0x21}, "NAV-TIMEUTC", 0x2091005B}, "UBX_NAV_TIMEUTC", all},
    {{{0x01, 0x22}, "NAV-CLOCK", 0x20910065}, "UBX_NAV_CLOCK", all},
    {{{0x01, 0x23}, "NAV-TIMEGLO", 0x2091004C}, "UBX_NAV_TIMEGLO", m9 | m10 | f9 | x20p},
    {{{0x01, 0x24}, "NAV-TIMEBDS", 0x20910051}, "UBX_NAV_TIMEBDS", all},
    {{{0x01, 0x25}, "NAV-TIMEGAL", 0x20910056}, "UBX_NAV_TIMEGAL", all},
    {{{0x01, 0x26}, "NAV-TIMELS", 0x20910060}, "UBX_NAV_TIMELS", all},
    {{{0x01, 0x27}, "NAV-TIMEQZSS", 0x20910386}, "UBX_NAV_TIMEQZSS", all},
    {{{0x01, 0x30}, "NAV-SVINFO", 0x20FE0015}, "UBX_NAV_SVINFO", kept},
    {{{0x01, 0x31}, "NAV-DGPS", 0x20FE001A}, "UBX_NAV_DGPS", kept},
    {{{0x01, 0x32}, "NAV-SBAS", 0x2091006A}, "UBX_NAV_SBAS", all},
    {{{0x01, 0x34}, "NAV-ORB", 0x20910010}, "UBX_NAV_ORB", all},
    {{{0x01, 0x35}, "NAV-SAT", 0x20910015}, "UBX_NAV_SAT", all},
    {{{0x01, 0x36}, "NAV-COV", 0x20910083}, "UBX_NAV_COV", all},
    {{{0x01, 0x39}, "NAV-GEOFENCE", 0x209100A1}, "UBX_NAV_GEOFENCE", m9 | m10_530 | f9 | x20p},
    {{{0x01, 0x3B}, "NAV-SVIN", 0x20910088}, "UBX_NAV_SVIN", f9 | x20p},
    {{{0x01, 0x3C}, "NAV-RELPOSNED", 0x2091008D}, "UBX_NAV_RELPOSNED", f9 | x20p},
    {{{0x01, 0x42}, "NAV-SLAS", 0x20910336}, "UBX_NAV_SLAS", m9 | m10 | f10 | f9},
    {{{0x01, 0x43}, "NAV-SIG", 0x20910345}, "UBX_NAV_SIG", all},
    {{{0x01, 0x60}, "NAV-AOPSTATUS", 0x20910079}, "UBX_NAV_AOPSTATUS", m9 | m10 | f10},
    {{{0x01, 0x61}, "NAV-EOE", 0x2091015F}, "UBX_NAV_EOE", all},
    {{{0x01, 0x62}, "NAV-PL", 0x20910415}, "UBX_NAV_PL", m10_510 | f10 | f9_new},
    {{{0x02, 0x10}, "RXM-RAW", 0x20FE0029}, "UBX_RXM_RAW", kept},
    {{{0x02, 0x11}, "RXM-SFRB", 0x20FE002E}, "UBX_RXM_SFRB", kept},
    {{{0x02, 0x13}, "RXM-SFRBX", 0x20910231}, "UBX_RXM_SFRBX", all},
    {{{0x02, 0x14}, "RXM-MEASX", 0x20910204}, "UBX_RXM_MEASX", all},
    {{{0x02, 0x15}, "RXM-RAWX", 0x209102A4}, "UBX_RXM_RAWX", m9 | m10_530 | f10 | f9 | x20p},
    {{{0x02, 0x20}, "RXM-SVSI", 0x20FE001F}, "UBX_RXM_SVSI", kept},
    {{{0x02, 0x32}, "RXM-RTCM", 0x20910268}, "UBX_RXM_RTCM", m9 | f9},
    {{{0x02, 0x33}, "RXM-SPARTN", 0x20910605}, "UBX_RXM_SPARTN", f9_new},
    {{{0x02, 0x34}, "RXM-COR", 0x209106B6}, "UBX_RXM_COR", m10_530 | f9_new | x20p},
    {{{0x02, 0x59}, "RXM-RLM", 0x2091025E}, "UBX_RXM_RLM", all},
    {{{0x02, 0x61}, "RXM-IMES", 0x20FE0024}, "UBX_RXM_IMES", kept},
    {{{0x02, 0x72}, "RXM-PMP", 0x2091031D}, "UBX_RXM_PMP", none},
    {{{0x0A, 0x02}, "MON-IO", 0x209101A5}, "UBX_MON_IO", m9 | m10 | f10 | f9},
    {{{0x0A, 0x06}, "MON-MSGPP", 0x20910196}, "UBX_MON_MSGPP", m9 | m10 | f10 | f9},
    {{{0x0A, 0x07}, "MON-RXBUF", 0x209101A0}, "UBX_MON_RXBUF", m9 | m10 | f9},
    {{{0x0A, 0x08}, "MON-TXBUF", 0x2091019B}, "UBX_MON_TXBUF", m9 | m10 | f9},
    {{{0x0A, 0x09}, "MON-HW", 0x209101B4}, "UBX_MON_HW", m9 | m10_510 | f10 | f9},
    {{{0x0A, 0x0B}, "MON-HW2", 0x209101B9}, "UBX_MON_HW2", m9 | m10_510 | f10 | f9},
    {{{0x0A, 0x21}, "MON-RXR", 0x20910187}, "UBX_MON_RXR", all},
    {{{0x0A, 0x2E}, "MON-SMGR", 0x20FE0033}, "UBX_MON_SMGR", kept},
    {{{0x0A, 0x31}, "MON-SPAN", 0x2091038B}, "UBX_MON_SPAN", all},
    {{{0x0A, 0x36}, "MON-COMMS", 0x2091034F}, "UBX_MON_COMMS", all},
    {{{0x0A, 0x37}, "MON-HW3", 0x20910354}, "UBX_MON_HW3", all},
    {{{0x0A, 0x38}, "MON-RF", 0x20910359}, "UBX_MON_RF", all},
    {{{0x0A, 0x39}, "MON-SYS", 0x2091069D}, "UBX_MON_SYS", m10_530 | f10 | f9_new | x20p},
    {{{0x0D, 0x01}, "TIM-TP", 0x2091017D}, "UBX_TIM_TP", all},
    {{{0x0D, 0x03}, "TIM-TM2", 0x20910178}, "UBX_TIM_TM2", all},
    {{{0x0D, 0x06}, "TIM-VRFY", 0x20910092}, "UBX_TIM_VRFY", all},
    {{{0x10, 0x02}, "ESF-MEAS", 0x20910277}, "UBX_ESF_MEAS", none},
    {{{0x10, 0x10}, "ESF-STATUS", 0x20910105}, "UBX_ESF_STATUS", none},
    {{{0x21, 0x08}, "LOG-INFO", 0x20910259}, "UBX_LOG_INFO", m9 | m10_530 | f9 | x20p},
    {{{0x27, 0x09}, "SEC-SIG", 0x20910634}, "UBX_SEC_SIG", m10_530 | f10 | f9_new | x20p},
    {{{0x27, 0x10}, "SEC-SIGLOG", 0x20910689}, "UBX_SEC_SIGLOG", m10_530 | f10 | f9_new | x20p},
    {{{0xF0, 0x00}, "GGA", 0x209100BA}, "NMEA_ID_GGA", all},
    {{{0xF0, 0x01}, "GLL", 0x209100C9}, "NMEA_ID_GLL", all},
    {{{0xF0, 0x02}, "GSA", 0x209100BF}, "NMEA_ID_GSA", all},
    {{{0xF0, 0x03}, "GSV", 0x209100C4}, "NMEA_ID_GSV", all},
    {{{0xF0, 0x04}, "RMC", 0x209100AB}, "NMEA_ID_RMC", all},
    {{{0xF0, 0x05}, "VTG", 0x209100B0}, "NMEA_ID_VTG", all},
    {{{0xF0, 0x06}, "GRS", 0x209100CE}, "NMEA_ID_GRS", all},
    {{{0xF0, 0x07}, "GST", 0x209100D3}, "NMEA_ID_GST", all},
    {{{0xF0, 0x08}, "ZDA", 0x209100D8}, "NMEA_ID_ZDA", all},
    {{{0xF0, 0x09}, "GBS", 0x209100DD}, "NMEA_ID_GBS", all},
    {{{0xF0, 0x0A}, "DTM", 0x209100A6}, "NMEA_ID_DTM", all},
    {{{0xF0, 0x0D}, "GNS", 0x209100B5}, "NMEA_ID_GNS", all},
    {{{0xF0, 0x0E}, "THS", 0x20FE0038}, "NMEA_ID_THS", kept},
    {{{0xF0, 0x0F}, "VLW", 0x209100E7}, "NMEA_ID_VLW", all},
    {{{0xF0, 0x30}, "HDT", 0x20FE0042}, "NMEA_ID_HDT", kept},
    {{{0xF0, 0x31}, "HDG", 0x20FE0047}, "NMEA_ID_HDG", kept},
    {{{0xF0, 0x32}, "ROT", 0x20FE004C}, "NMEA_ID_ROT", kept},
    {{{0xF0, 0x41}, "TXT", 0x20FE003D}, "NMEA_ID_TXT", kept},
    {{{0xF1, 0x00}, "PUBX-00", 0x209100EC}, "PUBX_ID_POLYP", all},
    {{{0xF1, 0x03}, "PUBX-03", 0x209100F1}, "PUBX_ID_POLYS", all},
    {{{0xF1, 0x04}, "PUBX-04", 0x209100F6}, "PUBX_ID_POLYT", all},
    {{{0xF5, 0x05}, "RTCM-1005", 0x209102BD}, "RTCM_3X_TYPE1005", f9 | x20p},
    {{{0xF5, 0x06}, "RTCM-1006", 0x209102C2}, "RTCM_3X_TYPE1006", none},
    {{{0xF5, 0x4A}, "RTCM-1074", 0x2091035E}, "RTCM_3X_TYPE1074", f9 | x20p},
    {{{0xF5, 0x4D}, "RTCM-1077", 0x209102CC}, "RTCM_3X_TYPE1077", f9 | x20p},
    {{{0xF5, 0x54}, "RTCM-1084", 0x20910363}, "RTCM_3X_TYPE1084", f9 | x20p},
    {{{0xF5, 0x57}, "RTCM-1087", 0x209102D1}, "RTCM_3X_TYPE1087", f9 | x20p},
    {{{0xF5, 0x5E}, "RTCM-1094", 0x20910368}, "RTCM_3X_TYPE1094", f9 | x20p},
    {{{0xF5, 0x61}, "RTCM-1097", 0x20910318}, "RTCM_3X_TYPE1097", f9 | x20p},
    {{{0xF5, 0x7C}, "RTCM-1124", 0x2091036D}, "RTCM_3X_TYPE1124", f9 | x20p},
    {{{0xF5, 0x7F}, "RTCM-1127", 0x209102D6}, "RTCM_3X_TYPE1127", f9 | x20p},
    {{{0xF5, 0xE6}, "RTCM-1230", 0x20910303}, "RTCM_3X_TYPE1230", f9 | x20p},
    {{{0xF5, 0xFD}, "RTCM-4072.1", 0x20910381}, "RTCM_3X_TYPE4072_1", f9p},
    {{{0xF5, 0xFE}, "RTCM-4072.0", 0x209102FE}, "RTCM_3X_TYPE4072_0", f9p},
};

// Rates of messages that no board here sends: taken and told.
struct UnsentRates {
    std::uint32_t i2c_key;
    std::string_view stem;
    FirmwareLists lists;
};
constexpr UnsentRates unsent_rates[] = {
    {0x20910313, "UBX_NAV_EELL", f9p_113},
    {0x209103A8, "UBX_NAV_TIMETRUSTED", f9p_150 | x20p},
    {0x20910400, "NMEA_ID_RLM", all},
    {0x20910430, "UBX_NAV2_CLOCK", f9_new},
    {0x20910435, "UBX_NAV2_COV", f9_new},
    {0x20910465, "UBX_NAV2_DOP", f9_new},
    {0x20910475, "UBX_NAV2_ODO", f9_new},
    {0x20910480, "UBX_NAV2_POSECEF", f9_new},
    {0x20910485, "UBX_NAV2_POSLLH", f9_new},
    {0x20910490, "UBX_NAV2_PVT", f9_new},
    {0x20910495, "UBX_NAV2_SAT", f9_new},
    {0x20910500, "UBX_NAV2_SBAS", f9_new},
    {0x20910505, "UBX_NAV2_SIG", f9_new},
    {0x20910510, "UBX_NAV2_SLAS", f9_new},
    {0x20910515, "UBX_NAV2_STATUS", f9_new},
    {0x20910520, "UBX_NAV2_SVIN", f9_new},
    {0x20910525, "UBX_NAV2_TIMEBDS", f9_new},
    {0x20910530, "UBX_NAV2_TIMEGAL", f9_new},
    {0x20910535, "UBX_NAV2_TIMEGLO", f9_new},
    {0x20910540, "UBX_NAV2_TIMEGPS", f9_new},
    {0x20910545, "UBX_NAV2_TIMELS", f9_new},
    {0x20910550, "UBX_NAV2_TIMEUTC", f9_new},
    {0x20910555, "UBX_NAV2_VELECEF", f9_new},
    {0x20910560, "UBX_NAV2_VELNED", f9_new},
    {0x20910565, "UBX_NAV2_EOE", f9_new},
    {0x20910575, "UBX_NAV2_TIMEQZSS", f9_new},
    {0x20910639, "UBX_RXM_MEASD12", m10},
    {0x2091063E, "UBX_RXM_MEASC12", m10},
    {0x20910643, "UBX_RXM_MEAS20", m10},
    {0x20910648, "UBX_RXM_MEAS50", m10},
    {0x20910652, "NMEA_NAV2_ID_RMC", f9_new},
    {0x20910657, "NMEA_NAV2_ID_VTG", f9_new},
    {0x2091065C, "NMEA_NAV2_ID_GNS", f9_new},
    {0x20910661, "NMEA_NAV2_ID_GGA", f9_new},
    {0x20910666, "NMEA_NAV2_ID_GSA", f9_new},
    {0x20910670, "NMEA_NAV2_ID_GLL", f9_new},
    {0x2091067F, "NMEA_NAV2_ID_ZDA", f9_new},
    {0x209106A2, "UBX_NAV_TIMENAVIC", f10 | f9p_15b},
    {0x209106A7, "UBX_NAV2_TIMENAVIC", f9p_15b},
    {0x209106CA, "UBX_SEC_OSNMA", f9p_150 | x20p},
};

}  // namespace

std::span<const FirmwareList> firmware_lists() { return firmware_list_table; }
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
            add_rates(rate.message.i2c_key, rate.stem, rate.lists, is_factory_sentence(rate.message.id) ? 1 : 0);
        for (const UnsentRates& rate : unsent_rates)
            add_rates(rate.i2c_key, rate.stem, rate.lists, 0);
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
    void add_rates(std::uint32_t i2c_key, std::string_view stem, FirmwareLists lists, std::uint64_t factory) {
        for (std::uint32_t port = 0; port < ublox_port_count; ++port) {
            names_.push_back("CFG-MSGOUT-" + std::string(stem) + std::string(rate_key_endings[port]));
            keys_.push_back({i2c_key + port, names_.back(), ConfigType::u1, factory, lists});
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
        std::vector<OutputMessage> known;
        for (const RateKeys& rate : rate_keys())
            known.push_back(rate.message);
        return known;
    }();
    return messages;
}

const OutputMessage* find_output_message(UbxMessageId id) {
    const auto known = output_messages();
    const auto found = std::lower_bound(known.begin(), known.end(), id,
                                        [](const OutputMessage& m, UbxMessageId wanted) { return m.id < wanted; });
    return found != known.end() && found->id == id ? &*found : nullptr;
}

const OutputMessage* find_output_message(std::string_view name) {
    const auto known = output_messages();
    const auto found =
        std::find_if(known.begin(), known.end(), [name](const OutputMessage& message) { return message.name == name; });
    return found != known.end() ? &*found : nullptr;
}

std::optional<std::uint32_t> rate_key(UbxMessageId message, PortId port) {
    const OutputMessage* found = find_output_message(message);
    if (found == nullptr) return std::nullopt;
    return found->i2c_key + static_cast<std::uint32_t>(port);
}

}  // namespace skyloop::firmware
