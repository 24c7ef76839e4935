#include "detail/city_text.hpp"
#include "base/core/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <utility>

namespace skyloop::inline world {
namespace {

// Too large or too small for a double: which, tells the exponent; without one it is the count of digits.
double out_of_range_number(std::string_view digits) {
    const std::size_t exponent = digits.find_first_of("eE");
    const bool small = exponent != std::string_view::npos ? digits.substr(exponent + 1).starts_with('-')
                                                          : digits.find_first_of("123456789") > digits.find('.');
    if (small) return 0;
    const double infinite = std::numeric_limits<double>::infinity();
    return digits.starts_with('-') ? -infinite : infinite;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

}  // namespace

std::optional<double> take_number(const char*& at, const char* end) {
    const char* first = at;
    if (first != end && *first == '+') {
        ++first;
        if (first != end && *first == '-') return std::nullopt;
    }
    double value = 0;
    const auto [after, error] = std::from_chars(first, end, value);
    if (error == std::errc::invalid_argument) return std::nullopt;
    if (error == std::errc::result_out_of_range)
        value = out_of_range_number({first, static_cast<std::size_t>(after - first)});
    at = after;
    return value;
}

std::string_view without_byte_order_mark(std::string_view text) {
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    if (text.starts_with(mark)) text.remove_prefix(mark.size());
    return text;
}

std::string line_place(std::string_view name, std::string_view text, std::size_t offset) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(offset, text.size()));
    return fmt::format("{}:{}", name, 1 + std::count(text.begin(), end, '\n'));
}

std::string shown(std::string_view word) {
    std::string text(word.substr(0, 40));
    for (char& c : text)
        if (c < ' ' || c > '~') c = '?';
    return word.size() > 40 ? text + "…" : text;
}

std::string material_of_name(std::string_view name) {
    const std::string lower = lower_case(name);
    if (lower.find("ground") != std::string::npos) {
        for (const char* wetness : {"dry", "medium", "wet"})
            // P.2040 has a "medium dry ground": medium goes before dry.
            if (lower.find("medium") != std::string::npos)
                return "medium-ground";
            else if (lower.find(wetness) != std::string::npos)
                return fmt::format("{}-ground", wetness);
        return "";
    }
    constexpr std::array<std::pair<std::string_view, const char*>, 7> words{{{"concrete", "concrete"},
                                                                             {"brick", "brick"},
                                                                             {"glass", "glass"},
                                                                             {"wood", "wood"},
                                                                             {"marble", "marble"},
                                                                             {"metal", "metal"},
                                                                             {"steel", "metal"}}};
    std::size_t first = std::string::npos;
    std::string material;
    for (const auto& [word, meant] : words) {
        const std::size_t at = lower.find(word);
        if (at < first) {
            first = at;
            material = meant;
        }
    }
    return material;
}

bool names_ground(std::string_view name) {
    const std::string lower = lower_case(name);
    if (lower.find("ground") != std::string::npos || lower.find("terrain") != std::string::npos) return true;
    const std::size_t plane = lower.find("plane");
    if (plane == std::string::npos) return false;
    const std::size_t behind = plane + 5;
    return (plane == 0 || !is_letter(lower[plane - 1])) && (behind == lower.size() || !is_letter(lower[behind]));
}

}  // namespace skyloop::inline world
