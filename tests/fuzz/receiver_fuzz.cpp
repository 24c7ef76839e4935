// Any bytes as what clients send to a receiver's port: it goes on with its epochs, and whatever leaves it is whole.
#include <algorithm>
#include <chrono>
#include <cstdint>

#include "../unit/firmware/sample_epochs.hpp"
#include "firmware/core/receiver.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "require.hpp"

namespace {

using namespace skyloop;
using namespace skyloop::firmware;
using namespace std::chrono_literals;

// The first byte chooses whose commands are understood, and the generation.
BoardProfile fuzzed_board(std::uint8_t choice) {
    BoardProfile board = sample_ublox();
    constexpr MakerKind personalities[] = {MakerKind::ublox, MakerKind::ublox, MakerKind::mtk, MakerKind::airoha};
    board.maker = personalities[choice % 4];
    board.identity.generation = 6 + choice / 4 % 5;
    board.power.save_modes = board.power.backup = true;
    for (const std::uint8_t id : std::initializer_list<std::uint8_t>{0x11, 0x3B, 0x57, 0x86})  // CFG-RXM, PM2, PWR, PMS
        board.legacy[{0x06, id}] = LegacyAnswer::apply;
    board.quirks.speed_change = static_cast<SpeedChangeAnswer>(choice / 32 % 3);
    return board;
}

void check_output(Receiver& receiver, StreamSplitter& splitter, GpsTime now) {
    for (const Receiver::Sent& sent : receiver.output(now)) {
        require(sent.baud >= 300 && !sent.bytes.empty());
        // A new speed or a restart cuts what was on its way; whole pieces are all that is looked at.
        if (sent.port == PortId::uart1) splitter.feed(sent.bytes);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 2 || size > 4096) return 0;
    Receiver receiver(fuzzed_board(data[0]));
    Epoch epoch{sample_fix("2024-03-05T12:00:00Z", 47, 8, 500)};
    add_satellites(epoch.fix, Constellation::gps, 1, 8);
    GpsTime now = epoch.fix.time;
    receiver.start(now);
    StreamSplitter splitter;
    // Portions of up to 64 bytes, a fifth of a second apart.
    ByteSpan left(data + 1, size - 1);
    while (!left.empty()) {
        const std::size_t portion = std::min<std::size_t>(left.size(), 64);
        receiver.input(PortId::uart1, left.first(portion), now);
        left = left.subspan(portion);
        now += 200ms;
        epoch.fix.time = now;
        receiver.on_epoch(epoch);
        check_output(receiver, splitter, now);
        const auto period = receiver.settings().navigation_period;
        require(period >= 1ms && period <= 3h);
    }
    check_output(receiver, splitter, now + 30s);
    require(splitter.counts().frames[static_cast<std::size_t>(StreamKind::rtcm3)] == 0);
    // What battery and flash hold can be taken back.
    Receiver next(fuzzed_board(data[0]));
    require(next.restore(receiver.persistent_text(), "fuzz").has_value());
    return 0;
}
