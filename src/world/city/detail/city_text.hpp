/// Small helpers of readers: numbers, places in a file, names that mean something.
#pragma once

#include <cstddef>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace skyloop::inline world {

/// Reads a number at `at` and moves behind it; digits may follow a plus sign, "nan" and "inf" are numbers. One too
/// large for a double is infinite, one too small is zero. @returns nothing, `at` unmoved, where there is no number
std::optional<double> take_number(const char*& at, const char* end);

/// The number of type T, as this machine holds it, whose bytes begin at `bytes`.
template <class T>
double number_at(const void* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
}

/// A text without the UTF-8 mark that Windows' editors put before it.
std::string_view without_byte_order_mark(std::string_view text);

/// "NAME:LINE" of a byte of a text, the first line being 1.
std::string line_place(std::string_view name, std::string_view text, std::size_t offset);

/// What to show of a file's word in a message: at most 40 characters, unprintable ones as '?'.
std::string shown(std::string_view word);

/// The material of surface_materials() that a name such as "itu_concrete", "Glass.003" or "wet ground" speaks of; empty
/// when it speaks of none. ("facade_brick" is brick; "plate_glass_metal" the one that comes first, glass.)
std::string material_of_name(std::string_view name);

/// True when an object or group of that name is ground: it contains "ground" or "terrain", or is the "Plane" that
/// modelling programs make, with or without a number.
bool names_ground(std::string_view name);

}  // namespace skyloop::inline world
