/// The configuration of a receiver in its layers (F9 interface description HPG 1.32, section 6.3; RECEIVER.md 4.3).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "firmware/config/config_keys.hpp"

namespace skyloop::firmware {

/// As CFG-VALGET numbers them.
enum class ConfigLayer : std::uint8_t { ram = 0, battery = 1, flash = 2, factory = 7 };

/// Layers as CFG-VALSET names several: bit 0 RAM, 1 battery-backed RAM, 2 flash.
using ConfigLayers = std::uint8_t;
inline constexpr ConfigLayers in_ram = 1, in_battery = 2, in_flash = 4;

/// Values ascending by group and item, raw as on the wire (an I1 of −1 is 0xFF).
struct ByGroupAndItem {
    bool operator()(std::uint32_t a, std::uint32_t b) const { return group_and_item(a) < group_and_item(b); }
};
using ConfigValues = std::map<std::uint32_t, std::uint64_t, ByGroupAndItem>;

/// A value as its item keeps it: as many bytes as the key says, of a logical only bit 0 (RECEIVER.md 3.4).
std::uint64_t cut_to_size(std::uint32_t key, std::uint64_t value);

/// One store for both ways to configure a receiver. It keeps values and layers; what is allowed is decided by those
/// who write. State: three layers.
class ConfigStore {
public:
    /// @param factory every item that the receiver has, with its factory value. RAM begins as a copy.
    explicit ConfigStore(ConfigValues factory);

    /// True when the receiver has the item of exactly this id.
    [[nodiscard]] bool has(std::uint32_t key) const;
    /// What a layer holds, or nothing; RAM and factory hold every item.
    [[nodiscard]] std::optional<std::uint64_t> stored(ConfigLayer layer, std::uint32_t key) const;
    [[nodiscard]] const ConfigValues& values(ConfigLayer layer) const;
    /// What is in force; 0 for an item that the receiver does not have.
    [[nodiscard]] std::uint64_t value(std::uint32_t key) const;
    /// The same of a signed item.
    [[nodiscard]] std::int64_t signed_value(std::uint32_t key) const;
    [[nodiscard]] bool flag(std::uint32_t key) const { return value(key) != 0; }
    /// Every how many epochs a message is sent on a port; 0: never.
    [[nodiscard]] int rate(UbxMessageId message, PortId port) const;

    /// Puts a value into the layers, cut to the item's size. No effect for an item that the receiver does not have.
    void set(ConfigLayers layers, std::uint32_t key, std::uint64_t value);
    /// Forgets a value in the layers; RAM never forgets.
    void erase(ConfigLayers layers, std::uint32_t key);
    /// Forgets a whole layer; RAM never forgets.
    void clear(ConfigLayers layers);
    /// Factory, overlaid with flash, then with the battery-backed layer.
    [[nodiscard]] ConfigValues values_at_start() const;
    /// RAM becomes what it is at a start.
    void reload();
    /// Grows with every change of RAM.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }

    /// Battery-backed layer and flash as text, a line "layer CFG-NAME value" each, to outlive the process.
    [[nodiscard]] std::string persistent_text() const;
    /// Whether an item may have a value.
    using Judge = std::function<bool(std::uint32_t key, std::uint64_t value)>;
    /// Takes them from such a text, then reload()s. Fails with `input`, naming the line. @param allows none: any value
    /// @param layers those that the receiver has
    Result<void> restore(std::string_view text, std::string_view name, const Judge& allows = {},
                         ConfigLayers layers = in_battery | in_flash);

private:
    ConfigValues factory_, ram_, battery_, flash_;
    std::uint64_t revision_ = 0;
};

/// Whether bytes pass a port at all (CFG-UART1-ENABLED and its like).
bool port_is_on(const ConfigStore& store, PortId port);

}  // namespace skyloop::firmware
