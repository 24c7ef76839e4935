#include "run/scenario/listed_board.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "base/core/files.hpp"
#include "base/core/json.hpp"
#include "detail/board_parents.hpp"
#include "detail/scenario_keys.hpp"
#include "detail/table_reader.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "run/scenario/board_files.hpp"

namespace skyloop::inline run {
namespace {

using firmware::BoardProfile;
using firmware::ConfigKey;

Json json_of(const toml::node& node) {
    if (const auto* list = node.as_array()) {
        Json values = Json::array();
        for (const toml::node& item : *list)
            values.push_back(json_of(item));
        return values;
    }
    if (const auto* table = node.as_table()) {
        Json values = Json::object();
        for (const auto& [key, value] : *table)
            values[std::string(key.str())] = json_of(value);
        return values;
    }
    if (const auto* text = node.as_string()) return text->get();
    if (const auto* flag = node.as_boolean()) return flag->get();
    if (const auto* whole = node.as_integer()) return whole->get();
    return node.value_or(0.0);
}

Json json_of(const std::optional<ParameterValue>& standard, KeyType type) {
    if (!standard) return type == KeyType::texts || type == KeyType::words ? Json::array() : Json();
    if (const auto* number = std::get_if<double>(&*standard)) {
        if (type == KeyType::whole_number) return static_cast<std::int64_t>(*number);
        return *number;
    }
    if (const auto* flag = std::get_if<bool>(&*standard)) return *flag;
    if (const auto* text = std::get_if<std::string>(&*standard)) return *text;
    return {};
}

// What a file may hold, in the order in which it is read; the standards are what the board has.
std::vector<KeyTable> tables_of(BoardProfile board) {
    KeyRecorder recorder;
    const toml::table nothing;
    MistakeList mistakes("keys");  // of readers that find nothing; nobody sees them
    recorder.begin(false);
    recorder.record({}, false, [&] {
        TableReader top(nothing, {}, mistakes, &recorder);
        read_board_keys(top, board);
    });
    return recorder.tables();
}

const toml::table* table_at(const toml::table& top, std::string_view path) {
    return path.empty() ? &top : top.at_path(path).as_table();
}

// Messages and items have tables of their own; what was not said of a legacy message has no standard.
bool is_listed(const KeyTable& table, const KeyEntry& key, const toml::table* given) {
    const bool optional = table.path == "ubx.legacy" || table.path == "usb" || table.path == "sbf" ||
                          table.path == "dronecan" || table.path == "nmea.late";
    if (table.path == "nmea.lines") return false;  // listed as a whole
    if (key.type == KeyType::table || key.type == KeyType::named_values || table.path == "config") return false;
    if (table.path.empty()) return key.name == "personality";
    return !(table.path == "ubx" && key.name == "messages") &&
           (!optional || (given != nullptr && given->contains(key.name)));
}

void list_keys(const toml::table& top, const BoardProfile& board, Json& listing) {
    for (const KeyTable& table : tables_of(board)) {
        const toml::table* given = table_at(top, table.path);
        Json& keys = table.path.empty() ? listing : listing[table.path];
        for (const KeyEntry& key : table.keys) {
            if (!is_listed(table, key, given)) continue;
            const toml::node* node = given == nullptr ? nullptr : given->get(key.name);
            keys[key.name] = node == nullptr ? json_of(key.standard, key.type) : json_of(*node);
        }
        if (!table.path.empty() && keys.is_null()) listing.erase(table.path);
    }
    listing["identity"]["banner"] = board.identity.banner;
}

Json value_of(const ConfigKey& item, std::uint64_t value) {
    using enum firmware::ConfigType;
    const std::uint64_t bits = firmware::cut_to_size(item.id, ~std::uint64_t{0});
    switch (item.type) {
        case l:
            return value != 0;
        case i1:
        case i2:
        case i4:
        case i8:
            return value > bits / 2 ? -1 - static_cast<std::int64_t>(bits - value) : static_cast<std::int64_t>(value);
        case x1:
        case x2:
        case x4:
        case x8:
            return fmt::format("0x{:X}", value);
        case r4:
            return std::bit_cast<float>(static_cast<std::uint32_t>(value));
        case r8:
            return std::bit_cast<double>(value);
        default:
            return value;
    }
}

Json messages_of(const BoardProfile& board, const firmware::ConfigValues& factory) {
    Json messages = Json::array();
    for (const UbxMessageId id : board.messages) {
        Json rates = Json::object();
        for (const firmware::PortId port : board.ports)
            if (const auto rate = factory.find(*firmware::rate_key(id, port)); rate != factory.end())
                rates[std::string(firmware::port_names[static_cast<std::size_t>(port)])] = rate->second;
        messages.push_back({{"name", firmware::find_output_message(id)->name}, {"rates", std::move(rates)}});
    }
    return messages;
}

Json items_of(const BoardProfile& board, const firmware::ConfigValues& factory) {
    Json differing = Json::array();
    std::size_t count = 0;
    for (const auto& [id, value] : factory) {
        if (!firmware::is_on_the_wire(board, id)) continue;
        ++count;
        const ConfigKey& item = *firmware::find_config_key(id);
        if (value == item.default_value || item.name.starts_with("CFG-MSGOUT-")) continue;
        differing.push_back(
            {{"name", item.name}, {"value", value_of(item, value)}, {"default", value_of(item, item.default_value)}});
    }
    Json items{{"count", count}};
    if (board.items_of != nullptr) {
        items["items_of"] = board.items_of->name;
        items["interface_description"] = board.items_of->source;
    }
    items["differing"] = std::move(differing);
    return items;
}

std::string text_of(const Json& value) {
    if (value.is_array()) {
        std::vector<std::string> parts;
        for (const Json& part : value)
            parts.push_back(text_of(part));
        return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", "));
    }
    if (value.is_null()) return "none";
    if (value.is_number_float()) return fmt::format("{}", value.get<double>());
    if (value.is_string()) return value.get<std::string>().empty() ? "none" : value.get<std::string>();
    return json_text(value);
}

