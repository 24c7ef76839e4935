/// The configuration of a u-blox receiver in its layers (F9 interface description HPG 1.32, section 6.3).
#pragma once

#include "firmware/core/layered_values.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "receiver/protocol/ubx_cfg.hpp"

namespace skyloop::firmware {

/// A value as its item keeps it: as many bytes as the key says, of a logical only bit 0 (F9 interface description HPG
/// 1.32, section 6.2).
std::uint64_t cut_to_size(std::uint32_t key, std::uint64_t value);

/// One store for both ways to configure a receiver.
class ConfigStore : public LayeredValues {
public:
    using LayeredValues::LayeredValues;
    /// The value of a signed item.
    [[nodiscard]] std::int64_t signed_value(std::uint32_t key) const;
    /// Every how many epochs a message is sent on a port; 0: never.
    [[nodiscard]] int rate(UbxMessageId message, PortId port) const;

protected:
    [[nodiscard]] std::string name_of(std::uint32_t key) const override;
    [[nodiscard]] std::optional<std::uint32_t> key_of(std::string_view name) const override;
    [[nodiscard]] std::uint64_t cut(std::uint32_t key, std::uint64_t value) const override {
        return cut_to_size(key, value);
    }
    [[nodiscard]] std::size_t bytes_of(std::uint32_t key) const override { return config_value_size(key); }
};

/// Whether bytes pass a port at all (CFG-UART1-ENABLED and its like).
bool port_is_on(const ConfigStore& store, PortId port);

}  // namespace skyloop::firmware
