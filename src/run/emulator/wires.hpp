/// The ports of a receiver and the wires that a scenario plugs into them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "run/emulator/station.hpp"
#include "run/scenario/scenario.hpp"
#include "wire/transport/cdc_acm_device.hpp"

namespace skyloop::inline run {

/// A wire as it was asked for: "uart2=pty:LINK".
struct WireRequest {
    firmware::PortId port = firmware::PortId::uart1;
    std::string uri;
    bool corrections = false;  ///< the URI is that of a caster's mount point, and nothing leaves by it
};

/// The port of a wire without a name: UART1, or the first port of a board that has no UART1.
firmware::PortId default_port(const firmware::BoardProfile& board);

/// What a board's USB port shows of itself; any other port stands behind a generic serial adapter.
UsbFace usb_face(const firmware::BoardProfile& board, firmware::PortId port);

/// What stands before "=" names the port, what stands behind is a URI of a transport; without a name it is the
/// default_port(), of a USB/IP wire the USB port of a board that has one. Fails with `usage`: the sentence quotes the
/// text and lists the board's ports.
Result<WireRequest> parse_wire(std::string_view text, const firmware::BoardProfile& board);

/// The wires of one receiver, as they were asked for; opens none. Without any in the scenario it is one pty.
Result<std::vector<WireRequest>> wires_of(const ReceiverEntry& entry, const firmware::BoardProfile& board);

/// The same of what stands in `corrections`: a caster's mount point, and the port that its bytes reach. Nothing where a
/// receiver has none. Fails with `usage`; no sentence has user or password.
Result<std::optional<WireRequest>> corrections_of(const ReceiverEntry& entry, const firmware::BoardProfile& board);

/// The port of a board by its name. Fails with `usage` and a sentence that lists the board's ports.
Result<firmware::PortId> port_of_board(std::string_view name, const firmware::BoardProfile& board);

/// The speed behind the address of a network wire, bit/s: UART1 begins at it, as if a client had set it before it was
/// connected. Nothing where no wire has one.
std::optional<std::uint32_t> speed_of_wires(const ReceiverEntry& entry);

/// A place at which bytes come out, and what messages call whose it is.
struct WireEnd {
    std::string owner;      ///< "port of 'rover'"
    std::string uri;        ///< as it was written
    std::string place;      ///< a path, or a port that is listened at; empty: it is free or may be shared
    std::string told_at{};  ///< "FILE:LINE:COLUMN: KEY: ", for messages; empty: no key of a file
};
WireEnd end_of_wire(const std::string& owner, const std::string& uri);
/// An actuator: a modem line has its device for itself.
WireEnd end_of_power(const std::string& owner, const std::string& uri);
WireEnd end_of_output(const OutputSettings& output);
/// What a receiver saves.
WireEnd end_of_state(const std::string& owner, const std::filesystem::path& file);

/// What is wrong where two of them are one place: the second would take it from the first. Fails with `usage`.
Result<void> check_ends(const std::vector<WireEnd>& ends);

/// Whether a wire leads to a client that lives in simulated time: "client:NAME".
bool has_scripted_client(const Scenario& scenario);

/// Takes all wires from the receivers but those to scripted clients, and leaves the speed_of_wires(); a receiver that
/// is left without one writes to nowhere, where it would get a pty.
void keep_scripted_clients(Scenario& scenario);

}  // namespace skyloop::inline run
