#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "base/core/words.hpp"
#include "detail/scenario_keys.hpp"
#include "firmware/core/board_profile.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "firmware/ublox/config/config_store.hpp"

namespace skyloop::inline run {
namespace {

using firmware::BoardProfile;
using firmware::ConfigKey;
using firmware::ConfigType;
using firmware::LegacyAnswer;

struct MessageNames {
    std::vector<UbxMessageId> ids;
    std::vector<std::string_view> names;
    template <class List>
    void add(const List& list) {
        for (const auto& message : list) {
            ids.push_back(message.id);
            names.push_back(message.name);
        }
    }
};

std::vector<UbxMessageId> read_messages(TableReader& ubx, std::string_view key, const MessageNames& known) {
    std::vector<UbxMessageId> messages;
    const auto found =
        ubx.choices(key, known.names, {}, "a list of messages by name, such as NAV-PVT, GGA or RTCM-1005");
    if (found)
        for (const std::size_t index : *found)
            messages.push_back(known.ids[index]);
    return messages;
}

void read_legacy(TableReader& legacy, BoardProfile& board) {
    for (const firmware::NamedMessage& message : firmware::legacy_messages()) {
        LegacyAnswer answer = LegacyAnswer::apply;
        legacy.word(message.name,
                    {{"apply", LegacyAnswer::apply},
                     {"ignore", LegacyAnswer::ignore},
                     {"refuse", LegacyAnswer::refuse},
                     {"silence", LegacyAnswer::silence}},
                    answer);
        if (legacy.has(message.name)) board.legacy[message.id] = answer;
    }
}

// Eight bytes as on the wire: system, reserved and most channels, reserved, flags.
void read_gnss_blocks(TableReader& ubx, BoardProfile& board) {
    std::vector<std::string> texts;
    ubx.texts("gnss_blocks", texts);
    constexpr std::size_t block_size = 8;
    for (const std::string& text : texts) {
        const auto bytes = bytes_of_hex(text);
        if (!bytes || bytes->size() != block_size)
            return ubx.mistake("gnss_blocks",
                               fmt::format("holds '{}'; expected eight bytes in hexadecimal digits", text));
        const Bytes& b = *bytes;
        std::uint32_t flags = 0;
        for (std::size_t i = 0; i < 4; ++i)
            flags |= std::uint32_t{b[4 + i]} << 8 * i;
        board.gnss_blocks.push_back({b[0], b[1], b[2], flags});
    }
}

// Whether a pattern, in which `*` stands for any text, covers the whole name.
bool matches(std::string_view pattern, std::string_view name) {
    while (!pattern.empty() && pattern.front() != '*') {
        if (name.empty() || name.front() != pattern.front()) return false;
        pattern.remove_prefix(1);
        name.remove_prefix(1);
    }
    if (pattern.empty()) return name.empty();
    const std::size_t more = pattern.find_first_not_of('*');
    if (more == std::string_view::npos) return true;
    pattern.remove_prefix(more);
    // The text up to the next star at its first place: a later one would leave less for what follows.
    const std::string_view part = pattern.substr(0, pattern.find('*'));
    if (part.size() == pattern.size()) return name.ends_with(part);
    const std::size_t place = name.find(part);
    return place != std::string_view::npos && matches(pattern.substr(part.size()), name.substr(place + part.size()));
}

void read_absent_keys(TableReader& config, BoardProfile& board) {
    std::vector<std::string> patterns;
    config.texts("absent", patterns);
    for (const std::string& pattern : patterns) {
        bool found = false;
        for (const ConfigKey& key : firmware::config_keys()) {
            if (!matches(pattern, key.name)) continue;
            board.absent_keys.insert(key.id);
            found = true;
        }
        if (!found)
            config.mistake("absent", fmt::format("holds '{}', which no configuration item is called{}", pattern,
                                                 did_you_mean(pattern, config_item_names())));
    }
}

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

void read_board_ubx(TableReader& ubx, BoardProfile& board) {
    MessageNames sent, polled;
    sent.add(firmware::output_messages());
    polled.add(firmware::polled_messages());
    polled.add(firmware::output_messages());
    board.messages = read_messages(ubx, "messages", sent);
    const auto only_polled = read_messages(ubx, "polled", polled);
    board.polled.insert(only_polled.begin(), only_polled.end());
    ubx.table("legacy", [&](TableReader& legacy) { read_legacy(legacy, board); });
    read_gnss_blocks(ubx, board);
    ubx.integer("gnss_channels_hardware", board.gnss_channels_hardware, {0, 255});
    ubx.integer("gnss_channels_used", board.gnss_channels_used, {0, 255});
    ubx.integer("gnss_supported", board.gnss_supported, {0, 15});
    ubx.integer("gnss_simultaneous", board.gnss_simultaneous, {0, 4});
    ubx.number("phase_deviation_scale", board.phase_deviation_scale, {0, 100});
    ubx.number("doppler_deviation_hz", board.doppler_deviation_hz, {0, 100});
    ubx.boolean("comms_output_port", board.comms_output_port);
    ubx.integer("galileo_words", board.galileo_words, {8, 9});
}

namespace {

// A message that the firmware has no rate for is not one of its.
void leave_out_messages_of_others(BoardProfile& board) {
    std::erase_if(board.messages, [&board](UbxMessageId message) {
        const std::uint32_t rate = firmware::find_output_message(message)->i2c_key;
        return firmware::is_of_ublox(rate) && !firmware::is_on_the_wire(board, rate);
    });
}

}  // namespace

void leave_out_rates_of_others(BoardProfile& board) {
    for (const firmware::OutputMessage& message : firmware::output_messages()) {
        const bool listed = board.items_of != nullptr && firmware::is_of_ublox(message.i2c_key);
        if (listed || firmware::sends(board, message.id)) continue;
        for (std::uint32_t port = 0; port < firmware::ublox_port_count; ++port)
            board.absent_keys.insert(message.i2c_key + port);
    }
}

void read_board_config(TableReader& config, BoardProfile& board) {
    std::vector<std::string_view> firmware;
    for (const firmware::FirmwareList& list : firmware::firmware_lists())
        firmware.push_back(list.name);
    if (const auto index = config.choice("items_of", firmware)) board.items_of = &firmware::firmware_lists()[*index];
    leave_out_messages_of_others(board);
    read_absent_keys(config, board);
    if (board.maker == firmware::MakerKind::ublox) leave_out_rates_of_others(board);
    const auto items = firmware::factory_config(board);
    for (const auto& [id, value] : read_config_items(config, {"items_of", "absent"})) {
        const std::string_view name = firmware::find_config_key(id)->name;
        if (!items.contains(id))
            config.mistake(name, "is set, and is among the items that the board does not have");
        else if (firmware::is_in_range(board, id, value))
            board.config[id] = value;
        else
            config.mistake(name, fmt::format("is {}, which the receiver itself would refuse", value));
    }
}

void read_signal_conflicts(TableReader& navigation, BoardProfile& board) {
    std::vector<std::string> sets;
    navigation.texts("signal_conflicts", sets, {}, 0);
    for (const std::string& names : sets) {
        std::set<std::uint32_t> conflict;
        for (std::size_t begin = 0, end = 0; begin < names.size(); begin = end + 1) {
            end = std::min(names.find(' ', begin), names.size());
            const std::string name = names.substr(begin, end - begin);
            const ConfigKey* key = firmware::find_config_key(name);
            if (key == nullptr || !name.starts_with("CFG-SIGNAL-"))
                return navigation.mistake("signal_conflicts",
                                          fmt::format("holds '{}', which no item of CFG-SIGNAL is called{}", name,
                                                      did_you_mean(name, config_item_names())));
            conflict.insert(key->id);
        }
        board.signal_conflicts.push_back(std::move(conflict));
    }
}

std::vector<std::string_view> config_item_names() {
    std::vector<std::string_view> names;
    for (const ConfigKey& key : firmware::config_keys())
        names.push_back(key.name);
    return names;
}

std::map<std::uint32_t, std::uint64_t> read_config_items(TableReader& config,
                                                         std::initializer_list<std::string_view> others) {
    std::map<std::uint32_t, std::uint64_t> items;
    for (const std::string& name : config.keys()) {
        if (std::ranges::find(others, name) != others.end()) continue;
        if (const ConfigKey* key = firmware::find_config_key(name)) {
            items[key->id] = read_value(config, *key);
        } else {
            config.mistake(name, fmt::format("is no configuration item{}", did_you_mean(name, config_item_names())));
            config.has_been_read(name);
        }
    }
    return items;
}

}  // namespace skyloop::inline run
