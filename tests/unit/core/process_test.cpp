// Programs of the host, well behaved and not.
#include "base/core/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

ProcessRequest shell(std::string text, double timeout_s = 20) {
    ProcessRequest request;
    request.command = {"/bin/sh", "-c", std::move(text)};
    request.timeout = Seconds(timeout_s);
    return request;
}

ProcessOutcome ran(const ProcessRequest& request) {
    const auto outcome = run_process(request);
    EXPECT_TRUE(outcome) << outcome.error().message;
    return outcome ? *outcome : ProcessOutcome{};
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST(Process, GivesExitCodeAndBothOutputs) {
    const ProcessOutcome outcome = ran(shell("echo out; echo err >&2; exit 7"));
    EXPECT_EQ(outcome.exit_code, 7);
    EXPECT_EQ(outcome.output, "out\n");
    EXPECT_EQ(outcome.errors, "err\n");
    EXPECT_FALSE(outcome.timed_out || outcome.cancelled || outcome.enough || outcome.output_cut);
}

TEST(Process, TellsOfTheSignalThatEndedIt) {
    const ProcessOutcome outcome = ran(shell("kill -TERM $$"));
    EXPECT_FALSE(outcome.exit_code);
    EXPECT_EQ(outcome.signal, 15);
}

TEST(Process, HasAnEmptyInputAndItsEnvironment) {
    ProcessRequest request = shell("cat; echo $SKYLOOP_A $SKYLOOP_B");
    request.environment = {"SKYLOOP_A=one", "SKYLOOP_B=two", "SKYLOOP_A=three"};
    EXPECT_EQ(ran(request).output, "three two\n");
}

TEST(Process, AMissingProgramIsAFailure) {
    ProcessRequest request;
    request.command = {"/no/such/program"};
    const auto outcome = run_process(request);
    ASSERT_FALSE(outcome);
    EXPECT_EQ(outcome.error().code, ErrorCode::outside);
    EXPECT_THAT(outcome.error().message, HasSubstr("cannot start '/no/such/program': No such file"));
    EXPECT_FALSE(run_process({}));
}

TEST(Process, IsKilledWithItsChildrenWhenItsTimeIsOver) {
    const auto begin = std::chrono::steady_clock::now();
    const ProcessOutcome outcome = ran(shell("sleep 60 & echo $!; wait", 0.3));
    EXPECT_TRUE(outcome.timed_out);
    EXPECT_LT(seconds_since(begin), 10);
    const std::string child = outcome.output.substr(0, outcome.output.find('\n'));
    ASSERT_FALSE(child.empty());
    // Killed children are reaped by whoever adopts them, soon; a zombie has no command line.
    std::string line = "?";
    for (int i = 0; i < 100 && !line.empty(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        std::ifstream file("/proc/" + child + "/cmdline");
        line.clear();
        std::getline(file, line);
    }
    EXPECT_EQ(line, "");
}

TEST(Process, WhatItLeavesBehindDoesNotKeepIt) {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(ran(shell("sleep 60 & exit 0")).exit_code, 0);
    EXPECT_LT(seconds_since(begin), 10);
}

TEST(Process, AFloodOfOutputIsCut) {
    ProcessRequest request = shell("yes 0123456789 | head -c 20000000; exit 0");
    request.output_limit = 1000;
    const ProcessOutcome outcome = ran(request);
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.output.size(), 1000);
    EXPECT_TRUE(outcome.output_cut);
    request = shell("yes", 0.3);
    request.output_limit = 10;
    EXPECT_TRUE(ran(request).timed_out) << "an endless flood does not stop the clock";
}

TEST(Process, LinesAreHandedOutUntilItIsEnough) {
    std::vector<std::string> lines;
    ProcessRequest request = shell("printf 'a\\nb\\nc'");
    request.line = [&lines](std::string_view line) { return lines.emplace_back(line), false; };
    EXPECT_EQ(ran(request).exit_code, 0);
    EXPECT_THAT(lines, ElementsAre("a", "b", "c")) << "the last one has no end";
    lines.clear();
    request.command.back() = "echo a; echo b; sleep 60";
    request.line = [&lines](std::string_view line) { return lines.emplace_back(line), line == "b"; };
    EXPECT_TRUE(ran(request).enough);
    EXPECT_THAT(lines, ElementsAre("a", "b"));
}

TEST(Process, CanBeCancelled) {
    ProcessRequest request = shell("sleep 60");
    request.cancelled = [] { return true; };
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_TRUE(ran(request).cancelled);
    EXPECT_LT(seconds_since(begin), 10);
}

}  // namespace
}  // namespace skyloop
