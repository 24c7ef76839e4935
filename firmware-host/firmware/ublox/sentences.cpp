// PUBX 00, 03, 04, 40 and 41 and the standard polls (u-blox M8 interface description, PUBX messages).
#include <algorithm>
#include <vector>

#include "base/core/number_text.hpp"
#include "firmware/ublox/config/legacy_keys.hpp"
#include "firmware/ublox/ublox.hpp"

namespace skyloop::firmware {
namespace {

bool pubx_port_exists(const BoardProfile& board, PortId port) {
    return std::ranges::find(board.ports, port) != board.ports.end();
}

// Whether the board can send the message; one that lists nothing can send all.
bool sends_message(const BoardProfile& board, UbxMessageId message) {
    return board.messages.empty() || knows(board, message);
}

// PUBX,40,XXX,i2c,uart1,uart2,usb,spi,0: every how many epochs a sentence is sent on each port. Many programs for
// microcontrollers and balloons end after USB, as in "$PUBX,40,GLL,0,0,0,0*5C", and a receiver obeys; ports that are
// not named stay as they are.
void set_pubx_rates(const SentenceView& sentence, const BoardProfile& board, ConfigStore& store) {
    constexpr int most = 255;
    constexpr std::size_t first = 2, fewest_ports = 4;
    const OutputMessage* message = find_output_message(sentence.field(1));
    if (message == nullptr || message->id.message_class != class_nmea || !sends_message(board, message->id)) return;
    if (sentence.fields.size() < first + fewest_ports) return;
    std::vector<int> rates;
    for (std::size_t at = first; at < std::min(first + ublox_port_count, sentence.fields.size()); ++at) {
        const auto rate = number_in<int>(sentence.field(at));
        if (!rate || *rate < 0 || *rate > most) return;
        rates.push_back(*rate);
    }
    for (std::size_t i = 0; i < rates.size(); ++i)
        if (const auto item = rate_key(message->id, static_cast<PortId>(i)))
            store.set(in_ram, *item, static_cast<std::uint64_t>(rates[i]));
}

std::optional<unsigned> hexadecimal_mask(std::string_view field) {
    return field.size() <= 4 ? hexadecimal_number_in<unsigned>(field) : std::nullopt;
}

// The bits of CFG-PRT: 0 UBX, 1 NMEA, 5 RTCM3.
void set_pubx_protocols(ConfigStore& store, PortId port, unsigned mask, bool in) {
    constexpr unsigned ubx_bit = 1, nmea_bit = 2, rtcm3_bit = 0x20;
    const auto item = [&](std::uint32_t protocol) {
        return in ? key::in_protocol(port, protocol) : key::out_protocol(port, protocol);
    };
    store.set(in_ram, item(protocol_ubx), (mask & ubx_bit) != 0);
    store.set(in_ram, item(protocol_nmea), (mask & nmea_bit) != 0);
    store.set(in_ram, item(protocol_rtcm3), (mask & rtcm3_bit) != 0);
}

// PUBX,41,port,inProto,outProto,baud,autobaud: like CFG-PRT. What is not understood changes nothing.
void set_port_by_pubx(const SentenceView& sentence, const BoardProfile& board, ConfigStore& store) {
    const auto number = number_in<int>(sentence.field(1));
    const auto in = hexadecimal_mask(sentence.field(2)), out = hexadecimal_mask(sentence.field(3));
    const auto baud = number_in<int>(sentence.field(4));
    if (!number || *number < 0 || *number >= static_cast<int>(ublox_port_count) || !in || !out) return;
    const auto port = static_cast<PortId>(*number);
    if (!pubx_port_exists(board, port)) return;
    if (is_uart(port)) {
        const std::uint32_t item = port == PortId::uart1 ? key::uart1_baudrate : key::uart2_baudrate;
        if (!baud || *baud <= 0 || !is_in_range(board, item, static_cast<std::uint64_t>(*baud))) return;
        store.set(in_ram, item, static_cast<std::uint64_t>(*baud));
    }
    set_pubx_protocols(store, port, *in, true);
    constexpr unsigned bit_of_rtcm2 = 2;
    store.set(in_ram, legacy_key::rtcm2_in(port), *in >> bit_of_rtcm2 & 1);
    set_pubx_protocols(store, port, *out, false);
}

// PUBX,00 and the like without more ask for that sentence.
std::vector<UbxMessageId> asked_by_pubx(const SentenceView& sentence) {
    const auto number = number_in<int>(sentence.field(0));
    if (sentence.fields.size() != 1 || !number || (*number != 0 && *number != 3 && *number != 4)) return {};
    return {{class_pubx, static_cast<std::uint8_t>(*number)}};
}

// "EIGPQ,RMC" and the like, from whatever talker.
bool is_standard_poll(const SentenceView& sentence) {
    constexpr std::string_view formatters[] = {"GPQ", "GNQ", "GLQ", "GBQ", "GAQ", "GQQ"};
    return sentence.address.size() == 5 && !sentence.address.starts_with('P') &&
           std::ranges::find(formatters, sentence.formatter()) != std::end(formatters);
}

}  // namespace

SentenceOutcome execute_ublox(const SentenceView& sentence, const BoardProfile& board, ConfigStore& store) {
    SentenceOutcome outcome;
    if (is_standard_poll(sentence)) {
        const OutputMessage* message = find_output_message(sentence.field(0));
        if (message != nullptr && message->id.message_class == class_nmea && sends_message(board, message->id))
            outcome.polled.push_back(message->id);
    } else if (sentence.address == "PUBX") {
        outcome.polled = asked_by_pubx(sentence);
        if (sentence.field(0) == "40") set_pubx_rates(sentence, board, store);
        if (sentence.field(0) == "41") set_port_by_pubx(sentence, board, store);
    } else {
        outcome.unknown = sentence.address.starts_with('P');
    }
    return outcome;
}

}  // namespace skyloop::firmware
