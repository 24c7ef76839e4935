/// UBX messages of class CFG about what leaves the ports: INF, NMEA, USB.
///
/// Numbers are as on the wire. Layouts: u-blox M8 interface description (UBX-13003221), section 32.11.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "receiver/protocol/ubx_fields.hpp"

namespace skyloop {

/// One protocol of CFG-INF.
struct CfgInfItem {
    std::uint8_t protocol_id = 0;  ///< 0 UBX, 1 NMEA
    std::array<std::uint8_t, 3> reserved0{};
    std::array<std::uint8_t, 6> masks{};  ///< DDC, UART1, UART2, USB, SPI, reserved; bits: 0 error, 1 warning, 2 notice
};

/// CFG-INF: which texts go out, one or more protocols in one message.
struct CfgInf {
    static constexpr UbxMessageId message_id{0x06, 0x02};
    std::vector<CfgInfItem> protocols;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v.rest(m.protocols, 1, 255);
    }
};

/// What every form of CFG-NMEA begins with.
struct CfgNmeaCore {
    std::uint8_t filter = 0;        ///< bits: 0 posFilt, 1 mskPosFilt, 2 timeFilt, 3 dateFilt, 4 gpsOnly, 5 trackFilt
    std::uint8_t nmea_version = 0;  ///< 0x21 2.1, 0x23 2.3, 0x40 4.0, 0x41 4.10, 0x4B 4.11
    std::uint8_t num_sv = 0;        ///< listed satellites at most; 0 all
    std::uint8_t flags = 0;         ///< bits: 0 compat, 1 consider, 2 limit82, 3 highPrec
};

/// What came to it with u-blox 7.
struct CfgNmeaExtension {
    std::uint32_t gnss_to_filter = 0;  ///< bits: 0 GPS, 1 SBAS, 2 Galileo, 4 QZSS, 5 GLONASS, 6 BeiDou
    std::uint8_t sv_numbering = 0;     ///< 0 strict, 1 extended
    std::uint8_t main_talker_id = 0;   ///< 0 by system, 1 GP, 2 GL, 3 GN, 4 GA, 5 GB, 7 GQ
    std::uint8_t gsv_talker_id = 0;    ///< 0 by system, 1 as the main one
    std::uint8_t version = 0;          ///< 0 in the form of 12 bytes, 1 in that of 20
};

/// CFG-NMEA of u-blox 5 and 6, 4 bytes.
struct CfgNmeaShort {
    static constexpr UbxMessageId message_id{0x06, 0x17};
    CfgNmeaCore core;
};

/// CFG-NMEA of u-blox 7 (version 0), 12 bytes.
struct CfgNmeaV0 {
    static constexpr UbxMessageId message_id{0x06, 0x17};
    CfgNmeaCore core;
    CfgNmeaExtension extension;
};

/// CFG-NMEA from M8 on (version 1), 20 bytes.
struct CfgNmea {
    static constexpr UbxMessageId message_id{0x06, 0x17};
    CfgNmeaCore core;
    CfgNmeaExtension extension;
    std::array<std::uint8_t, 2> bds_talker_id{};  ///< two letters; zeros: as the standard says
    std::array<std::uint8_t, 6> reserved1{};
};

/// CFG-USB: how the receiver shows itself on USB.
struct CfgUsb {
    static constexpr UbxMessageId message_id{0x06, 0x1B};
    std::uint16_t vendor_id = 0;
    std::uint16_t product_id = 0;
    std::array<std::uint8_t, 4> reserved0{};
    std::uint16_t power_consumption = 0;  ///< mA
    std::uint16_t flags = 0;              ///< bits: 0 show again (a command), 1 has its own power
    std::array<std::uint8_t, 32> vendor_string{};
    std::array<std::uint8_t, 32> product_string{};
    std::array<std::uint8_t, 32> serial_number{};
};

}  // namespace skyloop
