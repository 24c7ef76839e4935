// Signatures against the examples of RFC 6979, and as OpenSSL itself verifies them.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/osnma_client.hpp"
#include "world/osnma/detail/cryptography.hpp"
#include "world/osnma/osnma_keys.hpp"

namespace skyloop {
namespace {

Bytes text_bytes(std::string_view text) { return {text.begin(), text.end()}; }

// A.2.5, P-256 with SHA-256; the secret is that number, less the one that is added.
TEST(SigningKey, SignsAsTheExamples) {
    const test::Octets number = test::octets_of("C9AFA9D845BA75166B5C215767B1D6934E50C3DB36E89B127B8A622B120F6720");
    Sha256Digest secret{};
    std::copy(number.begin(), number.end(), secret.begin());
    const SigningKey key(secret);
    EXPECT_EQ(key.public_point(),
              test::octets_of("0360FED4BA255A9D31C961EB74C6356D68C049B8923B61FA6CE669622E60F29FB6"));
    EXPECT_EQ(key.sign(text_bytes("sample")),
              test::octets_of("EFD48B2AACB6A8FD1140DD9CD45E81D69D2C877B56AAF991C34D0EA84EAF3716"
                              "F7CB1C942D657C41D436C7A1B6E29F65F3E900DBB9AFF4064DC4AB2F843ACDA8"));
    EXPECT_EQ(key.sign(text_bytes("test")),
              test::octets_of("F1ABB023518351CD71D881567B1EA663ED3EFCF6C5132B354F28D3B0B7D38367"
                              "019F4113742A2B14BD25926B49C649155F267E60D3814B4C0CC84250E46F0083"));
}

TEST(SigningKey, OthersVerifyIt) {
    for (std::uint8_t first = 0; first < 8; ++first) {
        Sha256Digest secret{first, 1, 2, 3};
        const SigningKey key(secret);
        const Bytes message = text_bytes("a message"), signature = key.sign(message);
        EXPECT_TRUE(test::signature_holds(key.public_point(), signature, message));
        EXPECT_FALSE(test::signature_holds(key.public_point(), signature, text_bytes("another")));
    }
}

TEST(OsnmaKeys, TheSameSeedGivesTheSameMessages) {
    const GpsTime start = to_gps_time(2300, 3 * 86400.0 + 1800);
    const OsnmaKeys one({9, start}), two({9, start}), other({10, start});
    EXPECT_EQ(one.message(start).bits.bytes(), two.message(start).bits.bytes());
    EXPECT_NE(one.message(start).bits.bytes(), other.message(start).bits.bytes());
    EXPECT_EQ(one.tree_xml(), two.tree_xml());
    EXPECT_EQ(one.message(start).id, 0);
    EXPECT_EQ(one.message(start - std::chrono::minutes(29)).id, 12);
    EXPECT_TRUE(one.public_pem(1).starts_with("-----BEGIN PUBLIC KEY-----\nMFkwEwYHKoZIzj0CAQYIKoZIzj0DAQcDQgAE"));
}

}  // namespace
}  // namespace skyloop
