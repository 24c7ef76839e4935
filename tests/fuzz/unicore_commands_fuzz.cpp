// Commands to a Unicore receiver: each line is answered by whole lines or not at all, and what is saved can be loaded.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "firmware/core/factory_settings.hpp"
#include "firmware/makers.hpp"
#include "receiver/protocol/unicore_frame.hpp"
#include "require.hpp"

namespace {

using namespace skyloop;
using namespace skyloop::firmware;

BoardProfile unicore_board() {
    BoardProfile board;
    board.maker = MakerKind::unicore;
    board.identity.hardware = "UM982";
    board.baud = 115200;
    board.max_rate_hz = 20;
    board.constellations = {Constellation::gps, Constellation::sbas, Constellation::glonass};
    board.ports = {PortId::uart1, PortId::uart2, PortId::uart3};
    return board;
}

void check_unicore_settings(const Maker& maker, const BoardProfile& board) {
    const ReceiverConfig& config = maker.config();
    require(std::ranges::any_of(config.systems, gives_position));
    require(takes_baud(board, config.port(PortId::uart2).baud));
    require(config.settings.navigation_period >= std::chrono::milliseconds(50));
    const auto other = maker_row(board.maker).make(board, {});
    require(other->restore(maker.stored_text(), "stored").has_value());
    require(other->stored_text() == maker.stored_text());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const BoardProfile board = unicore_board();
    const std::unique_ptr<Maker> maker = maker_row(board.maker).make(board, {});
    const NavigationState state;
    const FirmwareFaults sound;
    PortUnit unit(PortId::uart1, 115200, board);
    const GpsTime now{};
    for (const StreamPiece& piece : maker->cut(unit, {data, size}, now)) {
        const CommandOutcome outcome = maker->receive(
            piece, {PortId::uart1, now, sound, state.time, {board, maker->config(), state, {}, PortId::uart1}});
        if (outcome.answers.empty()) continue;
        const std::string first = to_string(outcome.answers.front());
        require(first.ends_with("\r\n") && first.starts_with("$command,"));
        check_unicore_settings(*maker, board);
    }
    maker->restart(false);
    check_unicore_settings(*maker, board);
    return 0;
}
