#include <algorithm>

#include "firmware/ublox/config/config_handler.hpp"
#include "firmware/ublox/config/signal_keys.hpp"
#include "firmware/ublox/ublox.hpp"

namespace skyloop::firmware {
namespace {

constexpr UbxMessageId mon_ver{0x0A, 0x04}, mon_hw{0x0A, 0x09}, mon_rf{0x0A, 0x38}, nav_relposned{0x01, 0x3C},
    sec_sig{0x27, 0x09};

bool has_item(const BoardProfile& board, std::uint32_t item) {
    return is_on_the_wire(board, item) && !board.absent_keys.contains(item);
}

bool lets_corrections_in(const BoardProfile& board) {
    return std::any_of(board.ports.begin(), board.ports.end(),
                       [&](PortId port) { return has_item(board, key::in_protocol(port, protocol_rtcm3)); });
}

bool has_second_band(const BoardProfile& board) {
    return std::any_of(signal_keys.begin(), signal_keys.end(), [&](const auto& key) {
        return key.signal.signal == second_signal(key.signal.constellation, board.second_band) &&
               has_item(board, key.enable);
    });
}

std::vector<UbxMessageId> answers_of(const BoardProfile& board) {
    std::vector<UbxMessageId> answers(board.polled.begin(), board.polled.end());
    for (const auto& [id, answer] : board.legacy)
        if (answer == LegacyAnswer::apply || answer == LegacyAnswer::ignore) answers.push_back(id);
    if (board.quirks.value_config == ValueConfigSupport::full) answers.push_back({0x06, 0x8B});  // CFG-VALGET
    return answers;
}

}  // namespace

Abilities ublox_abilities(const BoardProfile& board) {
    constexpr int first_with_spoofing_detection = 8;  // NAV-STATUS, flags2
    Abilities can{.choice = Abilities::MessageChoice::rates, .ubx = true};
    can.version = knows(board, mon_ver);
    can.hardware_monitor = knows(board, mon_hw) || knows(board, mon_rf);
    can.jamming = can.hardware_monitor || knows(board, sec_sig);
    can.spoofing = board.identity.generation >= first_with_spoofing_detection;
    can.heading = sends(board, nav_relposned);
    can.accuracies = can.weeks = can.time = can.calendar = true;
    can.corrections = lets_corrections_in(board);
    can.time_mode = has_item(board, key::tmode_mode);
    can.constellations.emplace();
    for (const SystemKeys& system : system_keys_of_signals)
        if (has_item(board, system.enable)) can.constellations->push_back(system.constellation);
    can.second_band = has_second_band(board);
    can.answers = answers_of(board);
    can.more = {"ACK-ACK", "ACK-NAK", "INF-ERROR", "INF-WARNING", "INF-NOTICE", "TXT", "MGA-ACK"};
    return can;
}

}  // namespace skyloop::firmware
