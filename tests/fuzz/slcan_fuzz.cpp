// SLCAN: any bytes of a host, whole or in pieces, and any text as a line of SLCAN or candump.
#include <cstddef>
#include <cstdint>

#include "require.hpp"
#include "wire/can/can_sockets.hpp"
#include "wire/can/slcan_adapter.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const ByteSpan bytes(data, size);
    SlcanAdapter whole, pieces;
    const SlcanAdapter::Taken taken = whole.take(bytes);
    std::string answers;
    std::vector<CanFrame> frames;
    for (const std::uint8_t byte : bytes) {
        const SlcanAdapter::Taken part = pieces.take({&byte, 1});
        answers += part.answers;
        frames.insert(frames.end(), part.frames.begin(), part.frames.end());
    }
    require(answers == taken.answers && frames == taken.frames && whole.is_open() == pieces.is_open());
    for (const CanFrame& frame : frames) {
        const std::string line = slcan_line(frame);
        require(parse_slcan_line(std::string_view(line).substr(0, line.size() - 1)) == frame);
        require(parse_multicast_datagram(multicast_datagram(frame)) == frame);
    }
    static_cast<void>(parse_candump_line(to_string(bytes)));
    static_cast<void>(parse_multicast_datagram(bytes));
    return 0;
}
