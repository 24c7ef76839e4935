// CASIC's frames: what is read is written again as it was, pieces of a stream do not depend on how it arrives, and a
// receiver answers each frame by whole frames and keeps settings that it can start with.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "../support/split_stream.hpp"
#include "firmware/core/factory_settings.hpp"
#include "firmware/makers.hpp"
#include "receiver/protocol/casic_messages.hpp"
#include "receiver/protocol/decoded_message.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "require.hpp"

namespace {

using namespace skyloop;
using namespace skyloop::firmware;

template <class Message>
bool is_written_as_read(ByteSpan payload) {
    const auto message = decode_payload<Message>(payload);
    if (message) require(encode_payload(*message) == Bytes(payload.begin(), payload.end()));
    return false;
}

BoardProfile casic_board() {
    BoardProfile board;
    board.maker = MakerKind::casic;
    board.constellations = {Constellation::gps, Constellation::beidou};
    board.ports = {PortId::uart1, PortId::uart2};
    board.polled = {{0x0A, 0x04}};
    return board;
}

void check_casic_outcome(const Maker& maker, const BoardProfile& board, const CommandOutcome& outcome) {
    for (const Bytes& answer : outcome.answers)
        require(!answer.empty() && (answer.front() == '$' || parse_casic_frame(answer).has_value()));
    if (outcome.verdict) require(parse_casic_frame(*outcome.verdict).has_value());
    const ReceiverConfig& config = maker.config();
    require(std::ranges::any_of(config.systems, gives_position));
    require(takes_baud(board, config.port(PortId::uart1).baud));
    require(config.settings.navigation_period >= std::chrono::milliseconds(100));
}

}  // namespace

// Mutated sums are seldom right: the input is a class, an id and a payload as well.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const ByteSpan bytes(data, size);
    KnownCasicMessages::any([&]<class Message>() { return is_written_as_read<Message>(bytes); });
    const std::vector<StreamPiece> pieces = test::split_stream({.casic = true}, bytes, std::max<std::size_t>(size, 1));
    require(pieces == test::split_stream({.casic = true}, bytes, 3));
    for (const StreamPiece& piece : pieces)
        static_cast<void>(text_line(decode_piece(piece)));
    if (size < 2) return 0;
    const BoardProfile board = casic_board();
    const std::unique_ptr<Maker> maker = maker_row(board.maker).make(board, {});
    const NavigationState state;
    const FirmwareFaults sound;
    std::vector<StreamPiece> said = pieces;
    const ByteSpan payload = bytes.subspan(2, (size - 2) / 4 * 4);
    for (const std::uint8_t message_class : {bytes[0], std::uint8_t{0x06}})
        said.push_back({StreamKind::casic, encode_casic_frame({message_class, bytes[1]}, payload)});
    for (const StreamPiece& piece : said)
        check_casic_outcome(
            *maker, board,
            maker->receive(piece,
                           {PortId::uart1, {}, sound, state.time, {board, maker->config(), state, {}, PortId::uart1}}));
    require(maker_row(board.maker).make(board, {})->restore(maker->stored_text(), "stored").has_value());
    return 0;
}
