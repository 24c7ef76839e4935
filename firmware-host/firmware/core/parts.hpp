/// What the parts of a receiver share.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "firmware/core/maker.hpp"

namespace skyloop::firmware {

/// It does not move: its members refer to each other.
struct ReceiverParts {
    ReceiverParts(BoardProfile profile, const ReceiverOptions& options, const MakerRow& row);
    ReceiverParts(const ReceiverParts&) = delete;
    ReceiverParts& operator=(const ReceiverParts&) = delete;

    BoardProfile board;
    std::unique_ptr<Maker> maker;
    std::vector<PortUnit> units;
    Outbox outbox{units};
    FirmwareFaults faults{};
    std::vector<PortStatus> statuses{};
    std::shared_ptr<const NavigationState> reported{};  ///< of the last epoch, edited; what polls are answered from

    [[nodiscard]] const ReceiverConfig& config() const { return maker->config(); }
    void report(const NavigationState& state) { reported = std::make_shared<const NavigationState>(state); }
    /// What messages of now are made from.
    ReportContext context(PortId port);
    [[nodiscard]] ReportContext context(PortId port, const NavigationState& state) const;
    void look_at_ports();

    /// Queues messages, unless the receiver is silent.
    void send(PortId port, const std::vector<Bytes>& messages, GpsTime now);
    void send_in_turn(PortId port, const std::vector<ByteSpan>& messages, GpsTime now);
    /// A text for people, on all ports.
    void send_text(int level, const std::string& text, GpsTime now);
    /// The ports begin anew, each at its configured speed; what was counted of them goes on.
    void restart_ports();
};

/// What a ready message is, by what it begins with: its class alone, of UBX and CASIC none.
UbxMessageId protocol_of(const Bytes& message);

}  // namespace skyloop::firmware
