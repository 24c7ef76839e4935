#include "base/core/threads.hpp"

#include <gtest/gtest.h>

#include <future>
#include <numeric>
#include <vector>

namespace skyloop {
namespace {

TEST(JobThread, RunsAllThatWaitsBeforeItEnds) {
    std::vector<int> done, expected(100);
    std::iota(expected.begin(), expected.end(), 0);
    {
        JobThread thread(100);
        for (const int i : expected)
            thread.run([&done, i] { done.push_back(i); });
    }
    EXPECT_EQ(done, expected);
}

// As when nobody reads what is written.
TEST(JobThread, AJobThatIsHeldHoldsNobody) {
    std::promise<void> begun, released;
    std::vector<int> done;
    {
        JobThread thread(10);
        thread.run([&] {
            begun.set_value();
            released.get_future().wait();
        });
        begun.get_future().wait();
        for (int i = 0; i < 1000; ++i)
            thread.run([&done, i] { done.push_back(i); });
        EXPECT_EQ(thread.left_out(), 990U);
        EXPECT_TRUE(done.empty());
        released.set_value();
    }
    ASSERT_EQ(done.size(), 10U);
    EXPECT_EQ(done.front(), 990);
    EXPECT_EQ(done.back(), 999);
}

}  // namespace
}  // namespace skyloop
