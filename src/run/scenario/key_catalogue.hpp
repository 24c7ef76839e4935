/// Every key of scenario files, as the readers themselves ask for it: the source of the schema and of the reference.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "run/fault/parameters.hpp"

namespace skyloop::inline run {

/// What stands after the equals sign of a key, or under its heading.
enum class KeyType {
    number,
    whole_number,
    flag,           ///< true or false
    text,           ///< any
    time,           ///< ISO 8601 in UTC, as a text or as a TOML date and time
    word,           ///< one of `choices`
    words,          ///< a list of some of `choices`, each once
    word_or_words,  ///< a list of some of `choices`, or one alone
    texts,          ///< a list
    text_or_texts,
    numbers,        ///< a list
    whole_numbers,  ///< a list
    number_groups,  ///< a list of numbers, or of lists of them
    values,         ///< a list of what some other key takes
    place,          ///< [latitude, longitude] or [latitude, longitude, height]: degrees, metres above the ellipsoid
    named_values,   ///< a table of numbers, flags and texts, by names that are listed elsewhere
    table,
    tables  ///< a list
};

/// One key of a table.
struct KeyEntry {
    std::string name{};
    KeyType type = KeyType::text;
    double least = -std::numeric_limits<double>::max(), most = std::numeric_limits<double>::max();  ///< of each number
    std::size_t count_least = 0, count_most = std::numeric_limits<std::size_t>::max();              ///< of a list
    std::vector<std::string> choices{};
    std::optional<ParameterValue> standard{};  ///< what it is when it is not given; nothing: that is no fixed value
    bool needed = false;
    std::vector<std::string> kinds{};  ///< words of the table's `kind` with which it may stand; empty: with all
    std::string meaning{};             ///< for people, half a sentence
    std::string standard_words{};      ///< for people, where `standard` does not tell it: "the board's"

    /// Whether it is the same for a reader, by whatever kinds it is taken.
    [[nodiscard]] bool same_as(const KeyEntry& other) const;
};

/// Keys of a table of which some must be there, or may not stand together.
struct KeyRule {
    std::vector<std::string> keys{};
    std::vector<std::string> kinds{};  ///< as of a key
    bool operator==(const KeyRule&) const = default;
};

/// One table of a scenario.
struct KeyTable {
    std::string path{};             ///< "model.modern.clock"; empty: the top of the file
    bool list = false;              ///< [[path]]
    std::vector<KeyEntry> keys{};   ///< in the order in which they are read; one name may be there for several kinds
    std::vector<KeyRule> one_of{};  ///< at least one of the keys must be there
    std::vector<KeyRule> not_both{};
    std::vector<std::string> kinds{};   ///< words of `kind` that decide what else the table takes
    std::vector<std::string> unread{};  ///< keys that a reader looked for and never read: a mistake of the program
};

/// All tables, each before those in it. Made once, by letting the readers read nothing.
const std::vector<KeyTable>& scenario_key_tables();

/// The key of "receiver.0.rate_hz". @param kind of its table, where that decides what the key is
/// Throws std::out_of_range for a key that there is not: the program names it.
const KeyEntry& scenario_key(std::string_view path, std::string_view kind = {});
/// For the help of an option: "Navigation rate at the factory, Hz; 0.01 to 100; default the board's".
std::string key_help(const KeyEntry& key);

/// What the suffix of a key says of its unit: "m/s" of "speed_mps"; empty when it has none.
std::string_view key_unit(std::string_view key);

/// JSON Schema, draft 7, of scenario files.
std::string scenario_schema_json();
/// The page of all keys, Markdown.
std::string scenario_keys_markdown();

}  // namespace skyloop::inline run
