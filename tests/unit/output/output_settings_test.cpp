// What a user may type after --output, and what is said of all else.
#include "run/output/output_settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/core/random.hpp"

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

OutputSettings settings_of(std::string_view uri) {
    const auto parsed = parse_output_uri(uri);
    EXPECT_TRUE(parsed) << parsed.error().message;
    return parsed ? *parsed : OutputSettings{};
}

std::string refusal_of_output(std::string_view uri) {
    const auto parsed = parse_output_uri(uri);
    if (parsed) return "taken";
    EXPECT_EQ(parsed.error().code, ErrorCode::usage);
    return parsed.error().message;
}

TEST(OutputSettings, NameFormatWayAndTarget) {
    const OutputSettings input = settings_of("gps-input:127.0.0.1:14550");
    EXPECT_EQ(input.format, OutputFormat::gps_input);
    EXPECT_EQ(input.way, OutputWay::udp);
    EXPECT_EQ(input.address.host, "127.0.0.1");
    EXPECT_EQ(input.address.port, 14550);
    EXPECT_EQ(input.when, OutputMoment::report);
    EXPECT_EQ(input.system, 1);
    EXPECT_EQ(input.component, 220);
    EXPECT_EQ(input.uri, "gps-input:127.0.0.1:14550");
    EXPECT_EQ(settings_of("hil-gps:[::1]:14560").address.host, "::1");
    EXPECT_EQ(settings_of("gps-input-tcp-to:sitl:5762").way, OutputWay::tcp_client);
    const OutputSettings msp = settings_of("msp-tcp:5761");
    EXPECT_EQ(msp.way, OutputWay::tcp_server);
    EXPECT_EQ(msp.address.host, "127.0.0.1");
    EXPECT_EQ(settings_of("msp-tcp:0.0.0.0:0").address.host, "0.0.0.0");
    const OutputSettings lines = settings_of("json-udp:localhost:9000");
    EXPECT_EQ(lines.format, OutputFormat::json);
    EXPECT_EQ(lines.when, OutputMoment::epoch);
    EXPECT_EQ(settings_of("json-file:-").path, "-");
}

TEST(OutputSettings, OptionsFollowBehindCommas) {
    const OutputSettings all =
        settings_of("hil-gps:h:1,receiver=rear,when=epoch,system=255,component=1,id=7,eph=dop100");
    EXPECT_EQ(all.uri, "hil-gps:h:1");
    EXPECT_EQ(all.receiver, "rear");
    EXPECT_EQ(all.when, OutputMoment::epoch);
    EXPECT_EQ(all.system, 255);
    EXPECT_EQ(all.component, 1);
    EXPECT_EQ(all.id, 7);
    EXPECT_EQ(all.eph, HilGpsAccuracy::dop100);
    const OutputSettings rtcm = settings_of("rtcm-tcp:2101,station=4095,msm=4,every_s=1,ephemerides_s=0");
    EXPECT_EQ(rtcm.format, OutputFormat::rtcm);
    EXPECT_EQ(rtcm.station, 4095);
    EXPECT_EQ(rtcm.msm, 4);
    EXPECT_EQ(rtcm.every_s, 1);
    EXPECT_EQ(rtcm.ephemerides_s, 0);
    // A comma may be of a file's name.
    const OutputSettings file = settings_of("json-file:runs/a,b=c,when=report");
    EXPECT_EQ(file.path, "runs/a,b=c");
    EXPECT_EQ(file.when, OutputMoment::report);
}

