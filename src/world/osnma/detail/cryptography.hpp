/// The primitives that OSNMA needs: SHA-256, HMAC and signatures on the curve P-256.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/core/bytes.hpp"

namespace skyloop::inline world {

using Sha256Digest = std::array<std::uint8_t, 32>;

Sha256Digest sha256_of(ByteSpan bytes);
/// RFC 2104 with SHA-256.
Sha256Digest hmac_sha256(ByteSpan key, ByteSpan message);

/// A pair of keys of ECDSA on P-256 (FIPS 186-4, D.1.2.3), that of a secret number. Signatures hang on key and message
/// alone (RFC 6979).
class SigningKey {
public:
    /// @param secret any 32 bytes; taken modulo the order of the curve, less one, plus one
    explicit SigningKey(const Sha256Digest& secret);
    ~SigningKey();
    SigningKey(SigningKey&&) noexcept;
    SigningKey& operator=(SigningKey&&) = delete;

    /// r and s over SHA-256 of the message, 32 bytes each.
    [[nodiscard]] Bytes sign(ByteSpan message) const;
    /// The point in its compressed form, 33 bytes (SEC 1, 2.3.3).
    [[nodiscard]] Bytes public_point() const;
    /// The public key as programs read it (RFC 5480, PEM).
    [[nodiscard]] std::string public_pem() const;

private:
    struct Numbers;
    std::unique_ptr<Numbers> numbers_;
};

}  // namespace skyloop::inline world
