/// Receivers with CASIC's chips (AT6558): sentences, PCAS commands, binary frames.
#pragma once

#include "firmware/casic/settings.hpp"
#include "firmware/core/maker.hpp"
#include "firmware/sentences/sentence_maker.hpp"
#include "receiver/protocol/casic_frame.hpp"

namespace skyloop::firmware {

/// Works off PCAS commands and frames of class CFG. State: settings.
class CasicMaker : public SentenceMaker {
public:
    CasicMaker(const BoardProfile& board, const ReceiverOptions& options)
        : SentenceMaker(board, options, true, casic_settings(board).list) {}

    [[nodiscard]] StreamProtocols hears() const override { return {.casic = true}; }
    CommandOutcome receive(const StreamPiece& piece, const Situation& asked) override;
    DueMessages due(PortId port, EpochMessages& made, const FirmwareFaults& faults) override;

protected:
    void adjust(ReceiverConfig& config) const override;

private:
    /// A frame while it is worked off.
    struct Request {
        const CasicFrameView& frame;
        const Situation& asked;
        CommandOutcome& outcome;
    };
    void configure_by(const Request& request);
    bool poll(const Request& request);
    bool set(const Request& request);
    bool set_port(const Request& request);
    bool set_rate_of(const Request& request);
    bool set_interval(const Request& request);
    bool set_navigation(const Request& request);
    bool use_stored(const Request& request);
    bool restart_by(const Request& request);
    bool send_once(const Request& request, CasicMessageId wanted);
};

std::unique_ptr<Maker> make_casic(const BoardProfile& board, const ReceiverOptions& options);
Abilities casic_abilities(const BoardProfile& board);

}  // namespace skyloop::firmware
