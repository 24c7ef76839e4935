#include "detail/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace skyloop::inline world {

namespace {

constexpr int deepest_nesting = 100;

std::string place_in(std::string_view text, std::size_t offset, JsonText extent) {
    const std::string_view before = text.substr(0, std::min(offset, text.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const auto start = before.rfind('\n');
    const std::size_t column = before.size() - (start == std::string_view::npos ? 0 : start + 1) + 1;
    return extent == JsonText::line ? fmt::format("{}", column) : fmt::format("{}:{}", line, column);
}

/// Where brackets nest too deep, npos where they do not.
std::size_t too_deep_at(std::string_view text) {
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            if (c == '\\') ++i;
            if (c == '"') quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '[' || c == '{') {
            if (++depth > deepest_nesting) return i;
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
    return std::string_view::npos;
}

}  // namespace

Result<JsonData> parse_json(std::string_view text, std::string_view name, JsonText extent) {
    const std::size_t deep = too_deep_at(text);
    if (deep != std::string_view::npos)
        return fail(ErrorCode::input, fmt::format("{}:{}: nested deeper than {} levels", name,
                                                  place_in(text, deep, extent), deepest_nesting));
    try {
        return JsonData::parse(text.begin(), text.end());
    } catch (const JsonData::parse_error& error) {
        const std::size_t at = error.byte > 0 ? error.byte - 1 : 0;
        const char* what = at >= text.size() ? "the text ends within a value" : "this is no JSON";
        return fail(ErrorCode::input, fmt::format("{}:{}: {}", name, place_in(text, at, extent), what));
    } catch (const JsonData::exception&) {
        return fail(ErrorCode::input, fmt::format("{}: a number is larger than any can be", name));
    }
}

const JsonData& member(const JsonData& value, const char* key) {
    static const JsonData nothing;
    if (!value.is_object()) return nothing;
    const auto found = value.find(key);
    return found == value.end() ? nothing : *found;
}

std::string_view text_member(const JsonData& value, const char* key) {
    const JsonData& found = member(value, key);
    return found.is_string() ? std::string_view(found.get_ref<const std::string&>()) : std::string_view();
}

}  // namespace skyloop::inline world
