/// Raw bytes, as they travel on a wire.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace skyloop {

using Bytes = std::vector<std::uint8_t>;
using ByteSpan = std::span<const std::uint8_t>;

/// The characters of `text` as bytes.
inline Bytes to_bytes(std::string_view text) { return {text.begin(), text.end()}; }

/// The bytes as characters, one for one.
inline std::string to_string(ByteSpan bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace skyloop
