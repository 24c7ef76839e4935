#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <string_view>

#include "base/core/files.hpp"
#include "base/geo/local_frame.hpp"
#include "feed_asides.hpp"
#include "run/feed/feed_dialect.hpp"

namespace skyloop {
namespace {

using ::testing::HasSubstr;

struct JsonTalk {
    explicit JsonTalk(bool datagrams = false) {
        FeedContext context;
        context.datagrams = datagrams;
        dialect = make_dialect("json", context);
    }
    FeedNews say(std::string_view text) { return dialect->hear(to_bytes(text), now_ns += 10'000'000); }
    std::unique_ptr<FeedDialect> dialect;
    std::int64_t now_ns = 0;
};

// What a truth line gives, with `members` beside a place.
TruthSample json_truth(const std::string& members) {
    JsonTalk talk;
    const FeedNews news = talk.say(R"({"lla":[48,11,500],"h_ref":"ell",)" + members + "}\n");
    EXPECT_EQ(news.refusal, "");
    EXPECT_EQ(news.samples.size(), 1u) << members;
    return news.samples.empty() ? TruthSample() : news.samples[0];
}

const LocalFrame munich(Geodetic::degrees(48, 11, 500));

Eigen::Vector3d velocity_enu(const TruthSample& sample) { return munich.to_enu(*sample.velocity).vector(); }

TEST(JsonDialect, ReadsTheExampleOfItsDescription) {
    JsonTalk talk;
    const FeedNews news =
        talk.say(R"({"type":"truth","v":1,"t":12.345678,"lla":[47.3977420,8.5455940,488.123],"h_ref":"msl",)"
                 R"("vel_ned":[3.2,-0.1,0.02],"q":[0.99,0.01,0.02,0.13],"seq":617})"
                 "\n");
    ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
    const TruthSample& sample = news.samples[0];
    EXPECT_EQ(sample.vehicle, "0");
    EXPECT_EQ(sample.source_time, Nanoseconds(12'345'678'000));
    EXPECT_EQ(sample.received_ns, 10'000'000);
    const Geodetic place = to_geodetic(sample.position);
    EXPECT_NEAR(place.latitude.deg(), 47.3977420, 1e-9);
    EXPECT_NEAR(place.longitude.deg(), 8.5455940, 1e-9);
    EXPECT_NEAR(place.height.above_ellipsoid.value(), 488.123, 1e-6);  // no geoid in this context
    EXPECT_NEAR(sample.attitude->yaw().deg(), 15, 1);
    EXPECT_FALSE(sample.jump);
}

TEST(JsonDialect, TurnsEveryFrameOfVelocity) {
    // North 3, east 4, climbing 1.
    const Eigen::Vector3d expected(4, 3, 1);
    EXPECT_TRUE(velocity_enu(json_truth(R"("vel_ned":[3,4,-1])")).isApprox(expected, 1e-9));
    EXPECT_TRUE(velocity_enu(json_truth(R"("vel_enu":[4,3,1])")).isApprox(expected, 1e-9));
    // Looking east: forward is east, right is south.
    EXPECT_TRUE(velocity_enu(json_truth(R"("vel_frd":[4,-3,-1],"rpy_deg":[0,0,90])")).isApprox(expected, 1e-9));
    EXPECT_TRUE(velocity_enu(json_truth(R"("vel_frd":[4,-3,-1],"q":[0.735,0,0,0.735])")).isApprox(expected, 1e-9))
        << "a quaternion that is 4 % too long turns and does not stretch";
    EXPECT_TRUE(json_truth(R"("vel_ecef":[1,2,3])").velocity->vector().isApprox(Eigen::Vector3d(1, 2, 3)));
    EXPECT_TRUE(munich.to_enu(Displacement<Ecef>(*json_truth(R"("acc_ned":[0,0,-2])").acceleration))
                    .vector()
                    .isApprox(Eigen::Vector3d(0, 0, 2), 1e-9));
}

TEST(JsonDialect, TurnsEveryFormOfAttitude) {
    // A right bank of 20°, nose up 10°, heading north-east.
    const auto check = [](const TruthSample& sample) {
        EXPECT_NEAR(sample.attitude->roll().deg(), 20, 1e-3);
        EXPECT_NEAR(sample.attitude->pitch().deg(), 10, 1e-3);
        EXPECT_NEAR(sample.attitude->yaw().deg(), 45, 1e-3);
    };
    check(json_truth(R"("rpy_deg":[20,10,45])"));
    check(json_truth(R"("q":[0.9121732,0.1269732,0.1454975,0.3614531])"));
    // Of a robot with x forward, y left, z up in east, north, up: yaw 45° from east, nose up is negative pitch.
    check(json_truth(R"("q_flu_enu":[0.9005898,0.1926659,-0.0130987,0.3894179])"));
    const TruthSample turning = json_truth(R"("rate_frd":[0.1,0.2,0.3])");
    EXPECT_TRUE(turning.turn_rate->isApprox(Eigen::Vector3d(0.1, 0.2, 0.3)));
}

TEST(JsonDialect, CountsMetresFromItsOrigin) {
    JsonTalk talk;
    EXPECT_THAT(talk.say("{\"ned\":[1,2,3]}\n").refusal, HasSubstr("origin"));
    EXPECT_EQ(talk.say("{\"type\":\"origin\",\"lla\":[48,11,500],\"h_ref\":\"ell\"}\n").refused, 0u);
    for (const char* line :
         {"{\"ned\":[100,200,-30],\"vel_ned\":[1,2,3]}\n", "{\"enu\":[200,100,30],\"vel_enu\":[2,1,-3]}\n"}) {
        const FeedNews news = talk.say(line);
        ASSERT_EQ(news.samples.size(), 1u);
        EXPECT_TRUE(munich.to_enu(news.samples[0].position).vector().isApprox(Eigen::Vector3d(200, 100, 30), 1e-9));
        EXPECT_TRUE(velocity_enu(news.samples[0]).isApprox(Eigen::Vector3d(2, 1, -3), 1e-9));
    }
}

TEST(JsonDialect, KeepsNanosecondsOfTimesAsTextsAndWholeNumbers) {
    EXPECT_EQ(json_truth(R"("t_ns":1795222620123456789)").source_time, Nanoseconds(1795222620123456789));
    EXPECT_EQ(json_truth(R"("t_ns":"1795222620123456789")").source_time, Nanoseconds(1795222620123456789));
    EXPECT_EQ(json_truth(R"("t":"12.5")").source_time, Nanoseconds(12'500'000'000));
    EXPECT_EQ(json_truth(R"("t":-1)").source_time, Nanoseconds(-1'000'000'000));
    EXPECT_FALSE(json_truth(R"("t":null)").source_time);
}

TEST(JsonDialect, CountsGapsAndResetsOfEachVehicle) {
    JsonTalk talk;
    const auto line = [](const char* id, int sequence, int reset) {
        return "{\"ecef\":[4177000,854000,4728000],\"id\":\"" + std::string(id) +
               "\",\"seq\":" + std::to_string(sequence) + ",\"reset\":" + std::to_string(reset) + "}\n";
    };
    const FeedNews news = talk.say(line("a", 1, 0) + line("b", 50, 7) + line("a", 2, 0) + line("a", 5, 1) +
                                   line("b", 51, 7) + line("a", 4, 1) + line("a", 6, 1));
    ASSERT_EQ(news.samples.size(), 7u) << news.refusal;
    EXPECT_EQ(news.lost, 2u);
    for (std::size_t i = 0; i < 7; ++i)
        EXPECT_EQ(news.samples[i].jump, i == 3) << i;
    EXPECT_EQ(news.samples[1].vehicle, "b");
}

TEST(JsonDialect, JoinsThePiecesOfAStream) {
    JsonTalk stream, datagrams(true);
    const std::string line = "{\"lla\":[48,11,500],\"h_ref\":\"ell\"}";
    std::size_t samples = 0;
    for (const char c : line + "\r\n\n" + line + "\n" + line)
        samples += stream.say(std::string(1, c)).samples.size();
    EXPECT_EQ(samples, 2u);
    stream.dialect->reconnected();
    EXPECT_EQ(stream.say(line + "\n").samples.size(), 1u);
    EXPECT_EQ(datagrams.say(line + "\n" + line).samples.size(), 2u);
    EXPECT_EQ(datagrams.say(line.substr(0, 10)).refused, 1u);
    EXPECT_EQ(datagrams.say(line).samples.size(), 1u) << "the next one is whole again";
}

TEST(JsonDialect, APauseEndsWithASourceThatWasStartedAnew) {
    JsonTalk talk;
    const std::string pause = "{\"type\":\"clock\",\"paused\":true}\n";
    const auto truth = [](const char* t) { return std::string("{\"lla\":[48,11,500],\"h_ref\":\"ell\"") + t + "}\n"; };
    EXPECT_EQ(pause_told(talk.say(truth(",\"t\":1") + pause)), true);
    EXPECT_FALSE(pause_told(talk.say(truth(",\"t\":1.02") + truth(",\"t\":1.02") + truth("")))) << "it stands";
    const FeedNews again = talk.say(truth(",\"t\":0.02"));
    EXPECT_EQ(pause_told(again), false);
    EXPECT_EQ(again.asides[0].samples, 0u) << "ahead of the sample";
    EXPECT_FALSE(pause_told(talk.say(truth(",\"t\":0.04")))) << "told once";
    EXPECT_EQ(pause_told(talk.say(pause)), true);
    EXPECT_EQ(pause_told(talk.say("{\"type\":\"hello\"}\n")), false);
}

TEST(JsonDialect, StepsPausesEndsAndAnswers) {
    JsonTalk talk;
    const std::string truth = "{\"lla\":[48,11,500],\"h_ref\":\"ell\",\"t\":1}\n";
    const FeedNews news = talk.say(truth + "{\"type\":\"step\",\"t\":1.02}\n" + truth + truth +
                                   "{\"type\":\"step\",\"t_ns\":1040000000}\n{\"type\":\"clock\",\"paused\":true}\n");
    EXPECT_EQ(news.others, 3u);
    ASSERT_EQ(news.asides.size(), 3u);
    const auto steps = asides_of<FeedMilestone>(news);
    ASSERT_EQ(steps.size(), 2u);
    EXPECT_EQ(steps[0].until, Nanoseconds(1'020'000'000));
    EXPECT_EQ(news.asides[0].samples, 1u);
    EXPECT_EQ(news.asides[1].samples, 3u);
    EXPECT_EQ(pause_told(news), true);
    EXPECT_EQ(pause_told(talk.say("{\"type\":\"clock\",\"t\":3,\"paused\":false}\n")), false);
    EXPECT_EQ(asides_of<FeedEnd>(talk.say("{\"type\":\"bye\"}\n")).size(), 1u);
    const auto hello = talk.say("{\"type\":\"hello\"}\n");
    ASSERT_EQ(hello.answers.size(), 1u);
    EXPECT_THAT(to_string(hello.answers[0]), HasSubstr("\"type\":\"hello\""));
    const auto stepped = talk.dialect->stepped(Nanoseconds(1'020'000'000), 188);
    ASSERT_EQ(stepped.size(), 1u);
    EXPECT_EQ(to_string(stepped[0]), "{\"bytes\":188,\"t\":1.02,\"t_ns\":1020000000,\"type\":\"stepped\"}\n");
    EXPECT_THAT(talk.say("{\"type\":\"vis\",\"sv\":[]}\n").remark, HasSubstr("vis"));
    EXPECT_EQ(talk.say("{\"type\":\"vis\",\"sv\":[]}\n{\"type\":\"future\"}\n").remark, "");
}

TEST(JsonDialect, AsksForFaultsAndCommands) {
    JsonTalk talk;
    const FeedNews fault = talk.say(
        "{\"type\":\"event\",\"t\":30,\"name\":\"byte_loss\",\"args\":{\"probability\":0.5,\"for_s\":10,\"name\":"
        "\"plug\"}}"
        "\n");
    const auto begun = asides_of<Command>(fault);
    ASSERT_EQ(begun.size(), 1u) << fault.refusal;
    EXPECT_EQ(begun[0].verb, CommandVerb::start_fault);
    EXPECT_EQ(begun[0].source, "feed");
    EXPECT_EQ(begun[0].parameters.text("name"), "plug");
    EXPECT_EQ(begun[0].parameters.number("for_s"), 10);
    EXPECT_THAT(fault.remark, HasSubstr("act when they come"));
    EXPECT_EQ(talk.say("{\"type\":\"event\",\"t\":31,\"name\":\"pause\"}\n").remark, "") << "it is told once";
    EXPECT_EQ(JsonTalk().say("{\"type\":\"event\",\"name\":\"pause\"}\n").remark, "");
    const FeedNews both = JsonTalk().say("{\"type\":\"vis\"}\n{\"type\":\"event\",\"t\":3,\"name\":\"pause\"}\n");
    EXPECT_THAT(both.remark, testing::AllOf(HasSubstr("'vis'"), HasSubstr("act when they come")));
    const FeedNews pause = talk.say("{\"type\":\"event\",\"name\":\"pause\"}\n");
    const auto paused = asides_of<Command>(pause);
    ASSERT_EQ(paused.size(), 1u) << pause.refusal;
    EXPECT_EQ(paused[0].verb, CommandVerb::pause);
    for (const char* bad : {R"({"type":"event"})", R"({"type":"event","name":"byte_los"})",
                            R"({"type":"event","name":"byte_loss","args":{"probability":7}})",
                            R"({"type":"event","name":"byte_loss","args":[1]})",
                            R"({"type":"event","name":"byte_loss","args":{"probability":{"a":1}}})",
                            R"({"type":"event","name":"note","args":{"text":"a\nb"}})"}) {
        const FeedNews news = talk.say(std::string(bad) + "\n");
        EXPECT_EQ(news.asides.size(), 0u) << bad;
        EXPECT_EQ(news.refused, 1u) << bad;
    }
    EXPECT_THAT(talk.say("{\"type\":\"event\",\"name\":\"pauze\"}\n").refusal, HasSubstr("did you mean 'pause'"));
}

TEST(JsonDialect, RefusesInOneLineThatNamesTheKey) {
    const std::pair<const char*, const char*> cases[] = {
        {"nonsense", "no JSON"},
        {"[1,2]", "no JSON object"},
        {"{}", "no position"},
        {R"({"lla":[48,11,500]})", "'h_ref' is missing"},
        {R"({"lla":[48,11,500],"h_ref":"sea"})", "'h_ref' is 'sea'"},
        {R"({"lla":[91,11,500],"h_ref":"ell"})", "latitude"},
        {R"({"lla":[48,11],"h_ref":"ell"})", "3 numbers"},
        {R"({"lla":[48,"11",500],"h_ref":"ell"})", "3 numbers"},
        {R"({"lla":[48,11,1e999],"h_ref":"ell"})", "no JSON"},
        {R"({"lla":[48,11,NaN],"h_ref":"ell"})", "no JSON"},
        {R"({"lla":[48,11,500],"h_ref":"ell","ecef":[1,2,3]})", "both 'lla' and 'ecef'"},
        {R"({"ecef":[0,0,0]})", "centre"},
        {R"({"ecef":[1e200,0,0]})", "farther"},
        {R"({"v":2,"ecef":[4177000,854000,4728000]})", "'v' is 2"},
        {R"({"t":1,"t_ns":1,"ecef":[4177000,854000,4728000]})", "both 't' and 't_ns'"},
        {R"({"t":"soon","ecef":[4177000,854000,4728000]})", "'t' is"},
        {R"({"t":1e15,"ecef":[4177000,854000,4728000]})", "'t' is"},
        {R"({"t_ns":1.5,"ecef":[4177000,854000,4728000]})", "'t_ns' is"},
        {R"({"t_ns":9000000000000000000,"ecef":[4177000,854000,4728000]})", "'t_ns' is"},
        {R"({"q":[2,0,0,0],"ecef":[4177000,854000,4728000]})", "'q' has the length"},
        {R"({"vel_frd":[1,0,0],"ecef":[4177000,854000,4728000]})", "'vel_frd'"},
        {R"({"lla":[0,0,0],"h_ref":"ell"})", "cannot be: the place is at latitude and longitude 0"},
        {R"({"vel_ned":[20000,0,0],"lla":[48,11,500],"h_ref":"ell"})", "cannot be: the speed is 20000 m/s"},
        {R"({"id":"","ecef":[4177000,854000,4728000]})", "'id'"},
        {R"({"id":{},"ecef":[4177000,854000,4728000]})", "'id'"},
        {R"({"seq":1.5,"ecef":[4177000,854000,4728000]})", "'seq'"},
        {R"({"type":7})", "'type'"},
        {R"({"type":"step"})", "'t'"},
        {R"({"type":"clock","paused":1})", "'paused'"},
    };
    for (const auto& [line, what] : cases) {
        JsonTalk talk;
        const FeedNews news = talk.say(std::string(line) + "\n");
        EXPECT_EQ(news.refused, 1u) << line;
        EXPECT_EQ(news.samples.size(), 0u) << line;
        EXPECT_THAT(news.refusal, HasSubstr(what)) << line;
        EXPECT_EQ(news.refusal.find('\n'), std::string::npos) << line;
        ASSERT_EQ(news.answers.size(), 1u) << line;
        EXPECT_THAT(to_string(news.answers[0]), HasSubstr("\"type\":\"error\"")) << line;
    }
}

TEST(JsonDialect, ReadsTheLinesOfItsDocument) {
    const auto document = read_text_file(SKYLOOP_SOURCE_DIR "/docs/feeds.md");
    ASSERT_TRUE(document);
    const std::size_t begin = document->find("```json\n") + 8, end = document->find("```", begin);
    ASSERT_NE(end, std::string::npos);
    JsonTalk talk;
    const FeedNews news = talk.say(document->substr(begin, end - begin));
    EXPECT_EQ(news.refused, 0u) << news.refusal;
    EXPECT_EQ(news.samples.size(), 2u);
    EXPECT_EQ(asides_of<Command>(news).size(), 1u);
    EXPECT_EQ(asides_of<FeedMilestone>(news).size(), 1u);
    EXPECT_EQ(asides_of<FeedEnd>(news).size(), 1u);
    EXPECT_EQ(pause_told(news), true);
}

TEST(JsonDialect, AnswersOneRefusalASecond) {
    JsonTalk talk;
    std::size_t answers = 0;
    for (int i = 0; i < 350; ++i)  // 10 ms apart
        answers += talk.say("what\nis\nthis\n").answers.size();
    EXPECT_EQ(answers, 4u);
}

TEST(JsonDialect, BoundsLinesAndDepth) {
    JsonTalk talk;
    EXPECT_EQ(talk.say(std::string(70000, ' ')).refused, 0u);
    EXPECT_THAT(talk.say("{}\n").refusal, HasSubstr("longer than"));
    EXPECT_THAT(talk.say(std::string(60000, '[') + "\n").refusal, HasSubstr("deeper"));
    std::string deep = "{\"a\":";
    for (int i = 0; i < 30; ++i)
        deep += "{\"a\":";
    EXPECT_THAT(talk.say(deep + "\n").refusal, HasSubstr("deeper"));
}

TEST(JsonDialect, SurvivesCutsAndMutations) {
    const std::string whole =
        R"({"type":"truth","v":1,"t":12.345678,"id":"a","lla":[47.3977420,8.5455940,488.123],"h_ref":"msl",)"
        R"("vel_frd":[3.2,-0.1,0.02],"q":[0.99,0.01,0.02,0.13],"seq":617,"reset":1})"
        "\n{\"type\":\"event\",\"name\":\"byte_loss\",\"args\":{\"probability\":0.5}}\n{\"type\":\"step\",\"t_ns\":"
        "\"77\"}\n";
    std::mt19937 random(14);
    JsonTalk stream, datagrams(true);
    for (int i = 0; i < 5000; ++i) {
        std::string text = whole;
        for (auto changes = random() % 4; changes > 0; --changes)
            text[random() % text.size()] = static_cast<char>(random());
        if (random() % 3 == 0) text.resize(random() % text.size());
        for (JsonTalk* talk : {&stream, &datagrams}) {
            const FeedNews news = talk->say(text);
            for (const TruthSample& sample : news.samples)
                ASSERT_TRUE(sample.position.vector().allFinite());
            ASSERT_EQ(news.refusal.find('\n'), std::string::npos);
        }
    }
}

}  // namespace
}  // namespace skyloop
