// Items that old receivers reach by their legacy messages alone: no document gives them a key, so the group FD is our
// own. Ascending by item; `on_the_wire` is false for each.
#include "firmware/config/key_tables.hpp"

namespace skyloop::firmware {
namespace {

using enum ConfigType;
constexpr ConfigKey private_items[] = {
    // CFG-GNSS: the block of IMES, which only M8 has (RECEIVER.md 2.4).
    {0x10FD0001, "CFG-SIGNAL-IMES_ENA", l, 0, false},
};

}  // namespace

std::span<const ConfigKey> private_keys() { return private_items; }

}  // namespace skyloop::firmware
