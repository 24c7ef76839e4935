#include "firmware/core/layered_values.hpp"

#include <algorithm>

#include "base/core/number_text.hpp"

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

}  // namespace

// One line "battery CFG-RATE-MEAS 200"; a failure says what is wrong with it.
tl::expected<LayeredValues::StoredLine, std::string> LayeredValues::parse(std::string_view line, const Judge& allows,
                                                                          ConfigLayers layers) const {
    const std::string_view layer = next_word(line), name = next_word(line), number = next_word(line);
    if (layer != "battery" && layer != "flash")
        return tl::make_unexpected("layer '" + std::string(layer) + "'; expected battery or flash");
    if (((layer == "flash" ? in_flash : in_battery) & layers) == 0)
        return tl::make_unexpected("layer '" + std::string(layer) + "', which this receiver does not have");
    const auto key = key_of(name);
    if (!key || !has(*key))
        return tl::make_unexpected("'" + std::string(name) + "' is no configuration item of this receiver");
    StoredLine stored{layer == "flash", *key, 0};
    const auto value = number_in<std::uint64_t>(number);
    stored.value = value.value_or(0);
    if (!value || cut(*key, stored.value) != stored.value)
        return tl::make_unexpected(std::string(name) + " is '" + std::string(number) +
                                   "'; expected a whole number of " + std::to_string(bytes_of(*key)) + " bytes");
    if (allows && !allows(*key, stored.value))
        return tl::make_unexpected(std::string(name) + " is " + std::string(number) +
                                   ", which this receiver itself would refuse");
    if (!next_word(line).empty()) return tl::make_unexpected("text after the value of " + std::string(name));
    return stored;
}

bool LayeredValues::has(std::uint32_t key) const { return holds(factory_, key); }

const ConfigValues& LayeredValues::values(ConfigLayer layer) const {
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

std::optional<std::uint64_t> LayeredValues::stored(ConfigLayer layer, std::uint32_t key) const {
    const ConfigValues& held = values(layer);
    const auto found = held.find(key);
    if (found == held.end() || found->first != key) return std::nullopt;
    return found->second;
}

void LayeredValues::set(ConfigLayers layers, std::uint32_t key, std::uint64_t value) {
    if (!has(key)) return;
    const std::uint64_t kept = cut(key, value);
    if (layers & in_ram) {
        std::uint64_t& current = ram_[key];
        if (current != kept) ++revision_;
        current = kept;
    }
    if (layers & in_battery) battery_[key] = kept;
    if (layers & in_flash) flash_[key] = kept;
}

void LayeredValues::erase(ConfigLayers layers, std::uint32_t key) {
    if (!has(key)) return;
    if (layers & in_battery) battery_.erase(key);
    if (layers & in_flash) flash_.erase(key);
}

void LayeredValues::clear(ConfigLayers layers) {
    if (layers & in_battery) battery_.clear();
    if (layers & in_flash) flash_.clear();
}

ConfigValues LayeredValues::values_at_start() const {
    ConfigValues values = factory_;
    for (const ConfigValues* layer : {&flash_, &battery_})
        for (const auto& [key, value] : *layer)
            values[key] = value;
    return values;
}

void LayeredValues::reload() {
    ConfigValues fresh = values_at_start();
    if (fresh != ram_) ++revision_;
    ram_ = std::move(fresh);
}

std::string LayeredValues::persistent_text() const {
    std::string text;
    const auto append = [&](std::string_view layer, const ConfigValues& values) {
        for (const auto& [key, value] : values)
            text += std::string(layer) + " " + name_of(key) + " " + std::to_string(value) + "\n";
    };
    append("battery", battery_);
    append("flash", flash_);
    return text;
}

Result<void> LayeredValues::restore(std::string_view text, std::string_view name, const Judge& allows,
                                    ConfigLayers layers) {
    ConfigValues battery, flash;
    for (int number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
        const auto stored = parse(line, allows, layers);
        if (!stored)
            return fail(ErrorCode::input, std::string(name) + ":" + std::to_string(number) + ": " + stored.error());
        (stored->flash ? flash : battery)[stored->key] = stored->value;
    }
    battery_ = std::move(battery);
    flash_ = std::move(flash);
    reload();
    return {};
}

}  // namespace skyloop::firmware
