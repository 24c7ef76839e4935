#include "base/core/words.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

TEST(TerminalText, ShowsWhatATerminalWouldObey) {
    EXPECT_EQ(on_a_terminal("a\x1b[31m\x07\x7f\n\t"), "a\\u001b[31m\\u0007\\u007f\\n\\t");
    EXPECT_EQ(on_a_terminal("\xC2\x9B!"), "\\u009b!");
    EXPECT_EQ(on_a_terminal("grün …"), "grün …");
}

}  // namespace
}  // namespace skyloop
