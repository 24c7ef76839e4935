#include "firmware/messages/make_message.hpp"

#include "base/core/bytes.hpp"
#include "firmware/core/port_id.hpp"
#include "firmware/sentences/nmea_report.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/ubx_mon.hpp"

namespace skyloop::firmware {
namespace {

bool differs_by_port(UbxMessageId message) {
    return message.message_class == class_rtcm || message == MonComms::message_id;
}

}  // namespace

std::vector<Bytes> make_message(UbxMessageId message, const ReportContext& context) {
    switch (message.message_class) {
        case 0x01: {
            std::vector<Bytes> frames = make_satellite_message(message, context);
            return frames.empty() ? make_navigation_message(message, context) : frames;
        }
        case 0x02:
            return make_raw_message(message, context);
        case 0x0A:
        case 0x27:
            return make_monitor_message(message, context);
        case 0x0D:
            return make_navigation_message(message, context);
        case 0xF0:
        case 0xF1: {
            const NavigationState* told = told_state(message, context);
            if (told == nullptr) return {};
            return make_nmea_message(message, nmea_report({context.board, context.config, *told, {}, context.port}));
        }
        case 0xF5:
            return make_rtcm_message(message, context);
        default:
            return {};
    }
}

bool makes_nothing_of(UbxMessageId message) {
    // RXM-SPARTN, RXM-RLM, RXM-IMES, TIM-TM2, TIM-VRFY and LOG-INFO.
    constexpr std::array<UbxMessageId, 6> nothing{
        {{0x02, 0x33}, {0x02, 0x59}, {0x02, 0x61}, {0x0D, 0x03}, {0x0D, 0x06}, {0x21, 0x08}}};
    return std::find(nothing.begin(), nothing.end(), message) != nothing.end();
}

const std::vector<Bytes>& EpochMessages::of(UbxMessageId message, PortId port,
                                            std::span<const UbxMessageId> following) {
    const auto [entry, is_new] = made_.try_emplace(message);
    if (!is_new && !differs_by_port(message)) return entry->second;
    context_.port = port;
    context_.following = following;
    const bool sentence = message.message_class == class_nmea || message.message_class == class_pubx;
    if (!sentence || told_state(message, context_) != &context_.state)
        return entry->second = make_message(message, context_);
    if (!report_) report_.emplace(nmea_report(context_));
    return entry->second = make_nmea_message(message, *report_);
}

namespace {

// CFG-INFMSG has a bit for each level but that of the user, which always passes.
bool passes(std::uint64_t mask, int level) { return level == text_user || (mask >> level & 1) != 0; }

Bytes inf_frame(int level, const std::string& text) {
    const std::vector<char> characters(text.begin(), text.end());
    switch (level) {
        case text_error:
            return encode_frame(InfError{characters});
        case text_warning:
            return encode_frame(InfWarning{characters});
        case text_notice:
            return encode_frame(InfNotice{characters});
        case 3:
            return encode_frame(InfTest{characters});
        default:
            return encode_frame(InfDebug{characters});
    }
}

// MediaTek's and Airoha's receivers begin with sentences of their own instead of texts.
bool is_own_sentence(const std::string& text) { return text.starts_with('$'); }

}  // namespace

std::vector<Bytes> make_text_message(int level, const std::string& text, const ReportContext& context) {
    const auto& [board, config, state, ports, port, following] = context;
    std::vector<Bytes> out;
    if (level < 0 || (level > text_debug && level != text_user) || !config.port(port).on) return out;
    const PortConfig& out_of = config.port(port);
    const bool nmea = out_of.out.nmea;
    if (is_own_sentence(text)) {
        if (nmea) out.push_back(to_bytes(Sentence(text.substr(1)).finish()));
        return out;
    }
    if (nmea && passes(out_of.nmea_texts, level))
        out.push_back(to_bytes(encode(Txt{nmea_talker(board, config), 1, 1, level, text}, nmea_format(board, config))));
    const bool ubx = out_of.out.ubx && level <= text_debug;
    if (ubx && passes(out_of.ubx_texts, level)) out.push_back(inf_frame(level, text));
    return out;
}

}  // namespace skyloop::firmware
