/// Notes what the readers of a file ask for, when they are let read nothing.
#pragma once

#include <functional>
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

}  // namespace skyloop
