/// One table of a TOML file, read key by key; what is left over at the end is an unknown key.
/// Notes what the readers of a file ask for, when they are let read nothing.
#pragma once

#include <toml++/toml.h>

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "run/fault/parameters.hpp"
#include "run/scenario/key_catalogue.hpp"

namespace skyloop::inline run {

/// One reading shows the keys of one branch. So each table is read once for each word of its `kind`, and the whole with
/// every key said to be there and with none.
class KeyRecorder {
public:
    /// @param given what has() answers from here on
    void begin(bool given) { given_ = given; }
    [[nodiscard]] bool given() const { return given_; }

    /// Calls `body`, which reads the table: without a kind, and with each that it then names.
    void record(const std::string& path, bool list, const std::function<void()>& body);
    void note(const std::string& path, KeyEntry entry);
    void note_one_of(const std::string& path, std::initializer_list<std::string_view> keys);
    void note_not_both(const std::string& path, std::string_view key, std::string_view other);
    /// Of the words of `kind` of a table, the one to read with.
    std::optional<std::size_t> kind(const std::string& path, std::span<const std::string_view> words);
    /// The word of `kind` that is read with is none of this version.
    void refuse_kind(const std::string& path);
    /// A reader looks whether a key is there, which it may read or not.
    void look_for(const std::string& path, std::string_view key);

    /// What has been noted, each table before those in it; kinds that were refused are left out.
    [[nodiscard]] std::vector<KeyTable> tables() const;

private:
    struct Noted {
        KeyTable table{};
        std::vector<std::string> words{};  // of `kind`
        std::string kind{};                // the one that is read with; empty: none
        bool names_kinds = false;          // the reader has named the words
        std::set<std::string> refused{};   // of them
        std::set<std::string> looked_for{};
        std::set<std::pair<std::string, std::string>> seen{};  // kind, key
        std::vector<std::string> order{};                      // of names, as a reader asks that finds all of them
        // What a reader asks for that has no kind, and needs one, is not of all kinds.
        [[nodiscard]] bool is_waiting() const { return names_kinds && kind.empty(); }
    };
    [[nodiscard]] static KeyTable finished(const Noted& noted);
    void add_with_inner(const std::string& path, std::vector<KeyTable>& tables) const;
    static void add_rule(std::vector<KeyRule>& rules, const Noted& noted, KeyRule rule);

    bool given_ = false;
    std::map<std::string, Noted> noted_;
};

/// Where mistakes of one file are collected, a line each.
class MistakeList {
public:
    explicit MistakeList(std::string file) : file_(std::move(file)) {}
    /// @param code `outside` for what the outside world refused, as a file that cannot be read
    void add(const toml::source_region& where, const std::string& sentence, ErrorCode code = ErrorCode::input);
    [[nodiscard]] bool empty() const { return mistakes_.empty(); }
    [[nodiscard]] std::size_t count() const { return mistakes_.size(); }
    /// A part of the file that has been changed since it was parsed.
    struct Change {
        std::string path;             ///< that mistakes there begin with: "fault.at_s"
        std::string key;              ///< by which whoever changed it called it: "fault.gap.at_s"
        std::string option;           ///< of the command line: "--rate"; it stands before the sentence. Empty: none
        toml::source_position place;  ///< where the sentences are placed without an option
        std::string words;            ///< that end every sentence from here on; may be empty
    };
    void changed(Change change) { changes_.push_back(std::move(change)); }
    /// "FILE:LINE:COLUMN: " and the sentence, or the option that is to blame and the sentence.
    [[nodiscard]] std::string told(const toml::source_region& where, std::string_view sentence) const;
    std::vector<std::string> idle_keys;  ///< TableReader::idle_keys()
    /// All lines, in the order of the file; `outside` when nothing is wrong with the file itself, else `input`.
    [[nodiscard]] Error error() const;

private:
    struct Mistake {
        toml::source_position place;
        std::string line;
        ErrorCode code;
    };
    [[nodiscard]] const Change* change_of(const toml::source_region& where, std::string_view sentence) const;
    std::string file_;
    std::vector<Mistake> mistakes_;
    std::vector<Change> changes_;
};

/// A sentence that stays one line and can be read: keys and texts of a file may hold anything and be of any length.
std::string on_one_line(std::string_view sentence);

/// Which numbers a key takes.
struct NumberRange {
    double least = -std::numeric_limits<double>::max();
    double most = std::numeric_limits<double>::max();
    static NumberRange positive() { return {std::numeric_limits<double>::min()}; }
    static NumberRange not_negative() { return {0}; }
    [[nodiscard]] bool holds(double number) const { return number >= least && number <= most; }
};

/// What a key is, for people: of the keys of scenarios the schema, the reference page and the help of options print it.
struct KeyText {
    KeyText() = default;
    KeyText(const char* sentence) : meaning(sentence) {}
    /// @param absent what an absent key is, where that is no fixed value: "the board's"
    KeyText(std::string_view sentence, std::string_view absent) : meaning(sentence), standard(absent) {}
    std::string_view meaning{};  ///< half a sentence
    std::string_view standard{};
};

/// A word that a key takes, and what it means.
template <class Value>
struct Word {
    std::string_view word;
    Value value;
};

/// Reads the keys of one table. A key that is absent leaves the given value as it is; a key of the wrong type or out of
/// range is a mistake. `finish()` makes every key that nobody asked for a mistake that suggests the nearest known one.
///
/// A reader's call is the only place that has a key's name, range, default (the value before) and text. The unit is in
/// the name. A value in `std::optional` has no default.
class TableReader {
public:
    /// @param recorder notes each key that is asked for; the table is then empty. Null: the table is read
    TableReader(const toml::table& table, std::string path, MistakeList& mistakes, KeyRecorder* recorder = nullptr)
        : table_(table), path_(std::move(path)), mistakes_(mistakes), recorder_(recorder) {}

