#include "detail/sentence_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/core/words.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::size_t longest_sentence = 1000;

constexpr std::string_view own_words[] = {
    "always", "never", "at",    "after",        "within", "of",     "throughout", "during", "from",
    "to",     "until", "for",   "every",        "the",    "run",    "start",      "end",    "s",
    "below",  "above", "sends", "reconfigures", "silent", "trusts", "distrusts"};

bool is_blank(char character) {
    return character == ' ' || character == '\t' || character == '\n' || character == '\r';
}

}  // namespace

bool needs_quotes(std::string_view name) {
    if (name.empty() || name.front() == '\'' || name.front() == '"') return true;
    const std::string small = lower_case(name);
    return std::any_of(name.begin(), name.end(), is_blank) ||
           std::find(std::begin(own_words), std::end(own_words), small) != std::end(own_words);
}

SentenceWords::SentenceWords(std::string_view text) : length_(text.size()) {
    if (text.size() > longest_sentence)
        refuse(1, fmt::format("has {} characters; expected at most {}", text.size(), longest_sentence));
    else
        split(text);
}

void SentenceWords::split(std::string_view text) {
    std::size_t i = 0;
    while (i < text.size()) {
        if (is_blank(text[i])) {
            ++i;
            continue;
        }
        const bool quoted = text[i] == '\'' || text[i] == '"';
        std::size_t end = i + 1;
        while (end < text.size() && (quoted ? text[end] != text[i] : !is_blank(text[end])))
            ++end;
        if (quoted && end == text.size()) return refuse(i + 1, fmt::format("the quote {} is not closed", text[i]));
        const std::size_t first = quoted ? i + 1 : i;
        words_.push_back({std::string(text.substr(first, end - first)), i + 1, quoted});
        i = quoted ? end + 1 : end;
    }
}

bool SentenceWords::is_next(std::string_view word) const {
    return !at_end() && !words_[next_].quoted && lower_case(words_[next_].text) == lower_case(word);
}

void SentenceWords::take() {
    ++next_;
    welcome_.clear();
}

bool SentenceWords::accept(std::string_view word) {
    if (mistake_) return false;
    if (is_next(word)) return take(), true;
    wanted(word);
    return false;
}

bool SentenceWords::accept(std::initializer_list<std::string_view> words) {
    if (mistake_) return false;
    std::size_t at = next_;
    for (const std::string_view word : words) {
        const bool same = at < words_.size() && !words_[at].quoted && lower_case(words_[at].text) == word;
        if (!same) {
            // The first word alone was right: the mistake is in the second.
            wanted(fmt::format("{}", fmt::join(words, " ")));
            return false;
        }
        ++at;
    }
    next_ = at;
    welcome_.clear();
    return true;
}

std::optional<std::size_t> SentenceWords::one_of(std::initializer_list<std::string_view> words) {
    std::size_t index = 0;
    for (const std::string_view word : words) {
        if (accept(word)) return index;
        ++index;
    }
    refuse();
    return std::nullopt;
}

void SentenceWords::unit(std::initializer_list<std::string_view> units, std::string_view why) {
    for (const std::string_view unit : units)
        if (accept(unit)) return;
    if (!mistake_) refuse(column(), fmt::format("{}: {}", complaint(), why));
}

bool SentenceWords::at_number() const {
    if (at_end() || words_[next_].quoted) return false;
    const char first = words_[next_].text.front();
    return (first >= '0' && first <= '9') || first == '.' || first == '-' || first == '+';
}

std::optional<double> SentenceWords::number(double most) {
    wanted(fmt::format("a number from 0 to {:g}", most));
    if (mistake_ || !at_number()) return refuse(), std::nullopt;
    Word& word = words_[next_];
    double value = 0;
    const char* end = word.text.data() + word.text.size();
    const auto [rest, error] = std::from_chars(word.text.data(), end, value);
    if (error != std::errc{} || !std::isfinite(value) || value < 0 || std::signbit(value) || value > most)
        return refuse(), std::nullopt;
    if (rest == end) return take(), value;
    const auto taken = static_cast<std::size_t>(rest - word.text.data());
    word.text.erase(0, taken);
    word.column += taken;
    welcome_.clear();
    return value;
}

std::optional<std::string> SentenceWords::name(std::string_view wanted_name) {
    wanted(wanted_name);
    if (mistake_ || at_end()) return refuse(), std::nullopt;
    const Word& word = words_[next_];
    if (word.quoted ? word.text.empty() : needs_quotes(word.text)) return refuse(), std::nullopt;
    std::string text = word.text;
    take();
    return text;
}

void SentenceWords::wanted(std::string_view what) {
    if (std::find(welcome_.begin(), welcome_.end(), what) == welcome_.end()) welcome_.emplace_back(what);
}

std::size_t SentenceWords::column() const { return at_end() ? length_ + 1 : words_[next_].column; }

std::string SentenceWords::complaint() const {
    const std::string found =
        at_end() ? std::string("the sentence ends here") : fmt::format("'{}' is not understood", words_[next_].text);
    return fmt::format("{}; expected {}{}", found, welcome_.size() > 1 ? "one of " : "", fmt::join(welcome_, ", "));
}

void SentenceWords::refuse() {
    if (mistake_) return;
    const std::vector<std::string_view> candidates(welcome_.begin(), welcome_.end());
    // Of one word there is nothing to choose.
    const bool choice = !at_end() && candidates.size() > 1;
    refuse(column(), complaint() + (choice ? did_you_mean(words_[next_].text, candidates) : std::string()));
}

void SentenceWords::refuse(std::size_t column, std::string sentence) {
    if (!mistake_) mistake_ = SentenceMistake{column, std::move(sentence)};
}

}  // namespace skyloop::inline run
