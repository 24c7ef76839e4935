/// A digest that names content: equal digests are taken for equal content.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace skyloop {

/// SHA-256 (FIPS 180-4) of bytes that come piece by piece. The same on every machine.
class Sha256 {
public:
    void add(std::string_view bytes);
    /// 64 hexadecimal digits of everything that was added. Nothing may be added afterwards.
    [[nodiscard]] std::string hex();

private:
    void take_block(const unsigned char* block);

    std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                        0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<unsigned char, 64> waiting_{};  // the first bytes of a block
    std::size_t waiting_count_ = 0;
    std::uint64_t length_ = 0;  // bytes
};

/// 64 hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

}  // namespace skyloop
