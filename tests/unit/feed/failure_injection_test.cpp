#include "run/feed/mavlink_component.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "run/fault/fault_kind.hpp"

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr float gps = 4;

// A run that takes as many commands as it is told to.
struct TakenCommands {
    std::vector<Command> all;
    std::size_t room = 1000;
    CommandSink sink() {
        return [this](Command command) {
            if (all.size() >= room) return false;
            all.push_back(std::move(command));
            return true;
        };
    }
    [[nodiscard]] std::vector<std::string> lines() const {
        std::vector<std::string> lines;
        for (const Command& c : all)
            lines.push_back(c.verb == CommandVerb::stop_fault ? "stop " + c.parameters.text("fault")
                            : c.parameters.has("fault")       ? "again " + c.parameters.text("fault")
                                                        : c.parameters.text("name") + ": " + c.parameters.text("kind") +
                                                              " " + c.receivers.at(0));
        return lines;
    }
};

TEST(FailureInjector, TheCatalogueHasEveryFaultWithTheseParameters) {
    ASSERT_THAT(failure_faults(), SizeIs(7));
    for (const FailureFault& failure : failure_faults()) {
        const FaultKind* kind = find_fault_kind(failure.kind);
        ASSERT_NE(kind, nullptr) << failure.kind;
        EXPECT_FALSE(kind->measuring_receivers_only) << failure.kind;
        const CheckedParameters checked = check_parameters(kind->parameters, failure.parameters);
        EXPECT_THAT(checked.mistakes, IsEmpty()) << failure.kind;
        EXPECT_TRUE(kind->make(checked.parameters, {1, "test"})) << failure.kind;
    }
}

TEST(FailureInjector, StartsAFaultOnEachReceiverAndStopsItAgain) {
    TakenCommands run;
    FailureInjector injector({"front", "rear"}, run.sink());
    EXPECT_EQ(injector.inject(gps, 1, 0), MavlinkResult::accepted);
    EXPECT_EQ(injector.inject(gps, 0, 2), MavlinkResult::accepted);
    EXPECT_THAT(run.lines(), ElementsAre("mavlink off 1: receiver_silent front", "mavlink off 2: receiver_silent rear",
                                         "stop mavlink off 2"));
    EXPECT_EQ(run.all[0].source, "mavlink");
}

TEST(FailureInjector, TheSameAgainIsLeftToTheRunAndAnotherTakesItsPlace) {
    TakenCommands run;
    FailureInjector injector({"only"}, run.sink());
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(injector.inject(gps, 2, 1), MavlinkResult::accepted);
    EXPECT_EQ(injector.inject(gps, 4, 0), MavlinkResult::accepted);
    EXPECT_EQ(injector.inject(gps, 0, 0), MavlinkResult::accepted);
    EXPECT_EQ(injector.inject(gps, 0, 0), MavlinkResult::accepted) << "nothing to stop";
    EXPECT_THAT(run.lines(),
                ElementsAre("mavlink stuck 1: freeze only", "again mavlink stuck 1", "again mavlink stuck 1",
                            "stop mavlink stuck 1", "mavlink wrong 2: position_step only", "stop mavlink wrong 2"));
    EXPECT_EQ(run.all[4].parameters.number("north_m"), 100);
}

TEST(FailureInjector, RefusesWhatItCannotDo) {
    TakenCommands run;
    FailureInjector injector({"only"}, run.sink());
    EXPECT_EQ(injector.inject(0, 1, 0), MavlinkResult::unsupported) << "a gyroscope";
    EXPECT_EQ(injector.inject(gps, 8, 0), MavlinkResult::unsupported);
    EXPECT_EQ(injector.inject(gps, 1, 2), MavlinkResult::denied) << "there is one receiver";
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    for (const float odd : {nan, infinity, -infinity, -1.0F, 0.5F, 1e30F}) {
        EXPECT_EQ(injector.inject(odd, 1, 0), MavlinkResult::denied) << odd;
        EXPECT_EQ(injector.inject(gps, odd, 0), MavlinkResult::denied) << odd;
        EXPECT_EQ(injector.inject(gps, 1, odd), MavlinkResult::denied) << odd;
    }
    EXPECT_THAT(run.all, IsEmpty());
}

TEST(FailureInjector, WhatTheRunCannotTakeNowIsDoneAtTheNextAttempt) {
    TakenCommands run;
    run.room = 1;
    FailureInjector injector({"front", "rear"}, run.sink());
    EXPECT_EQ(injector.inject(gps, 1, 0), MavlinkResult::temporarily_rejected);
    run.room = 100;
    EXPECT_EQ(injector.inject(gps, 1, 0), MavlinkResult::accepted);
    EXPECT_THAT(run.lines(), ElementsAre("mavlink off 1: receiver_silent front", "again mavlink off 1",
                                         "mavlink off 2: receiver_silent rear"));
}

}  // namespace
}  // namespace skyloop
