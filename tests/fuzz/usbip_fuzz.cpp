// Any bytes of a USB/IP client: the request, then the imported device. What the device does depends on the bytes alone,
// not on how they are cut into pieces, and its memory stays within its bounds.
#include <algorithm>
#include <cstdint>

#include "require.hpp"
#include "wire/transport/usbip_session.hpp"

namespace {

using namespace skyloop;

struct Outcome {
    Bytes output, received;
    std::string mistake;
    bool operator==(const Outcome&) const = default;
};

// In pieces of `piece` bytes, with serial bytes to read and a host that reads every answer.
Outcome play(ByteSpan bytes, std::size_t piece) {
    constexpr std::int64_t frame_ns = 1'000'000;
    UsbipSession session({}, UsbipDevice{});
    Outcome outcome;
    for (std::size_t at = 0; at < bytes.size() && session.mistake().empty();) {
        // Looks without time: the bus then has what it needs, and its pace is not what is compared.
        const std::size_t count = std::min(piece, bytes.size() - at);
        session.hear(bytes.subspan(at, count));
        at += count;
        session.run(frame_ns);
        const ByteSpan output = session.output();
        outcome.output.insert(outcome.output.end(), output.begin(), output.end());
        session.sent(output.size());
        const Bytes received = session.take_received();
        outcome.received.insert(outcome.received.end(), received.begin(), received.end());
        require(session.pending() <= 256);
    }
    outcome.mistake = session.mistake();
    // Time goes on: what waits for it comes out, and serial bytes go to whoever polls.
    for (std::int64_t frame = 2; frame < 4; ++frame) {
        session.put(Bytes(3000, 'x'));
        session.run(frame * 300 * frame_ns);
    }
    return outcome;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 8192) return 0;
    const ByteSpan bytes(data, size);
    const auto request = parse_usbip_request(bytes);
    require(!request.message || request.mistake.empty());
    require(request.size <= size);
    const auto command = parse_usbip_command(bytes);
    require(!command.message || (command.mistake.empty() && command.size >= usbip_header_bytes));
    require(command.size <= size);
    const Outcome whole = play(bytes, std::max<std::size_t>(size, 1)), parts = play(bytes, 7);
    require(whole.mistake == parts.mistake);
    require(whole.received.size() <= size);
    return 0;
}
