// Configuration items: ports and the protocols on them; texts, sentences, hardware, power, security. Ids, names, types,
// defaults and lists as in keys_navigation.cpp.
//
// Items that receivers reach by their legacy messages alone: no document gives them a key, so the group FD is our own.
// Bits 8 to 11 of an item are the bit of CFG-CFG's masks that it is saved with.

#include "firmware/ublox/config/config_keys.hpp"

namespace skyloop::firmware {
namespace {

using enum ConfigType;
using namespace listed;

/// Eight characters of a text of CFG-USB, the first one lowest.
constexpr std::uint64_t eight_characters(std::string_view text, std::size_t part) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 8 && 8 * part + i < text.size(); ++i)
        value |= std::uint64_t{static_cast<unsigned char>(text[8 * part + i])} << (8 * i);
    return value;
}
constexpr std::string_view vendor = "u-blox AG - www.u-blox.com", product = "u-blox GNSS receiver";

constexpr ConfigKey ports_items[] = {
    {0x20510001, "CFG-I2C-ADDRESS", u1, 132, all},
    {0x10510002, "CFG-I2C-EXTENDEDTIMEOUT", l, 0, all},
    {0x10510003, "CFG-I2C-ENABLED", l, 1, all},
    {0x40520001, "CFG-UART1-BAUDRATE", u4, 38400, all},
    {0x20520002, "CFG-UART1-STOPBITS", e1, 1, all},
    {0x20520003, "CFG-UART1-DATABITS", e1, 0, all},
    {0x20520004, "CFG-UART1-PARITY", e1, 0, all},
    {0x10520005, "CFG-UART1-ENABLED", l, 1, all},
    {0x40530001, "CFG-UART2-BAUDRATE", u4, 38400, m9 | f9 | x20p},
    {0x20530002, "CFG-UART2-STOPBITS", e1, 1, m9 | f9 | x20p},
    {0x20530003, "CFG-UART2-DATABITS", e1, 0, m9 | f9 | x20p},
    {0x20530004, "CFG-UART2-PARITY", e1, 0, m9 | f9 | x20p},
    {0x10530005, "CFG-UART2-ENABLED", l, 1, m9 | f9 | x20p},
    {0x10530006, "CFG-UART2-REMAP", l, 0, f9p_113},
    {0x20640001, "CFG-SPI-MAXFF", u1, 50, all},
    {0x10640002, "CFG-SPI-CPOLARITY", l, 0, all},
    {0x10640003, "CFG-SPI-CPHASE", l, 0, all},
    {0x10640005, "CFG-SPI-EXTENDEDTIMEOUT", l, 0, all},
    {0x10640006, "CFG-SPI-ENABLED", l, 0, all},
    {0x10650001, "CFG-USB-ENABLED", l, 1, m9 | f9},
    {0x10650002, "CFG-USB-SELFPOW", l, 1, m9 | f9},
    {0x3065000A, "CFG-USB-VENDOR_ID", u2, 0x1546, m9 | f9},
    {0x3065000B, "CFG-USB-PRODUCT_ID", u2, 0x01A9, m9 | f9},
    {0x3065000C, "CFG-USB-POWER", u2, 0, m9 | f9},
    {0x5065000D, "CFG-USB-VENDOR_STR0", x8, eight_characters(vendor, 0), m9 | f9},
    {0x5065000E, "CFG-USB-VENDOR_STR1", x8, eight_characters(vendor, 1), m9 | f9},
    {0x5065000F, "CFG-USB-VENDOR_STR2", x8, eight_characters(vendor, 2), m9 | f9},
    {0x50650010, "CFG-USB-VENDOR_STR3", x8, eight_characters(vendor, 3), m9 | f9},
    {0x50650011, "CFG-USB-PRODUCT_STR0", x8, eight_characters(product, 0), m9 | f9},
    {0x50650012, "CFG-USB-PRODUCT_STR1", x8, eight_characters(product, 1), m9 | f9},
    {0x50650013, "CFG-USB-PRODUCT_STR2", x8, eight_characters(product, 2), m9 | f9},
    {0x50650014, "CFG-USB-PRODUCT_STR3", x8, eight_characters(product, 3), m9 | f9},
    {0x50650015, "CFG-USB-SERIAL_NO_STR0", x8, 0, m9 | f9},
    {0x50650016, "CFG-USB-SERIAL_NO_STR1", x8, 0, m9 | f9},
    {0x50650017, "CFG-USB-SERIAL_NO_STR2", x8, 0, m9 | f9},
    {0x50650018, "CFG-USB-SERIAL_NO_STR3", x8, 0, m9 | f9},
    {0x10710001, "CFG-I2CINPROT-UBX", l, 1, all},
    {0x10710002, "CFG-I2CINPROT-NMEA", l, 1, all},
    {0x10710004, "CFG-I2CINPROT-RTCM3X", l, 1, m9 | m10_530 | f9 | x20p},
    {0x10710005, "CFG-I2CINPROT-SPARTN", l, 1, f9_new | x20p},
    {0x10720001, "CFG-I2COUTPROT-UBX", l, 1, all},
    {0x10720002, "CFG-I2COUTPROT-NMEA", l, 1, all},
    {0x10720004, "CFG-I2COUTPROT-RTCM3X", l, 0, f9 | x20p},
    {0x10730001, "CFG-UART1INPROT-UBX", l, 1, all},
    {0x10730002, "CFG-UART1INPROT-NMEA", l, 1, all},
    {0x10730004, "CFG-UART1INPROT-RTCM3X", l, 1, m9 | m10_530 | f9 | x20p},
    {0x10730005, "CFG-UART1INPROT-SPARTN", l, 1, f9_new | x20p},
    {0x10740001, "CFG-UART1OUTPROT-UBX", l, 1, all},
    {0x10740002, "CFG-UART1OUTPROT-NMEA", l, 1, all},
    {0x10740004, "CFG-UART1OUTPROT-RTCM3X", l, 0, f9 | x20p},
    {0x10750001, "CFG-UART2INPROT-UBX", l, 1, m9 | f9 | x20p},
    {0x10750002, "CFG-UART2INPROT-NMEA", l, 1, m9 | f9 | x20p},
    {0x10750004, "CFG-UART2INPROT-RTCM3X", l, 1, m9 | f9 | x20p},
    {0x10750005, "CFG-UART2INPROT-SPARTN", l, 1, f9_new | x20p},
    {0x10760001, "CFG-UART2OUTPROT-UBX", l, 1, m9 | f9 | x20p},
    {0x10760002, "CFG-UART2OUTPROT-NMEA", l, 1, m9 | f9 | x20p},
    {0x10760004, "CFG-UART2OUTPROT-RTCM3X", l, 0, f9 | x20p},
    {0x10770001, "CFG-USBINPROT-UBX", l, 1, m9 | f9},
    {0x10770002, "CFG-USBINPROT-NMEA", l, 1, m9 | f9},
    {0x10770004, "CFG-USBINPROT-RTCM3X", l, 1, m9 | f9},
    {0x10770005, "CFG-USBINPROT-SPARTN", l, 1, f9_new},
    {0x10780001, "CFG-USBOUTPROT-UBX", l, 1, m9 | f9},
    {0x10780002, "CFG-USBOUTPROT-NMEA", l, 1, m9 | f9},
    {0x10780004, "CFG-USBOUTPROT-RTCM3X", l, 0, f9},
    {0x10790001, "CFG-SPIINPROT-UBX", l, 1, all},
    {0x10790002, "CFG-SPIINPROT-NMEA", l, 1, all},
    {0x10790004, "CFG-SPIINPROT-RTCM3X", l, 1, m9 | m10_530 | f9 | x20p},
    {0x10790005, "CFG-SPIINPROT-SPARTN", l, 1, f9_new | x20p},
    {0x107A0001, "CFG-SPIOUTPROT-UBX", l, 1, all},
    {0x107A0002, "CFG-SPIOUTPROT-NMEA", l, 1, all},
    {0x107A0004, "CFG-SPIOUTPROT-RTCM3X", l, 0, f9 | x20p},
};

}  // namespace