    void number(std::string_view key, std::optional<double>& value, NumberRange range = {}, KeyText text = {});
    void number(std::string_view key, double& value, NumberRange range = {}, KeyText text = {}) {
        with_default(value, [&](std::optional<double>& found) { number(key, found, range, text); });
    }
    void boolean(std::string_view key, std::optional<bool>& value, KeyText text = {});
    void boolean(std::string_view key, bool& value, KeyText text = {}) {
        with_default(value, [&](std::optional<bool>& found) { boolean(key, found, text); });
    }
    void text(std::string_view key, std::string& value, KeyText text = {});
    /// @param least how many there are at least, 0 or 1
    void texts(std::string_view key, std::vector<std::string>& values, KeyText text = {}, std::size_t least = 1);
    /// A text or a list of texts.
    void text_or_texts(std::string_view key, std::vector<std::string>& values, KeyText text = {});
    /// A whole number. `range` lies within what Integer holds.
    template <std::integral Integer>
    void integer(std::string_view key, std::optional<Integer>& value, NumberRange range, KeyText text = {}) {
        const auto standard = value ? std::optional(static_cast<double>(*value)) : std::nullopt;
        if (const auto found = whole_number(key, range, text, standard)) value = static_cast<Integer>(*found);
    }
    template <std::integral Integer>
    void integer(std::string_view key, Integer& value, NumberRange range, KeyText text = {}) {
        with_default(value, [&](std::optional<Integer>& found) { integer(key, found, range, text); });
    }
    /// A list of exactly `count` numbers.
    /// @param standard what they are when the key is absent, for the catalogue of keys alone
    std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count, KeyText text = {},
                                               std::span<const double> standard = {});
    /// As many numbers as there are. @return whether they have been read
    bool numbers(std::string_view key, std::span<double> values, KeyText text = {});
    /// [latitude, longitude] or [latitude, longitude, height]: degrees, metres above the ellipsoid.
    std::optional<Geodetic> place(std::string_view key, KeyText text = {});
    /// An instant as parse_instant() reads it, given as a text, or as a TOML date with or without a time.
    std::optional<std::string> utc(std::string_view key, KeyText text = {});
    /// One of the given words; gives its index.
    /// @param standard the word that an absent key is, for the catalogue of keys alone
    std::optional<std::size_t> choice(std::string_view key, std::span<const std::string_view> words, KeyText text = {},
                                      std::string_view standard = {});
    /// A list of some of the given words, at least one and none twice; gives their indices in the order of the list.
    /// @param wanted what a mistake says was expected, when the words are too many to list
    std::optional<std::vector<std::size_t>> choices(std::string_view key, std::span<const std::string_view> words,
                                                    KeyText text = {}, std::string_view wanted = {});
    /// A list of whole numbers, at least one.
    std::optional<std::vector<std::int64_t>> whole_numbers(std::string_view key, NumberRange range, KeyText text = {});

    /// One of the given words; `value` becomes what it means.
    template <class Value>
    void word(std::string_view key, std::initializer_list<Word<std::type_identity_t<Value>>> words, Value& value,
              KeyText text = {}) {
        std::vector<std::string_view> known;
        std::string_view standard;
        for (const auto& word : words) {
            known.push_back(word.word);
            if (standard.empty() && word.value == value) standard = word.word;
        }
        const auto index = choice(key, known, text, standard);
        if (index && !recording()) value = words.begin()[*index].value;
    }

    /// A quantity of one unit.
    template <class Quantity>
    void quantity(std::string_view key, std::optional<Quantity>& value, NumberRange range, KeyText text = {}) {
        std::optional<double> found = value ? std::optional(value->value()) : std::nullopt;
        number(key, found, range, text);
        if (found) value = Quantity(*found);
    }
    template <class Quantity>
    void quantity(std::string_view key, Quantity& value, NumberRange range, KeyText text = {}) {
        with_default(value, [&](std::optional<Quantity>& found) { quantity(key, found, range, text); });
    }
    /// An angle in degrees.
    void degrees(std::string_view key, std::optional<Angle>& value, NumberRange range, KeyText text = {});
    void degrees(std::string_view key, Angle& value, NumberRange range, KeyText text = {}) {
        with_default(value, [&](std::optional<Angle>& found) { degrees(key, found, range, text); });
    }