using Rows = std::vector<std::vector<std::string>>;

// Cells in columns, two blanks in front of each row.
std::string table_text(const Rows& rows) {
    std::vector<std::size_t> widths;
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (i == widths.size()) widths.push_back(0);
            widths[i] = std::max(widths[i], row[i].size());
        }
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i)
            line += fmt::format("  {:<{}}", row[i], i + 1 == row.size() ? 0 : widths[i]);
        text += line + "\n";
    }
    return text;
}

std::string keys_text(std::string_view title, const Json& keys) {
    Rows rows;
    for (const auto& [key, value] : keys.items()) {
        const std::string_view unit = value.is_number() ? key_unit(key) : std::string_view();
        rows.push_back({key, unit.empty() ? text_of(value) : fmt::format("{} {}", text_of(value), unit)});
    }
    return fmt::format("\n{}\n{}", title, table_text(rows));
}

std::string messages_text(const Json& messages) {
    Rows rows{{"message"}};
    for (const Json& message : messages) {
        if (rows.size() == 1)
            for (const auto& [port, rate] : message.at("rates").items())
                rows.front().push_back(port);
        rows.push_back({message.at("name")});
        for (const auto& [port, rate] : message.at("rates").items())
            rows.back().push_back(rate == 0 ? "-" : json_text(rate));
    }
    return fmt::format("\nmessages, every so many epochs\n{}", table_text(rows));
}

std::string items_text(const Json& items) {
    std::string text = fmt::format("\n{} configuration items", items.at("count").get<std::size_t>());
    if (items.contains("items_of"))
        text += fmt::format(", of {} ({})", text_of(items["items_of"]), text_of(items["interface_description"]));
    Rows rows{{"differing item", "here", "otherwise"}};
    for (const Json& item : items.at("differing"))
        rows.push_back({item.at("name"), text_of(item.at("value")), text_of(item.at("default"))});
    return text + "\n" + (rows.size() == 1 ? "" : table_text(rows));
}

Result<Json> board_listing(std::string_view name, std::span<const std::filesystem::path> directories) {
    const auto board = find_board(name, directories);
    if (!board) return fail(board.error());
    const std::filesystem::path file = board->files.front();
    const auto text = read_text_file(file);
    if (!text) return fail(text.error());
    Json listing{{"name", board->name},
                 {"description", board->description},
                 {"files", board->files},
                 {"aliases", board->aliases},
                 {"sources", board->sources}};
    const auto list = [&](toml::table& top, MistakeList& mistakes) {
        lay_parents_under(top, file, directories, mistakes);
        list_keys(top, *board, listing);
    };
    static_cast<void>(read_toml(
        *text, file.string(), [](TableReader&) {}, list));
    const firmware::ConfigValues factory = firmware::factory_config(*board);
    const bool is_ublox = board->maker == firmware::MakerKind::ublox;
    if (is_ublox || !board->sentences.empty()) listing["messages"] = messages_of(*board, factory);
    if (is_ublox) listing["items"] = items_of(*board, factory);
    return listing;
}

std::string text_of_listing(const Json& listing) {
    std::string text = fmt::format("{}\n  {}\n", text_of(listing.at("name")), text_of(listing.at("description")));
    text += table_text({{"personality", text_of(listing.at("personality"))},
                        {"aliases", text_of(listing.at("aliases"))},
                        {"files", text_of(listing.at("files"))}});
    for (const auto& [key, value] : listing.items()) {
        if (key == "items")
            text += items_text(value);
        else if (key == "messages")
            text += messages_text(value);
        else if (value.is_object())
            text += keys_text(key, value);
    }
    text += "\nsources\n";
    for (const Json& source : listing.at("sources"))
        text += fmt::format("  {}\n", text_of(source));
    return text;
}

}  // namespace

Result<std::string> board_json(std::string_view name, std::span<const std::filesystem::path> directories) {
    const auto listing = board_listing(name, directories);
    if (!listing) return fail(listing.error());
    return json_text(*listing) + "\n";
}

Result<std::string> board_text(std::string_view name, std::span<const std::filesystem::path> directories) {
    const auto listing = board_listing(name, directories);
    if (!listing) return fail(listing.error());
    return text_of_listing(*listing);
}

}  // namespace skyloop::inline run
