/// Notes what the readers of a file ask for, when they are let read nothing.
#pragma once

#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "run/scenario/key_catalogue.hpp"

namespace skyloop {

/// One reading shows the keys of one branch. So there are many: with every key said to be there and with none, and with
/// each word of `kind` in turn, of all tables at once; a table within one that has kinds has each of its own with each
/// of that one's.
class KeyRecorder {
public:
    /// @param given what has() answers
    /// @param turn which word of `kind` every table is said to have; nothing: none, to learn which tables have kinds
    void begin(bool given, std::optional<std::size_t> turn);
    [[nodiscard]] bool given() const { return given_; }
    /// How many turns there are.
    [[nodiscard]] std::size_t turns() const;

    /// A table is about to be read.
    void enter(const std::string& path, bool list);
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
        std::set<std::string> refused{};   // of them
        std::set<std::string> looked_for{};
        std::set<std::pair<std::string, std::string>> seen{};  // kind, key
        std::vector<std::string> order{};                      // of names, as a reader asks that finds all of them
    };
    Noted& of(const std::string& path);
    // For how many turns a table keeps a word: until those above it have had all of theirs.
    [[nodiscard]] std::size_t turns_of_one_word(const std::string& path) const;
    // The word that is read with, "" in a table without kinds; nothing: the table has kinds, and this is the turn of
    // none.
    [[nodiscard]] std::optional<std::string> kind_of(const Noted& noted) const;
    [[nodiscard]] static KeyTable finished(const Noted& noted);
    void add_with_inner(const std::string& path, std::vector<KeyTable>& tables) const;
    void add_rule(std::vector<KeyRule>& rules, const Noted& noted, KeyRule rule) const;

    bool given_ = false;
    std::optional<std::size_t> turn_;
    std::map<std::string, Noted> noted_;
};

}  // namespace skyloop
