// Items that old receivers reach by their legacy messages alone: no document gives them a key, so the group FD is our
// own. Ascending by item; `on_the_wire` is false for each. Bits 8 to 11 of an item are the bit of CFG-CFG's masks that
// it is saved with.
#include "firmware/config/key_tables.hpp"

namespace skyloop::firmware {
namespace {

using enum ConfigType;

/// Eight characters of a text of CFG-USB, the first one lowest.
constexpr std::uint64_t eight_characters(std::string_view text, std::size_t part) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 8 && 8 * part + i < text.size(); ++i)
        value |= std::uint64_t{static_cast<unsigned char>(text[8 * part + i])} << (8 * i);
    return value;
}
constexpr std::string_view vendor = "u-blox AG - www.u-blox.com", product = "u-blox GNSS receiver";

constexpr ConfigKey private_items[] = {
    // CFG-PRT, by port: the pin that says that there is something to read; bit 4 of the mode of a UART; RTCM 2 as
    // input,
    // which receivers had up to M8.
    {0x30FD0001, "CFG-PRT-TXREADY_I2C", u2, 0, false},
    {0x30FD0002, "CFG-PRT-TXREADY_UART1", u2, 0, false},
    {0x30FD0003, "CFG-PRT-TXREADY_UART2", u2, 0, false},
    {0x30FD0004, "CFG-PRT-TXREADY_USB", u2, 0, false},
    {0x30FD0005, "CFG-PRT-TXREADY_SPI", u2, 0, false},
    {0x10FD0011, "CFG-PRT-MODEBIT4_UART1", l, 0, false},
    {0x10FD0012, "CFG-PRT-MODEBIT4_UART2", l, 0, false},
    {0x10FD0020, "CFG-PRT-RTCM2_IN_I2C", l, 1, false},
    {0x10FD0021, "CFG-PRT-RTCM2_IN_UART1", l, 1, false},
    {0x10FD0022, "CFG-PRT-RTCM2_IN_UART2", l, 1, false},
    {0x10FD0023, "CFG-PRT-RTCM2_IN_USB", l, 1, false},
    {0x10FD0024, "CFG-PRT-RTCM2_IN_SPI", l, 1, false},
    // CFG-USB.
    {0x30FD0030, "CFG-USB-VENDOR_ID", u2, 0x1546, false},
    {0x30FD0031, "CFG-USB-PRODUCT_ID", u2, 0x01A9, false},
    {0x30FD0032, "CFG-USB-POWER", u2, 0, false},
    {0x50FD0034, "CFG-USB-VENDOR_STR0", x8, eight_characters(vendor, 0), false},
    {0x50FD0035, "CFG-USB-VENDOR_STR1", x8, eight_characters(vendor, 1), false},
    {0x50FD0036, "CFG-USB-VENDOR_STR2", x8, eight_characters(vendor, 2), false},
    {0x50FD0037, "CFG-USB-VENDOR_STR3", x8, eight_characters(vendor, 3), false},
    {0x50FD0038, "CFG-USB-PRODUCT_STR0", x8, eight_characters(product, 0), false},
    {0x50FD0039, "CFG-USB-PRODUCT_STR1", x8, eight_characters(product, 1), false},
    {0x50FD003A, "CFG-USB-PRODUCT_STR2", x8, eight_characters(product, 2), false},
    {0x50FD003B, "CFG-USB-PRODUCT_STR3", x8, eight_characters(product, 3), false},
    {0x50FD003C, "CFG-USB-SERIAL_NO_STR0", x8, 0, false},
    {0x50FD003D, "CFG-USB-SERIAL_NO_STR1", x8, 0, false},
    {0x50FD003E, "CFG-USB-SERIAL_NO_STR2", x8, 0, false},
    {0x50FD003F, "CFG-USB-SERIAL_NO_STR3", x8, 0, false},
    // CFG-NAV5, CFG-NAVX5, CFG-SBAS.
    {0x20FD0301, "CFG-NAVSPG-DR_LIMIT", u1, 0, false},
    {0x10FD0302, "CFG-NAVSPG-USE_ADR", l, 0, false},
    {0x20FD0303, "CFG-SBAS-MAX_SBAS", u1, 3, false},
    // CFG-GNSS: channels, 0 where the board's own hold; and IMES, which only M8 has (RECEIVER.md 2.4).
    {0x20FD0401, "CFG-SIGNAL-CHANNELS_USED", u1, 0, false},
    {0x40FD0410, "CFG-SIGNAL-GPS_CHANNELS", x4, 0, false},
    {0x40FD0411, "CFG-SIGNAL-SBAS_CHANNELS", x4, 0, false},
    {0x40FD0412, "CFG-SIGNAL-GAL_CHANNELS", x4, 0, false},
    {0x40FD0413, "CFG-SIGNAL-BDS_CHANNELS", x4, 0, false},
    {0x40FD0414, "CFG-SIGNAL-IMES_CHANNELS", x4, 0, false},
    {0x40FD0415, "CFG-SIGNAL-QZSS_CHANNELS", x4, 0, false},
    {0x40FD0416, "CFG-SIGNAL-GLO_CHANNELS", x4, 0, false},
    {0x10FD0420, "CFG-SIGNAL-IMES_ENA", l, 0, false},
    {0x10FD0421, "CFG-SIGNAL-IMES_L1_ENA", l, 1, false},
    // CFG-TP5, by pulse; how the second pulse of an M8 is given, where later receivers have CFG-TP-PULSE_DEF for both.
    {0x30FD0430, "CFG-TP-RF_GROUP_DELAY_TP1", i2, 0, false},
    {0x30FD0431, "CFG-TP-RF_GROUP_DELAY_TP2", i2, 0, false},
    {0x20FD0432, "CFG-TP-SYNC_MODE_TP1", u1, 0, false},
    {0x20FD0433, "CFG-TP-SYNC_MODE_TP2", u1, 0, false},
    {0x20FD0434, "CFG-TP-PULSE_DEF_TP2", e1, 1, false},
    {0x20FD0435, "CFG-TP-PULSE_LENGTH_DEF_TP2", e1, 1, false},
    // CFG-PMS.
    {0x20FD0440, "CFG-PM-SETUP", e1, 0, false},
    // CFG-PM2: its flags without an item, and of its periods what is beyond whole seconds, ms.
    {0x40FD0441, "CFG-PM-FLAGS", x4, 0x0142800E, false},
    {0x30FD0442, "CFG-PM-UPDATE_REST", u2, 0, false},
    {0x30FD0443, "CFG-PM-SEARCH_REST", u2, 0, false},
    {0x30FD0444, "CFG-PM-GRID_REST", u2, 0, false},
};

}  // namespace

std::span<const ConfigKey> private_keys() { return private_items; }

}  // namespace skyloop::firmware
