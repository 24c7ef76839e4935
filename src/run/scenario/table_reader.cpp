#include "detail/table_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "base/core/words.hpp"
#include "detail/toml_values.hpp"

namespace skyloop::inline run {
namespace {

std::string_view type_words(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::string:
            return "a text";
        case toml::node_type::integer:
            return "a whole number";
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "true or false";
        case toml::node_type::array:
            return "a list";
        case toml::node_type::table:
            return "a table";
        default:
            return "a date or time";
    }
}

std::string range_words(NumberRange range, std::string_view noun = "a number") {
    constexpr double most = std::numeric_limits<double>::max();
    const bool above = range.least > -most;
    const bool below = range.most < most;
    if (range.least == NumberRange::positive().least)
        return below ? fmt::format("{} above 0, up to {}", noun, range.most) : fmt::format("{} above 0", noun);
    if (above && below) return fmt::format("{} from {} to {}", noun, range.least, range.most);
    if (above) return fmt::format("{} of {} or more", noun, range.least);
    if (below) return fmt::format("{} of {} or less", noun, range.most);
    return noun == "a number" ? "a finite number" : std::string(noun);
}

KeyEntry number_entry(KeyType type, NumberRange range, std::optional<double> standard) {
    KeyEntry entry{.type = type, .least = range.least, .most = range.most};
    if (standard) entry.standard = *standard;
    return entry;
}

KeyEntry word_entry(std::span<const std::string_view> words, std::string_view standard) {
    return {.type = KeyType::word, .choices = {words.begin(), words.end()}, .standard = std::string(standard)};
}

}  // namespace

const toml::node* TableReader::find(std::string_view key) {
    known_.emplace_back(key);
    return table_.get(key);
}

