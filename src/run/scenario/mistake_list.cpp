#include <fmt/format.h>
#include <fmt/ranges.h>

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

// What was put in after parsing has no place of its own.
const MistakeList::Change* MistakeList::change_of(const toml::source_region& where, std::string_view sentence) const {
    if (where.begin.line > 0 || changes_.empty()) return nullptr;
    const Change* named = nullptr;
    for (const Change& change : changes_)
        if (sentence.starts_with(change.path) && (named == nullptr || change.path.size() >= named->path.size()))
            named = &change;
    if (named != nullptr) return named;
    const auto speaks = [&](const Change& change) { return speaks_of(sentence, change.path); };
    const auto found = std::find_if(changes_.begin(), changes_.end(), speaks);
    return found == changes_.end() ? &changes_.front() : &*found;
}

std::string MistakeList::told(const toml::source_region& where, std::string_view sentence) const {
    const Change* change = change_of(where, sentence);
    std::string text(sentence);
    if (change != nullptr && sentence.starts_with(change->path)) {
        if (!change->option.empty()) return change->option + text.substr(std::min(text.find(": "), text.size()));
        text.replace(0, change->path.size(), change->key);
    }
    if (change != nullptr && !change->option.empty()) return fmt::format("{}: {}", change->option, text);
    const toml::source_position place = where.begin.line > 0 ? where.begin
                                        : change != nullptr  ? change->place
                                                             : toml::source_position{1, 1};
    return fmt::format("{}:{}:{}: {}", file_, place.line, place.column, text);
}

void MistakeList::add(const toml::source_region& where, const std::string& sentence, ErrorCode code) {
    const Change* change = change_of(where, sentence);
    std::string words;
    for (const Change& each : changes_)
        if (!each.words.empty()) words += (words.empty() ? "; with " : ", ") + each.words;
    const toml::source_position place = change != nullptr ? change->place : where.begin;
    mistakes_.push_back({place, told(where, on_one_line(sentence + words)), code});
}

Error MistakeList::error() const {
    std::vector<Mistake> sorted = mistakes_;
    std::stable_sort(sorted.begin(), sorted.end(), [](const Mistake& a, const Mistake& b) {
        return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
    });
    std::vector<std::string_view> lines;
    bool outside = true;
    for (const Mistake& mistake : sorted) {
        outside = outside && mistake.code == ErrorCode::outside;
        // A key that is looked at twice is wrong once.
        if (lines.empty() || lines.back() != mistake.line) lines.push_back(mistake.line);
    }
    return {outside ? ErrorCode::outside : ErrorCode::input, fmt::format("{}", fmt::join(lines, "\n"))};
}

}  // namespace skyloop
