/// One table of a TOML file, read key by key; what is left over at the end is an unknown key.
#pragma once

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/geodetic.hpp"
#include "key_recorder.hpp"
#include "run/fault/parameters.hpp"

namespace skyloop {

/// Where mistakes of one file are collected, a line each.
class MistakeList {
public:
    explicit MistakeList(std::string file) : file_(std::move(file)) {}
    /// @param code `outside` for what the outside world refused, as a file that cannot be read
    void add(const toml::source_region& where, const std::string& sentence, ErrorCode code = ErrorCode::input);
    [[nodiscard]] bool empty() const { return mistakes_.empty(); }
    /// A part of the file has been changed since it was parsed: mistakes at `path` ("run.duration_s") are told at
    /// `where`, and begin with `key`, by which whoever changed it called it ("fault.gap.at_s"). @param words that end
    /// each sentence from here on
    void changed(std::string path, std::string key, const toml::source_region& where, const std::string& words);
    /// "FILE:LINE:COLUMN: ".
    [[nodiscard]] std::string told_at(const toml::source_region& where, std::string_view key) const;
    /// All lines, in the order of the file; `outside` when nothing is wrong with the file itself, else `input`.
    [[nodiscard]] Error error() const;

private:
    struct Mistake {
        toml::source_index line, column;
        std::string sentence;
        ErrorCode code;
        bool operator==(const Mistake&) const = default;
    };
    [[nodiscard]] toml::source_position place_of(const toml::source_region& where, std::string_view sentence) const;
    std::string file_;
    std::vector<Mistake> mistakes_;
    struct Change {
        std::string path, key;
        toml::source_position place;
    };
    [[nodiscard]] const Change* change_of(const toml::source_region& where, std::string_view sentence) const;
    std::vector<Change> changes_;
    std::string changes_text_;
};

/// A sentence that stays one line and can be read: keys and texts of a file may hold anything and be of any length.
std::string on_one_line(std::string_view sentence);

/// Which numbers a key takes.
struct NumberRange {
    double least = -std::numeric_limits<double>::max();
    double most = std::numeric_limits<double>::max();
    static NumberRange positive() { return {std::numeric_limits<double>::min()}; }
    static NumberRange not_negative() { return {0}; }
};

/// A word that a key takes, and what it means.
template <class Value>
struct Word {
    std::string_view word;
    Value value;
};

/// Reads the keys of one table. A key that is absent leaves the given value as it is; a key of the wrong type or out of
/// range is a mistake. `finish()` makes every key that nobody asked for a mistake that suggests the nearest known one.
class TableReader {
public:
    /// @param recorder notes each key that is asked for; the table is then empty. Null: the table is read
    TableReader(const toml::table& table, std::string path, MistakeList& mistakes, KeyRecorder* recorder = nullptr)
        : table_(table), path_(std::move(path)), mistakes_(mistakes), recorder_(recorder) {}

    void number(std::string_view key, double& value, NumberRange range = {});
    void boolean(std::string_view key, bool& value);
    void text(std::string_view key, std::string& value);
    /// @param least how many there are at least, 0 or 1
    void texts(std::string_view key, std::vector<std::string>& values, std::size_t least = 1);
    /// A text or a list of texts.
    void text_or_texts(std::string_view key, std::vector<std::string>& values);
    /// A whole number. `range` lies within what Integer holds.
    template <std::integral Integer>
    void integer(std::string_view key, Integer& value, NumberRange range) {
        if (recording()) note(key, number_entry(KeyType::whole_number, range, static_cast<double>(value)));
        if (const auto found = whole_number(key, range)) value = static_cast<Integer>(*found);
    }
    /// A list of exactly `count` numbers.
    /// @param standard what they are when the key is absent, for the catalogue of keys alone
    std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count,
                                               std::span<const double> standard = {});
    /// [latitude, longitude] or [latitude, longitude, height]: degrees, metres above the ellipsoid.
    std::optional<Geodetic> place(std::string_view key);
    /// An instant as parse_instant() reads it, given as a text, or as a TOML date with or without a time.
    std::optional<std::string> utc(std::string_view key);
    /// One of the given words; gives its index.
    /// @param standard the word that stands for an absent key, for the catalogue of keys alone
    std::optional<std::size_t> choice(std::string_view key, std::span<const std::string_view> words,
                                      std::string_view standard = {});
    /// A list of some of the given words, at least one and none twice; gives their indices in the order of the list.
    /// @param wanted what a mistake says was expected, when the words are too many to list
    std::optional<std::vector<std::size_t>> choices(std::string_view key, std::span<const std::string_view> words,
                                                    std::string_view wanted = {});
    /// A list of whole numbers, at least one.
    std::optional<std::vector<std::int64_t>> whole_numbers(std::string_view key, NumberRange range);

    /// One of the given words; `value` becomes what it means.
    template <class Value, std::size_t count>
    void word(std::string_view key, const std::array<Word<Value>, count>& words, Value& value) {
        std::array<std::string_view, count> known;
        std::transform(words.begin(), words.end(), known.begin(), [](const Word<Value>& w) { return w.word; });
        const auto now =
            std::find_if(words.begin(), words.end(), [&](const Word<Value>& word) { return word.value == value; });
        const std::string_view standard = now == words.end() ? std::string_view() : now->word;
        if (const auto index = choice(key, known, standard)) value = words[*index].value;
    }

