#include "firmware/ublox/config/config_store.hpp"

#include <algorithm>
#include <array>

#include "receiver/protocol/ubx_cfg.hpp"

namespace skyloop::firmware {

std::uint64_t cut_to_size(std::uint32_t key, std::uint64_t value) {
    constexpr std::uint32_t size_of_logical = 1;
    if ((key >> 28 & 7u) == size_of_logical) return value & 1;
    const std::size_t bytes = config_value_size(key);
    return bytes >= 8 ? value : value & ((std::uint64_t{1} << 8 * bytes) - 1);
}

std::int64_t ConfigStore::signed_value(std::uint32_t key) const {
    const std::size_t unused_bits = 64 - 8 * std::max<std::size_t>(config_value_size(key), 1);
    return static_cast<std::int64_t>(value(key) << unused_bits) >> unused_bits;
}

int ConfigStore::rate(UbxMessageId message, PortId port) const {
    const auto key = rate_key(message, port);
    return key ? static_cast<int>(value(*key)) : 0;
}

std::string ConfigStore::name_of(std::uint32_t key) const { return std::string(find_config_key(key)->name); }

std::optional<std::uint32_t> ConfigStore::key_of(std::string_view name) const {
    const ConfigKey* item = find_config_key(name);
    return item == nullptr ? std::nullopt : std::optional(item->id);
}

bool port_is_on(const ConfigStore& store, PortId port) {
    // In the order of PortId. SPI has the pins of other ports, and is off at the factory: whoever has one has strapped
    // it.
    constexpr std::array items{key::i2c_enabled, key::uart1_enabled, key::uart2_enabled, key::usb_enabled};
    const auto index = static_cast<std::size_t>(port);
    return index >= items.size() || !store.has(items[index]) || store.flag(items[index]);
}

}  // namespace skyloop::firmware
