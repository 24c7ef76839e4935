/// A text as a number.
#pragma once

#include <cstdint>
#include <string_view>

namespace skyloop {

/// FNV-1a, 64 bit (Fowler, Noll and Vo): quick and stable everywhere, not for secrets.
/// @param basis the digest of what came before, to go on with it
constexpr std::uint64_t fnv1a_64(std::string_view text, std::uint64_t basis = 0xcbf29ce484222325u) {
    std::uint64_t digest = basis;
    for (const char c : text)
        digest = (digest ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return digest;
}

}  // namespace skyloop
