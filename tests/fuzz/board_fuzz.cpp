// Any bytes as a receiver profile: mistakes of one line each, or a profile that a receiver can be built from.
#include <chrono>
#include <cstdint>
#include <sstream>
#include <string>
#include <string_view>

#include "firmware/core/receiver.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "require.hpp"
#include "run/scenario/board_files.hpp"

namespace {

using namespace skyloop;

// A receiver of this profile that has not found its position yet.
void check_receiver(const firmware::BoardProfile& board) {
    firmware::Receiver receiver(board);
    const auto period = receiver.settings().navigation_period;
    require(period > Nanoseconds(0) && period <= std::chrono::seconds(10));
    Epoch epoch;
    epoch.fix.time = to_gps_time(2304, 0);
    receiver.start(epoch.fix.time);
    receiver.on_epoch(epoch);
    Bytes sent;
    for (const firmware::Receiver::Sent& piece : receiver.output(epoch.fix.time + std::chrono::seconds(60)))
        if (piece.port == firmware::PortId::uart1) sent.insert(sent.end(), piece.bytes.begin(), piece.bytes.end());
    StreamSplitter splitter;
    splitter.feed(sent);
    require(splitter.counts().bad[static_cast<std::size_t>(StreamKind::nmea)] == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto board = read_board({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    if (!board) {
        require(board.error().code == ErrorCode::input && !board.error().message.empty());
        std::istringstream lines(board.error().message);
        for (std::string line; std::getline(lines, line);)
            require(line.starts_with("fuzz.toml:") && line.size() < 2000);
        return 0;
    }
    require(board->name == "fuzz" && !board->constellations.empty());
    require(board->default_rate_hz > 0 && board->default_rate_hz <= board->max_rate_hz);
    require(board->baud >= 1200 && board->transmit_buffer_bytes >= 128);
    check_receiver(*board);
    return 0;
}
