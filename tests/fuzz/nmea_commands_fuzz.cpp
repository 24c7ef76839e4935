// Sentences of clients: each line of the input goes to a receiver of every kind. Answers are whole sentences,
// and the store keeps every item in its range.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>

#include "firmware/core/factory_settings.hpp"
#include "firmware/makers.hpp"

namespace {

using namespace skyloop;
using namespace skyloop::firmware;

BoardProfile board_of(MakerKind kind) {
    BoardProfile board;
    board.maker = kind;
    board.constellations = {Constellation::gps, Constellation::sbas, Constellation::glonass};
    board.ports = {PortId::i2c, PortId::uart1, PortId::uart2, PortId::usb};
    board.quirks.answers_unknown_nmea = true;
    board.identity.version_answers = {"$PMTK705,AXN_1.30,0145,x,", "$PQVERNO,R,y", "$PAIR020,z"};
    return board;
}

void check_answers(const CommandOutcome& outcome) {
    for (const Bytes& answer : outcome.answers) {
        const std::string text = to_string(answer);
        if (!text.ends_with("\r\n") || !parse_sentence(text)) std::abort();
    }
}

// Settings that can be saved can be loaded, and give a position.
void check_settings(const Maker& maker, const BoardProfile& board) {
    const ReceiverConfig& config = maker.config();
    if (std::ranges::none_of(config.systems, gives_position)) std::abort();
    if (!takes_baud(board, config.port(PortId::uart1).baud)) std::abort();
    if (!maker_row(board.maker).make(board, {})->restore(maker.stored_text(), "stored")) std::abort();
}

void talk_to(MakerKind kind, const std::vector<std::string>& lines) {
    const BoardProfile board = board_of(kind);
    const std::unique_ptr<Maker> maker = maker_row(kind).make(board, {});
    const NavigationState state;
    const FirmwareFaults sound;
    for (const std::string& line : lines) {
        if (line.empty()) continue;
        // The checksum of a mutated line is seldom right: its body counts.
        const Bytes whole = to_bytes(Sentence(line.substr(1, line.rfind('*') - 1)).finish());
        for (const PortId port : {PortId::uart1, PortId::usb})
            check_answers(maker->receive({kind == MakerKind::ufirebird ? StreamKind::command : StreamKind::nmea, whole},
                                         {port, {}, sound, state.time, {board, maker->config(), state, {}, port}}));
    }
    check_settings(*maker, board);
    maker->restart(false);
    check_settings(*maker, board);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    for (const MakerKind kind : {MakerKind::mute, MakerKind::ublox, MakerKind::mtk, MakerKind::airoha, MakerKind::casic,
                                 MakerKind::quectel, MakerKind::ufirebird})
        talk_to(kind, lines);
    return 0;
}
