// Bytes as configuration messages to a receiver of generation 9: whatever comes, RAM holds every item, each in its
// range, and stands together; what is answered decodes; what is saved can be restored.
//
// Each message is a byte that says which, a byte with its length, and its payload.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "firmware/ublox/config/config_handler.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "require.hpp"

namespace {

using namespace skyloop;
using namespace skyloop::firmware;

BoardProfile fuzz_board() {
    BoardProfile board;
    board.identity.generation = 9;
    board.baud = 38400;
    board.bauds = {9600, 38400, 115200};
    board.ports = {PortId::i2c, PortId::uart1, PortId::uart2, PortId::usb, PortId::spi};
    board.constellations = {Constellation::gps, Constellation::galileo};
    return board;
}

void check_answer(const ConfigOutcome& outcome) {
    require(outcome.verdict != Verdict::silence);
    require(outcome.answers.empty() == (outcome.verdict == Verdict::refuse));
    for (const Bytes& bytes : outcome.answers) {
        const auto frame = parse_frame(bytes);
        require(frame && frame->id == CfgValget::message_id);
        require(decode_payload<CfgValget>(frame->payload).has_value());
    }
}

void send(ValueConfig& values, std::uint8_t which, ByteSpan payload) {
    switch (which % 4) {
        case 0:
            require(values.valset(payload).answers.empty());
            return;
        case 1:
            check_answer(values.valget(payload));
            return;
        case 2:
            require(values.valdel(payload).answers.empty());
            return;
        default:
            values.cancel();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const BoardProfile board = fuzz_board();
    static const ConfigValues factory = factory_config(board);
    ConfigStore store(factory);
    ValueConfig values(board, store);
    ConfigValues checked = factory;
    for (ByteSpan left(data, size); left.size() > 2;) {
        const std::size_t length = std::min<std::size_t>(left[1], left.size() - 2);
        send(values, left[0], left.subspan(2, length));
        left = left.subspan(2 + length);
        const ConfigValues& ram = store.values(ConfigLayer::ram);
        if (ram == checked) continue;  // to compare is cheaper than to check
        require(ram.size() == factory.size());
        require(is_consistent(board, ram));
        checked = ram;
    }
    ConfigStore next(factory);
    require(next.restore(store.persistent_text(), "text").has_value());
    require(next.persistent_text() == store.persistent_text());
    return 0;
}
