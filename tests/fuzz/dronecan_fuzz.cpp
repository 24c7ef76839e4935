// DroneCAN: any frames, and any bytes as the payload of every type; what is read must return as it was.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "receiver/protocol/dronecan_listing.hpp"
#include "receiver/protocol/dronecan_transfer.hpp"
#include "require.hpp"

namespace {

void check_dronecan_payload(skyloop::ByteSpan payload) {
    skyloop::KnownDronecanTypes::any([&]<class Message>() {
        const auto message = skyloop::decode_bits<Message>(payload);
        if (!message) return false;
        const skyloop::Bytes once = skyloop::encode_bits(*message);
        const auto again = skyloop::decode_bits<Message>(once);
        skyloop::require(again.has_value() && skyloop::encode_bits(*again) == once && once.size() == payload.size());
        return false;
    });
}

}  // namespace

// Frames of 13 bytes each: id, size, data.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const ByteSpan bytes(data, size);
    check_dronecan_payload(bytes);
    constexpr std::size_t piece = 13;
    TransferReceiver receiver;
    GpsTime now{};
    for (std::size_t at = 0; at + piece <= size; at += piece) {
        CanFrame frame;
        for (std::size_t i = 0; i < 4; ++i)
            frame.id |= std::uint32_t{bytes[at + i]} << (8 * i);
        frame.extended = (frame.id & 0x8000'0000U) == 0;
        frame.id &= frame.extended ? 0x1FFF'FFFFU : 0x7FFU;
        frame.size = static_cast<std::uint8_t>(bytes[at + 4] % 9);
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at + 5), frame.size, frame.data.begin());
        DecodedMessage message;
        list_can(frame, message);
        now += std::chrono::milliseconds(bytes[at + 4]);
        const auto transfer = receiver.take(frame, now);
        if (!transfer) continue;
        const DronecanType* type = find_dronecan_type(transfer->kind, transfer->type_id);
        require(type != nullptr);
        // A whole one goes into frames, and comes out of them.
        TransferReceiver fresh;
        std::optional<DronecanTransfer> again;
        for (const CanFrame& part : dronecan_frames(*transfer, type->signature))
            again = fresh.take(part, now);
        require(again == transfer);
    }
    return 0;
}
