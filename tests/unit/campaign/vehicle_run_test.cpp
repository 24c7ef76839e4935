#include "campaigns/campaign/detail/vehicle_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skyloop {
namespace {

using testing::HasSubstr;

Result<Verdict> verdict_of(const std::string& script) {
    ProcessRequest request;
    request.command = {"/bin/sh", "-c", script};
    return vehicle_verdict(run_process(request).value(), Seconds(10));
}
std::string evidence_of(const std::string& script) { return verdict_of(script).value().evidence; }

TEST(VehicleRun, OneThatFailsIsQuotedWithItsLastLine) {
    EXPECT_EQ(evidence_of("echo one >&2; printf 'no \\033 home\\n\\n' >&2; exit 7"),
              "ended with exit code 7: no   home");
    EXPECT_EQ(evidence_of("exit 7"), "ended with exit code 7");
    EXPECT_EQ(evidence_of("echo fine >&2"), "ended with exit code 0");
    EXPECT_EQ(evidence_of("exit 125"), "ended with exit code 125");
}

TEST(VehicleRun, OneThatIsNotThereHasNoVerdict) {
    for (const auto& [script, code] : {std::pair{"nosuchprogram", "127"}, {"/", "126"}}) {
        const auto none = verdict_of(script);
        ASSERT_FALSE(none) << script;
        EXPECT_EQ(none.error().code, ErrorCode::outside);
        EXPECT_THAT(none.error().message,
                    HasSubstr(std::string("vehicle: was not run: it ended with exit code ") + code + ": "));
        EXPECT_THAT(none.error().message, HasSubstr(script));
    }
}

}  // namespace
}  // namespace skyloop
