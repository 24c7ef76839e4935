#include "run/fault/receiver_needs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/core/words.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "receiver/protocol/ubx_messages.hpp"
#include "run/fault/known_names.hpp"

namespace skyloop::inline run {
namespace {

using firmware::Abilities;
using firmware::BoardProfile;

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

// Whether one of the board's own lines has such a place: "{HDT." or "{heading_deg".
bool has_in_a_line(const UsedReceiver& receiver, std::initializer_list<std::string_view> places) {
    return std::ranges::any_of(receiver.board.style.lines, [&](const firmware::OwnLine& line) {
        return std::ranges::any_of(places,
                                   [&](std::string_view place) { return line.text.find(place) != std::string::npos; });
    });
}

// As a dialogue calls it: sentences by their formatters, PUBX,00 by its number, RTCM by its type.
std::string name_in_dialogue(UbxMessageId id) {
    std::string name(ubx_message_name(id).value_or("UBX-" + to_string(id)));
    if (id.message_class == firmware::class_pubx) std::replace(name.begin(), name.end(), '-', ',');
    if (id.message_class == firmware::class_rtcm) name = name.substr(0, name.find('.'));
    return name;
}

// Whole sentences among its texts, and TXT for the others.
void add_texts(const BoardProfile& board, std::vector<std::string>& names) {
    for (const firmware::OwnLine& line : board.style.lines)
        names.push_back(line.text.substr(1, line.text.find_first_of(",{") - 1));
    for (const auto* texts : {&board.identity.banner, &board.power.texts})
        for (const std::string& text : *texts)
            names.push_back(text.starts_with('$') ? text.substr(1, text.find(',') - 1) : "TXT");
}

std::vector<std::string> names_of_sent(const UsedReceiver& receiver, const Abilities& can) {
    std::vector<std::string> names(can.more.begin(), can.more.end());
    for (const firmware::OutputMessage& message : firmware::output_messages())
        if (sends_periodically(receiver, message.id)) names.push_back(name_in_dialogue(message.id));
    for (const UbxMessageId id : can.answers)
        names.push_back(name_in_dialogue(id));
    add_texts(receiver.board, names);
    return names;
}

}  // namespace

bool takes_commands(const UsedReceiver& receiver) { return firmware::abilities(receiver.board).takes_commands(); }

bool reports_heading(const UsedReceiver& receiver) {
    const Abilities can = firmware::abilities(receiver.board);
    // Whoever has a command line sends THS when it is asked, and knows itself whether it has a pair.
    const bool by_command = can.choice == Abilities::MessageChoice::command_line;
    if (can.heading || has_in_a_line(receiver, {"{heading_deg", "{HDT.", "{THS."})) return true;
    return !by_command && (has_sentence(receiver, "THS") || has_sentence(receiver, "HDT"));
}

bool reports_accuracies(const UsedReceiver& receiver) {
    return can<&Abilities::accuracies>(receiver) || has_sentence(receiver, "GST") || has_sentence(receiver, "GBS") ||
           has_in_a_line(receiver, {"_acc_m", "{acc_m", "{GST.", "{GBS."});
}

bool reports_weeks(const UsedReceiver& receiver) {
    return can<&Abilities::weeks>(receiver) || has_in_a_line(receiver, {"{week"});
}

bool reports_time(const UsedReceiver& receiver) {
    return can<&Abilities::time>(receiver) || !receiver.board.sentences.empty();
}

bool reports_calendar(const UsedReceiver& receiver) {
    return can<&Abilities::calendar>(receiver) || !receiver.board.sentences.empty();
}

bool solves_rtk(const UsedReceiver& receiver) {
    return can<&Abilities::corrections>(receiver) && receiver.board.corrections.rtk;
}

bool sends_rtcm(const firmware::BoardProfile& board) {
    return board.maker == firmware::MakerKind::sbf || board.maker == firmware::MakerKind::unicore ||
           board.maker == firmware::MakerKind::quectel ||
           std::any_of(board.messages.begin(), board.messages.end(),
                       [](const UbxMessageId& id) { return id.message_class == firmware::class_rtcm; });
}

bool reports_dead_reckoning(const UsedReceiver& receiver) {
    return receiver.board.timing.coasting.value() > 0 && can<&Abilities::dead_reckoning>(receiver);
}

bool has_texts_at_start(const UsedReceiver& receiver) { return !receiver.board.identity.banner.empty(); }

bool has_wired_uart1(const UsedReceiver& receiver) {
    return std::find(receiver.wired.begin(), receiver.wired.end(), firmware::PortId::uart1) != receiver.wired.end();
}

bool is_can_node(const UsedReceiver& receiver) { return receiver.board.maker == firmware::MakerKind::dronecan; }

bool sends_periodically(const UsedReceiver& receiver, UbxMessageId message) {
    using enum Abilities::MessageChoice;
    const BoardProfile& board = receiver.board;
    if (firmware::makes_nothing_of(message)) return false;
    const bool listed = firmware::sends(board, message);
    const bool sentence = message.message_class == firmware::class_nmea;
    if (is_can_node(receiver)) return false;  // a bus has messages of its own
    if (sentence && (listed || board.messages.empty()) && is_factory_sentence(board, message)) return true;
    const Abilities can = firmware::abilities(board);
    if (can.choice == command_line) return sentence && (listed || board.messages.empty());
    return can.choice == rates && listed;
}

bool sends_by_command_line(const UsedReceiver& receiver, UbxMessageId message) {
    return firmware::abilities(receiver.board).choice == Abilities::MessageChoice::command_line &&
           !is_factory_sentence(receiver.board, message);
}

bool can_track(const BoardProfile& board, Constellation constellation) {
    const auto known = firmware::abilities(board).constellations;
    return !known || std::find(known->begin(), known->end(), constellation) != known->end();
}

bool has_second_band(const BoardProfile& board) { return firmware::abilities(board).second_band.value_or(true); }

std::string why_never_sent(const UsedReceiver& receiver, std::string_view wanted) {
    const Abilities can = firmware::abilities(receiver.board);
    if (!can.own_prefix.empty() && upper_case(wanted).starts_with(can.own_prefix)) return {};
    const std::vector<std::string> names = names_of_sent(receiver, can);
    if (std::any_of(names.begin(), names.end(), [&](const auto& name) { return is_message_named(name, wanted); }))
        return {};
    return fmt::format("never sends {}", wanted);
}

}  // namespace skyloop::inline run