    /// A quantity of one unit, kept in `Quantity`.
    template <class Quantity>
    void quantity(std::string_view key, Quantity& value, NumberRange range = {}) {
        double number_value = value.value();
        number(key, number_value, range);
        value = Quantity(number_value);
    }

    /// Reads a sub-table with `body` and finishes it.
    void table(std::string_view key, const std::function<void(TableReader&)>& body);
    /// The same of a sub-table whose keys are names that the catalogue of keys does not list.
    void named_values(std::string_view key, const std::function<void(TableReader&)>& body);
    /// Reads each table of a list with `body` and finishes it.
    /// @param fewest that the caller takes, for the catalogue of keys alone
    void tables(std::string_view key, const std::function<void(TableReader&)>& body, std::size_t fewest = 0);
    /// Shows each table of a list to `body` as it stands, unchecked; mistakes are for tables() to find.
    void look_at_tables(std::string_view key, const std::function<void(const toml::table&)>& body) const;
    /// Says why a key that other versions know is refused here.
    void refuse(std::string_view key, const std::string& reason);

    [[nodiscard]] bool has(std::string_view key) {
        asked_for_.emplace_back(key);
        if (recording()) recorder_->look_for(path_, key);
        return recording() ? recorder_->given() : table_.contains(key);
    }
    /// The sentence is a mistake of the table when none of these keys is there.
    void needs_one_of(std::initializer_list<std::string_view> keys, const std::string& sentence);
    [[nodiscard]] bool is_boolean(std::string_view key) const { return table_[key].is_boolean(); }
    /// The keys that the table has.
    [[nodiscard]] std::vector<std::string> keys() const;
    /// The caller has dealt with this key itself.
    void has_been_read(std::string_view key) { known_.emplace_back(key); }
    void mistake(std::string_view key, const std::string& sentence);
    /// A file that the key names is refused.
    void mistake_of_file(std::string_view key, const Error& error);
    /// mistake() for what shows only when more of the file has been read. Valid while the file is read.
    [[nodiscard]] std::function<void(std::string_view key, const std::string& sentence)> mistake_later() const;
    /// "FILE:LINE:COLUMN: KEY: ", for what shows only when the run is put together; of the table where the key is
    /// absent.
    [[nodiscard]] std::string told_at(std::string_view key) const;
    /// "FILE:LINE:COLUMN: " of the table.
    [[nodiscard]] std::string told_at() const { return mistakes_.told_at(table_.source(), path_); }
    /// The path of a file, which has a name. @param folder to which it is relative
    void file_path(std::string_view key, const std::filesystem::path& folder, std::filesystem::path& value);
    /// Whatever stands there, as faults and commands take it; a list of pairs of numbers becomes one list. Nothing, and
    /// a mistake, for a table or a list that is neither of numbers, pairs of numbers nor texts.
    std::optional<ParameterValue> value(std::string_view key);
    /// What stands there, for a caller that reads it itself; null: nothing. @param type for the catalogue of keys
    const toml::node* node(std::string_view key, KeyType type);
    void mistake_here(const std::string& sentence) { mistakes_.add(table_.source(), where() + sentence); }
    void finish();

    /// Whether nothing is read, and the keys that are asked for are noted.
    [[nodiscard]] bool recording() const { return recorder_ != nullptr; }
    /// For the catalogue of keys: these are taken, as `value` gives them and check_parameters() checks them.
    void note_parameters(const std::vector<ParameterSpec>& specs);
    /// For the catalogue of keys: the caller refuses the one beside the other.
    void note_not_both(std::string_view key, std::string_view other);
    /// For the catalogue of keys: `kind`, one of these words, decides what else the table takes.
    /// @return the one to read with; nothing when nothing is recorded
    std::optional<std::size_t> note_kinds(std::span<const std::string_view> words, std::string_view standard = {});

private:
    void note(std::string_view key, KeyEntry entry);
    void record_inner(std::string_view key, KeyEntry entry, const std::function<void(TableReader&)>& body);
    static KeyEntry word_entry(std::span<const std::string_view> words, std::string_view standard);
    static KeyEntry numbers_entry(std::size_t count, std::span<const double> standard);
    static KeyEntry number_entry(KeyType type, NumberRange range, std::optional<double> standard = {});
    const toml::node* find(std::string_view key);
    std::optional<std::int64_t> whole_number(std::string_view key, NumberRange range);
    void mistake_at(const toml::node& node, std::string_view key, const std::string& sentence);
    [[nodiscard]] std::string where() const { return path_.empty() ? std::string() : "[" + path_ + "] "; }
    [[nodiscard]] std::string path_of(std::string_view key) const;
    void wrong_type(std::string_view key, const toml::node& node, std::string_view expected);

    const toml::table& table_;
    std::string path_;
    MistakeList& mistakes_;
    KeyRecorder* recorder_;
    std::vector<std::string> known_;      // copies: a caller may compose a key
    std::vector<std::string> asked_for_;  // whether they are there; may be meant by others, too
};

/// Parses TOML and reads its top table with `body`.
/// @param file its name, for messages
/// Fails with `input`, or with `outside` where the only mistakes are files named in it that cannot be read: one line
/// per mistake, `FILE:LINE:COLUMN: KEY: what was found; what was expected`.
/// @param change what is done to the parsed table before it is read
Result<void> read_toml(std::string_view text, const std::string& file, const std::function<void(TableReader&)>& body,
                       const std::function<void(toml::table&, MistakeList&)>& change = {});

}  // namespace skyloop
