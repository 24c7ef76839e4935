#include "config_key_names.hpp"

#include <string>
#include <utility>
#include <vector>

#include "firmware/config/config_keys.hpp"

namespace skyloop::host {
namespace {

DecodedValue name_of(const DecodedValue& key) {
    const auto* id = std::get_if<std::uint64_t>(&key.content);
    const auto* known = id == nullptr ? nullptr : firmware::find_config_key(static_cast<std::uint32_t>(*id));
    if (known == nullptr) return {};
    return {std::string(known->name)};
}

void name_pair(DecodedValue& pair) {
    auto* fields = std::get_if<std::vector<DecodedField>>(&pair.content);
    if (fields == nullptr || fields->empty()) return;
    DecodedField name{"name", name_of(fields->front().value)};
    fields->insert(fields->begin() + 1, std::move(name));
}

}  // namespace

void name_config_keys(DecodedMessage& message) {
    if (message.protocol != "ubx" || !message.name.starts_with("CFG-VAL")) return;
    for (std::size_t i = 0; i < message.fields.size(); ++i) {
        auto* values = std::get_if<std::vector<DecodedValue>>(&message.fields[i].value.content);
        if (values == nullptr) continue;
        if (message.fields[i].name == "pairs") {
            for (DecodedValue& pair : *values)
                name_pair(pair);
        } else if (message.fields[i].name == "keys") {
            std::vector<DecodedValue> names;
            for (const DecodedValue& key : *values)
                names.push_back(name_of(key));
            message.fields.insert(message.fields.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                  {"names", {std::move(names)}});
            return;
        }
    }
}

}  // namespace skyloop::host
