// Any bytes as the URI of an actuator, and as what its hardware answers: an address within its bounds, or a refusal.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "require.hpp"
#include "wire/actuator/actuator_uri.hpp"
#include "wire/actuator/hid_switches.hpp"
#include "wire/usb/hub_port_power.hpp"

namespace {

using namespace skyloop;

void check(const RelayAddress& relay) { require(relay.number >= 1 && relay.number <= 8); }
void check(const GpioAddress& pin) { require(pin.number >= 0 && pin.number < mcp2221::pins); }
void check(const HubPortAddress& hub) { require(!hub.port_path.empty()); }
void check(const ModemLineAddress& line) { require(!line.device.empty()); }
void check(const SwitchCommands& commands) {
    require(!commands.cut.empty() && !commands.restore.empty());
    require(!commands.cut.front().empty() && !commands.restore.front().empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    if (const auto uri = parse_actuator_uri(text))
        std::visit([](const auto& address) { check(address); }, *uri);
    else
        require(uri.error().code == ErrorCode::usage && !uri.error().message.empty());
    const ByteSpan bytes(data, size);
    if (const auto board = relay_board(text)) require(board->relays >= 1 && board->relays <= 8);
    if (const auto states = relay_states(bytes)) require(states->serial.size() <= 5);
    for (int pin = 0; pin < mcp2221::pins; ++pin)
        if (mcp2221::output_level(bytes, pin)) require(size == mcp2221::report_size);
    if (const auto ports = hub_ports(bytes)) require(ports->count >= 0 && ports->count <= 255);
    return 0;
}
