#include "firmware/messages/make_message.hpp"

#include "firmware/message_class.hpp"
#include "receiver/protocol/ubx_ports.hpp"

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
        case 0xF1:
            return make_nmea_message(message, nmea_report(context));
        case 0xF5:
            return make_rtcm_message(message, context);
        default:
            return {};
    }
}

const std::vector<Bytes>& EpochMessages::of(UbxMessageId message, PortId port,
                                            std::span<const UbxMessageId> following) {
    const auto [entry, is_new] = made_.try_emplace(message);
    if (!is_new && !differs_by_port(message)) return entry->second;
    context_.port = port;
    context_.following = following;
    if (message.message_class != class_nmea && message.message_class != class_pubx)
        return entry->second = make_message(message, context_);
    if (!report_) report_.emplace(nmea_report(context_));
    return entry->second = make_nmea_message(message, *report_);
}

}  // namespace skyloop::firmware