    /// Reads a sub-table with `body` and finishes it.
    void table(std::string_view key, KeyText text, const std::function<void(TableReader&)>& body);
    void table(std::string_view key, const std::function<void(TableReader&)>& body) { table(key, {}, body); }
    /// The same of a sub-table whose keys are names that the catalogue of keys does not list.
    void named_values(std::string_view key, KeyText text, const std::function<void(TableReader&)>& body);
    /// Reads each table of a list with `body` and finishes it.
    /// @param fewest that the caller takes, for the catalogue of keys alone
    void tables(std::string_view key, KeyText text, const std::function<void(TableReader&)>& body,
                std::size_t fewest = 0);
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
    /// The keys that `body` reads have an effect only where `acts`; else idle_keys() reports those that are there.
    /// @param when they have: "with truth = \"constant\""
    void where(bool acts, std::string_view when, const std::function<void()>& body);
    /// Whether any of the keys that `body` reads is there.
    bool reads_any(const std::function<void()>& body) { return !given_of(body).empty(); }
    /// "PATH.KEY: has no effect here; …" of the file so far.
    [[nodiscard]] const std::vector<std::string>& idle_keys() const { return mistakes_.idle_keys; }
    /// Of two keys at most one may be there; the mistake is the second one's.
    void not_both(std::string_view key, std::string_view other);
    [[nodiscard]] bool is_boolean(std::string_view key) const { return table_[key].is_boolean(); }
    /// The table as TOML, for another reading.
    [[nodiscard]] std::string toml_text() const;
    /// The keys that the table has.
    [[nodiscard]] std::vector<std::string> keys() const;
    /// The caller has dealt with this key itself.
    void has_been_read(std::string_view key) { known_.emplace_back(key); }
    void mistake(std::string_view key, const std::string& sentence) { mistake(key, Error{ErrorCode::input, sentence}); }
    /// A file that the key names is refused.
    void mistake(std::string_view key, const Error& error);
    /// mistake() for what shows only when more of the file has been read. Valid while the file is read.
    [[nodiscard]] std::function<void(std::string_view key, const std::string& sentence)> mistake_later() const;
    /// "FILE:LINE:COLUMN: KEY: ", for what shows only when the run is put together; of the table where the key is
    /// absent.
    [[nodiscard]] std::string told_at(std::string_view key) const;
    /// "FILE:LINE:COLUMN: " of the table.
    [[nodiscard]] std::string told_at() const { return mistakes_.told(table_.source(), {}); }
    /// The path of a file, which has a name. @param folder to which it is relative
    void file_path(std::string_view key, const std::filesystem::path& folder, std::filesystem::path& value,
                   KeyText text = {});
    /// The corners of a polygon, [[latitude, longitude], …] in degrees.
    std::optional<std::vector<Geodetic>> polygon(std::string_view key, KeyText text = {});
    /// Whatever stands there, as faults and commands take it; a list of pairs of numbers becomes one list. Nothing, and
    /// a mistake, for a table or a list that is neither of numbers, pairs of numbers nor texts.
    std::optional<ParameterValue> value(std::string_view key);
    /// What stands there, for a caller that reads it itself; null: nothing. @param type for the catalogue of keys
    const toml::node* node(std::string_view key, KeyType type, KeyText text = {});
    void mistake_here(const std::string& sentence) { mistakes_.add(table_.source(), where() + sentence); }
    void finish();
    /// In the file so far.
    [[nodiscard]] std::size_t mistake_count() const { return mistakes_.count(); }

    /// Whether nothing is read, and the keys that are asked for are noted.
    [[nodiscard]] bool recording() const { return recorder_ != nullptr; }
    /// For the catalogue of keys: these are taken, as `value` gives them and check_parameters() checks them.
    void note_parameters(std::span<const ParameterSpec> specs);
    /// For the catalogue of keys: the caller refuses the one beside the other.
    void note_not_both(std::string_view key, std::string_view other);
    /// For the catalogue of keys: `kind`, one of these words, decides what else the table takes.
    /// @return the one to read with; nothing when nothing is recorded
    std::optional<std::size_t> note_kinds(std::span<const std::string_view> words, KeyText text,
                                          std::string_view standard = {});

private:
    // Lets the reader of a value that may have no default read one that has.
    template <class Value, class Read>
    static void with_default(Value& value, Read read) {
        std::optional<Value> found = value;
        read(found);
        value = *found;
    }
    void note(std::string_view key, KeyText text, KeyEntry entry);
    void record_inner(std::string_view key, KeyText text, KeyEntry entry,
                      const std::function<void(TableReader&)>& body);
    const toml::node* find(std::string_view key);
    std::vector<std::string> given_of(const std::function<void()>& body);
    std::optional<std::int64_t> whole_number(std::string_view key, NumberRange range, KeyText text,
                                             std::optional<double> standard);
    // Shows each entry of a list to `take`, which gives what is wrong with it, or an empty text. @return whether there
    // is a list without a mistake
    bool take_list(std::string_view key, const std::string& expected,
                   const std::function<std::string(const toml::node&)>& take);
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

}  // namespace skyloop::inline run
