#include "firmware/config/config_keys.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "firmware/config/key_tables.hpp"

namespace skyloop::firmware {
namespace {

// As the names of CFG-MSGOUT items end, in the order of PortId.
constexpr std::array<std::string_view, port_count> rate_key_endings{"_I2C", "_UART1", "_UART2", "_USB", "_SPI"};

// Six sentences leave every epoch from the factory on (RECEIVER.md 3.5.2).
bool is_factory_sentence(UbxMessageId id) {
    constexpr std::uint8_t nmea = 0xF0, last = 0x05;  // GGA, GLL, GSA, GSV, RMC, VTG
    return id.message_class == nmea && id.id <= last;
}

// The whole list with its indices. Built once; it never changes.
class KeyList {
public:
    KeyList() {
        for (const auto part : {navigation_keys(), ports_keys(), system_keys(), private_keys()})
            keys_.insert(keys_.end(), part.begin(), part.end());
        for (const RateKeys& rate : rate_keys())
            add_rates(rate);
        std::sort(keys_.begin(), keys_.end(),
                  [](const ConfigKey& a, const ConfigKey& b) { return group_and_item(a.id) < group_and_item(b.id); });
        for (const ConfigKey& key : keys_)
            by_name_.emplace(key.name, &key);
    }

    [[nodiscard]] std::span<const ConfigKey> keys() const { return keys_; }
    [[nodiscard]] const ConfigKey* find(std::uint32_t id) const {
        const auto found = std::lower_bound(
            keys_.begin(), keys_.end(), group_and_item(id),
            [](const ConfigKey& key, std::uint32_t wanted) { return group_and_item(key.id) < wanted; });
        return found != keys_.end() && found->id == id ? &*found : nullptr;
    }
    [[nodiscard]] const ConfigKey* find(std::string_view name) const {
        const auto found = by_name_.find(name);
        return found == by_name_.end() ? nullptr : found->second;
    }

private:
    void add_rates(const RateKeys& rate) {
        const bool on_the_wire = (rate.message.i2c_key >> 16 & 0xFF) != private_message_group;
        const std::uint64_t factory = is_factory_sentence(rate.message.id) ? 1 : 0;
        for (std::uint32_t port = 0; port < port_count; ++port) {
            names_.push_back("CFG-MSGOUT-" + std::string(rate.stem) + std::string(rate_key_endings[port]));
            keys_.push_back({rate.message.i2c_key + port, names_.back(), ConfigType::u1, factory, on_the_wire});
        }
    }

    std::deque<std::string> names_;  // of the items of CFG-MSGOUT; a deque does not move them
    std::vector<ConfigKey> keys_;
    std::map<std::string_view, const ConfigKey*> by_name_;
};

const KeyList& key_list() {
    static const KeyList list;
    return list;
}

}  // namespace

std::span<const ConfigKey> config_keys() { return key_list().keys(); }
const ConfigKey* find_config_key(std::uint32_t id) { return key_list().find(id); }
const ConfigKey* find_config_key(std::string_view name) { return key_list().find(name); }

std::span<const OutputMessage> output_messages() {
    static const std::vector<OutputMessage> messages = [] {
        std::vector<OutputMessage> all;
        for (const RateKeys& rate : rate_keys())
            all.push_back(rate.message);
        return all;
    }();
    return messages;
}

const OutputMessage* find_output_message(UbxMessageId id) {
    const auto all = output_messages();
    const auto found = std::lower_bound(all.begin(), all.end(), id,
                                        [](const OutputMessage& m, UbxMessageId wanted) { return m.id < wanted; });
    return found != all.end() && found->id == id ? &*found : nullptr;
}

const OutputMessage* find_output_message(std::string_view name) {
    const auto all = output_messages();
    const auto found =
        std::find_if(all.begin(), all.end(), [name](const OutputMessage& message) { return message.name == name; });
    return found != all.end() ? &*found : nullptr;
}

std::optional<std::uint32_t> rate_key(UbxMessageId message, PortId port) {
    const OutputMessage* found = find_output_message(message);
    if (found == nullptr) return std::nullopt;
    return found->i2c_key + static_cast<std::uint32_t>(port);
}

}  // namespace skyloop::firmware
