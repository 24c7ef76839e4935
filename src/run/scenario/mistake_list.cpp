#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "detail/table_reader.hpp"
#include "run/scenario/scenario_changes.hpp"

namespace skyloop {

std::string on_one_line(std::string_view sentence) {
    constexpr std::size_t longest = 600;
    std::size_t end = std::min(sentence.size(), longest);
    while (end < sentence.size() && (static_cast<unsigned char>(sentence[end]) & 0xC0) == 0x80)
        --end;  // not within a character of several bytes
    std::string line;
    for (const char c : sentence.substr(0, end))
        line += static_cast<unsigned char>(c) < 0x20 || c == 0x7f
                    ? fmt::format("\\x{:02x}", static_cast<unsigned char>(c))
                    : std::string(1, c);
    return end < sentence.size() ? line + "..." : line;
}

void MistakeList::add(const toml::source_region& where, const std::string& sentence, ErrorCode code) {
    const toml::source_position place = place_of(where, sentence);
    const Change* change = change_of(where, sentence);
    const std::string told = change != nullptr ? change->key + sentence.substr(change->path.size()) : sentence;
    mistakes_.push_back({place.line, place.column, on_one_line(told + changes_text_), code});
}

void MistakeList::changed(std::string path, std::string key, const toml::source_region& where,
                          const std::string& words) {
    changes_.push_back({std::move(path), std::move(key), where.begin});
    changes_text_ += (changes_text_.empty() ? "; with " : ", ") + words;
}

// What was put in after parsing has no place of its own.
const MistakeList::Change* MistakeList::change_of(const toml::source_region& where, std::string_view sentence) const {
    if (where.begin.line > 0) return nullptr;
    for (const Change& change : changes_)
        if (sentence.starts_with(change.path)) return &change;
    return nullptr;
}

toml::source_position MistakeList::place_of(const toml::source_region& where, std::string_view sentence) const {
    if (where.begin.line > 0) return where.begin;
    if (const Change* change = change_of(where, sentence)) return change->place;
    for (const Change& change : changes_)
        if (speaks_of(sentence, change.path)) return change.place;
    return changes_.empty() ? toml::source_position{1, 1} : changes_.front().place;
}

std::string MistakeList::told_at(const toml::source_region& where, std::string_view key) const {
    const toml::source_position place = place_of(where, key);
    return fmt::format("{}:{}:{}: ", file_, place.line, place.column);
}

Error MistakeList::error() const {
    std::vector<Mistake> sorted = mistakes_;
    std::stable_sort(sorted.begin(), sorted.end(), [](const Mistake& a, const Mistake& b) {
        return std::pair(a.line, a.column) < std::pair(b.line, b.column);
    });
    // A key that is looked at twice is wrong once.
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    std::string lines;
    for (const Mistake& m : sorted)
        lines += fmt::format("{}{}:{}:{}: {}", lines.empty() ? "" : "\n", file_, m.line, m.column, m.sentence);
    const bool outside = std::all_of(sorted.begin(), sorted.end(),
                                     [](const Mistake& mistake) { return mistake.code == ErrorCode::outside; });
    return {outside ? ErrorCode::outside : ErrorCode::input, std::move(lines)};
}

}  // namespace skyloop