std::string TableReader::path_of(std::string_view key) const {
    return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

void TableReader::mistake(std::string_view key, const Error& error) {
    if (recording() && key == "kind") recorder_->refuse_kind(path_);
    const toml::node* node = table_.get(key);
    mistakes_.add(node ? node->source() : table_.source(), fmt::format("{}: {}", path_of(key), error.message),
                  error.code);
}

std::function<void(std::string_view, const std::string&)> TableReader::mistake_later() const {
    return [table = &table_, path = path_, mistakes = &mistakes_](std::string_view key, const std::string& sentence) {
        const toml::node* node = table->get(key);
        mistakes->add(node ? node->source() : table->source(), fmt::format("{}.{}: {}", path, key, sentence));
    };
}

void TableReader::mistake_at(const toml::node& node, std::string_view key, const std::string& sentence) {
    mistakes_.add(node.source(), fmt::format("{}: {}", path_of(key), sentence));
}

void TableReader::wrong_type(std::string_view key, const toml::node& node, std::string_view expected) {
    mistake_at(node, key, fmt::format("is {}; expected {}", type_words(node), expected));
}

void TableReader::number(std::string_view key, std::optional<double>& value, NumberRange range, KeyText text) {
    if (recording()) note(key, text, number_entry(KeyType::number, range, value));
    const toml::node* node = find(key);
    if (!node) return;
    const auto found = node->value<double>();
    if (!found || node->is_boolean()) return wrong_type(key, *node, range_words(range));
    if (!std::isfinite(*found) || !range.holds(*found))
        return mistake(key, fmt::format("is {}; expected {}", *found, range_words(range)));
    value = *found;
}

void TableReader::degrees(std::string_view key, std::optional<Angle>& value, NumberRange range, KeyText text) {
    std::optional<double> found = value ? std::optional(value->deg()) : std::nullopt;
    const auto before = found;
    number(key, found, range, text);
    if (found != before) value = Angle::degrees(*found);
}

std::optional<std::int64_t> TableReader::whole_number(std::string_view key, NumberRange range, KeyText text,
                                                      std::optional<double> standard) {
    if (recording()) note(key, text, number_entry(KeyType::whole_number, range, standard));
    const toml::node* node = find(key);
    if (!node) return std::nullopt;
    const auto* found = node->as_integer();
    const std::string expected = range_words(range, "a whole number");
    if (!found) return wrong_type(key, *node, expected), std::nullopt;
    if (!range.holds(static_cast<double>(found->get())))
        return mistake(key, fmt::format("is {}; expected {}", found->get(), expected)), std::nullopt;
    return found->get();
}

void TableReader::boolean(std::string_view key, std::optional<bool>& value, KeyText text) {
    if (recording()) note(key, text, {.type = KeyType::flag, .standard = value});
    const toml::node* node = find(key);
    if (!node) return;
    const auto* found = node->as_boolean();
    if (!found) return wrong_type(key, *node, "true or false");
    value = found->get();
}

void TableReader::text(std::string_view key, std::string& value, KeyText text) {
    if (recording()) note(key, text, {.type = KeyType::text, .standard = value});
    const toml::node* node = find(key);
    if (!node) return;
    const auto* found = node->as_string();
    if (!found) return wrong_type(key, *node, "a text in quotes");
    value = found->get();
}

std::optional<std::string> TableReader::utc(std::string_view key, KeyText text) {
    if (recording()) note(key, text, {.type = KeyType::time});
    const toml::node* node = find(key);
    if (!node) return std::nullopt;
    if (const auto* written = node->as_string()) return written->get();
    toml::date_time t;
    if (const auto* day = node->as_date())
        t = toml::date_time(day->get(), toml::time());
    else if (const auto* found = node->as_date_time())
        t = found->get();
    else
        return wrong_type(key, *node, "a date with a time, in UTC"), std::nullopt;
    const int minutes = t.offset ? t.offset->minutes : 0, size = std::abs(minutes);
    return fmt::format(
        "{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:09}{}", t.date.year, t.date.month, t.date.day, t.time.hour,
        t.time.minute, t.time.second, t.time.nanosecond,
        minutes == 0 ? "Z" : fmt::format("{}{:02}:{:02}", minutes < 0 ? '-' : '+', size / 60, size % 60));
}

std::optional<std::size_t> TableReader::choice(std::string_view key, std::span<const std::string_view> words,
                                               KeyText text, std::string_view standard) {
    if (recording() && key == "kind") return note_kinds(words, text, standard);
    if (recording()) note(key, text, word_entry(words, standard));
    const toml::node* node = find(key);
    if (!node) return std::nullopt;
    const auto* word = node->as_string();
    if (!word) return wrong_type(key, *node, "a text in quotes"), std::nullopt;
    const auto found = std::find(words.begin(), words.end(), word->get());
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
    mistake(key, fmt::format("is '{}'; expected one of {}{}", word->get(), fmt::join(words, " "),
                             did_you_mean(word->get(), words)));
    return std::nullopt;
}

bool TableReader::take_list(std::string_view key, const std::string& expected,
                            const std::function<std::string(const toml::node&)>& take) {
    const toml::node* node = find(key);
    if (!node) return false;
    const auto* list = node->as_array();
    if (!list) return wrong_type(key, *node, expected), false;
    for (const toml::node& item : *list)
        if (const std::string wrong = take(item); !wrong.empty())
            return mistake_at(item, key, fmt::format("holds {}", wrong)), false;
    return true;
}

void TableReader::texts(std::string_view key, std::vector<std::string>& values, KeyText text, std::size_t least) {
    if (recording()) note(key, text, {.type = KeyType::texts, .count_least = least});
    std::vector<std::string> found;
    const std::string expected = "a list of texts";
    const bool read = take_list(key, expected, [&](const toml::node& item) {
        const auto* word = item.as_string();
        if (!word) return fmt::format("{}; expected {}", type_words(item), expected);
        found.push_back(word->get());
        return std::string();
    });
    if (!read) return;
    if (found.size() < least) return mistake(key, "is an empty list; expected at least one text");
    values = std::move(found);
}

void TableReader::text_or_texts(std::string_view key, std::vector<std::string>& values, KeyText text) {
    if (recording()) note(key, text, {.type = KeyType::text_or_texts, .count_least = 1});
    const toml::node* node = table_.get(key);
    if (node == nullptr || !node->is_string()) return texts(key, values, text);
    values = {std::string()};
    this->text(key, values.front(), text);
}

std::optional<std::vector<double>> TableReader::numbers(std::string_view key, std::size_t count, KeyText text,
                                                        std::span<const double> standard) {
    if (recording()) {
        KeyEntry entry{.type = KeyType::numbers, .count_least = count, .count_most = count};
        if (!standard.empty()) entry.standard = std::vector<double>(standard.begin(), standard.end());
        note(key, text, std::move(entry));
    }
    std::vector<double> values;
    const std::string expected = fmt::format("a list of {} numbers", count);
    const bool read = take_list(key, expected, [&](const toml::node& item) {
        const auto value = item.is_number() ? item.value<double>() : std::nullopt;
        if (!value) return fmt::format("{}; expected {}", type_words(item), expected);
        values.push_back(*value);
        return std::isfinite(*value) ? std::string() : fmt::format("{}; expected {}", *value, expected);
    });
    if (!read) return std::nullopt;
    if (values.size() == count) return values;
    mistake(key, fmt::format("has {} numbers; expected {}", values.size(), count));
    return std::nullopt;
}

bool TableReader::numbers(std::string_view key, std::span<double> values, KeyText text) {
    const auto found = numbers(key, values.size(), text, values);
    if (found) std::copy(found->begin(), found->end(), values.begin());
    return found.has_value();
}

std::optional<Geodetic> TableReader::place(std::string_view key, KeyText text) {
    if (recording()) note(key, text, {.type = KeyType::place, .count_least = 2, .count_most = 3});
    const auto* list = table_.get(key) ? table_.get(key)->as_array() : nullptr;
    if (list && list->size() != 2 && list->size() != 3) {
        (void)find(key);
        return mistake(key, fmt::format("has {} numbers; expected latitude and longitude, or both and a height",
                                        list->size())),
               std::nullopt;
    }
    const std::size_t count = list && list->size() == 2 ? 2 : 3;
    const auto values = numbers(key, count, text);
    if (!values) return std::nullopt;
    const auto place = place_from_degrees((*values)[0], (*values)[1], count == 3 ? (*values)[2] : 0);
    if (!place) return mistake(key, place.error()), std::nullopt;
    return *place;
}

std::optional<std::vector<std::size_t>> TableReader::choices(std::string_view key,
                                                             std::span<const std::string_view> words, KeyText text,
                                                             std::string_view wanted) {
    if (recording())
        note(key, text, {.type = KeyType::words, .count_least = 1, .choices = {words.begin(), words.end()}});
    const std::string expected =
        wanted.empty() ? fmt::format("a list of some of {}", fmt::join(words, " ")) : std::string(wanted);
    std::vector<std::size_t> found;
    const bool read = take_list(key, expected, [&](const toml::node& item) {
        const auto* word = item.as_string();
        if (!word) return fmt::format("{}; expected {}", type_words(item), expected);
        const auto known = std::find(words.begin(), words.end(), word->get());
        if (known == words.end())
            return fmt::format("'{}'; expected {}{}", word->get(), expected, did_you_mean(word->get(), words));
        const auto index = static_cast<std::size_t>(known - words.begin());
        if (std::find(found.begin(), found.end(), index) != found.end())
            return fmt::format("'{}' twice; expected it once", word->get());
        found.push_back(index);
        return std::string();
    });
    if (!read) return std::nullopt;
    if (found.empty()) return mistake(key, fmt::format("is an empty list; expected {}", expected)), std::nullopt;
    return found;
}

std::optional<std::vector<std::int64_t>> TableReader::whole_numbers(std::string_view key, NumberRange range,
                                                                    KeyText text) {
    if (recording()) {
        KeyEntry entry = number_entry(KeyType::whole_numbers, range, std::nullopt);
        entry.count_least = 1;
        note(key, text, std::move(entry));
    }
    const std::string expected = "a list, each entry " + range_words(range, "a whole number");
    std::vector<std::int64_t> values;
    const bool read = take_list(key, expected, [&](const toml::node& item) {
        const auto* value = item.as_integer();
        if (!value) return fmt::format("{}; expected {}", type_words(item), expected);
        values.push_back(value->get());
        const bool good = range.holds(static_cast<double>(value->get()));
        return good ? std::string() : fmt::format("{}; expected {}", value->get(), expected);
    });
    if (!read) return std::nullopt;
    if (values.empty()) return mistake(key, "is an empty list; expected " + expected), std::nullopt;
    return values;
}

std::string TableReader::toml_text() const {
    std::ostringstream text;
    text << table_;
    return text.str();
}

std::vector<std::string> TableReader::keys() const {
    std::vector<std::string> names;
    for (const auto& [key, node] : table_)
        names.emplace_back(key.str());
    return names;
}

void TableReader::table(std::string_view key, KeyText text, const std::function<void(TableReader&)>& body) {
    if (recording()) return record_inner(key, text, {.type = KeyType::table}, body);
    const toml::node* node = find(key);
    if (!node) return;
    const auto* inner = node->as_table();
    if (!inner) return wrong_type(key, *node, "a table");
    TableReader reader(*inner, path_of(key), mistakes_);
    body(reader);
    reader.finish();
}

void TableReader::named_values(std::string_view key, KeyText text, const std::function<void(TableReader&)>& body) {
    if (recording()) return note(key, text, {.type = KeyType::named_values});
    table(key, text, body);
}

void TableReader::tables(std::string_view key, KeyText text, const std::function<void(TableReader&)>& body,
                         std::size_t fewest) {
    if (recording())
        return record_inner(key, text, {.type = KeyType::tables, .count_least = fewest, .needed = fewest > 0}, body);
    const toml::node* node = find(key);
    if (!node) return;
    const auto* list = node->as_array();
    if (!list) return wrong_type(key, *node, fmt::format("a list of tables, each headed [[{}]]", path_of(key)));
    for (const toml::node& item : *list) {
        const auto* inner = item.as_table();
        if (!inner)
            return mistake(
                key, fmt::format("holds {}; expected tables, each headed [[{}]]", type_words(item), path_of(key)));
        TableReader reader(*inner, path_of(key), mistakes_);
        body(reader);
        reader.finish();
    }
}

void TableReader::look_at_tables(std::string_view key, const std::function<void(const toml::table&)>& body) const {
    const auto* list = table_[key].as_array();
    if (!list) return;
    for (const toml::node& item : *list)
        if (const auto* inner = item.as_table()) body(*inner);
}

void TableReader::refuse(std::string_view key, const std::string& reason) {
    if (find(key)) mistake(key, reason);
}

void TableReader::finish() {
    std::vector<std::string_view> meant(known_.begin(), known_.end());
    meant.insert(meant.end(), asked_for_.begin(), asked_for_.end());
    for (const auto& [key, node] : table_) {
        const std::string_view word = key.str();
        if (std::find(known_.begin(), known_.end(), word) != known_.end()) continue;
        mistakes_.add(key.source(), fmt::format("{}: unknown key{}", path_of(word), did_you_mean(word, meant)));
    }
}

Result<void> read_toml(std::string_view text, const std::string& file, const std::function<void(TableReader&)>& body,
                       const std::function<void(toml::table&, MistakeList&)>& change) {
    try {
        toml::table table = parsed_toml(text, file);
        MistakeList mistakes(file);
        if (change) change(table, mistakes);
        // What could not be changed is not what was to be read.
        if (!mistakes.empty()) return fail(mistakes.error());
        TableReader top(table, {}, mistakes);
        body(top);
        top.finish();
        if (!mistakes.empty()) return fail(mistakes.error());
        return {};
    } catch (const toml::parse_error& error) {
        return fail(ErrorCode::input, MistakeList(file).told(error.source(), on_one_line(error.description())));
    }
}

}  // namespace skyloop::inline run
