// Values of any type, as tables of parameters take them.
#include <fmt/format.h>

#include <algorithm>

#include "detail/table_reader.hpp"

namespace skyloop {
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

}  // namespace skyloop
