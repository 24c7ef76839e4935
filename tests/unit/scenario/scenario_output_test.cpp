// [[output]]: where, whom and how.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario_text.hpp"

namespace skyloop {
namespace {

using test::mistakes_of;
using test::scenario_of;
using testing::HasSubstr;
using testing::StartsWith;

TEST(ScenarioOutput, IsRead) {
    const auto outputs = scenario_of(test::every_key_text).outputs;
    ASSERT_EQ(outputs.size(), 1U);
    const OutputSettings& output = outputs.front();
    EXPECT_EQ(output.uri, "hil-gps:127.0.0.1:14560");
    EXPECT_EQ(output.format, OutputFormat::hil_gps);
    EXPECT_EQ(output.receiver, "rear");
    EXPECT_EQ(output.when, OutputMoment::epoch);
    EXPECT_EQ(output.system, 2);
    EXPECT_EQ(output.component, 3);
    EXPECT_EQ(output.id, 4);
    EXPECT_EQ(output.eph, HilGpsAccuracy::dop100);
}

TEST(ScenarioOutput, KeysStandBesideThoseOfTheTarget) {
    const auto outputs = scenario_of(R"toml(
[[output]]
to = "json-tcp:9000"
[[output]]
to = "gps-input:h:1,id=1,system=9"
system = 8
)toml")
                             .outputs;
    ASSERT_EQ(outputs.size(), 2U);
    EXPECT_EQ(outputs[0].when, OutputMoment::epoch);
    EXPECT_EQ(outputs[1].when, OutputMoment::report);
    EXPECT_EQ(outputs[1].id, 1);
    EXPECT_EQ(outputs[1].system, 8);
}

TEST(ScenarioOutput, MistakesAreToldWithTheirPlace) {
    EXPECT_THAT(mistakes_of("[[output]]\nto = \"gps-inptu:h:1\"\n"),
                StartsWith("test.toml:2:6: output.to: output 'gps-inptu:h:1': 'gps-inptu' is no output"));
    EXPECT_THAT(mistakes_of("[[output]]\nid = 1\n"), HasSubstr("says nowhere; expected to ="));
    EXPECT_THAT(mistakes_of("[[output]]\nto = \"json-tcp:1\"\nreceiver = \"left\"\n"),
                StartsWith("test.toml:3:12: output.receiver: 'left' is no receiver of this scenario; expected one of "
                           "receiver0"));
    EXPECT_THAT(mistakes_of("[[output]]\nto = \"json-tcp:1,receiver=left\"\n"), HasSubstr("'left' is no receiver"));
    EXPECT_THAT(mistakes_of("[[output]]\nto = \"json-tcp:1\"\nid = 256\n"), HasSubstr("test.toml:3:6"));
    EXPECT_THAT(mistakes_of("[[output]]\nto = \"json-tcp:1\"\nsystem = 0\n"), HasSubstr("test.toml:3:10"));
    EXPECT_THAT(mistakes_of("[[output]]\nto = \"json-tcp:1\"\nwehn = \"epoch\"\n"), HasSubstr("did you mean 'when'?"));
    EXPECT_THAT(mistakes_of("[[output]]\nto = \"gps-input:h:1\"\neph = \"dop100\"\n"),
                StartsWith("test.toml:3:7: output.eph: 'eph' is an option of hil-gps; gps-input does not have it"));
    EXPECT_THAT(mistakes_of("[[output]]\nto = 5\n"), HasSubstr("test.toml:2:6"));
}

}  // namespace
}  // namespace skyloop
