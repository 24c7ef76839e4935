/// Structures that say their own size, in and out.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "answer.hpp"

namespace skyloop {

/// Larger ones are a size that was never set.
inline constexpr std::size_t largest_struct = 4096;

/// The size that a structure has had since it exists; smaller ones are no such structure. A structure that grows keeps
/// its first size here.
template <class T>
inline constexpr std::size_t first_size = sizeof(T);

/// @param size as the caller has set it
template <class T>
Answer<void> check_size(std::size_t size, const char* name) {
    if (size >= first_size<T> && size <= largest_struct) return {};
    return refuse(SKY_E_ARG, fmt::format("{} is {}; expected {} to {}", name, size, first_size<T>, largest_struct));
}

/// The caller's structure as this version knows it: what an older caller does not know is zero, what a newer one knows
/// more is left out.
template <class T>
Answer<T> read_struct(const T* given, const char* name) {
    if (given == nullptr) return refuse(SKY_E_ARG, fmt::format("{} is null", name));
    std::uint32_t size = 0;
    std::memcpy(&size, given, sizeof size);
    if (const auto checked = check_size<T>(size, "struct_size"); !checked) return refuse(checked.error());
    T value{};
    std::memcpy(&value, given, std::min<std::size_t>(size, sizeof(T)));
    return value;
}

/// Fills the caller's structure, zeros where it is longer; its struct_size stays. check_size() comes before.
template <class T>
void write_struct(T value, T* out) {
    std::uint32_t size = 0;
    std::memcpy(&size, out, sizeof size);
    value.struct_size = size;
    std::memset(out, 0, size);
    std::memcpy(out, &value, std::min<std::size_t>(size, sizeof(T)));
}

}  // namespace skyloop
