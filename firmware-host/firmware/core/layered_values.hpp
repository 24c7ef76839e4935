/// Settings in the layers in which receivers keep them: RAM, battery-backed memory, flash, factory.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/result.hpp"

namespace skyloop::firmware {

/// As u-blox's CFG-VALGET numbers them.
enum class ConfigLayer : std::uint8_t { ram = 0, battery = 1, flash = 2, factory = 7 };

/// Layers as u-blox's CFG-VALSET names several: bit 0 RAM, 1 battery-backed RAM, 2 flash.
using ConfigLayers = std::uint8_t;
inline constexpr ConfigLayers in_ram = 1, in_battery = 2, in_flash = 4;

/// Values ascending by key; of u-blox's, whose upper byte is a size, by group and item, and raw as on the wire (an I1
/// of −1 is 0xFF).
struct ByGroupAndItem {
    bool operator()(std::uint32_t a, std::uint32_t b) const { return (a & 0xFFFFFF) < (b & 0xFFFFFF); }
};
using ConfigValues = std::map<std::uint32_t, std::uint64_t, ByGroupAndItem>;

/// State: three layers over the factory's. What may be set is decided by those who set it.
class LayeredValues {
public:
    /// @param factory every setting that the receiver has. RAM begins as a copy.
    explicit LayeredValues(ConfigValues factory) : factory_(std::move(factory)), ram_(factory_) {}
    virtual ~LayeredValues() = default;
    LayeredValues(const LayeredValues&) = default;
    LayeredValues& operator=(const LayeredValues&) = default;
    LayeredValues(LayeredValues&&) = default;
    LayeredValues& operator=(LayeredValues&&) = default;

    /// True when the receiver has the setting of exactly this key.
    [[nodiscard]] bool has(std::uint32_t key) const;
    /// What a layer holds, or nothing; RAM and factory hold every setting.
    [[nodiscard]] std::optional<std::uint64_t> stored(ConfigLayer layer, std::uint32_t key) const;
    [[nodiscard]] const ConfigValues& values(ConfigLayer layer) const;
    /// What is in force; 0 for a setting that the receiver does not have.
    [[nodiscard]] std::uint64_t value(std::uint32_t key) const { return stored(ConfigLayer::ram, key).value_or(0); }
    [[nodiscard]] bool flag(std::uint32_t key) const { return value(key) != 0; }

    /// Puts a value into the layers, cut to the setting's size. No effect for one that the receiver does not have.
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

    /// Battery-backed layer and flash as text, a line "layer NAME value" each, to outlive the process.
    [[nodiscard]] std::string persistent_text() const;
    /// Whether a setting may have a value.
    using Judge = std::function<bool(std::uint32_t key, std::uint64_t value)>;
    /// Takes them from such a text, then reload()s. Fails with `input`, naming the line. @param allows none: any value
    /// @param layers those that the receiver has
    Result<void> restore(std::string_view text, std::string_view name, const Judge& allows = {},
                         ConfigLayers layers = in_battery | in_flash);

protected:
    [[nodiscard]] virtual std::string name_of(std::uint32_t key) const = 0;
    [[nodiscard]] virtual std::optional<std::uint32_t> key_of(std::string_view name) const = 0;
    /// A value as the setting keeps it, and how long that is.
    [[nodiscard]] virtual std::uint64_t cut(std::uint32_t key, std::uint64_t value) const = 0;
    [[nodiscard]] virtual std::size_t bytes_of(std::uint32_t key) const = 0;

private:
    struct StoredLine {
        bool flash = false;
        std::uint32_t key = 0;
        std::uint64_t value = 0;
    };
    [[nodiscard]] tl::expected<StoredLine, std::string> parse(std::string_view line, const Judge& allows,
                                                              ConfigLayers layers) const;

    ConfigValues factory_, ram_, battery_, flash_;
    std::uint64_t revision_ = 0;
};

}  // namespace skyloop::firmware