TEST(OutputSettings, WhatIsNoOutputIsRefusedWithItsReason) {
    EXPECT_THAT(refusal_of_output(""), HasSubstr("is no output; expected gps-input:HOST:PORT"));
    EXPECT_THAT(refusal_of_output("gps-inptu:h:1"), HasSubstr("'gps-inptu' is no output"));
    EXPECT_THAT(refusal_of_output("msp:h:1"), HasSubstr("'msp' is no output"));
    EXPECT_THAT(refusal_of_output("json-tcp-from:1"), HasSubstr("'json-tcp-from' is no output"));
    EXPECT_THAT(refusal_of_output("json"), HasSubstr("is no output"));
    EXPECT_THAT(refusal_of_output("gps-input:14550"), HasSubstr("the host is missing"));
    EXPECT_THAT(refusal_of_output("gps-input:h:0"), HasSubstr("port 0 cannot be sent to"));
    EXPECT_THAT(refusal_of_output("gps-input:h:65536"), HasSubstr("a port from 0 to 65535"));
    EXPECT_THAT(refusal_of_output("json-tcp:::1:5"), HasSubstr("the host is not understood"));
    EXPECT_THAT(refusal_of_output("json-file:"), HasSubstr("the path is missing"));
    EXPECT_THAT(refusal_of_output("gps-input:h:1,sytem=3"), HasSubstr("did you mean 'system'?"));
    EXPECT_THAT(refusal_of_output("gps-input:h:1,system=0"), HasSubstr("system '0': expected a whole number from 1"));
    EXPECT_THAT(refusal_of_output("rtcm:h:1"), HasSubstr("'rtcm' is no output"));
    EXPECT_THAT(refusal_of_output("rtcm-tcp:1,msm=3"), HasSubstr("msm '3': expected a whole number from 4 to 7"));
    EXPECT_THAT(refusal_of_output("rtcm-tcp:1,station=4096"), HasSubstr("expected a whole number from 0 to 4095"));
    EXPECT_THAT(refusal_of_output("rtcm-tcp:1,every_s=0"), HasSubstr("expected a whole number from 1 to 3600"));
    EXPECT_THAT(refusal_of_output("rtcm-tcp:1,ephemerides_s=3601"), HasSubstr("from 0 to 3600"));
    EXPECT_THAT(refusal_of_output("json-tcp:1,station=1"), HasSubstr("'station' is an option of rtcm; json does not"));
    EXPECT_THAT(refusal_of_output("gps-input:h:1,id=256"), HasSubstr("id '256'"));
    EXPECT_THAT(refusal_of_output("gps-input:h:1,id=1.5"), HasSubstr("id '1.5'"));
    EXPECT_THAT(refusal_of_output("gps-input:h:1,id="), HasSubstr("id ''"));
    EXPECT_THAT(refusal_of_output("gps-input:h:1,later"), HasSubstr("'later': expected KEY=VALUE"));
    EXPECT_THAT(refusal_of_output("gps-input:h:1,when=epoh"), HasSubstr("did you mean 'epoch'?"));
    EXPECT_THAT(refusal_of_output("gps-input:h:1,receiver="), HasSubstr("receiver is empty"));
}

TEST(OutputSettings, AnOptionThatWouldDoNothingIsRefused) {
    EXPECT_THAT(refusal_of_output("json-file:o.json,id=3"),
                HasSubstr("'id' is an option of gps-input, hil-gps, msp; json does not have it"));
    for (const char* uri : {"json-tcp:1,eph=dop100", "json-tcp:1,system=9", "json-tcp:1,component=7",
                            "msp-tcp:1,system=9", "msp-tcp:1,eph=dop100", "gps-input:h:1,eph=dop100"})
        EXPECT_THAT(refusal_of_output(uri), HasSubstr("does not have it")) << uri;
    EXPECT_THAT(refusal_of_output("gps-input:h:1,id=1,when=epoch,id=2"), HasSubstr("'id' is there twice"));
    EXPECT_THAT(refusal_of_output("json-file:a,receiver=x,receiver=x"), HasSubstr("'receiver' is there twice"));
}

// Cut, changed and lengthened at random: a sentence or settings, and never more.
TEST(OutputSettings, AnyTextIsUnderstoodOrRefused) {
    RandomStream random(3, "output uris");
    int taken = 0, refused = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string text = "hil-gps:[::1]:14560,receiver=rear,when=epoch,system=255,id=7,eph=dop100";
        for (std::uint64_t changes = random.bits() % 4; changes > 0; --changes)
            text.at(random.bits() % text.size()) = static_cast<char>(random.bits() % 256);
        if (random.bits() % 3 == 0) text.resize(random.bits() % text.size());
        const auto settings = parse_output_uri(text);
        (settings ? taken : refused) += 1;
        if (!settings) {
            ASSERT_FALSE(settings.error().message.empty());
        }
    }
    EXPECT_GT(taken, 1000);
    EXPECT_GT(refused, 1000);
}

TEST(OutputSettings, ChooseWhomTheyTell) {
    const std::vector<std::string> names{"front", "rear"};
    EXPECT_THAT(*told_receivers(settings_of("msp-tcp:1"), names), ElementsAre(true, false));
    EXPECT_THAT(*told_receivers(settings_of("json-tcp:1"), names), ElementsAre(true, true));
    EXPECT_THAT(*told_receivers(settings_of("json-tcp:1,receiver=rear"), names), ElementsAre(false, true));
    const auto none = told_receivers(settings_of("json-tcp:1,receiver=left"), names);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::usage);
    EXPECT_THAT(none.error().message, HasSubstr("'left' is no receiver of this scenario; expected one of front, rear"));
}

}  // namespace
}  // namespace skyloop
