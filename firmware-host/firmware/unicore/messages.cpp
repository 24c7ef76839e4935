// The logs of an epoch as bytes.
#include <optional>
#include <string>

#include "firmware/core/port_id.hpp"
#include "firmware/messages/station_messages.hpp"
#include "firmware/unicore/logs.hpp"
#include "receiver/protocol/unicore_frame.hpp"

namespace skyloop::firmware {
namespace {

template <class Message>
std::vector<Bytes> log_of(const Message& message, const UnicoreLogKind& kind, const UnicoreHeader& header) {
    if (kind.form == UnicoreForm::text) {
        const std::string name = std::string(Message::message_name) + "A";
        return {to_bytes(unicore_log_line(name, header, unicore_body(message)))};
    }
    if constexpr (UnicoreBinaryLog<Message>)
        return {encode_unicore_frame(Message::message_id, header, encode_payload(message))};
    else
        return {};
}

}  // namespace

std::vector<Bytes> unicore_messages(const UnicoreLogKind& kind, EpochMessages& made, PortId port,
                                    std::span<const UbxMessageId> following, std::optional<GpsTime> asked) {
    if (kind.form == UnicoreForm::sentence) return made.of(kind.id, port, {});
    if (kind.form == UnicoreForm::rtcm) return make_station_message(kind.id, made, port, following);
    const ReportContext context = made.context(port);
    const UnicoreHeader header = unicore_header(context, asked);
    if (kind.name == UnicoreBestNav::message_name) return log_of(unicore_best_nav(context), kind, header);
    if (kind.name == UnicoreRecTime::message_name) return log_of(unicore_rec_time(context), kind, header);
    if (kind.name == UnicoreAgric::message_name) return log_of(unicore_agric(context), kind, header);
    if (kind.name == UnicorePvtsln::message_name) return log_of(unicore_pvtsln(context), kind, header);
    if (kind.name == UnicoreHeading::message_name) return log_of(unicore_heading(context), kind, header);
    if (kind.name == UnicoreObsVm::message_name) return log_of(unicore_obs_vm(context), kind, header);
    const bool text = kind.form == UnicoreForm::text;
    return log_of(unicore_version(context.board, text), kind, header);
}

}  // namespace skyloop::firmware
