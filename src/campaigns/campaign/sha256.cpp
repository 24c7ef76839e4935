#include "campaigns/campaign/sha256.hpp"

#include <sha2.h>

#include <array>
#include <cstdint>

namespace skyloop::inline campaigns {

Sha256::Sha256() : context_(std::make_unique<SHA2_CTX>()) { SHA256Init(context_.get()); }
Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) {
    SHA256Update(context_.get(), reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

std::string Sha256::hex() {
    std::array<char, SHA256_DIGEST_STRING_LENGTH> text{};
    return SHA256End(context_.get(), text.data());
}

std::string sha256_hex(std::string_view bytes) {
    Sha256 digest;
    digest.add(bytes);
    return digest.hex();
}

}  // namespace skyloop::inline campaigns
