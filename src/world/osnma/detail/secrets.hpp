/// Secret numbers of a run.
#pragma once

#include "cryptography.hpp"

namespace skyloop::inline world {

/// 32 bytes by a name, of the seed alone. Whoever knows the seed knows them: they are for tests.
inline Sha256Digest osnma_secret(std::uint64_t seed, std::string_view name) {
    BitWriter key;
    key.put(seed, 64);
    const Bytes message(name.begin(), name.end());
    return hmac_sha256(key.bytes(), message);
}

}  // namespace skyloop::inline world
