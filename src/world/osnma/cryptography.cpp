#include <openssl/bn.h>
#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/obj_mac.h>

#include <algorithm>

#include "detail/cryptography.hpp"

namespace skyloop::inline world {

// What OpenSSL frees, owned.
template <auto Free>
struct OpensslFree {
    void operator()(auto* what) const { Free(what); }
};

namespace {

using Number = std::unique_ptr<BIGNUM, OpensslFree<BN_clear_free>>;
using NumberContext = std::unique_ptr<BN_CTX, OpensslFree<BN_CTX_free>>;
using Curve = std::unique_ptr<EC_GROUP, OpensslFree<EC_GROUP_free>>;
using Point = std::unique_ptr<EC_POINT, OpensslFree<EC_POINT_free>>;

Number number_of(ByteSpan bytes) { return Number(BN_bin2bn(bytes.data(), static_cast<int>(bytes.size()), nullptr)); }

Sha256Digest bytes_of(const BIGNUM* number) {
    Sha256Digest bytes{};
    BN_bn2binpad(number, bytes.data(), static_cast<int>(bytes.size()));
    return bytes;
}

// The numbers that RFC 6979 (3.2) proposes for k, one after the other.
class Nonces {
public:
    Nonces(const Sha256Digest& secret, const Sha256Digest& digest_modulo_order) {
        key_.fill(0);
        value_.fill(1);
        for (const std::uint8_t round : {std::uint8_t{0}, std::uint8_t{1}}) {
            Bytes message(value_.begin(), value_.end());
            message.push_back(round);
            message.insert(message.end(), secret.begin(), secret.end());
            message.insert(message.end(), digest_modulo_order.begin(), digest_modulo_order.end());
            step(message);
        }
    }
    Number next() {
        if (used_) {
            Bytes message(value_.begin(), value_.end());
            message.push_back(0);
            step(message);
        }
        used_ = true;
        value_ = hmac_sha256(key_, value_);
        return number_of(value_);
    }

private:
    void step(const Bytes& message) {
        key_ = hmac_sha256(key_, message);
        value_ = hmac_sha256(key_, value_);
    }
    Sha256Digest key_{}, value_{};
    bool used_ = false;
};

}  // namespace

Sha256Digest sha256_of(ByteSpan bytes) {
    Sha256Digest digest{};
    EVP_Digest(bytes.data(), bytes.size(), digest.data(), nullptr, EVP_sha256(), nullptr);
    return digest;
}

Sha256Digest hmac_sha256(ByteSpan key, ByteSpan message) {
    Sha256Digest digest{};
    HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()), message.data(), message.size(), digest.data(),
         nullptr);
    return digest;
}

struct SigningKey::Numbers {
    Curve curve{EC_GROUP_new_by_curve_name(NID_X9_62_prime256v1)};
    Number secret;
    Point point;
};

SigningKey::SigningKey(const Sha256Digest& secret) : numbers_(std::make_unique<Numbers>()) {
    const NumberContext context(BN_CTX_new());
    const BIGNUM* order = EC_GROUP_get0_order(numbers_->curve.get());
    const Number fewer(BN_dup(order));
    BN_sub_word(fewer.get(), 1);
    numbers_->secret = number_of(secret);
    BN_mod(numbers_->secret.get(), numbers_->secret.get(), fewer.get(), context.get());
    BN_add_word(numbers_->secret.get(), 1);
    numbers_->point.reset(EC_POINT_new(numbers_->curve.get()));
    EC_POINT_mul(numbers_->curve.get(), numbers_->point.get(), numbers_->secret.get(), nullptr, nullptr, context.get());
}

SigningKey::~SigningKey() = default;
SigningKey::SigningKey(SigningKey&&) noexcept = default;

Bytes SigningKey::sign(ByteSpan message) const {
    const NumberContext context(BN_CTX_new());
    const EC_GROUP* curve = numbers_->curve.get();
    const BIGNUM* order = EC_GROUP_get0_order(curve);
    const Number digest = number_of(sha256_of(message)), reduced(BN_new()), r(BN_new()), s(BN_new());
    BN_mod(reduced.get(), digest.get(), order, context.get());
    Nonces nonces(bytes_of(numbers_->secret.get()), bytes_of(reduced.get()));
    do {
        const Number k = nonces.next();
        if (BN_is_zero(k.get()) || BN_cmp(k.get(), order) >= 0) continue;
        const Point point(EC_POINT_new(curve));
        EC_POINT_mul(curve, point.get(), k.get(), nullptr, nullptr, context.get());
        EC_POINT_get_affine_coordinates(curve, point.get(), r.get(), nullptr, context.get());
        BN_mod(r.get(), r.get(), order, context.get());
        // s = (z + r d) / k
        BN_mod_mul(s.get(), r.get(), numbers_->secret.get(), order, context.get());
        BN_mod_add(s.get(), s.get(), reduced.get(), order, context.get());
        const Number inverse(BN_mod_inverse(nullptr, k.get(), order, context.get()));
        BN_mod_mul(s.get(), s.get(), inverse.get(), order, context.get());
    } while (BN_is_zero(r.get()) || BN_is_zero(s.get()));
    Bytes signature;
    for (const BIGNUM* part : {r.get(), s.get()}) {
        const Sha256Digest bytes = bytes_of(part);
        signature.insert(signature.end(), bytes.begin(), bytes.end());
    }
    return signature;
}

Bytes SigningKey::public_point() const {
    const NumberContext context(BN_CTX_new());
    Bytes point(33);
    EC_POINT_point2oct(numbers_->curve.get(), numbers_->point.get(), POINT_CONVERSION_COMPRESSED, point.data(),
                       point.size(), context.get());
    return point;
}

std::string SigningKey::public_pem() const {
    // SubjectPublicKeyInfo of an uncompressed point of P-256 (RFC 5480, 2), whose head is the same for all.
    static constexpr std::array<std::uint8_t, 26> head{0x30, 0x59, 0x30, 0x13, 0x06, 0x07, 0x2a, 0x86, 0x48,
                                                       0xce, 0x3d, 0x02, 0x01, 0x06, 0x08, 0x2a, 0x86, 0x48,
                                                       0xce, 0x3d, 0x03, 0x01, 0x07, 0x03, 0x42, 0x00};
    const NumberContext context(BN_CTX_new());
    Bytes told(head.begin(), head.end());
    told.resize(head.size() + 65);
    EC_POINT_point2oct(numbers_->curve.get(), numbers_->point.get(), POINT_CONVERSION_UNCOMPRESSED,
                       told.data() + head.size(), 65, context.get());
    std::string text((told.size() + 2) / 3 * 4, '\0');
    EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), told.data(), static_cast<int>(told.size()));
    constexpr std::size_t line = 64;
    std::string pem = "-----BEGIN PUBLIC KEY-----\n";
    for (std::size_t at = 0; at < text.size(); at += line)
        pem += text.substr(at, line) + '\n';
    return pem + "-----END PUBLIC KEY-----\n";
}

}  // namespace skyloop::inline world
