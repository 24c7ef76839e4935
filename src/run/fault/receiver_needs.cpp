#include "run/fault/receiver_needs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/core/words.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "firmware/ublox/config/signal_keys.hpp"
#include "receiver/protocol/ubx_messages.hpp"
#include "run/fault/known_names.hpp"

namespace skyloop::inline run {
namespace {

using firmware::BoardProfile;
using firmware::MakerKind;

constexpr UbxMessageId version_message{0x0A, 0x04}, mon_hw{0x0A, 0x09}, mon_rf{0x0A, 0x38}, nav_relposned{0x01, 0x3C},
    sec_sig{0x27, 0x09};

bool is_ublox(const BoardProfile& board) { return board.maker == MakerKind::ublox; }
bool has_item(const BoardProfile& board, std::uint32_t item) {
    return firmware::is_on_the_wire(board, item) && !board.absent_keys.contains(item);
}
bool is_septentrio(const BoardProfile& board) { return board.maker == MakerKind::sbf; }

bool has_sentence(const UsedReceiver& receiver, std::string_view name) {
    const firmware::OutputMessage* message = firmware::find_output_message(name);
    return message != nullptr && sends_periodically(receiver, message->id);
}

// Sent from the factory on, or as the scenario says.
bool is_factory_sentence(const BoardProfile& board, UbxMessageId message) {
    return std::any_of(board.sentences.begin(), board.sentences.end(), [&](const firmware::SentenceRate& sentence) {
        const auto name = firmware::nmea_sentence_names[static_cast<std::size_t>(sentence.sentence)];
        return sentence.every_epochs > 0 && firmware::find_output_message(name)->id == message;
    });
}

// As a dialogue calls it: sentences by their formatters, PUBX,00 by its number, RTCM by its type.
std::string name_in_dialogue(UbxMessageId id) {
    std::string name(ubx_message_name(id).value_or("UBX-" + to_string(id)));
    if (id.message_class == firmware::class_pubx) std::replace(name.begin(), name.end(), '-', ',');
    if (id.message_class == firmware::class_rtcm) name = name.substr(0, name.find('.'));
    return name;
}

void add_answers_of_ublox(const BoardProfile& board, std::vector<std::string>& names) {
    for (const char* name : {"ACK-ACK", "ACK-NAK", "INF-ERROR", "INF-WARNING", "INF-NOTICE", "TXT", "MGA-ACK"})
        names.emplace_back(name);
    for (const UbxMessageId id : board.polled)
        names.push_back(name_in_dialogue(id));
    for (const auto& [id, answer] : board.legacy)
        if (answer == firmware::LegacyAnswer::apply || answer == firmware::LegacyAnswer::ignore)
            names.push_back(name_in_dialogue(id));
    if (board.quirks.value_config == firmware::ValueConfigSupport::full) names.emplace_back("CFG-VALGET");
}

// Whole sentences among its texts, and TXT for the others.
void add_texts(const BoardProfile& board, std::vector<std::string>& names) {
    for (const auto* texts : {&board.identity.banner, &board.power.texts})
        for (const std::string& text : *texts)
            names.push_back(text.starts_with('$') ? text.substr(1, text.find(',') - 1) : "TXT");
}

std::vector<std::string> names_of_sent(const UsedReceiver& receiver) {
    const BoardProfile& board = receiver.board;
    std::vector<std::string> names;
    for (const firmware::OutputMessage& message : firmware::output_messages())
        if (sends_periodically(receiver, message.id)) names.push_back(name_in_dialogue(message.id));
    add_texts(board, names);
    switch (board.maker) {
        case MakerKind::ublox:
            add_answers_of_ublox(board, names);
            break;
        case MakerKind::sbf:
            names.emplace_back("SBF");
            break;
        case MakerKind::msp:
        case MakerKind::msp_v1:
            names.emplace_back("MSP");
            break;
        case MakerKind::mavlink:
            names.emplace_back("MAVLink");
            break;
        default:
            break;
    }
    return names;
}

// Answers and reports of which the maker has more than are listed anywhere.
bool may_be_own(const BoardProfile& board, std::string_view wanted) {
    switch (board.maker) {
        case MakerKind::mtk:
            return wanted.starts_with("PMTK");
        case MakerKind::airoha:
            return wanted.starts_with("PAIR");
        case MakerKind::sbf:
            return wanted.starts_with("RTCM-");
        default:
            return false;
    }
}

}  // namespace

bool takes_commands(const UsedReceiver& receiver) {
    const MakerKind kind = receiver.board.maker;
    return kind == MakerKind::ublox || kind == MakerKind::mtk || kind == MakerKind::airoha || kind == MakerKind::sbf;
}

bool answers_version(const UsedReceiver& receiver) {
    return is_ublox(receiver.board) && firmware::knows(receiver.board, version_message);
}

bool has_hardware_monitor(const UsedReceiver& receiver) {
    return is_ublox(receiver.board) &&
           (firmware::knows(receiver.board, mon_hw) || firmware::knows(receiver.board, mon_rf));
}

bool reports_jamming(const UsedReceiver& receiver) {
    return is_septentrio(receiver.board) || has_hardware_monitor(receiver) ||
           (is_ublox(receiver.board) && firmware::knows(receiver.board, sec_sig));
}

// u-blox from the M8 on (NAV-STATUS flags2, spoofDetState), and Septentrio in RFStatus.
bool reports_spoofing(const UsedReceiver& receiver) {
    constexpr int first_with_detection = 8;
    return is_septentrio(receiver.board) ||
           (is_ublox(receiver.board) && receiver.board.identity.generation >= first_with_detection);
}

bool reports_heading(const UsedReceiver& receiver) {
    switch (receiver.board.maker) {
        case MakerKind::ublox:
            return firmware::sends(receiver.board, nav_relposned) || has_sentence(receiver, "THS");
        case MakerKind::msp:
        case MakerKind::mavlink:
        case MakerKind::sbf:
            return true;
        default:
            return has_sentence(receiver, "THS");
    }
}

bool reports_accuracies(const UsedReceiver& receiver) {
    switch (receiver.board.maker) {
        case MakerKind::mute:
        case MakerKind::mtk:
        case MakerKind::airoha:
            return has_sentence(receiver, "GST") || has_sentence(receiver, "GBS");
        default:
            return receiver.board.maker != MakerKind::msp_v1;
    }
}

bool reports_time(const UsedReceiver& receiver) {
    return receiver.board.maker != MakerKind::msp_v1 || !receiver.board.sentences.empty();
}

bool reports_calendar(const UsedReceiver& receiver) {
    return reports_time(receiver) && receiver.board.maker != MakerKind::mavlink;
}

bool reports_weeks(const UsedReceiver& receiver) {
    const MakerKind kind = receiver.board.maker;
    return kind == MakerKind::ublox || kind == MakerKind::sbf || kind == MakerKind::msp || kind == MakerKind::mavlink;
}

bool takes_corrections(const UsedReceiver& receiver) {
    const BoardProfile& board = receiver.board;
    const auto lets_in = [&](firmware::PortId port) {
        return has_item(board, firmware::key::in_protocol(port, firmware::protocol_rtcm3));
    };
    return is_septentrio(board) || (is_ublox(board) && std::any_of(board.ports.begin(), board.ports.end(), lets_in));
}

bool solves_rtk(const UsedReceiver& receiver) { return takes_corrections(receiver) && receiver.board.corrections.rtk; }

bool reports_dead_reckoning(const UsedReceiver& receiver) {
    const MakerKind kind = receiver.board.maker;
    return receiver.board.timing.coasting.value() > 0 && kind != MakerKind::msp && kind != MakerKind::msp_v1 &&
           kind != MakerKind::mavlink && kind != MakerKind::sbf;
}

bool has_time_mode(const UsedReceiver& receiver) {
    return is_ublox(receiver.board) && has_item(receiver.board, firmware::key::tmode_mode);
}

bool has_texts_at_start(const UsedReceiver& receiver) { return !receiver.board.identity.banner.empty(); }

bool has_wired_uart1(const UsedReceiver& receiver) {
    return std::find(receiver.wired.begin(), receiver.wired.end(), firmware::PortId::uart1) != receiver.wired.end();
}

bool sends_periodically(const UsedReceiver& receiver, UbxMessageId message) {
    const BoardProfile& board = receiver.board;
    if (firmware::makes_nothing_of(message)) return false;
    const bool listed = firmware::sends(board, message);
    const bool sentence = message.message_class == firmware::class_nmea;
    if (sentence && (listed || board.messages.empty()) && is_factory_sentence(board, message)) return true;
    if (is_septentrio(board)) return sentence && (listed || board.messages.empty());
    return takes_commands(receiver) && listed;
}

bool sends_by_command_line(const UsedReceiver& receiver, UbxMessageId message) {
    return is_septentrio(receiver.board) && !is_factory_sentence(receiver.board, message);
}

bool can_track(const BoardProfile& board, Constellation constellation) {
    if (!is_ublox(board)) return true;
    for (const firmware::SystemKeys& system : firmware::system_keys_of_signals)
        if (system.constellation == constellation) return has_item(board, system.enable);
    return false;
}

bool has_second_band(const BoardProfile& board) {
    if (!is_ublox(board)) return true;
    return std::any_of(firmware::signal_keys.begin(), firmware::signal_keys.end(), [&](const auto& key) {
        return key.signal.signal == second_signal(key.signal.constellation, board.second_band) &&
               has_item(board, key.enable);
    });
}

std::string why_never_sent(const UsedReceiver& receiver, std::string_view wanted) {
    if (may_be_own(receiver.board, upper_case(wanted))) return {};
    const std::vector<std::string> names = names_of_sent(receiver);
    if (std::any_of(names.begin(), names.end(), [&](const auto& name) { return is_message_named(name, wanted); }))
        return {};
    return fmt::format("never sends {}", wanted);
}

}  // namespace skyloop::inline run
