#include "../../../src/campaign/vehicle_run.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

std::string evidence_of(const std::string& script) {
    ProcessRequest request;
    request.command = {"/bin/sh", "-c", script};
    return vehicle_verdict(run_process(request).value(), Seconds(10)).evidence;
}

TEST(VehicleRun, OneThatFailsIsQuotedWithItsLastLine) {
    EXPECT_EQ(evidence_of("echo one >&2; printf 'no \\033 home\\n\\n' >&2; exit 7"),
              "ended with exit code 7: no   home");
    EXPECT_EQ(evidence_of("exit 7"), "ended with exit code 7");
    EXPECT_EQ(evidence_of("echo fine >&2"), "ended with exit code 0");
    EXPECT_NE(evidence_of("nosuchprogram").find("exit code 127: "), std::string::npos);
    EXPECT_NE(evidence_of("nosuchprogram").find("nosuchprogram"), std::string::npos);
}

}  // namespace
}  // namespace skyloop
