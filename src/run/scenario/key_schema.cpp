// JSON Schema of scenario files (https://json-schema.org/draft-07). The draft is that of the editors: taplo 0.9, which
// serves TOML in VS Code, Zed, Helix and Neovim, silently passes over `prefixItems` and what stands beside a `$ref` in
// schemas of draft 2020-12.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/core/json.hpp"
#include "base/geo/geodetic.hpp"
#include "run/scenario/key_catalogue.hpp"

namespace skyloop::inline run {
namespace {

// 35, not 35.00000000000001 as radians give it back.
Json plain_number(double value) {
    const double rounded = std::stod(fmt::format("{:.12g}", value));
    constexpr double exact = 9e15;
    if (std::floor(rounded) == rounded && std::abs(rounded) < exact) return static_cast<std::int64_t>(rounded);
    return rounded;
}

Json plain_value(const ParameterValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return plain_number(*number);
    if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
        Json list = Json::array();
        for (const double number : *numbers)
            list.push_back(plain_number(number));
        return list;
    }
    return std::visit([](const auto& other) { return Json(other); }, value);
}

Json number_schema(const KeyEntry& key, std::string_view type) {
    constexpr double no_bound = std::numeric_limits<double>::max();
    Json schema{{"type", type}};
    if (key.least == std::numeric_limits<double>::min())
        schema["exclusiveMinimum"] = 0;
    else if (key.least > -no_bound)
        schema["minimum"] = plain_number(key.least);
    if (key.most < no_bound) schema["maximum"] = plain_number(key.most);
    return schema;
}

Json list_schema(const KeyEntry& key, Json items) {
    Json schema{{"type", "array"}, {"items", std::move(items)}};
    if (key.count_least > 0) schema["minItems"] = key.count_least;
    if (key.count_most < std::numeric_limits<std::size_t>::max()) schema["maxItems"] = key.count_most;
    return schema;
}

Json word_schema(const KeyEntry& key) { return {{"type", "string"}, {"enum", key.choices}}; }

// [[latitude, longitude], …] as well as one list of all.
Json groups_schema(const KeyEntry& key) {
    const Json flat = list_schema(key, number_schema(key, "number"));
    if (key.count_least <= 3) return flat;  // a place, or bounds
    const Json pair{{"type", "array"}, {"items", number_schema(key, "number")}, {"minItems", 2}, {"maxItems", 2}};
    return {{"anyOf", Json::array({flat, {{"type", "array"}, {"items", pair}, {"minItems", key.count_least / 2}}})}};
}

// The limits of place_from_degrees().
Json place_schema(const KeyEntry& key) {
    const auto between = [](double least, double most, std::string_view meaning) {
        return Json{{"type", "number"},
                    {"minimum", plain_number(least)},
                    {"maximum", plain_number(most)},
                    {"description", meaning}};
    };
    return list_schema(key, Json::array({between(-90, 90, "latitude, °"), between(-360, 360, "longitude, °"),
                                         between(-1e4, 1e7, "height above the ellipsoid, m")}));
}

Json one_or_more(Json single, Json list) { return {{"anyOf", Json::array({std::move(single), std::move(list)})}}; }

// What a key takes, without words for people. A table is a reference that the caller sets.
Json value_schema(const KeyEntry& key) {
    const Json text{{"type", "string"}};
    switch (key.type) {
        case KeyType::number:
            return number_schema(key, "number");
        case KeyType::whole_number:
            return number_schema(key, "integer");
        case KeyType::flag:
            return {{"type", "boolean"}};
        case KeyType::text:
        case KeyType::time:
            return text;
        case KeyType::word:
            return word_schema(key);
        case KeyType::words: {
            Json list = list_schema(key, word_schema(key));
            list["uniqueItems"] = true;
            return list;
        }
        case KeyType::word_or_words:
            return one_or_more(word_schema(key), list_schema(key, word_schema(key)));
        case KeyType::texts:
            return list_schema(key, text);
        case KeyType::text_or_texts:
            return one_or_more(text, list_schema(key, text));
        case KeyType::numbers:
            return list_schema(key, number_schema(key, "number"));
        case KeyType::number_groups:
            return groups_schema(key);
        case KeyType::whole_numbers:
            return list_schema(key, number_schema(key, "integer"));
        case KeyType::values:
            return list_schema(key, Json::object());
        case KeyType::place:
            return place_schema(key);
        case KeyType::named_values:
            return {{"type", "object"}, {"additionalProperties", {{"type", {"number", "boolean", "string"}}}}};
        default:
            return Json::object();
    }
}

std::string description_of(const KeyEntry& key) {
    std::string words = key.meaning;
    if (const std::string_view unit = key_unit(key.name); !unit.empty()) words += fmt::format(" [{}]", unit);
    if (!key.standard_words.empty()) words += fmt::format("; default: {}", key.standard_words);
    return words;
}

std::string path_below(const KeyTable& table, const KeyEntry& key) {
    return table.path.empty() ? key.name : table.path + "." + key.name;
}

Json key_schema(const KeyTable& table, const KeyEntry& key) {
    Json schema = value_schema(key);
    const Json reference{{"$ref", "#/definitions/" + path_below(table, key)}};
    // In draft 7 nothing beside a reference counts.
    if (key.type == KeyType::table) schema = {{"allOf", Json::array({reference})}};
    if (key.type == KeyType::tables) schema = list_schema(key, reference);
    schema["description"] = description_of(key);
    if (key.standard && key.standard_words.empty()) schema["default"] = plain_value(*key.standard);
    return schema;
}

bool taken_with(const std::vector<std::string>& kinds, const std::string& kind) {
    return kinds.empty() || std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

// A key that means several things by the kind is any of them; which one, the part of the kind says.
Json properties_of(const KeyTable& table) {
    Json properties = Json::object();
    for (const KeyEntry& key : table.keys) {
        Json schema = key_schema(table, key);
        const auto before = properties.find(key.name);
        if (before == properties.end())
            properties[key.name] = std::move(schema);
        else if (before->contains("anyOf") && before->value("x-by-kind", false))
            (*before)["anyOf"].push_back(std::move(schema));
        else
            *before = {{"x-by-kind", true}, {"anyOf", Json::array({*before, std::move(schema)})}};
    }
    for (auto& [name, schema] : properties.items())
        schema.erase("x-by-kind");
    return properties;
}

Json needed_of(const KeyTable& table, const std::string& kind) {
    Json needed = Json::array();
    for (const KeyEntry& key : table.keys)
        if (key.needed && (kind.empty() ? key.kinds.empty() : !key.kinds.empty() && taken_with(key.kinds, kind)))
            needed.push_back(key.name);
    return needed;
}

Json rule_schemas(const KeyTable& table, const std::string& kind) {
    Json rules = Json::array();
    const auto counts = [&](const KeyRule& rule) {
        return kind.empty() ? rule.kinds.empty() : !rule.kinds.empty() && taken_with(rule.kinds, kind);
    };
    for (const KeyRule& rule : table.one_of) {
        if (!counts(rule)) continue;
        Json ways = Json::array();
        for (const std::string& key : rule.keys)
            ways.push_back({{"required", Json::array({key})}});
        rules.push_back({{"anyOf", std::move(ways)}});
    }
    for (const KeyRule& rule : table.not_both)
        if (counts(rule)) rules.push_back({{"not", {{"required", rule.keys}}}});
    return rules;
}

// What a table with this kind takes: no key of others, and its own of those that differ.
Json kind_schema(const KeyTable& table, const std::string& kind) {
    Json names = Json::array();
    Json own = Json::object();
    for (const KeyEntry& key : table.keys) {
        if (!taken_with(key.kinds, kind)) continue;
        names.push_back(key.name);
        const auto same_name = [&](const KeyEntry& other) { return other.name == key.name; };
        if (std::count_if(table.keys.begin(), table.keys.end(), same_name) > 1) own[key.name] = key_schema(table, key);
    }
    Json then{{"propertyNames", {{"enum", std::move(names)}}}};
    if (!own.empty()) then["properties"] = std::move(own);
    if (Json needed = needed_of(table, kind); !needed.empty()) then["required"] = std::move(needed);
    if (Json rules = rule_schemas(table, kind); !rules.empty()) then["allOf"] = std::move(rules);
    return {{"if", {{"properties", {{"kind", {{"const", kind}}}}}, {"required", Json::array({"kind"})}}},
            {"then", std::move(then)}};
}

Json table_schema(const KeyTable& table) {
    Json schema{{"type", "object"}, {"properties", properties_of(table)}, {"additionalProperties", false}};
    if (Json needed = needed_of(table, {}); !needed.empty()) schema["required"] = std::move(needed);
    Json parts = rule_schemas(table, {});
    const bool by_kind =
        std::any_of(table.keys.begin(), table.keys.end(), [](const KeyEntry& key) { return !key.kinds.empty(); });
    if (by_kind)
        for (const std::string& kind : table.kinds)
            parts.push_back(kind_schema(table, kind));
    if (!parts.empty()) schema["allOf"] = std::move(parts);
    return schema;
}

}  // namespace

std::string scenario_schema_json() {
    Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
                {"title", "skyloop scenario"},
                {"description", "Written by `skyloop schema`; `skyloop check FILE` tells what a schema cannot."}};
    Json definitions = Json::object();
    for (const KeyTable& table : scenario_key_tables())
        if (table.path.empty())
            schema.update(table_schema(table));
        else
            definitions[table.path] = table_schema(table);
    schema["definitions"] = std::move(definitions);
    return schema.dump(2) + "\n";
}

}  // namespace skyloop::inline run
