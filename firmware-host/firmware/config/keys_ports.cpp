// Configuration items: ports and the protocols on them. Ids, names and types are those of the u-blox F9 interface
// description HPG 1.32, section 6.9; defaults those of the NEO-M9N's list (RECEIVER.md 3.5.1), 0 where it has none.
#include "firmware/config/key_tables.hpp"

namespace skyloop::firmware {
namespace {

using enum ConfigType;
constexpr ConfigKey ports_items[] = {
    {0x20510001, "CFG-I2C-ADDRESS", u1, 132},      {0x10510002, "CFG-I2C-EXTENDEDTIMEOUT", l, 0},
    {0x10510003, "CFG-I2C-ENABLED", l, 1},         {0x40520001, "CFG-UART1-BAUDRATE", u4, 38400},
    {0x20520002, "CFG-UART1-STOPBITS", e1, 1},     {0x20520003, "CFG-UART1-DATABITS", e1, 0},
    {0x20520004, "CFG-UART1-PARITY", e1, 0},       {0x10520005, "CFG-UART1-ENABLED", l, 1},
    {0x40530001, "CFG-UART2-BAUDRATE", u4, 38400}, {0x20530002, "CFG-UART2-STOPBITS", e1, 1},
    {0x20530003, "CFG-UART2-DATABITS", e1, 0},     {0x20530004, "CFG-UART2-PARITY", e1, 0},
    {0x10530005, "CFG-UART2-ENABLED", l, 1},       {0x20640001, "CFG-SPI-MAXFF", u1, 50},
    {0x10640002, "CFG-SPI-CPOLARITY", l, 0},       {0x10640003, "CFG-SPI-CPHASE", l, 0},
    {0x10640005, "CFG-SPI-EXTENDEDTIMEOUT", l, 0}, {0x10640006, "CFG-SPI-ENABLED", l, 0},
    {0x10650001, "CFG-USB-ENABLED", l, 1},         {0x10650002, "CFG-USB-SELFPOW", l, 1},
    {0x10710001, "CFG-I2CINPROT-UBX", l, 1},       {0x10710002, "CFG-I2CINPROT-NMEA", l, 1},
    {0x10710004, "CFG-I2CINPROT-RTCM3X", l, 1},    {0x10720001, "CFG-I2COUTPROT-UBX", l, 1},
    {0x10720002, "CFG-I2COUTPROT-NMEA", l, 1},     {0x10720004, "CFG-I2COUTPROT-RTCM3X", l, 0},
    {0x10730001, "CFG-UART1INPROT-UBX", l, 1},     {0x10730002, "CFG-UART1INPROT-NMEA", l, 1},
    {0x10730004, "CFG-UART1INPROT-RTCM3X", l, 1},  {0x10730005, "CFG-UART1INPROT-SPARTN", l, 0},
    {0x10740001, "CFG-UART1OUTPROT-UBX", l, 1},    {0x10740002, "CFG-UART1OUTPROT-NMEA", l, 1},
    {0x10740004, "CFG-UART1OUTPROT-RTCM3X", l, 0}, {0x10750001, "CFG-UART2INPROT-UBX", l, 1},
    {0x10750002, "CFG-UART2INPROT-NMEA", l, 1},    {0x10750004, "CFG-UART2INPROT-RTCM3X", l, 1},
    {0x10750005, "CFG-UART2INPROT-SPARTN", l, 0},  {0x10760001, "CFG-UART2OUTPROT-UBX", l, 1},
    {0x10760002, "CFG-UART2OUTPROT-NMEA", l, 1},   {0x10760004, "CFG-UART2OUTPROT-RTCM3X", l, 0},
    {0x10770001, "CFG-USBINPROT-UBX", l, 1},       {0x10770002, "CFG-USBINPROT-NMEA", l, 1},
    {0x10770004, "CFG-USBINPROT-RTCM3X", l, 1},    {0x10780001, "CFG-USBOUTPROT-UBX", l, 1},
    {0x10780002, "CFG-USBOUTPROT-NMEA", l, 1},     {0x10780004, "CFG-USBOUTPROT-RTCM3X", l, 0},
    {0x10790001, "CFG-SPIINPROT-UBX", l, 1},       {0x10790002, "CFG-SPIINPROT-NMEA", l, 1},
    {0x10790004, "CFG-SPIINPROT-RTCM3X", l, 1},    {0x107A0001, "CFG-SPIOUTPROT-UBX", l, 1},
    {0x107A0002, "CFG-SPIOUTPROT-NMEA", l, 1},     {0x107A0004, "CFG-SPIOUTPROT-RTCM3X", l, 0},
};

}  // namespace

std::span<const ConfigKey> ports_keys() { return ports_items; }

}  // namespace skyloop::firmware
