// Any bytes at any two speeds: how they are split over calls makes no difference, and nothing is made out of nothing.
#include <algorithm>
#include <cstdint>

#include "require.hpp"
#include "wire/transport/line_garbler.hpp"

namespace {

using namespace skyloop;

constexpr std::uint32_t bauds[] = {1200, 4800, 9600, 9900, 19200, 38400, 57600, 115200, 230400, 460800, 921600};

void append(Bytes& heard, const Bytes& more) { heard.insert(heard.end(), more.begin(), more.end()); }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 3 || size > 4096) return 0;
    const std::uint32_t sender = bauds[data[0] % std::size(bauds)];
    const std::uint32_t listener = bauds[data[1] % std::size(bauds)];
    const ByteSpan sent(data + 3, size - 3);
    const std::size_t cut = sent.empty() ? 0 : data[2] % (sent.size() + 1);

    LineGarbler whole(sender, listener), parts(sender, listener);
    Bytes at_once = whole.pass(sent);
    append(at_once, whole.idle());
    Bytes in_parts = parts.pass(sent.first(cut));
    append(in_parts, parts.pass(sent.subspan(cut)));
    append(in_parts, parts.idle());
    require(at_once == in_parts);
    require(whole.framing_errors() == parts.framing_errors());
    // A listener looks for the next byte from the middle of a stop bit on: it hears at most one in each nine and a half
    // of its own bits, and the last one into the rest of the line.
    require(19 * (at_once.size() - std::min<std::size_t>(at_once.size(), 1)) * sender <=
            20 * sent.size() * std::max(listener, sender));
    if (sender == listener) require(std::equal(at_once.begin(), at_once.end(), sent.begin(), sent.end()));
    return 0;
}
