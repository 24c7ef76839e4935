#include "detail/named_messages.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "receiver/protocol/ubx_messages.hpp"

namespace skyloop::inline run {
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

namespace {

using firmware::BoardProfile;

constexpr UbxMessageId cfg_rst{0x06, 0x04}, cfg_valset{0x06, 0x8A}, cfg_valdel{0x06, 0x8C}, rxm_pmreq{0x02, 0x41},
    nav_resetodo{0x01, 0x10}, nav_odo{0x01, 0x09}, pubx_rates{0xF1, 0x40}, pubx_port{0xF1, 0x41};
constexpr std::string_view no_ublox = "is no u-blox receiver and has no such messages";

bool is_of_values(UbxMessageId id) { return id >= cfg_valset && id <= cfg_valdel; }

// As LegacyConfig does with a message of class CFG.
firmware::LegacyAnswer answer_to(const BoardProfile& board, UbxMessageId id) {
    if (is_of_values(id)) {
        using enum firmware::ValueConfigSupport;
        const auto support = board.quirks.value_config;
        return support == full     ? firmware::LegacyAnswer::apply
               : support == refuse ? firmware::LegacyAnswer::refuse
                                   : firmware::LegacyAnswer::silence;
    }
    const auto known = board.legacy.find(id);
    return known == board.legacy.end() ? firmware::LegacyAnswer::refuse : known->second;
}

bool is_answered(const BoardProfile& board, UbxMessageId id) {
    if (id == cfg_rst || id == rxm_pmreq || id == pubx_rates || id == pubx_port) return false;
    if (id.message_class == firmware::class_cfg) return answer_to(board, id) != firmware::LegacyAnswer::silence;
    if (id == nav_resetodo) return firmware::sends(board, nav_odo);
    return id.message_class == firmware::class_mga || id.message_class == firmware::class_log ||
           firmware::knows(board, id);
}

}  // namespace

std::string why_not_answered(const UsedReceiver& receiver, std::string_view name) {
    const auto id = find_message(name);
    if (!id) return {};
    if (!can<&firmware::Abilities::ubx>(receiver)) return std::string(no_ublox);
    return is_answered(receiver.board, *id) ? std::string() : fmt::format("never answers {}", name);
}

std::string why_not_refused(const UsedReceiver& receiver, std::string_view name) {
    const auto id = find_message(name);
    if (!id) return {};
    if (!can<&firmware::Abilities::ubx>(receiver)) return std::string(no_ublox);
    const bool refused = id->message_class == firmware::class_cfg && *id != cfg_rst &&
                         answer_to(receiver.board, *id) == firmware::LegacyAnswer::refuse;
    return refused ? fmt::format("refuses {} anyway", name) : std::string();
}

std::string why_not_withheld(const UsedReceiver& receiver, std::string_view name) {
    const auto id = find_message(name);
    if (!id) return {};
    if (sends_by_command_line(receiver, *id)) return "sends what its command line chooses, whatever is withheld";
    if (sends_periodically(receiver, *id)) return {};
    return fmt::format("never sends {} with its epochs", name);
}

std::string why_no_item(const UsedReceiver& receiver, std::string_view name) {
    const firmware::ConfigKey* key = firmware::find_config_key(upper_case(name));
    if (key == nullptr) return {};
    if (!can<&firmware::Abilities::ubx>(receiver) ||
        receiver.board.quirks.value_config != firmware::ValueConfigSupport::full)
        return "takes no CFG-VALSET";
    return firmware::factory_config(receiver.board).contains(key->id)
               ? std::string()
               : fmt::format("has no {} and refuses it anyway", name);
}

}  // namespace skyloop::inline run
