#include "firmware/septentrio/septentrio.hpp"

#include "firmware/sentences/sentence_maker.hpp"
#include "firmware/septentrio/rover_and_station.hpp"

namespace skyloop::firmware {

SeptentrioMaker::SeptentrioMaker(const BoardProfile& board, const ReceiverOptions& options)
    : Maker(board), start_(SeptentrioTarget::at_start(board, options)), now_(start_), console_(board, start_) {
    now_.config.settings.subframes = wants_messages(console_.state().settings);
}

// Corrections are looked for among the lines.
std::vector<StreamPiece> SeptentrioMaker::cut(PortUnit& unit, ByteSpan bytes, GpsTime now) {
    std::vector<StreamPiece> pieces = unit.splitter.feed(bytes, now);
    for (const std::string& line : lines_[unit.id].feed(bytes))
        pieces.push_back({StreamKind::command, to_bytes(line)});
    return pieces;
}

CommandOutcome SeptentrioMaker::receive(const StreamPiece& piece, const Situation& asked) {
    if (piece.kind != StreamKind::command) return {};
    ++revision_;
    const std::uint32_t speed = config().port(asked.from).baud;
    CommandOutcome outcome = console_.execute(to_string(piece.bytes), now_, asked.from);
    // What follows was sent at a speed that the port no longer has, or to a receiver that starts.
    if (outcome.reset || config().port(asked.from).baud != speed) lines_.erase(asked.from);
    return outcome;
}

CorrectionState SeptentrioMaker::allowed(CorrectionState at_hand) const {
    return allowed_corrections(console_.state().settings, at_hand);
}

void SeptentrioMaker::restrict(NavigationState& state) const {
    withhold_forbidden(console_.state().settings, state);
    tell_given_place(state);
}

// What streams ask for, then sentences that a run has its board send from the start on.
DueMessages SeptentrioMaker::due(PortId port, EpochMessages& made, const FirmwareFaults& faults) {
    DueMessages due;
    due.add(septentrio_output(console_.state(), made.context(port)));
    for (const BoardSentence& sentence : board_sentences(board())) {
        if (!is_due(sentence, factory_rate(board(), sentence.index), made, faults)) continue;
        const std::vector<Bytes>& messages = made.of(sentence.id, port, {});
        due.frames.insert(due.frames.end(), messages.begin(), messages.end());
    }
    return due;
}

void SeptentrioMaker::restart(bool) {
    ++revision_;
    console_.restart(now_);
}

void SeptentrioMaker::forget_settings() {
    ++revision_;
    console_.forget(now_);
}

void SeptentrioMaker::set_speed(std::uint32_t baud) {
    ++revision_;
    now_.config.ports[static_cast<std::size_t>(PortId::uart1)].baud = baud;
}

Result<void> SeptentrioMaker::restore(const std::string& text, const std::string& name) {
    ++revision_;
    return console_.load(text, name, now_);
}

std::unique_ptr<Maker> make_septentrio(const BoardProfile& board, const ReceiverOptions& options) {
    return std::make_unique<SeptentrioMaker>(board, options);
}

Abilities septentrio_abilities(const BoardProfile&) {
    return {.choice = Abilities::MessageChoice::command_line,
            .jamming = true,  // RFStatus
            .spoofing = true,
            .heading = true,
            .accuracies = true,
            .weeks = true,
            .time = true,
            .calendar = true,
            .dead_reckoning = false,
            .corrections = true,
            .more = {"SBF"},
            .own_prefix = "RTCM-"};
}

}  // namespace skyloop::firmware
