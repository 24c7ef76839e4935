#include "run/control/command_json.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace skyloop {
namespace {

using testing::HasSubstr;

std::string command_refusal(std::string_view text) {
    const auto command = command_from_json(text, "test");
    return command ? "taken" : command.error().message;
}

TEST(CommandJson, ReadsACommandWithItsParametersAndStandards) {
    const auto command = command_from_json(R"({"command":"set_baud","baud":9600,"receiver":"front"})", "http");
    ASSERT_TRUE(command) << command.error().message;
    EXPECT_EQ(command->verb, CommandVerb::set_baud);
    EXPECT_EQ(command->parameters.number("baud"), 9600);
    EXPECT_THAT(command->receivers, testing::ElementsAre("front"));
    EXPECT_EQ(command->source, "http");
    const auto step = command_from_json(R"({"command":"step"})", "http");
    ASSERT_TRUE(step);
    EXPECT_EQ(step->parameters.number("seconds"), 1);
}

TEST(CommandJson, RefusesWithOneLineThatSaysWhatWasExpected) {
    EXPECT_THAT(command_refusal("{"), HasSubstr("no JSON from byte"));
    EXPECT_THAT(command_refusal("[1]"), HasSubstr("is a JSON array; expected an object"));
    EXPECT_THAT(command_refusal("{}"), HasSubstr("'command' is missing"));
    EXPECT_THAT(command_refusal(R"({"command":"pauze"})"), HasSubstr("did you mean 'pause'?"));
    EXPECT_THAT(command_refusal(R"({"command":1})"), HasSubstr("'command' is no text"));
    EXPECT_THAT(command_refusal(R"({"command":"speed","factor":-1})"), HasSubstr("'factor' is -1; expected a number"));
    EXPECT_THAT(command_refusal(R"({"command":"speed","factor":1,"factor":2})"), HasSubstr("stands there twice"));
    EXPECT_THAT(command_refusal(R"({"command":"speed","factor":1e999})"), HasSubstr("too large"));
    EXPECT_THAT(command_refusal(R"({"command":"speed","factor":null})"), HasSubstr("is a JSON null"));
    EXPECT_THAT(command_refusal(R"({"command":"speed","factor":1,"fator":1})"), HasSubstr("not known here"));
    EXPECT_THAT(command_refusal(R"({"command":"pause","receiver":"front"})"), HasSubstr("for the whole run"));
    EXPECT_THAT(command_refusal(R"({"command":"note","text":"a\nb"})"), HasSubstr("'text' is a JSON string"));
    EXPECT_THAT(command_refusal(R"({"command":"move_to","at":[91,0]})"), HasSubstr("latitude is 91"));
    EXPECT_THAT(command_refusal(R"({"command":"move_to","at":[1,"a"]})"), HasSubstr("'at' is a JSON array"));
    EXPECT_THAT(command_refusal(R"({"command":"start_fault"})"), HasSubstr("'fault' is missing"));
    EXPECT_THAT(command_refusal(std::string(60000, '[')), HasSubstr("no JSON"));
}

TEST(CommandJson, ALiveFaultIsForOneReceiverOrForSeveral) {
    const auto taken = [](std::string_view receiver) {
        const auto fault = live_fault_from_json(fmt::format(R"({{"kind":"outage","receiver":{}}})", receiver), "http");
        return fault ? fault->receivers : std::vector<std::string>{fault.error().message};
    };
    EXPECT_THAT(taken(R"("front")"), testing::ElementsAre("front"));
    EXPECT_THAT(taken(R"(["front","rear"])"), testing::ElementsAre("front", "rear"));
    EXPECT_THAT(taken(R"("")"), testing::IsEmpty());
    for (const char* wrong : {"[]", "1", "[1,2]"})
        EXPECT_THAT(taken(wrong), testing::ElementsAre("'receiver' is no text; expected a name, or a list of names"));
    EXPECT_THAT(command_refusal(R"({"command":"restart","receiver":["front","rear"]})"),
                HasSubstr("'receiver' names 2 receivers; expected one, or none for all of them"));
    EXPECT_EQ(command_refusal(R"({"command":"restart","receiver":["front"]})"), "taken");
}

TEST(CommandJson, WritesWhatItReads) {
    for (const std::string_view text :
         {R"({"command":"move_to","at":[48.5,11,500]})", R"({"command":"note","text":"quote \" and ü"})",
          R"({"command":"restart","receiver":"front","start":"cold"})",
          R"({"command":"start_fault","kind":"freeze","name":"a","receiver":["front","rear"],"ramp_in_s":0,)"
          R"("ramp_out_s":0,"velocity":"kept"})",
          R"({"command":"stop_fault","fault":"a"})"}) {
        const auto command = command_from_json(text, "http");
        ASSERT_TRUE(command) << text << command.error().message;
        EXPECT_EQ(nlohmann::json::parse(command_json(*command)), nlohmann::json::parse(text));
    }
}

