#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

#include "detail/toml_values.hpp"
#include "run/scenario/scenario_file.hpp"

namespace skyloop::inline run {
namespace {

// The place behind the text in quotes that begins at `at` (TOML 1.0, "String"); of one that does not end, its line's
// end, where the parser refuses it, or the end of all.
std::size_t end_of_quoted(std::string_view text, std::size_t at) {
    const char quote = text[at];
    const bool of_lines = text.substr(at, 3) == std::string_view(quote == '"' ? "\"\"\"" : "'''");
    std::size_t run = 0;  // of quotes that follow each other
    for (std::size_t i = at + (of_lines ? 3 : 1); i < text.size(); ++i) {
        if (!of_lines && text[i] == '\n') return i;
        run = text[i] == quote ? run + 1 : 0;
        if (run == (of_lines ? 3 : 1)) {
            ++i;
            // Up to two quotes before the three that close are of the text.
            for (int more = 0; of_lines && more < 2 && i < text.size() && text[i] == quote; ++more)
                ++i;
            return i;
        }
        if (quote == '"' && text[i] == '\\') ++i;
    }
    return text.size();
}

// Counts the dots of the key that is being read, and of those in whose inline tables it stands.
class KeyDepth {
public:
    // @return whether the key has too many parts
    bool take(char c) {
        const bool in_value = levels_.back().in_value;
        if (c == '.' && !in_value) ++levels_.back().dots, ++dots_;
        if (c == '=') levels_.back().in_value = true;
        if (c == ',' || c == '\n') begin_anew();
        if (c == '{') levels_.push_back({});
        if (c == '[') levels_.push_back({0, in_value, in_value});
        if ((c == ']' || c == '}') && levels_.size() > 1) {
            dots_ -= levels_.back().dots;
            levels_.pop_back();
        }
        return dots_ >= most_key_parts;
    }

private:
    struct Level {
        std::size_t dots = 0;   // of its key
        bool in_value = false;  // where dots are those of numbers
        bool list = false;      // of values; else a header, an inline table or the document
    };
    void begin_anew() {
        Level& level = levels_.back();
        dots_ -= level.dots;
        level = {0, level.list, level.list};
    }

    std::vector<Level> levels_{Level{}};  // of each bracket that is open
    std::size_t dots_ = 0;                // of all levels
};

// Where a key has its first part too many.
std::optional<std::size_t> part_too_many(std::string_view text) {
    KeyDepth depth;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (c == '"' || c == '\'') {
            i = end_of_quoted(text, i);
        } else if (c == '#') {
            i = std::min(text.find('\n', i), text.size());
        } else if (depth.take(c)) {
            return i;
        } else {
            ++i;
        }
    }
    return std::nullopt;
}

// Lines and columns as the parser counts them, in characters of UTF-8.
toml::source_position position_of(std::string_view text, std::size_t at) {
    const std::string_view before = text.substr(0, at);
    const std::size_t line = before.rfind('\n') + 1;  // npos + 1 is 0
    const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };
    return {static_cast<toml::source_index>(1 + std::count(before.begin(), before.end(), '\n')),
            static_cast<toml::source_index>(
                1 + std::count_if(before.begin() + static_cast<std::ptrdiff_t>(line), before.end(), begins))};
}

}  // namespace

toml::table parsed_toml(std::string_view text, std::string_view file) {
    if (const auto at = part_too_many(text))
        throw toml::parse_error(
            fmt::format("the key has more than {} parts; expected at most {}", most_key_parts, most_key_parts).c_str(),
            position_of(text, *at));
    return toml::parse(text, file);
}

namespace {

// A text that TOML reads back as the same characters (TOML 1.0, "String").
std::string quoted_text(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            quoted += fmt::format("\\{}", c);
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            quoted += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        else
            quoted += c;
    }
    return quoted + "\"";
}

// With a point or an exponent, so that it stays no whole number.
std::string floating_text(double number) {
    if (std::isnan(number)) return "nan";
    if (std::isinf(number)) return number < 0 ? "-inf" : "inf";
    std::string text = fmt::format("{}", number);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
}

template <class Moment>
std::string moment_text(const Moment& moment) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << moment;
    return text.str();
}

std::optional<std::string> list_text(const toml::array& list) {
    std::string text;
    for (const toml::node& item : list) {
        const auto one = toml_text(item);
        if (!one) return std::nullopt;
        text += (text.empty() ? "" : ", ") + *one;
    }
    return "[" + text + "]";
}

