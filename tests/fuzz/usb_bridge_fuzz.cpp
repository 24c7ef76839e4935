// Any descriptors of an interface, and any text as a bridge's address: what is understood lies within the bytes, and an
// address says the same again.
#include <algorithm>
#include <cstdint>
#include <string_view>

#include "require.hpp"
#include "wire/transport/usb_bridge.hpp"
#include "wire/usb/cdc_acm.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const ByteSpan bytes(data, size);
    if (const auto joined = read_cdc_union(bytes)) {
        const std::uint8_t expected[] = {0x24, 0x06, joined->control, joined->data};
        require(std::search(bytes.begin(), bytes.end(), std::begin(expected), std::end(expected)) != bytes.end());
    }
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto address = parse_usb_bridge_address(text);
    if (!address) {
        require(address.error().code == ErrorCode::usage && !address.error().message.empty());
        return 0;
    }
    const auto again = parse_usb_bridge_address(to_string(address->device));
    require(again && to_string(again->device) == to_string(address->device));
    require(!address->baud || (*address->baud >= 50 && *address->baud <= 12'000'000));
    require(address->format.data_bits == 7 || address->format.data_bits == 8);
    return 0;
}
