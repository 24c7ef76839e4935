// How a reader of tables notes the keys that it is asked for.
#include "detail/table_reader.hpp"

namespace skyloop {
namespace {

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
    return {.name = spec.name,
            .type = key_type_of(spec),
            .least = spec.least,
            .most = spec.most,
            .count_least = spec.count_least,
            .count_most = spec.count_most,
            .choices = spec.choices,
            .standard = spec.standard,
            .needed = spec.needed,
            .meaning = spec.meaning};
}

}  // namespace

void TableReader::note(std::string_view key, KeyEntry entry) {
    entry.name = key;
    // Behind a look whether it is there stands a value of no meaning.
    if (recorder_->given() && std::find(asked_for_.begin(), asked_for_.end(), key) != asked_for_.end())
        entry.standard.reset();
    // An empty text is no text.
    if (entry.standard == ParameterValue(std::string())) entry.standard.reset();
    recorder_->note(path_, std::move(entry));
}

KeyEntry TableReader::number_entry(KeyType type, NumberRange range, std::optional<double> standard) {
    KeyEntry entry{.type = type, .least = range.least, .most = range.most};
    if (type == KeyType::whole_numbers) entry.count_least = 1;
    if (standard) entry.standard = *standard;
    return entry;
}

KeyEntry TableReader::numbers_entry(std::size_t count, std::span<const double> standard) {
    KeyEntry entry{.type = KeyType::numbers, .count_least = count, .count_most = count};
    if (!standard.empty()) entry.standard = std::vector<double>(standard.begin(), standard.end());
    return entry;
}

KeyEntry TableReader::word_entry(std::span<const std::string_view> words, std::string_view standard) {
    return {.type = KeyType::word, .choices = {words.begin(), words.end()}, .standard = std::string(standard)};
}

void TableReader::record_inner(std::string_view key, KeyEntry entry, const std::function<void(TableReader&)>& body) {
    static const toml::table nothing;  // readers may keep it until the file has been read
    const std::string path = path_of(key);
    recorder_->enter(path, entry.type == KeyType::tables);
    note(key, std::move(entry));
    TableReader reader(nothing, path, mistakes_, recorder_);
    body(reader);
}

void TableReader::needs_one_of(std::initializer_list<std::string_view> keys, const std::string& sentence) {
    if (recording()) recorder_->note_one_of(path_, keys);
    const bool there = std::any_of(keys.begin(), keys.end(), [this](std::string_view key) { return has(key); });
    if (!there) mistake_here(sentence);
}

void TableReader::note_not_both(std::string_view key, std::string_view other) {
    if (recording()) recorder_->note_not_both(path_, key, other);
}

void TableReader::note_parameters(const std::vector<ParameterSpec>& specs) {
    if (!recording()) return;
    for (const ParameterSpec& spec : specs)
        note(spec.name, entry_of(spec));
}

std::optional<std::size_t> TableReader::note_kinds(std::span<const std::string_view> words, std::string_view standard) {
    if (!recording()) return std::nullopt;
    const auto kind = recorder_->kind(path_, words);
    note("kind", word_entry(words, standard));
    return kind;
}

}  // namespace skyloop
