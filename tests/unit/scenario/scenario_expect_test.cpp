// [[expect]]: sentences and probes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run/verdict/expectation.hpp"
#include "scenario_text.hpp"

namespace skyloop {
namespace {

using test::mistakes_of;
using test::scenario_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(ScenarioExpect, SentencesAreRead) {
    const auto list = scenario_of(R"toml(
[[receiver]]
name = "left"
[[fault]]
kind = "outage"
[[expect]]
what = "no fix within 2 s of the outage"
[[expect]]
name = "stays quiet"
what = "client reconfigures never"
receiver = "left"
)toml")
                          .expectations;
    ASSERT_EQ(list.size(), 2);
    ASSERT_TRUE(list[0].sentence);
    EXPECT_EQ(expectation_text(*list[0].sentence), "no fix within 2 s of the start of outage");
    EXPECT_EQ(list[0].title(), "no fix within 2 s of the outage");
    EXPECT_EQ(list[1].title(), "stays quiet");
    EXPECT_EQ(list[1].receiver, "left");
    EXPECT_FALSE(list[1].probe);
}

TEST(ScenarioExpect, ProbesAreRead) {
    const auto list = scenario_of(R"toml(
[[expect]]
command = ["gpspipe", "-w"]
expect_exit = 2
json = "tpv.mode >= 3"
at_s = 30
within_s = 10.5
timeout_s = 5
[[expect]]
command = "grep -q RTK log"
)toml")
                          .expectations;
    ASSERT_EQ(list.size(), 2);
    ASSERT_TRUE(list[0].probe);
    EXPECT_THAT(list[0].probe->command, ElementsAre("gpspipe", "-w"));
    EXPECT_EQ(list[0].probe->expect_exit, 2);
    ASSERT_TRUE(list[0].probe->condition);
    EXPECT_EQ(condition_text(*list[0].probe->condition), "tpv.mode >= 3");
    EXPECT_EQ(list[0].probe->at, Seconds(30));
    EXPECT_EQ(list[0].probe->within, Seconds(10.5));
    EXPECT_EQ(list[0].probe->timeout, Seconds(5));
    EXPECT_THAT(list[1].probe->command, ElementsAre("grep -q RTK log"));
    EXPECT_FALSE(list[1].probe->expect_exit);
    EXPECT_EQ(list[1].title(), "command 'grep -q RTK log' exits 0");
}

TEST(ScenarioExpect, MistakesAreToldWithTheirPlace) {
    EXPECT_THAT(mistakes_of("[[expect]]\nwhat = \"no fixx\""),
                StartsWith("test.toml:2:8: expect.what: at character 4: 'fixx' is not understood; expected fix"));
    EXPECT_THAT(mistakes_of("[[expect]]\nname = \"x\""), HasSubstr("says nothing; expected what"));
    EXPECT_THAT(mistakes_of("[[expect]]\nwhat = 3"),
                AllOf(HasSubstr("expected a text"), Not(HasSubstr("says nothing"))));
    EXPECT_THAT(mistakes_of("[[expect]]\nwhat = \"fix\"\ncommand = \"x\""),
                HasSubstr("expect.what: stands beside command"));
    EXPECT_THAT(mistakes_of("[[expect]]\nwhat = \"fix\"\nat_s = 3"), HasSubstr("expect.at_s: is of a command"));
    EXPECT_THAT(mistakes_of("[[expect]]\ncommand = \"\""), HasSubstr("expect.command: names no program"));
    EXPECT_THAT(mistakes_of("[[expect]]\ncommand = []"), HasSubstr("expect.command: names no program"));
    EXPECT_THAT(mistakes_of("[[expect]]\ncommand = \"x\"\njson = \"mode\""),
                HasSubstr("expect.json: at character 5: the condition ends here"));
    EXPECT_THAT(mistakes_of("[[expect]]\ncommand = \"x\"\nexpect_exit = 300"), HasSubstr("from 0 to 255"));
    EXPECT_THAT(mistakes_of("[[expect]]\ncommand = \"x\"\nat_s = -1"), HasSubstr("expect.at_s: is -1"));
    EXPECT_THAT(mistakes_of("[[expect]]\ncommand = \"x\"\ntimeout_s = nan"), HasSubstr("expect.timeout_s"));
    EXPECT_THAT(mistakes_of("[[expect]]\ncommand = \"x\"\nreceiver = \"a\""),
                HasSubstr("expect.receiver: is of a sentence"));
    EXPECT_THAT(mistakes_of("[[expect]]\nwhat = \"fix\"\nwat = 1"), HasSubstr("unknown key; did you mean 'what'?"));
    EXPECT_THAT(mistakes_of("[[expect]]\nwhat = \"C/N0 of G99 below 30 dBHz\""),
                HasSubstr("test.toml:2:8: expect.what: 'G99' is no satellite; expected G01 to G63 of GPS"));
    EXPECT_THAT(mistakes_of("[[expect]]\nwhat = \"receiver sends NAV-PTV every 1 s always\""),
                HasSubstr("expect.what: 'NAV-PTV' is no message; did you mean 'NAV-PVT'"));
    EXPECT_THAT(mistakes_of("[[expect]]\nwhat = \"receiver sends FOO every 1 s always\""),
                HasSubstr("test.toml:2:8: expect.what: 'FOO' is no message; expected a name like"));
    EXPECT_THAT(mistakes_of("expect = 3"), HasSubstr("a list of tables, each headed [[expect]]"));
}

TEST(ScenarioExpect, UnknownNamesAreToldAtTheirEntry) {
    const std::string healthy = "[[fault]]\nkind = \"outage\"\n[[expect]]\nwhat = \"fix within 9 s of the outage\"\n";
    EXPECT_THAT(mistakes_of(healthy + "[[expect]]\nwhat = \"no fix within 2 s of the outagee\"\n"),
                StartsWith("test.toml:6:8: expect.what: no fault or command is called 'outagee', and none is of that "
                           "kind; did you mean 'outage'?"));
    EXPECT_EQ(mistakes_of(healthy + "[[expect]]\nwhat = \"fix always\"\nreceiver = \"left\"\n"),
              "test.toml:7:12: expect.receiver: 'left' is no receiver of this scenario; expected one of receiver0");
}

}  // namespace
}  // namespace skyloop
