/// Receivers on a CAN bus: nodes of DroneCAN.
///
/// A port of such a receiver carries frames as lines of SLCAN, both ways; what is plugged in makes of them what its bus
/// has (wire/transport/can_transport.hpp).
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "base/core/can_frame.hpp"
#include "firmware/dronecan/node_id_client.hpp"
#include "firmware/sentences/sentence_maker.hpp"
#include "receiver/protocol/dronecan_transfer.hpp"

namespace skyloop::firmware {

/// What a node sends, transfer by transfer, as lines of SLCAN. State: the transfer ids of the next ones.
class NodeOutput {
public:
    /// A message, or a request's answer. @param id of the node
    template <class Message>
    Bytes broadcast(std::uint8_t id, const Message& message) {
        return send({Message::type.kind, Message::type.id, priority_low, id, 0, 0, encode_bits(message)},
                    Message::type.signature);
    }
    template <class Message>
    Bytes respond(const DronecanTransfer& request, const Message& message) {
        return lines({Message::type.kind, Message::type.id, request.priority, request.destination, request.source,
                      request.transfer_id, encode_bits(message)},
                     Message::type.signature);
    }
    static Bytes lines(const DronecanTransfer& transfer, std::uint64_t signature);

private:
    static constexpr std::uint8_t priority_low = 24;
    Bytes send(DronecanTransfer transfer, std::uint64_t signature);

    std::map<std::uint16_t, std::uint8_t> next_ids_;  ///< by type
};

/// State: the settings, the node's id and since when it runs, transfers that are on their way in, transfer ids.
class DronecanMaker : public SentenceMaker {
public:
    DronecanMaker(const BoardProfile& board, const ReceiverOptions& options);

    [[nodiscard]] const ReceiverConfig& config() const override;
    /// A piece is a whole transfer in the lines of its frames, or a frame of RTCM 3 that transfers have brought.
    std::vector<StreamPiece> cut(PortUnit& unit, ByteSpan bytes, GpsTime now) override;
    [[nodiscard]] bool has_frames() const override { return false; }
    CommandOutcome receive(const StreamPiece& piece, const Situation& asked) override;
    void follow(const NavigationState&, GpsTime now) override { leaves_at_ = now; }
    DueMessages due(PortId port, EpochMessages& made, const FirmwareFaults& faults) override;
    void begin(GpsTime awake) override;
    [[nodiscard]] std::optional<GpsTime> acts_at() const override;
    std::vector<PortMessage> act(GpsTime now, const FirmwareFaults& faults) override;

private:
    [[nodiscard]] DronecanNodeStatus status(GpsTime now) const;
    [[nodiscard]] DronecanGetNodeInfoResponse info(GpsTime now) const;
    CommandOutcome answer(const DronecanTransfer& request, const Situation& asked);
    void answer_info(const DronecanTransfer& request, const Situation& asked, CommandOutcome& outcome);
    void answer_opcode(const DronecanTransfer& request, CommandOutcome& outcome);
    void answer_restart(const DronecanTransfer& request, CommandOutcome& outcome);

    NodeUniqueId unique_id_;
    NodeIdClient ids_;
    NodeOutput output_, double_output_;  ///< of the other node with the same id, where there is one
    std::map<PortId, SlcanLines> lines_;
    TransferReceiver transfers_;
    GpsTime began_{}, leaves_at_{};
    std::optional<GpsTime> status_at_;
    mutable ReceiverConfig config_;
    mutable std::optional<std::uint64_t> config_revision_;
};

std::unique_ptr<Maker> make_dronecan(const BoardProfile& board, const ReceiverOptions& options);
Abilities dronecan_abilities(const BoardProfile& board);

}  // namespace skyloop::firmware
