#include "detail/message_lookup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "base/core/letter_case.hpp"
#include "base/core/number_in.hpp"
#include "base/core/spelling.hpp"
#include "firmware/config/config_keys.hpp"
#include "firmware/config/message_names.hpp"
#include "receiver/protocol/ubx_names.hpp"

namespace skyloop {
namespace {

using firmware::NamedMessage;

// What clients send that stands in no other table of the firmware: u-blox F9 interface description HPG 1.32, section 3,
// and M8 interface description, 32 and 31.3: CFG-RST, CFG-VALSET, CFG-VALGET, CFG-VALDEL, NAV-RESETODO, PUBX-40 and
// -41.
constexpr UbxMessageId more_messages[] = {{0x06, 0x04}, {0x06, 0x8A}, {0x06, 0x8B}, {0x06, 0x8C},
                                          {0x01, 0x10}, {0xF1, 0x40}, {0xF1, 0x41}};

std::vector<NamedMessage> named_messages() {
    std::vector<NamedMessage> all;
    for (const UbxMessageId id : more_messages)
        if (const auto name = ubx_message_name(id)) all.push_back({id, *name});
    for (const auto& list : {firmware::polled_messages(), firmware::legacy_messages()})
        all.insert(all.end(), list.begin(), list.end());
    for (const firmware::OutputMessage& message : firmware::output_messages())
        all.push_back({message.id, message.name});
    return all;
}

std::optional<std::uint8_t> hexadecimal_byte(std::string_view digits) {
    return digits.size() == 2 ? hexadecimal_number_in<std::uint8_t>(digits) : std::nullopt;
}

// "UBX-0F-01".
std::optional<UbxMessageId> message_by_number(std::string_view name) {
    constexpr std::string_view prefix = "UBX-";
    if (name.size() != 9 || !name.starts_with(prefix) || name[6] != '-') return std::nullopt;
    const auto message_class = hexadecimal_byte(name.substr(4, 2)), id = hexadecimal_byte(name.substr(7, 2));
    if (!message_class || !id) return std::nullopt;
    return UbxMessageId{*message_class, *id};
}

Error nothing_named(std::string_view parameter, std::string_view expected) {
    return {ErrorCode::usage, fmt::format("{} names nothing; expected {}", parameter, expected)};
}

}  // namespace

Result<UbxMessageId> find_message(std::string_view name) {
    std::string wanted = upper_case(name);
    if (const auto id = message_by_number(wanted)) return *id;
    if (wanted.starts_with("PUBX,")) wanted[4] = '-';
    std::vector<std::string_view> known;
    for (const NamedMessage& message : named_messages()) {
        if (message.name == wanted) return message.id;
        known.push_back(message.name);
    }
    return fail(ErrorCode::usage, fmt::format("'{}' is no message that is known{}; expected a name like MON-VER, GGA, "
                                              "PUBX,41 or UBX-0A-04",
                                              name, did_you_mean(wanted, known)));
}

Result<std::set<UbxMessageId>> read_messages(const Parameters& parameters, std::string_view parameter) {
    std::set<UbxMessageId> messages;
    for (const std::string& name : parameters.texts(parameter)) {
        const auto message = find_message(name);
        if (!message) return fail(ErrorCode::usage, fmt::format("{}: {}", parameter, message.error().message));
        messages.insert(*message);
    }
    if (messages.empty()) return fail(nothing_named(parameter, "at least one message"));
    return messages;
}

Result<std::set<std::uint32_t>> read_items(const Parameters& parameters, std::string_view parameter) {
    std::set<std::uint32_t> items;
    for (const std::string& name : parameters.texts(parameter)) {
        const std::string wanted = upper_case(name);
        const firmware::ConfigKey* key = firmware::find_config_key(wanted);
        if (key == nullptr) {
            std::vector<std::string_view> known;
            for (const firmware::ConfigKey& each : firmware::config_keys())
                known.push_back(each.name);
            return fail(ErrorCode::usage, fmt::format("{}: '{}' is no configuration item{}; expected a name like "
                                                      "CFG-RATE-MEAS",
                                                      parameter, name, did_you_mean(wanted, known)));
        }
        items.insert(key->id);
    }
    if (items.empty()) return fail(nothing_named(parameter, "at least one configuration item"));
    return items;
}

}  // namespace skyloop
