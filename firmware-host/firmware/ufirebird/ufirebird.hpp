/// Unicore's UFirebird chips (UC6580, UM600): sentences, and commands whose checksum may be left out.
#pragma once

#include <map>
#include <string>

#include "firmware/core/command_line_reader.hpp"
#include "firmware/core/maker.hpp"
#include "firmware/sentences/sentence_maker.hpp"

namespace skyloop::firmware {

/// Works off PDTINFO, CFGSYS and CFGMSG. State: settings, and the line that has begun on each port.
class UfirebirdMaker : public SentenceMaker {
public:
    UfirebirdMaker(const BoardProfile& board, const ReceiverOptions& options);

    std::vector<StreamPiece> cut(PortUnit& unit, ByteSpan bytes, GpsTime now) override;
    [[nodiscard]] bool has_frames() const override { return false; }
    CommandOutcome receive(const StreamPiece& piece, const Situation& asked) override;
    void restart(bool keeps_ram) override;

protected:
    void adjust(ReceiverConfig& config) const override;

private:
    struct Command;
    void execute(Command& command);
    void systems(Command& command);
    void rate(Command& command);

    std::map<PortId, CommandLineReader> lines_;
};

std::unique_ptr<Maker> make_ufirebird(const BoardProfile& board, const ReceiverOptions& options);
Abilities ufirebird_abilities(const BoardProfile& board);

}  // namespace skyloop::firmware