TEST(CommandJson, RefusesNamesOfLiveFaultsThatAScenarioMayNotGive) {
    const auto run = live_fault_from_json(R"({"kind":"outage","name":"run"})", "http");
    ASSERT_FALSE(run);
    EXPECT_EQ(run.error().message, "'name' is 'run', which means the run itself; expected another name");
    const auto numbered = live_fault_from_json(R"({"kind":"outage","name":"a#b"})", "http");
    ASSERT_FALSE(numbered);
    EXPECT_THAT(numbered.error().message, HasSubstr("'name' has a '#'"));
    EXPECT_TRUE(live_fault_from_json(R"({"kind":"outage","name":"a b"})", "http"));
}

TEST(CommandJson, RefusesALiveFaultOfNoKind) {
    const auto unnamed = live_fault_from_json(R"({"for_s":3})", "http");
    ASSERT_FALSE(unnamed);
    EXPECT_THAT(unnamed.error().message, HasSubstr("'kind' is missing"));
    const auto unknown = live_fault_from_json(R"({"kind":"no_such_fault"})", "http");
    ASSERT_FALSE(unknown);
    EXPECT_THAT(unknown.error().message, HasSubstr("'no_such_fault'; expected the name of a kind"));
}

// Whatever the catalogue holds: its own examples of each kind are made of the standards and the least that is needed.
TEST(CommandJson, StartsEveryKindOfFaultThatNeedsNothing) {
    for (const FaultKind& kind : fault_kinds()) {
        bool needs = false;
        for (const ParameterSpec& spec : kind.parameters)
            needs = needs || spec.needed;
        if (needs) continue;
        const auto fault = live_fault_from_json(R"({"kind":")" + std::string(kind.name) + R"(","for_s":5})", "http");
        if (!fault) {
            EXPECT_FALSE(fault.error().message.empty()) << kind.name;  // its standards alone may say too little
            continue;
        }
        EXPECT_EQ(fault->verb, CommandVerb::start_fault);
        EXPECT_EQ(fault->parameters.text("kind"), kind.name);
        EXPECT_EQ(fault->parameters.text("name"), kind.name);
        EXPECT_EQ(fault->parameters.number("for_s"), 5);
        const auto again = command_from_json(command_json(*fault), "http");
        ASSERT_TRUE(again) << kind.name << ": " << again.error().message;
        EXPECT_EQ(again->parameters.values(), fault->parameters.values());
    }
}

TEST(CommandJson, ListsEveryKindWithItsParameters) {
    const auto commands = nlohmann::json::parse(command_kinds_json());
    ASSERT_EQ(commands.size(), command_kinds().size());
    EXPECT_EQ(commands[0]["name"], command_kinds()[0].name);
    const auto faults = nlohmann::json::parse(fault_kinds_json());
    EXPECT_EQ(faults.size(), fault_kinds().size());
}

}  // namespace
}  // namespace skyloop
