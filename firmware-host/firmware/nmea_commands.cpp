// PUBX 00, 03, 04, 40 and 41 and the standard polls (RECEIVER.md 5.7).
#include "firmware/nmea_commands.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/core/number_text.hpp"
#include "firmware/board_profile.hpp"
#include "firmware/config/config_handler.hpp"
#include "firmware/config/legacy_keys.hpp"
#include "firmware/config/signal_keys.hpp"
#include "firmware/messages/nmea_report.hpp"
#include "firmware/port_id.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::uint32_t rtcm3_protocol = 4;
// CFG-SBAS-USE_DIFFCORR (F9 interface description HPG 1.32).
constexpr std::uint32_t sbas_corrections = 0x1036'0004;

std::uint32_t enable_key(Constellation constellation) {
    for (const SystemKeys& system : system_keys_of_signals)
        if (system.constellation == constellation) return system.enable;
    return 0;
}

}  // namespace

CommandOutcome execute_sentence(const SentenceView& sentence, const BoardProfile& board, ConfigStore& store,
                                PortId from) {
    switch (board.personality) {
        case Personality::mute:
        case Personality::msp:
        case Personality::msp_v1:
        case Personality::mavlink:
        case Personality::sbf:
            return {};
        case Personality::ublox:
            return execute_ublox(sentence, board, store, from);
        case Personality::mtk:
            return execute_pmtk(sentence, board, store, from);
        case Personality::airoha:
            return execute_pair(sentence, board, store, from);
    }
    return {};
}

std::optional<int> NumberedCommand::argument(std::size_t i) const { return number_in<int>(sentence.field(i)); }

void NumberedCommand::answer(const std::string& body) { outcome.answers.push_back(to_bytes(Sentence(body).finish())); }

std::optional<int> NumberedCommand::argument_within(std::size_t i, int least, int most) const {
    const auto value = argument(i);
    return value && *value >= least && *value <= most ? value : std::nullopt;
}

bool NumberedCommand::set_fix_interval(ConfigLayers layers, int period) {
    const int least =
        std::max(board.least_measurement_period_ms, static_cast<int>(std::ceil(1000.0 / board.max_rate_hz - 1e-6)));
    if (period < least || !is_in_range(board, key::rate_meas, static_cast<std::uint64_t>(period))) return false;
    store.set(layers, key::rate_meas, static_cast<std::uint64_t>(period));
    store.set(layers, key::rate_nav, 1);
    return true;
}

std::uint64_t NumberedCommand::fix_interval() const {
    return store.value(key::rate_meas) * std::max<std::uint64_t>(1, store.value(key::rate_nav));
}

std::optional<std::uint32_t> NumberedCommand::sentence_item(std::string_view name) const {
    const OutputMessage* message = find_output_message(name);
    return message == nullptr ? std::nullopt : rate_key(message->id, from);
}

std::vector<Bytes> version_answers(const BoardProfile& board, std::string_view prefix) {
    std::vector<Bytes> answers;
    for (const std::string_view answer : board.identity.version_answers)
        if (answer.starts_with('$') && answer.substr(1).starts_with(prefix))
            answers.push_back(to_bytes(Sentence(answer.substr(1)).finish()));
    return answers;
}

AidingSource correction_source(const ConfigStore& store, PortId from) {
    if (store.flag(sbas_corrections) && store.flag(enable_key(Constellation::sbas))) return AidingSource::sbas;
    return store.flag(key::in_protocol(from, rtcm3_protocol)) ? AidingSource::rtcm : AidingSource::none;
}

void set_correction_source(ConfigStore& store, PortId from, AidingSource source) {
    constexpr ConfigLayers layers = in_ram | in_battery;
    store.set(layers, sbas_corrections, source == AidingSource::sbas);
    store.set(layers, key::in_protocol(from, rtcm3_protocol), source == AidingSource::rtcm);
    if (source == AidingSource::sbas) store.set(layers, enable_key(Constellation::sbas), 1);
}

bool set_systems(const BoardProfile& board, ConfigStore& store, ConfigLayers layers,
                 const std::vector<std::pair<Constellation, bool>>& wanted) {
    ConfigValues after = store.values(ConfigLayer::ram);
    for (const auto& [constellation, on] : wanted)
        if (const auto item = after.find(enable_key(constellation)); item != after.end())
            item->second = on;
        else if (on)
            return false;
    if (!is_consistent(board, after)) return false;
    for (const auto& [constellation, on] : wanted)
        store.set(layers, enable_key(constellation), on);
    return true;
}

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
    for (std::size_t at = first; at < std::min(first + port_count, sentence.fields.size()); ++at) {
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
    if (!number || *number < 0 || *number >= static_cast<int>(port_count) || !in || !out) return;
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

// What M8 says to a maker's sentence that it does not know: a warning.
std::vector<Bytes> unknown_sentence_notice(const SentenceView& sentence, const BoardProfile& board,
                                           const ConfigStore& store, PortId from) {
    constexpr int warning = 1;
    constexpr std::size_t shown = 4;
    const bool passes =
        store.flag(key::out_protocol(from, protocol_nmea)) && (store.value(key::inf_nmea(from)) >> warning & 1) != 0;
    if (!board.quirks.answers_unknown_nmea || !passes) return {};
    const std::string text = std::string(sentence.address.substr(0, shown)) + " inv format";
    return {to_bytes(encode(Txt{nmea_talker(board, store), 1, 1, warning, text}, nmea_format(board, store)))};
}

}  // namespace

CommandOutcome execute_ublox(const SentenceView& sentence, const BoardProfile& board, ConfigStore& store, PortId from) {
    CommandOutcome outcome;
    if (is_standard_poll(sentence)) {
        const OutputMessage* message = find_output_message(sentence.field(0));
        if (message != nullptr && message->id.message_class == class_nmea && sends_message(board, message->id))
            outcome.polled.push_back(message->id);
    } else if (sentence.address == "PUBX") {
        outcome.polled = asked_by_pubx(sentence);
        if (sentence.field(0) == "40") set_pubx_rates(sentence, board, store);
        if (sentence.field(0) == "41") set_port_by_pubx(sentence, board, store);
    } else if (sentence.address.starts_with('P')) {
        outcome.answers = unknown_sentence_notice(sentence, board, store, from);
    }
    return outcome;
}

}  // namespace skyloop::firmware
