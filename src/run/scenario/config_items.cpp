#include "detail/config_items.hpp"

#include <fmt/format.h>

#include <bit>
#include <limits>

#include "base/core/spelling.hpp"
#include "firmware/config/config_store.hpp"

namespace skyloop {
namespace {

using firmware::ConfigKey;
using firmware::ConfigType;

// The least and the most that the bytes of an item hold, as far as TOML can write them.
NumberRange range_of(const ConfigKey& key) {
    using enum ConfigType;
    const double most = static_cast<double>(firmware::cut_to_size(key.id, ~std::uint64_t{0} >> 1));
    const bool is_signed = key.type == i1 || key.type == i2 || key.type == i4 || key.type == i8;
    if (!is_signed) return {0, most};
    const double half = (most + 1) / 2;
    return {-half, half - 1};
}

std::uint64_t read_value(TableReader& config, const ConfigKey& key) {
    if (key.type == ConfigType::r8) {
        double number = 0;
        config.number(key.name, number);
        return std::bit_cast<std::uint64_t>(number);
    }
    if (key.type == ConfigType::r4) {
        constexpr double most = std::numeric_limits<float>::max();
        double number = 0;
        config.number(key.name, number, {-most, most});
        return std::bit_cast<std::uint32_t>(static_cast<float>(number));
    }
    if (key.type == ConfigType::l && config.is_boolean(key.name)) {
        bool flag = false;
        config.boolean(key.name, flag);
        return flag;
    }
    std::int64_t number = 0;
    config.integer(key.name, number, range_of(key));
    return firmware::cut_to_size(key.id, static_cast<std::uint64_t>(number));
}

}  // namespace

std::vector<std::string_view> config_item_names() {
    std::vector<std::string_view> names;
    for (const ConfigKey& key : firmware::config_keys())
        names.push_back(key.name);
    return names;
}

std::map<std::uint32_t, std::uint64_t> read_config_items(TableReader& config, std::string_view other) {
    std::map<std::uint32_t, std::uint64_t> items;
    for (const std::string& name : config.keys()) {
        if (name == other) continue;
        if (const ConfigKey* key = firmware::find_config_key(name)) {
            items[key->id] = read_value(config, *key);
        } else {
            config.mistake(name, fmt::format("is no configuration item{}", did_you_mean(name, config_item_names())));
            config.has_been_read(name);
        }
    }
    return items;
}

}  // namespace skyloop
