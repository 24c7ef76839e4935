/// A digest that names content: equal digests are taken for equal content.
#pragma once

#include <memory>
#include <string>
#include <string_view>

struct _SHA2_CTX;  // libmd's

namespace skyloop::inline campaigns {

/// SHA-256 (FIPS 180-4) of bytes that come piece by piece. The same on every machine.
class Sha256 {
public:
    Sha256();
    ~Sha256();
    Sha256(const Sha256&) = delete;
    Sha256& operator=(const Sha256&) = delete;
    void add(std::string_view bytes);
    /// 64 hexadecimal digits of everything that was added. Nothing may be added afterwards.
    [[nodiscard]] std::string hex();

private:
    std::unique_ptr<_SHA2_CTX> context_;
};

/// 64 hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

}  // namespace skyloop::inline campaigns
