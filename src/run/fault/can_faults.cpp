// What goes wrong on a CAN bus, and with a node of it.
#include <array>

#include "detail/fault_catalogue.hpp"
#include "detail/wire_fault.hpp"
#include "firmware/core/firmware_faults.hpp"

namespace skyloop::inline run {
namespace {

Result<Fault> make_node_silent(const Parameters&, const FaultContext&) {
    return fault_of<&Fault::firmware>(
        [](firmware::FirmwareFaults& faults, const FaultMoment&) { faults.no_node_status = true; });
}

Result<Fault> make_node_id_collision(const Parameters&, const FaultContext&) {
    return fault_of<&Fault::firmware>(
        [](firmware::FirmwareFaults& faults, const FaultMoment&) { faults.shares_node_id = true; });
}

// A controller that is off the bus neither sends nor receives; its receiver goes on.
Result<Fault> make_can_bus_off(const Parameters&, const FaultContext&) {
    return fault_of<&Fault::wire>([](WireConditions& wire, const FaultMoment& moment) {
        if (moment.strength > 0) wire.to_client.dead = wire.to_receiver.dead = true;
    });
}

constexpr ParameterSpec frame_direction =
    word_parameter("direction", "to_client", wire_directions, "which frames: those of the node, those to it, or both");

template <double WireDirection::*which>
Result<Fault> of_frames(const Parameters& parameters, const FaultContext&) {
    return worsened(parameters,
                    [p = parameters.number("probability")](WireDirection& direction, const FaultMoment& moment) {
                        combine(direction.*which, p * moment.strength);
                    });
}

constexpr auto node_kinds = without_strength(std::to_array<FaultKind>({
    FaultKind{"node_silent",
              "The node sends no NodeStatus, so that others count it as lost after 3 s; its other messages and its "
              "answers go on. receiver_silent ends all of it.",
              "Firmware that hangs in one of its tasks.",
              {},
              make_node_silent}
        .that_needs(can_node),
    FaultKind{"node_id_collision",
              "Another node of the bus has the same node id: it sends a NodeStatus with another uptime, and answers "
              "GetNodeInfo, too, with another unique id.",
              "Two nodes with the same fixed id, or a server of ids whose database was erased.",
              {},
              make_node_id_collision}
        .that_needs(can_node),
}));

constexpr auto bus_kinds = without_strength(std::to_array<FaultKind>({
    FaultKind{"can_bus_off",
              "The node's CAN controller is off the bus: nothing of it is sent or received; its receiver goes on.",
              "A bus without its terminating resistors, a short, or a node of another bit rate: after 255 errors a "
              "controller leaves the bus.",
              {},
              make_can_bus_off}
        .that_needs(can_node),
}));

constexpr auto frame_kinds = std::to_array<FaultKind>({
    FaultKind{"lost_frames",
              "Single frames are missing, and with one of them the whole transfer.",
              "A bus that is full, and buffers of a controller or an adapter that overflow.",
              {number_parameter("probability", 0.01, 0, 1, "of each frame to be lost"), frame_direction},
              of_frames<&WireDirection::message_loss>}
        .that_needs(can_node),
    FaultKind{"reordered_frames",
              "A frame comes after the one that followed it: a transfer whose frames change places is lost.",
              "Controllers with several transmit mailboxes, and bridges over UDP.",
              {number_parameter("probability", 0.01, 0, 1, "of each frame to change places with the next one"),
               frame_direction},
              of_frames<&WireDirection::reordering>}
        .that_needs(can_node),
});

}  // namespace

std::vector<FaultKind> can_receiver_fault_kinds() { return all_kinds_of(FaultLayer::receiver, {node_kinds}); }

std::vector<FaultKind> can_wire_fault_kinds() { return all_kinds_of(FaultLayer::wire, {bus_kinds, frame_kinds}); }

}  // namespace skyloop::inline run
