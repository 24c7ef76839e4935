/// Observation files in Hatanaka's compact form.
#pragma once

#include <string>
#include <string_view>

#include "base/core/result.hpp"

namespace skyloop::inline world::rinex {

/// Whether a text begins as a compact RINEX file does.
bool is_compact(std::string_view text);

/// The RINEX text that a compact one stands for: versions 1.0 (of RINEX 2) and 3.0 (of RINEX 3 and 4), differences up
/// to the ninth order. Y. Hatanaka (2008), "A Compression Format and Tools for GNSS Observation Data", Bulletin of the
/// Geographical Survey Institute 55, 21-30.
/// Fails with `input` and NAME:LINE where it is of another version, damaged or cut, or where its text has more than
/// max_text_file_size bytes: what follows a damage cannot be restored.
Result<std::string> from_compact(std::string_view text, std::string_view name);

}  // namespace skyloop::inline world::rinex
