// Values of any type, as tables of parameters take them, and how a reader of tables notes the keys that it asks for.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "detail/table_reader.hpp"
#include "run/scenario/scenario_file.hpp"

namespace skyloop::inline run {

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
    // Of a file that was laid under this one.
    const std::string& file = where.begin.line > 0 && where.path && !where.path->empty() ? *where.path : file_;
    return fmt::format("{}:{}:{}: {}", file, place.line, place.column, text);
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

namespace {

bool is_pair(const toml::node& item) {
    const auto* pair = item.as_array();
    return pair != nullptr && pair->size() == 2 && (*pair)[0].is_number() && (*pair)[1].is_number();
}

// Of a list of numbers and lists the first entry that is no pair, as the corners of an area are; null: none.
const toml::node* besides_pairs(const toml::array& list) {
    if (std::none_of(list.begin(), list.end(), [](const toml::node& item) { return item.is_array(); })) return nullptr;
    const auto odd = std::find_if_not(list.begin(), list.end(), is_pair);
    return odd == list.end() ? nullptr : &*odd;
}

// Adds the numbers of a list, and of lists in it.
bool append_numbers(const toml::array& list, std::vector<double>& numbers) {
    for (const toml::node& item : list) {
        if (const auto* inner = item.as_array()) {
            if (!append_numbers(*inner, numbers)) return false;
        } else if (const auto number = item.is_number() ? item.value<double>() : std::nullopt) {
            numbers.push_back(*number);
        } else {
            return false;
        }
    }
    return true;
}

std::optional<std::vector<std::string>> all_texts(const toml::array& list) {
    std::vector<std::string> texts;
    for (const toml::node& item : list) {
        const auto* text = item.as_string();
        if (text == nullptr) return std::nullopt;
        texts.push_back(text->get());
    }
    return texts;
}

KeyType key_type_of(const ParameterSpec& spec) {
    switch (spec.type) {
        case ParameterType::number:
            return KeyType::number;
        case ParameterType::whole_number:
            return KeyType::whole_number;
        case ParameterType::flag:
            return KeyType::flag;
        case ParameterType::word:
            return KeyType::word;
        case ParameterType::words:
            return KeyType::word_or_words;
        case ParameterType::text:
            return KeyType::text;
        case ParameterType::texts:
            return KeyType::text_or_texts;
        case ParameterType::numbers:
            return KeyType::number_groups;
    }
    return KeyType::text;
}

KeyEntry entry_of(const ParameterSpec& spec) {
    return {.name = std::string(spec.name),
            .type = key_type_of(spec),
            .least = spec.least,
            .most = spec.most,
            .count_least = spec.count_least,
            .count_most = spec.count_most,
            .choices = {spec.choices.begin(), spec.choices.end()},
            .standard = spec.standard_value(),
            .needed = spec.needed,
            .meaning = std::string(spec.meaning)};
}

}  // namespace

std::optional<ParameterValue> TableReader::value(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (const auto* flag = node->as_boolean()) return ParameterValue(flag->get());
    if (const auto* text = node->as_string()) return ParameterValue(text->get());
    if (node->is_number()) return ParameterValue(*node->value<double>());
    if (node->is_date_time() || node->is_date() || node->is_time()) {
        if (auto text = utc(key)) return ParameterValue(*text);
        return std::nullopt;
    }
    if (const auto* list = node->as_array()) {
        std::vector<double> numbers;
        if (append_numbers(*list, numbers)) {
            const toml::node* odd = besides_pairs(*list);
            if (odd == nullptr) return ParameterValue(numbers);
            const auto* group = odd->as_array();
            mistake_at(*odd, key,
                       fmt::format("holds {}; expected numbers alone, or pairs [latitude, longitude]",
                                   group != nullptr ? fmt::format("a group of {}", group->size()) : "a single number"));
            return std::nullopt;
        }
        if (auto texts = all_texts(*list)) return ParameterValue(*texts);
    }
    wrong_type(key, *node, "a number, a text, true or false, or a list of numbers or texts");
    return std::nullopt;
}

std::optional<std::vector<Geodetic>> TableReader::polygon(std::string_view key, KeyText text) {
    if (recording()) note(key, text, {.type = KeyType::number_groups, .least = -360, .most = 360, .count_least = 6});
    const auto found = value(key);
    if (!found) return std::nullopt;
    const auto* numbers = std::get_if<std::vector<double>>(&*found);
    if (numbers == nullptr)
        return mistake(key, "is no list of pairs; expected [[latitude, longitude], …]"), std::nullopt;
    auto corners = corners_from_degrees(*numbers);
    if (!corners) return mistake(key, corners.error()), std::nullopt;
    return std::move(*corners);
}

const toml::node* TableReader::node(std::string_view key, KeyType type, KeyText text) {
    if (recording()) note(key, text, {.type = type, .count_least = 1});
    return find(key);
}

std::string TableReader::told_at(std::string_view key) const {
    const toml::node* node = table_.get(key);
    return mistakes_.told(node ? node->source() : table_.source(), path_of(key) + ": ");
}

void TableReader::file_path(std::string_view key, const std::filesystem::path& folder, std::filesystem::path& value,
                            KeyText text) {
    std::string path;
    this->text(key, path, text);
    if (!path.empty()) value = folder / path;
    if (path.empty() && table_[key].is_string()) mistake(key, "is empty; expected the path of a file");
}

void TableReader::note(std::string_view key, KeyText text, KeyEntry entry) {
    entry.name = key;
    if (!text.meaning.empty()) entry.meaning = text.meaning;
    entry.standard_words = text.standard;
    if (!text.standard.empty()) entry.standard.reset();
    // Behind a look whether it is there stands a value of no meaning.
    if (recorder_->given() && std::find(asked_for_.begin(), asked_for_.end(), key) != asked_for_.end())
        entry.standard.reset();
    // An empty text is no text.
    if (entry.standard == ParameterValue(std::string())) entry.standard.reset();
    recorder_->note(path_, std::move(entry));
}

void TableReader::record_inner(std::string_view key, KeyText text, KeyEntry entry,
                               const std::function<void(TableReader&)>& body) {
    static const toml::table nothing;  // readers may keep it until the file has been read
    const std::string path = path_of(key);
    const bool list = entry.type == KeyType::tables;
    note(key, text, std::move(entry));
    recorder_->record(path, list, [&] {
        TableReader reader(nothing, path, mistakes_, recorder_);
        body(reader);
    });
}

void TableReader::needs_one_of(std::initializer_list<std::string_view> keys, const std::string& sentence) {
    if (recording()) recorder_->note_one_of(path_, keys);
    const bool there = std::any_of(keys.begin(), keys.end(), [this](std::string_view key) { return has(key); });
    if (!there) mistake_here(sentence);
}

void TableReader::note_not_both(std::string_view key, std::string_view other) {
    if (recording()) recorder_->note_not_both(path_, key, other);
}

void TableReader::where(bool acts, std::string_view when, const std::function<void()>& body) {
    for (const std::string& key : given_of(body))
        if (!acts) mistakes_.idle_keys.push_back(fmt::format("{}: has no effect here; it acts {}", path_of(key), when));
}

std::vector<std::string> TableReader::given_of(const std::function<void()>& body) {
    const auto before = static_cast<std::ptrdiff_t>(known_.size());
    body();
    std::vector<std::string> given(known_.begin() + before, known_.end());
    std::erase_if(given, [this](const std::string& key) { return !table_.contains(key); });
    return given;
}

void TableReader::not_both(std::string_view key, std::string_view other) {
    note_not_both(key, other);
    if (!recording() && has(key) && has(other))
        mistake(other, fmt::format("stands beside {}; expected one of the two", key));
}

void TableReader::note_parameters(std::span<const ParameterSpec> specs) {
    if (!recording()) return;
    for (const ParameterSpec& spec : specs)
        note(spec.name, {}, entry_of(spec));
}

std::optional<std::size_t> TableReader::note_kinds(std::span<const std::string_view> words, KeyText text,
                                                   std::string_view standard) {
    if (!recording()) return std::nullopt;
    const auto kind = recorder_->kind(path_, words);
    note("kind", text,
         {.type = KeyType::word, .choices = {words.begin(), words.end()}, .standard = std::string(standard)});
    return kind;
}

}  // namespace skyloop::inline run
