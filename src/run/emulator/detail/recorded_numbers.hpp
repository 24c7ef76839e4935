/// Lines of whole numbers, as recordings hold them.
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace skyloop {

/// The numbers of a line, one space between them; nothing when there are others than `Count` or anything else.
template <std::size_t Count>
std::optional<std::array<std::int64_t, Count>> recorded_numbers(std::string_view line) {
    std::array<std::int64_t, Count> numbers{};
    for (std::size_t i = 0; i < Count; ++i) {
        if (i > 0 && !line.starts_with(' ')) return std::nullopt;
        if (i > 0) line.remove_prefix(1);
        const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), numbers[i]);
        if (error != std::errc()) return std::nullopt;
        line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    }
    return line.empty() ? std::optional(numbers) : std::nullopt;
}

}  // namespace skyloop
