#include "receiver/protocol/dronecan_listing.hpp"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "receiver/protocol/field_lister.hpp"

namespace skyloop::inline receiver {
namespace {

void put_head(const DronecanTransfer& transfer, DecodedMessage& message) {
    const auto number = [](unsigned value) { return DecodedValue{std::uint64_t{value}}; };
    message.id = fmt::format("{}", transfer.type_id);
    if (const DronecanType* type = find_dronecan_type(transfer.kind, transfer.type_id)) message.name = type->name;
    if (transfer.kind == DronecanKind::request) message.name += "-request";
    if (transfer.kind == DronecanKind::response) message.name += "-response";
    message.fields = {{"source", number(transfer.source)}};
    if (transfer.destination != 0) message.fields.push_back({"destination", number(transfer.destination)});
    message.fields.push_back({"transfer_id", number(transfer.transfer_id)});
}

}  // namespace

void list_dronecan(const DronecanTransfer& transfer, DecodedMessage& message) {
    put_head(transfer, message);
    const bool listed = KnownDronecanTypes::any([&]<class Message>() {
        if (Message::type.kind != transfer.kind || Message::type.id != transfer.type_id) return false;
        const auto found = decode_bits<Message>(transfer.payload);
        if (!found) return false;
        FieldLister lister;
        walk_fields(*found, lister);
        std::vector<DecodedField> fields = lister.take();
        message.fields.insert(message.fields.end(), std::make_move_iterator(fields.begin()),
                              std::make_move_iterator(fields.end()));
        return true;
    });
    if (!listed) message.payload = transfer.payload;
}

void list_can(const CanFrame& frame, DecodedMessage& message) {
    if (const auto whole = TransferReceiver().take(frame, {})) return list_dronecan(*whole, message);
    const auto head = dronecan_head(frame);
    if (head)
        put_head(*head, message);
    else
        message.id = fmt::format("0x{:X}", frame.id);
    message.payload.assign(frame.bytes().begin(), frame.bytes().end());
}

}  // namespace skyloop::inline receiver
