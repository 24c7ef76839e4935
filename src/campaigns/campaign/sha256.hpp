/// A digest that names content: equal digests are taken for equal content.
#pragma once

#include <memory>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // OpenSSL's

namespace skyloop {

/// SHA-256 (FIPS 180-4) of bytes that come piece by piece. The same on every machine.
class Sha256 {
public:
    Sha256();
    void add(std::string_view bytes);
    /// 64 hexadecimal digits of everything that was added. Nothing may be added afterwards.
    [[nodiscard]] std::string hex();

private:
    struct Free {
        void operator()(evp_md_ctx_st* context) const;
    };
    std::unique_ptr<evp_md_ctx_st, Free> context_;
};

/// 64 hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

}  // namespace skyloop
