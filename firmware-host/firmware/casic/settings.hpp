/// What receivers with CASIC's chips can be set to, beside what all senders of sentences have.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/core/receiver_config.hpp"
#include "firmware/sentences/sentence_settings.hpp"
#include "receiver/protocol/casic_messages.hpp"

namespace skyloop::firmware {

/// Binary messages that are sent periodically, in the order in which they leave.
inline constexpr std::array<CasicMessageId, 7> casic_periodic{
    CasicNavDop::message_id,           CasicNavSol::message_id,        CasicNavPv::message_id,
    CasicNavTimeutc::message_id,       CasicGpsSatellites::message_id, CasicBeidouSatellites::message_id,
    CasicGlonassSatellites::message_id};

/// Keys of the settings of their own.
struct CasicKeys {
    static constexpr std::uint32_t sentence_version = 5000;  ///< as PCAS05 numbers them
    static constexpr std::uint32_t fix_mode = 5001, least_satellites = 5002, most_satellites = 5003, least_cn0 = 5004,
                                   least_elevation = 5005;  ///< as CFG-NAVX has them
    static constexpr std::uint32_t protocols(PortId port) { return 5020 + static_cast<std::uint32_t>(port); }
    /// Every how many epochs the text about the antenna comes.
    static constexpr std::uint32_t antenna_text(PortId port) { return 5040 + static_cast<std::uint32_t>(port); }
    /// @param message in casic_periodic
    static constexpr std::uint32_t rate(std::size_t message, PortId port) {
        return 5100 + static_cast<std::uint32_t>(message * port_count) + static_cast<std::uint32_t>(port);
    }
};

/// PCAS05: 2 is NMEA 4.10, 5 NMEA 4.0 with BeiDou, 9 NMEA 2.2 of GPS alone.
inline constexpr std::uint64_t casic_nmea_4_10 = 2, casic_nmea_4_0 = 5, casic_nmea_2_2 = 9;
/// Bits of CFG-PRT.
inline constexpr std::uint64_t casic_binary_in = 0x01, casic_text_in = 0x02, casic_binary_out = 0x10,
                               casic_text_out = 0x20, casic_all_protocols = 0x33;

OwnSettings casic_settings(const BoardProfile& board);

/// Systems by the bits of PCAS04 and CFG-NAVX: 0 GPS, 1 BeiDou, 2 GLONASS. Changes nothing, and says false, where the
/// board could not go on with them.
bool set_casic_systems(SentenceSettings& store, std::uint64_t bits);
std::uint64_t casic_systems(const SentenceSettings& store);
/// Motion: 0 portable, 1 stationary, 2 on foot, 3 car, 4 ship, 5 to 7 airborne. False for another number.
bool set_casic_motion(SentenceSettings& store, std::uint64_t number);
std::uint64_t casic_motion(const SentenceSettings& store);
/// A speed that the port can have comes in force. False for another.
bool set_casic_speed(SentenceSettings& store, const BoardProfile& board, PortId port, std::uint64_t baud);
/// 100, 200, 250, 500 or 1000 ms, no faster than the board.
bool set_casic_interval(SentenceSettings& store, const BoardProfile& board, std::uint64_t period_ms);
/// What is in force is in flash from then on.
void save_casic(SentenceSettings& store);

}  // namespace skyloop::firmware