// Values with commas between, as an array; or words.
std::optional<std::vector<CampaignValue>> as_array(std::string_view text) {
    try {
        const toml::table table = parsed_toml(fmt::format("v = [{}\n]", text));
        const toml::array* list = table.size() == 1 ? table["v"].as_array() : nullptr;
        if (list == nullptr) return std::nullopt;
        std::vector<CampaignValue> values;
        for (const toml::node& item : *list) {
            auto value = campaign_value(item);
            if (!value) return std::nullopt;
            values.push_back(std::move(*value));
        }
        return values;
    } catch (const toml::parse_error&) {
        return std::nullopt;
    }
}

}  // namespace

std::string sense_of(const CampaignValue& value) {
    std::string sense;
    const std::function<void(const toml::node&)> add = [&](const toml::node& node) {
        const auto* number = node.as_floating_point();
        if (const toml::array* list = node.as_array()) {
            sense += "[";
            for (const toml::node& item : *list)
                add(item);
            sense += "],";
        } else if (number != nullptr && number->get() == std::floor(number->get()) && std::abs(number->get()) < 1e15) {
            sense += fmt::format("{},", static_cast<std::int64_t>(number->get()));
        } else {
            sense += toml_text(node).value_or("") + ",";
        }
    };
    with_toml_value(value, add);
    return sense;
}

std::optional<std::string> toml_text(const toml::node& node) {
    if (const auto* text = node.as_string()) return quoted_text(text->get());
    if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
    if (const auto* number = node.as_floating_point()) return floating_text(number->get());
    if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
    if (const auto* list = node.as_array()) return list_text(*list);
    if (const auto* date = node.as_date()) return moment_text(date->get());
    if (const auto* time = node.as_time()) return moment_text(time->get());
    if (const auto* moment = node.as_date_time()) return moment_text(moment->get());
    return std::nullopt;
}

std::optional<CampaignValue> campaign_value(const toml::node& node) {
    const auto text = toml_text(node);
    if (!text) return std::nullopt;
    const auto* plain = node.as_string();
    return CampaignValue{*text, plain != nullptr ? plain->get() : *text};
}

CampaignValue campaign_value(double number) { return {floating_text(number), floating_text(number)}; }

CampaignValue campaign_value(std::int64_t number) { return {fmt::format("{}", number), fmt::format("{}", number)}; }

CampaignValue quoted_value(std::string_view text) { return {quoted_text(text), std::string(text)}; }

void with_toml_value(const CampaignValue& value, const std::function<void(const toml::node&)>& use) {
    const toml::table table = parsed_toml("v = " + value.toml);
    use(*table.get("v"));
}

namespace {

// A value that is written as TOML writes texts and arrays, and no plain word.
bool begins_as_toml(std::string_view text) {
    return !text.empty() && std::string_view("\"'[").find(text.front()) != std::string_view::npos;
}

// Of the first value: the comma behind it, or npos. Where it begins with a quote or a bracket, those within do not
// count.
std::size_t end_of_value(std::string_view text) {
    char quote = 0;
    int brackets = 0;
    const bool is_toml = begins_as_toml(text);
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == ',' && quote == 0 && brackets == 0) return i;
        if (!is_toml) continue;
        if (quote != 0) {
            if (c == '\\' && quote == '"') ++i;
            if (c == quote) quote = 0;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else {
            brackets += c == '[' ? 1 : c == ']' ? -1 : 0;
        }
    }
    return std::string_view::npos;
}

}  // namespace

Result<std::vector<CampaignValue>> parse_campaign_values(std::string_view text) {
    if (auto values = as_array(text); values && !values->empty()) return std::move(*values);
    std::vector<CampaignValue> values;
    for (std::string_view rest = text;;) {
        const std::size_t comma = end_of_value(rest);
        const std::string word(rest.substr(0, comma));
        if (word.empty())
            return fail(ErrorCode::usage, fmt::format("'{}' has an empty value; expected values with commas between, "
                                                      "such as 1.5,2 or town,street",
                                                      text));
        auto one = as_array(word);
        if (begins_as_toml(word) && (!one || one->size() != 1))
            return fail(ErrorCode::usage,
                        fmt::format("'{}' is no value; expected its quotes and brackets closed", word));
        if (!one || one->size() != 1) one = as_array(quoted_text(word));
        if (!one || one->size() != 1) return fail(ErrorCode::usage, "a value is no text in UTF-8");
        values.push_back(std::move(one->front()));
        if (comma == std::string_view::npos) return values;
        rest.remove_prefix(comma + 1);
    }
}

}  // namespace skyloop::inline run
