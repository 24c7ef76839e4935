// Any text as the address of a live source: one line of refusal, or an address whose parts can be used.
#include <cstdint>
#include <string_view>

#include "require.hpp"
#include "run/feed/truth_feed.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const auto address = parse_feed_address(std::string_view(reinterpret_cast<const char*>(data), size));
    if (!address) {
        require(address.error().code == ErrorCode::usage);
        require(address.error().message.find('\n') == std::string::npos);
        return 0;
    }
    require(!address->host.empty() && !address->dialect.empty());
    const bool relay = address->wire == FeedWire::udp_relay || address->wire == FeedWire::tcp_relay;
    require(relay == !address->to_host.empty() && relay == (address->to_port != 0));
    require((address->wire == FeedWire::serial) == (address->baud != 0));
    return 0;
}
