/// Septentrio's receivers: a command line, SBF, sentences, RTCM 3.
#pragma once

#include "firmware/core/command_line_reader.hpp"
#include "firmware/septentrio/console.hpp"

namespace skyloop::firmware {

class SeptentrioMaker : public Maker {
public:
    SeptentrioMaker(const BoardProfile& board, const ReceiverOptions& options);

    [[nodiscard]] const ReceiverConfig& config() const override { return now_.config; }
    [[nodiscard]] std::uint64_t revision() const override { return revision_; }
    std::vector<StreamPiece> cut(PortUnit& unit, ByteSpan bytes, GpsTime now) override;
    [[nodiscard]] bool has_frames() const override { return false; }
    CommandOutcome receive(const StreamPiece& piece, const Situation& asked) override;
    [[nodiscard]] CorrectionState allowed(CorrectionState at_hand) const override;
    void restrict(NavigationState& state) const override;
    void follow(const NavigationState& state, GpsTime) override { console_.follow(state); }
    DueMessages due(PortId port, EpochMessages& made, const FirmwareFaults& faults) override;
    void restart(bool keeps_ram) override;
    void lose_battery() override {}
    void forget_settings() override;
    void set_speed(std::uint32_t baud) override;
    [[nodiscard]] bool takes_speed(std::uint32_t baud) const override { return takes_baud(board(), baud); }
    [[nodiscard]] std::string stored_text() const override { return console_.boot_text(); }
    Result<void> restore(const std::string& text, const std::string& name) override;

private:
    SeptentrioTarget start_, now_;
    SeptentrioConsole console_;
    std::map<PortId, CommandLineReader> lines_;
    std::uint64_t revision_ = 1;
};

std::unique_ptr<Maker> make_septentrio(const BoardProfile& board, const ReceiverOptions& options);
Abilities septentrio_abilities(const BoardProfile& board);

}  // namespace skyloop::firmware