std::span<const ConfigKey> ports_keys() { return ports_items; }

namespace {

constexpr ConfigKey system_items[] = {
    {0x20920001, "CFG-INFMSG-UBX_I2C", x1, 0, all},
    {0x20920002, "CFG-INFMSG-UBX_UART1", x1, 0, all},
    {0x20920003, "CFG-INFMSG-UBX_UART2", x1, 0, m9 | f9 | x20p},
    {0x20920004, "CFG-INFMSG-UBX_USB", x1, 0, m9 | f9},
    {0x20920005, "CFG-INFMSG-UBX_SPI", x1, 0, all},
    {0x20920006, "CFG-INFMSG-NMEA_I2C", x1, 7, all},
    {0x20920007, "CFG-INFMSG-NMEA_UART1", x1, 7, all},
    {0x20920008, "CFG-INFMSG-NMEA_UART2", x1, 7, m9 | f9 | x20p},
    {0x20920009, "CFG-INFMSG-NMEA_USB", x1, 7, m9 | f9},
    {0x2092000A, "CFG-INFMSG-NMEA_SPI", x1, 7, all},
    {0x20930001, "CFG-NMEA-PROTVER", e1, 41, all},
    {0x20930002, "CFG-NMEA-MAXSVS", e1, 0, all},
    {0x10930003, "CFG-NMEA-COMPAT", l, 0, all},
    {0x10930004, "CFG-NMEA-CONSIDER", l, 1, all},
    {0x10930005, "CFG-NMEA-LIMIT82", l, 0, all},
    {0x10930006, "CFG-NMEA-HIGHPREC", l, 0, all},
    {0x20930007, "CFG-NMEA-SVNUMBERING", e1, 0, all},
    {0x10930011, "CFG-NMEA-FILT_GPS", l, 0, all},
    {0x10930012, "CFG-NMEA-FILT_SBAS", l, 0, all},
    {0x10930013, "CFG-NMEA-FILT_GAL", l, 0, all},
    {0x10930015, "CFG-NMEA-FILT_QZSS", l, 0, all},
    {0x10930016, "CFG-NMEA-FILT_GLO", l, 0, m9 | m10 | f9 | x20p},
    {0x10930017, "CFG-NMEA-FILT_BDS", l, 0, all},
    {0x10930018, "CFG-NMEA-FILT_NAVIC", l, 0, f10 | f9p_15b | x20p},
    {0x10930021, "CFG-NMEA-OUT_INVFIX", l, 0, all},
    {0x10930022, "CFG-NMEA-OUT_MSKFIX", l, 0, all},
    {0x10930023, "CFG-NMEA-OUT_INVTIME", l, 0, all},
    {0x10930024, "CFG-NMEA-OUT_INVDATE", l, 0, all},
    {0x10930025, "CFG-NMEA-OUT_ONLYGPS", l, 0, all},
    {0x10930026, "CFG-NMEA-OUT_FROZENCOG", l, 0, all},
    {0x20930031, "CFG-NMEA-MAINTALKERID", e1, 0, all},
    {0x20930032, "CFG-NMEA-GSVTALKERID", e1, 0, all},
    {0x30930033, "CFG-NMEA-BDSTALKERID", u2, 0, all},
    {0x10A20001, "CFG-TXREADY-ENABLED", l, 0, all},
    {0x10A20002, "CFG-TXREADY-POLARITY", l, 0, all},
    {0x20A20003, "CFG-TXREADY-PIN", u1, 0, all},
    {0x30A20004, "CFG-TXREADY-THRESHOLD", u2, 0, all},
    {0x20A20005, "CFG-TXREADY-INTERFACE", e1, 0, all},
    {0x10A3002E, "CFG-HW-ANT_CFG_VOLTCTRL", l, 0, all},
    {0x10A3002F, "CFG-HW-ANT_CFG_SHORTDET", l, 0, all},
    {0x10A30030, "CFG-HW-ANT_CFG_SHORTDET_POL", l, 1, all},
    {0x10A30031, "CFG-HW-ANT_CFG_OPENDET", l, 0, all},
    {0x10A30032, "CFG-HW-ANT_CFG_OPENDET_POL", l, 1, all},
    {0x10A30033, "CFG-HW-ANT_CFG_PWRDOWN", l, 0, all},
    {0x10A30034, "CFG-HW-ANT_CFG_PWRDOWN_POL", l, 1, all},
    {0x10A30035, "CFG-HW-ANT_CFG_RECOVER", l, 0, all},
    {0x20A30036, "CFG-HW-ANT_SUP_SWITCH_PIN", u1, 16, m9 | m10 | f10 | f9},
    {0x20A30037, "CFG-HW-ANT_SUP_SHORT_PIN", u1, 15, m9 | m10 | f10 | f9},
    {0x20A30038, "CFG-HW-ANT_SUP_OPEN_PIN", u1, 8, m9 | m10 | f10 | f9},
    {0x30A3003C, "CFG-HW-ANT_ON_SHORT_US", u2, 500, m9 | m10 | f10 | f9_new | x20p},
    {0x20A30054, "CFG-HW-ANT_SUP_ENGINE", e1, 0, m9 | m10 | f10 | f9},
    {0x20A30055, "CFG-HW-ANT_SUP_SHORT_THR", u1, 0, m9 | m10_510 | f10 | f9},
    {0x20A30056, "CFG-HW-ANT_SUP_OPEN_THR", u1, 0, m9 | m10_510 | f10 | f9},
    {0x20A30057, "CFG-HW-RF_LNA_MODE", e1, 0, m10 | f10},
    {0x10A3006A, "CFG-HW-RF1_LNA_MODE_LOWGAIN", l, 0, x20p},
    {0x10A3006B, "CFG-HW-RF2_LNA_MODE_LOWGAIN", l, 0, x20p},
    {0x10A3006C, "CFG-HW-RF3_LNA_MODE_LOWGAIN", l, 0, x20p},
    {0x20A70001, "CFG-SPARTN-USE_SOURCE", e1, 0, f9_new | x20p},
    {0x10C70001, "CFG-RINV-DUMP", l, 0, all},
    {0x10C70002, "CFG-RINV-BINARY", l, 0, all},
    {0x20C70003, "CFG-RINV-DATA_SIZE", u1, 22, all},
    {0x50C70004, "CFG-RINV-CHUNK0", x8, 0x203A'6563'6974'6F4E, all},  // "Notice: no data saved!"
    {0x50C70005, "CFG-RINV-CHUNK1", x8, 0x2061'7461'6420'6F6E, all},
    {0x50C70006, "CFG-RINV-CHUNK2", x8, 0x0000'2164'6576'6173, all},
    {0x50C70007, "CFG-RINV-CHUNK3", x8, 0, all},
    {0x20D00001, "CFG-PM-OPERATEMODE", e1, 0, m9 | m10},
    {0x40D00002, "CFG-PM-POSUPDATEPERIOD", u4, 10, m9 | m10},
    {0x40D00003, "CFG-PM-ACQPERIOD", u4, 10, m9 | m10},
    {0x40D00004, "CFG-PM-GRIDOFFSET", u4, 0, m9 | m10},
    {0x30D00005, "CFG-PM-ONTIME", u2, 0, m9 | m10},
    {0x20D00006, "CFG-PM-MINACQTIME", u1, 0, m9 | m10},
    {0x20D00007, "CFG-PM-MAXACQTIME", u1, 0, m9 | m10},
    {0x10D00008, "CFG-PM-DONOTENTEROFF", l, 0, m9 | m10},
    {0x10D00009, "CFG-PM-WAITTIMEFIX", l, 0, m9 | m10},
    {0x10D0000A, "CFG-PM-UPDATEEPH", l, 1, m9 | m10},
    {0x20D0000B, "CFG-PM-EXTINTSEL", e1, 0, m9},
    {0x10D0000C, "CFG-PM-EXTINTWAKE", l, 0, m9 | m10},
    {0x10D0000D, "CFG-PM-EXTINTBACKUP", l, 0, m9 | m10},
    {0x10D0000E, "CFG-PM-EXTINTINACTIVE", l, 0, m9 | m10},
    {0x40D0000F, "CFG-PM-EXTINTINACTIVITY", u4, 0, m9 | m10},
    {0x10D00010, "CFG-PM-LIMITPEAKCURR", l, 0, m9 | m10},
    {0x10DE0002, "CFG-LOGFILTER-RECORD_ENA", l, 0, m9 | m10_530 | f9 | x20p},
    {0x10DE0003, "CFG-LOGFILTER-ONCE_PER_WAKE_UP_ENA", l, 0, m9 | m10_530 | f9p_113 | f9p_132 | f9p_15b},
    {0x10DE0004, "CFG-LOGFILTER-APPLY_ALL_FILTERS", l, 0, m9 | m10_530 | f9 | x20p},
    {0x30DE0005, "CFG-LOGFILTER-MIN_INTERVAL", u2, 0, m9 | m10_530 | f9 | x20p},
    {0x30DE0006, "CFG-LOGFILTER-TIME_THRS", u2, 0, m9 | m10_530 | f9 | x20p},
    {0x30DE0007, "CFG-LOGFILTER-SPEED_THRS", u2, 0, m9 | m10_530 | f9 | x20p},
    {0x40DE0008, "CFG-LOGFILTER-POSITION_THRS", u4, 0, m9 | m10_530 | f9 | x20p},
    {0x10F60009, "CFG-SEC-CFG_LOCK", l, 0, all},
    {0x30F6000A, "CFG-SEC-CFG_LOCK_UNLOCKGRP1", u2, 0, all},
    {0x30F6000B, "CFG-SEC-CFG_LOCK_UNLOCKGRP2", u2, 0, all},
    {0x10F60051, "CFG-SEC-JAMDET_SENSITIVITY_HI", l, 0, m10_530 | f9p_150 | f9p_15b | x20p},
    {0x10F6005D, "CFG-SEC-SPOOFDET_SIM_SIG_DIS", l, 0, m10_530 | f9p_150 | x20p},
};

}  // namespace

std::span<const ConfigKey> system_keys() { return system_items; }

namespace {

constexpr ConfigKey private_items[] = {
    // CFG-PRT, by port: the pin that says that there is something to read; bit 4 of the mode of a UART; RTCM 2 as
    // input, which receivers had up to M8.
    {0x30FD0001, "CFG-PRT-TXREADY_I2C", u2, 0, kept},
    {0x30FD0002, "CFG-PRT-TXREADY_UART1", u2, 0, kept},
    {0x30FD0003, "CFG-PRT-TXREADY_UART2", u2, 0, kept},
    {0x30FD0004, "CFG-PRT-TXREADY_USB", u2, 0, kept},
    {0x30FD0005, "CFG-PRT-TXREADY_SPI", u2, 0, kept},
    {0x10FD0011, "CFG-PRT-MODEBIT4_UART1", l, 0, kept},
    {0x10FD0012, "CFG-PRT-MODEBIT4_UART2", l, 0, kept},
    {0x10FD0020, "CFG-PRT-RTCM2_IN_I2C", l, 1, kept},
    {0x10FD0021, "CFG-PRT-RTCM2_IN_UART1", l, 1, kept},
    {0x10FD0022, "CFG-PRT-RTCM2_IN_UART2", l, 1, kept},
    {0x10FD0023, "CFG-PRT-RTCM2_IN_USB", l, 1, kept},
    {0x10FD0024, "CFG-PRT-RTCM2_IN_SPI", l, 1, kept},
    // CFG-NAV5, CFG-NAVX5, CFG-SBAS.
    {0x20FD0301, "CFG-NAVSPG-DR_LIMIT", u1, 0, kept},
    {0x10FD0302, "CFG-NAVSPG-USE_ADR", l, 0, kept},
    {0x20FD0303, "CFG-SBAS-MAX_SBAS", u1, 3, kept},
    // CFG-GNSS: channels, 0 where the board's own hold; and IMES, which only M8 has (RECEIVER.md 2.4).
    {0x20FD0401, "CFG-SIGNAL-CHANNELS_USED", u1, 0, kept},
    {0x40FD0410, "CFG-SIGNAL-GPS_CHANNELS", x4, 0, kept},
    {0x40FD0411, "CFG-SIGNAL-SBAS_CHANNELS", x4, 0, kept},
    {0x40FD0412, "CFG-SIGNAL-GAL_CHANNELS", x4, 0, kept},
    {0x40FD0413, "CFG-SIGNAL-BDS_CHANNELS", x4, 0, kept},
    {0x40FD0414, "CFG-SIGNAL-IMES_CHANNELS", x4, 0, kept},
    {0x40FD0415, "CFG-SIGNAL-QZSS_CHANNELS", x4, 0, kept},
    {0x40FD0416, "CFG-SIGNAL-GLO_CHANNELS", x4, 0, kept},
    {0x10FD0420, "CFG-SIGNAL-IMES_ENA", l, 0, kept},
    {0x10FD0421, "CFG-SIGNAL-IMES_L1_ENA", l, 1, kept},
    // CFG-TP5, by pulse; how the second pulse of an M8 is given, where later receivers have CFG-TP-PULSE_DEF for both.
    {0x30FD0430, "CFG-TP-RF_GROUP_DELAY_TP1", i2, 0, kept},
    {0x30FD0431, "CFG-TP-RF_GROUP_DELAY_TP2", i2, 0, kept},
    {0x20FD0432, "CFG-TP-SYNC_MODE_TP1", u1, 0, kept},
    {0x20FD0433, "CFG-TP-SYNC_MODE_TP2", u1, 0, kept},
    {0x20FD0434, "CFG-TP-PULSE_DEF_TP2", e1, 1, kept},
    {0x20FD0435, "CFG-TP-PULSE_LENGTH_DEF_TP2", e1, 1, kept},
    // CFG-PMS.
    {0x20FD0440, "CFG-PM-SETUP", e1, 0, kept},
    // CFG-PM2: its flags without an item, and of its periods what is beyond whole seconds, ms.
    {0x40FD0441, "CFG-PM-FLAGS", x4, 0x0142800E, kept},
    {0x30FD0442, "CFG-PM-UPDATE_REST", u2, 0, kept},
    {0x30FD0443, "CFG-PM-SEARCH_REST", u2, 0, kept},
    {0x30FD0444, "CFG-PM-GRID_REST", u2, 0, kept},
};

}  // namespace

std::span<const ConfigKey> private_keys() { return private_items; }

}  // namespace skyloop::firmware
