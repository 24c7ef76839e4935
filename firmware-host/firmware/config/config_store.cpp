#include "firmware/config/config_store.hpp"

#include <array>

#include "base/core/number_text.hpp"
#include "receiver/protocol/ubx_cfg.hpp"

namespace skyloop::firmware {
namespace {

// Size bits differ and the items are the same: another id, thus not in the layer.
bool holds(const ConfigValues& layer, std::uint32_t key) {
    const auto found = layer.find(key);
    return found != layer.end() && found->first == key;
}

std::string_view next_word(std::string_view& line) {
    const std::size_t begin = std::min(line.find_first_not_of(" \t\r"), line.size());
    const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

struct StoredLine {
    bool flash = false;
    std::uint32_t key = 0;
    std::uint64_t value = 0;
};

// One line "battery CFG-RATE-MEAS 200"; a failure says what is wrong with it.
tl::expected<StoredLine, std::string> parse_stored_line(std::string_view line, const ConfigValues& known,
                                                        const ConfigStore::Judge& allows, ConfigLayers layers) {
    const std::string_view layer = next_word(line), name = next_word(line), number = next_word(line);
    if (layer != "battery" && layer != "flash")
        return tl::make_unexpected("layer '" + std::string(layer) + "'; expected battery or flash");
    if (((layer == "flash" ? in_flash : in_battery) & layers) == 0)
        return tl::make_unexpected("layer '" + std::string(layer) + "', which this receiver does not have");
    const ConfigKey* key = find_config_key(name);
    if (key == nullptr || !holds(known, key->id))
        return tl::make_unexpected("'" + std::string(name) + "' is no configuration item of this receiver");
    StoredLine stored{layer == "flash", key->id, 0};
    const auto value = number_in<std::uint64_t>(number);
    stored.value = value.value_or(0);
    if (!value || cut_to_size(key->id, stored.value) != stored.value)
        return tl::make_unexpected(std::string(name) + " is '" + std::string(number) +
                                   "'; expected a whole number of " + std::to_string(config_value_size(key->id)) +
                                   " bytes");
    if (allows && !allows(key->id, stored.value))
        return tl::make_unexpected(std::string(name) + " is " + std::string(number) +
                                   ", which this receiver itself would refuse");
    if (!next_word(line).empty()) return tl::make_unexpected("text after the value of " + std::string(name));
    return stored;
}

}  // namespace

std::uint64_t cut_to_size(std::uint32_t key, std::uint64_t value) {
    constexpr std::uint32_t size_of_logical = 1;
    if ((key >> 28 & 7u) == size_of_logical) return value & 1;
    const std::size_t bytes = config_value_size(key);
    return bytes >= 8 ? value : value & ((std::uint64_t{1} << 8 * bytes) - 1);
}

ConfigStore::ConfigStore(ConfigValues factory) : factory_(std::move(factory)), ram_(factory_) {}

bool ConfigStore::has(std::uint32_t key) const { return holds(factory_, key); }

const ConfigValues& ConfigStore::values(ConfigLayer layer) const {
    switch (layer) {
        case ConfigLayer::ram:
            return ram_;
        case ConfigLayer::battery:
            return battery_;
        case ConfigLayer::flash:
            return flash_;
        case ConfigLayer::factory:
            break;
    }
    return factory_;
}

std::optional<std::uint64_t> ConfigStore::stored(ConfigLayer layer, std::uint32_t key) const {
    const ConfigValues& held = values(layer);
    const auto found = held.find(key);
    if (found == held.end() || found->first != key) return std::nullopt;
    return found->second;
}

std::uint64_t ConfigStore::value(std::uint32_t key) const { return stored(ConfigLayer::ram, key).value_or(0); }

std::int64_t ConfigStore::signed_value(std::uint32_t key) const {
    const std::size_t unused_bits = 64 - 8 * std::max<std::size_t>(config_value_size(key), 1);
    return static_cast<std::int64_t>(value(key) << unused_bits) >> unused_bits;
}

int ConfigStore::rate(UbxMessageId message, PortId port) const {
    const auto key = rate_key(message, port);
    return key ? static_cast<int>(value(*key)) : 0;
}

void ConfigStore::set(ConfigLayers layers, std::uint32_t key, std::uint64_t value) {
    if (!has(key)) return;
    const std::uint64_t cut = cut_to_size(key, value);
    if (layers & in_ram) {
        std::uint64_t& current = ram_[key];
        if (current != cut) ++revision_;
        current = cut;
    }
    if (layers & in_battery) battery_[key] = cut;
    if (layers & in_flash) flash_[key] = cut;
}

void ConfigStore::erase(ConfigLayers layers, std::uint32_t key) {
    if (!has(key)) return;
    if (layers & in_battery) battery_.erase(key);
    if (layers & in_flash) flash_.erase(key);
}

void ConfigStore::clear(ConfigLayers layers) {
    if (layers & in_battery) battery_.clear();
    if (layers & in_flash) flash_.clear();
}

ConfigValues ConfigStore::values_at_start() const {
    ConfigValues values = factory_;
    for (const ConfigValues* layer : {&flash_, &battery_})
        for (const auto& [key, value] : *layer)
            values[key] = value;
    return values;
}

void ConfigStore::reload() {
    ConfigValues fresh = values_at_start();
    if (fresh != ram_) ++revision_;
    ram_ = std::move(fresh);
}

std::string ConfigStore::persistent_text() const {
    std::string text;
    const auto append = [&text](std::string_view layer, const ConfigValues& values) {
        for (const auto& [key, value] : values)
            text +=
                std::string(layer) + " " + std::string(find_config_key(key)->name) + " " + std::to_string(value) + "\n";
    };
    append("battery", battery_);
    append("flash", flash_);
    return text;
}

Result<void> ConfigStore::restore(std::string_view text, std::string_view name, const Judge& allows,
                                  ConfigLayers layers) {
    ConfigValues battery, flash;
    for (int number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
        const auto stored = parse_stored_line(line, factory_, allows, layers);
        if (!stored)
            return fail(ErrorCode::input, std::string(name) + ":" + std::to_string(number) + ": " + stored.error());
        (stored->flash ? flash : battery)[stored->key] = stored->value;
    }
    battery_ = std::move(battery);
    flash_ = std::move(flash);
    reload();
    return {};
}

bool port_is_on(const ConfigStore& store, PortId port) {
    // In the order of PortId. SPI has the pins of other ports, and is off at the factory: whoever has one has strapped
    // it.
    constexpr std::array items{key::i2c_enabled, key::uart1_enabled, key::uart2_enabled, key::usb_enabled};
    const auto index = static_cast<std::size_t>(port);
    return index >= items.size() || !store.has(items[index]) || store.flag(items[index]);
}

}  // namespace skyloop::firmware
