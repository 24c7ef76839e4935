// Real power behind an emulated receiver: a command that leaves a line for each order stands for the relay.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "run/emulator/assembly.hpp"
#include "support/run_parts.hpp"
#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using test::content_of;
using test::emulator_data;
using test::emulator_scenario;
using test::TemporaryFolder;
using testing::Contains;
using testing::HasSubstr;

RunMode against_the_clock() {
    RunMode mode;
    mode.now = to_gps_time(2400, 0);
    mode.now_steady_ns = steady_clock_ns();
    return mode;
}

std::string orders_into(const std::filesystem::path& file) {
    return "command:sh -c 'echo cut >>$0' " + file.string() + "|sh -c 'echo on >>$0' " + file.string();
}

std::string receiver_with(const std::string& name, const std::string& power) {
    return "[[receiver]]\nname = \"" + name + "\"\nport = \"pty\"\npower = \"" + power + "\"\n";
}

constexpr const char* cut_twice = R"([run]
duration_s = 4
speed = 4
[model]
name = "ideal"
[[fault]]
kind = "power_cut"
receiver = ["a"]
at_s = 1
for_s = 1
[[fault]]
kind = "power_cut"
receiver = ["a"]
at_s = 1.5
for_s = 1.5
)";

TEST(Power, FollowsTheFaultsOfItsReceiver) {
    const TemporaryFolder folder;
    const auto a = folder / "a", b = folder / "b";
    const Scenario scenario = emulator_scenario(std::string(cut_twice) + receiver_with("a", orders_into(a)) +
                                                receiver_with("b", orders_into(b)));
    auto assembly = assemble(scenario, emulator_data(), against_the_clock());
    ASSERT_TRUE(assembly) << assembly.error().message;
    EXPECT_EQ(content_of(a), "on\n") << "before time begins";
    const std::atomic<bool> stop{false};
    assembly->emulator->run_until(*assembly->end, stop);
    EXPECT_EQ(content_of(a), "on\ncut\non\n") << "two faults at once are one outage";
    EXPECT_EQ(content_of(b), "on\n");
    const PowerCounts counts = assembly->emulator->first().power()->counts();
    EXPECT_EQ(counts.cuts, 1U);
    EXPECT_EQ(counts.restores, 1U);
    EXPECT_EQ(counts.failures, 0U);
    EXPECT_THAT(run_summary(scenario, *assembly, "0"), HasSubstr("\"cuts\": 1"));
}

TEST(Power, IsOnAtTheEndOfARunInTheMiddleOfAnOutage) {
    const TemporaryFolder folder;
    const auto a = folder / "a";
    const Scenario scenario = emulator_scenario(std::string(cut_twice) + receiver_with("a", orders_into(a)));
    auto assembly = assemble(scenario, emulator_data(), against_the_clock());
    ASSERT_TRUE(assembly) << assembly.error().message;
    const std::atomic<bool> stop{false};
    assembly->emulator->run_until(advanced(assembly->start, Seconds(2.2)), stop);
    EXPECT_EQ(content_of(a), "on\ncut\non\n");
}

TEST(Power, FollowsTheFaultsThatBeginAndEndInAPause) {
    const TemporaryFolder folder;
    const auto a = folder / "a";
    CommandQueue live;
    RunMode mode = against_the_clock();
    mode.live_commands = &live;
    auto assembly = assemble(emulator_scenario("[model]\nname = \"ideal\"\n[[command]]\nkind = \"pause\"\nat_s = 0\n"
                                               "[[fault]]\nkind = \"power_cut\"\nname = \"dark\"\nat_s = 1000\n" +
                                               receiver_with("a", orders_into(a))),
                             emulator_data(), mode);
    ASSERT_TRUE(assembly) << assembly.error().message;
    const auto ask = [&](CommandVerb verb) {
        EXPECT_TRUE(live.push({verb, Parameters({{"fault", std::string("dark")}}), {}, "http"}));
    };
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    std::atomic<bool> stop{false};
    int orders = 1;  // that have been followed
    assembly->emulator->on_look([&](GpsTime now) {
        EXPECT_EQ(now, assembly->start) << "time stands still";
        const std::string followed = content_of(a);
        if (orders == 1 && followed == "on\n") ask(CommandVerb::start_fault), ++orders;
        if (orders == 2 && followed == "on\ncut\n") ask(CommandVerb::stop_fault), ++orders;
        if (orders == 3 && followed == "on\ncut\non\n") ++orders;
        stop = orders > 3 || std::chrono::steady_clock::now() > give_up;
    });
    assembly->emulator->run_until(GpsTime::max(), stop);
    EXPECT_EQ(orders, 4) << "cut and restored before the end of the run";
}

TEST(Power, IsLeftAloneInVirtualTime) {
    const TemporaryFolder folder;
    const auto a = folder / "a";
    RunMode mode = against_the_clock();
    mode.virtual_time = true;
    const auto assembly =
        assemble(emulator_scenario(std::string(cut_twice) + receiver_with("a", orders_into(a))), emulator_data(), mode);
    ASSERT_TRUE(assembly) << assembly.error().message;
    EXPECT_EQ(assembly->emulator->first().power(), nullptr);
    EXPECT_FALSE(std::filesystem::exists(a));
    EXPECT_THAT(assembly->warnings, Contains(HasSubstr("in virtual time nothing does")));
}

TEST(Power, IsRefusedBeforeAnythingIsOpened) {
    const auto refusal = [](const std::string& text) {
        const auto assembly = assemble(emulator_scenario(text), emulator_data(), against_the_clock());
        return assembly ? Error{ErrorCode::outside, "accepted"} : assembly.error();
    };
    const Error unknown = refusal("[[receiver]]\npower = \"relais:1\"");
    EXPECT_EQ(unknown.code, ErrorCode::usage);
    EXPECT_THAT(unknown.message, HasSubstr("power 'relais:1' is not understood; expected relay:VID:PID/N"));
    const std::string same = "command:true|true";
    const Error shared = refusal(receiver_with("a", same) + receiver_with("b", same));
    EXPECT_EQ(shared.code, ErrorCode::usage);
    EXPECT_THAT(shared.message, testing::MatchesRegex(R"(test\.toml:[0-9]+:[0-9]+: receiver\.power: power )"
                                                      R"('command:true\|true' is that of a too; expected an actuator )"
                                                      R"(of its own)"));
}

TEST(Power, OfTwoReceiversIsNotOneHoweverItIsWritten) {
    const auto told = [](const std::string& text) {
        const auto assembly = assemble(emulator_scenario(text), emulator_data(), against_the_clock());
        return assembly ? "accepted" : assembly.error().message;
    };
    EXPECT_THAT(told(receiver_with("a", "relay:16c0:05df/1") + receiver_with("b", "relay:16C0:05DF/1,active=power")),
                HasSubstr("power 'relay:16C0:05DF/1,active=power' may be that of a too, 'relay:16c0:05df/1'; expected "
                          "an actuator of its own"));
    const std::string line = "[[receiver]]\nname = \"a\"\nport = \"serial:/dev/no-such-tty\"\n";
    EXPECT_THAT(told(line + "power = \"line:/dev/../dev/no-such-tty/rts\"\n"),
                HasSubstr("power of 'a' 'line:/dev/../dev/no-such-tty/rts' is where port of 'a' "
                          "'serial:/dev/no-such-tty' goes; expected another place"));
    EXPECT_THAT(told(line + receiver_with("b", "line:/dev/no-such-tty/dtr")), HasSubstr("expected another place"));
}

}  // namespace
}  // namespace skyloop
