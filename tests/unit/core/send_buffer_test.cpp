#include "base/core/bytes.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

TEST(SendBuffer, GivesBytesInTheirOrder) {
    SendBuffer buffer;
    EXPECT_TRUE(buffer.empty());
    buffer.add(to_bytes("abcdef"));
    buffer.sent(4);
    EXPECT_EQ(to_string(buffer.waiting()), "ef");
    buffer.add(to_bytes("gh"));
    EXPECT_EQ(to_string(buffer.waiting()), "efgh");
    EXPECT_EQ(buffer.size(), 4U);
    buffer.sent(4);
    EXPECT_TRUE(buffer.empty());
    buffer.add(to_bytes("ij"));
    EXPECT_EQ(to_string(buffer.waiting()), "ij");
    buffer.clear();
    EXPECT_TRUE(buffer.waiting().empty());
}

TEST(SendBuffer, GivesUpWhatHasLeftThoughItNeverRunsEmpty) {
    SendBuffer buffer;
    buffer.add(Bytes(1000, 0));
    for (int i = 1; i <= 1'000'000; ++i) {
        buffer.add(Bytes(10, static_cast<std::uint8_t>(i)));
        buffer.sent(10);
        ASSERT_LE(buffer.held(), 2 * buffer.size() + 10) << i;
    }
    EXPECT_EQ(buffer.size(), 1000U);
    EXPECT_EQ(buffer.waiting().back(), static_cast<std::uint8_t>(1'000'000));
    EXPECT_EQ(buffer.waiting().front(), static_cast<std::uint8_t>(1'000'000 - 99));
}

}  // namespace
}  // namespace skyloop
