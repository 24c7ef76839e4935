/// Receivers that understand nothing and speak MSP or MAVLink.
#pragma once

#include "firmware/output_only/other_protocols.hpp"
#include "firmware/sentences/sentence_maker.hpp"

namespace skyloop::firmware {

/// Sends frames of its own protocol by UART1, before sentences where its board has any. These protocols have no word
/// for dead reckoning.
class FrameMaker : public SentenceMaker {
public:
    /// Whole frames of one epoch, in order.
    using Make = std::vector<Bytes> (*)(const NavigationState& state, MavlinkSent& sent);
    FrameMaker(const BoardProfile& board, const ReceiverOptions& options, Make make)
        : SentenceMaker(board, options, false), make_(make) {}

    DueMessages due(PortId port, EpochMessages& made, const FirmwareFaults& faults) override;
    void restart(bool keeps_ram) override;

private:
    Make make_;
    MavlinkSent sent_;
};

std::unique_ptr<Maker> make_sentences(const BoardProfile& board, const ReceiverOptions& options);
std::unique_ptr<Maker> make_msp(const BoardProfile& board, const ReceiverOptions& options);
std::unique_ptr<Maker> make_msp_v1(const BoardProfile& board, const ReceiverOptions& options);
std::unique_ptr<Maker> make_mavlink(const BoardProfile& board, const ReceiverOptions& options);

Abilities sentence_abilities(const BoardProfile& board);
Abilities msp_abilities(const BoardProfile& board);
Abilities msp_v1_abilities(const BoardProfile& board);
Abilities mavlink_abilities(const BoardProfile& board);

}  // namespace skyloop::firmware
