// Reports are read back as their readers do.
#include "run/verdict/reports.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <pugixml.hpp>

namespace skyloop {
namespace {

using testing::HasSubstr;

const ReportedRun run{
    "tunnel.toml", 42, GpsTime(std::chrono::seconds(1'393'675'218)), Seconds(60.5), {"port0.out", "fixes.csv"}};

std::vector<Verdict> one_of_each() {
    const GpsTime at = run.start + std::chrono::milliseconds(12'250);
    return {{"lost", "no fix within 2 s of the start of outage", Outcome::passed, "came true", at, Seconds(12.25)},
            {"a <b> & \"c\"", "fix always", Outcome::failed, "x\x01y\xFFz ]]> <&", at, Seconds(12.25)},
            {"late", "fix at 90 s", Outcome::undecided, "the run ended after 60.5 s", std::nullopt, Seconds(60.5)},
            {"probe", "command 'true' exits 0", Outcome::not_run, "needs the clock", std::nullopt, Seconds(60.5)}};
}

TEST(Verdicts, SayThatAllIsMetWhereAllWasJudged) {
    const std::vector<Verdict> all = one_of_each();
    EXPECT_EQ(all_met({}), true);
    EXPECT_EQ(all_met(std::vector{all[0]}), true);
    EXPECT_EQ(all_met(std::vector{all[0], all[1]}), false);
    EXPECT_EQ(all_met(std::vector{all[2], all[3]}), false);
    EXPECT_EQ(all_met(std::vector{all[0], all[3]}), std::nullopt);
    EXPECT_EQ(all_met(std::vector{all[3]}), std::nullopt);
}

TEST(Verdicts, MakeASuccessWhereSomethingPassedAndNothingDidNot) {
    const std::vector<Verdict> all = one_of_each();
    EXPECT_TRUE(is_success({}));
    EXPECT_TRUE(is_success(std::vector{all[0], all[3]}));
    EXPECT_FALSE(is_success(std::vector{all[0], all[1]}));
    EXPECT_FALSE(is_success(std::vector{all[0], all[2]}));
    EXPECT_FALSE(is_success(std::vector{all[3]})) << "nothing was judged";
}

TEST(Verdicts, OfProbesAloneThatWereNotRunAreToldPlainly) {
    const std::vector<Verdict> probe{one_of_each()[3]};
    EXPECT_THAT(verdict_text(probe, run), HasSubstr("0 of 1 expectations met in tunnel.toml (seed 42, 60.500 s), "
                                                    "1 not run: nothing was judged, so the run is no success\n"));
    EXPECT_TRUE(nlohmann::json::parse(verdict_json(probe, run))["met"].is_null());
    EXPECT_THAT(junit_xml(probe, run), HasSubstr("tests=\"1\" failures=\"0\" errors=\"0\" skipped=\"1\""));
}

TEST(VerdictText, SendsNoControlCharactersToATerminal) {
    const std::vector<Verdict> verdicts{
        {"red \x1b[31m\nline", "fix", Outcome::failed, "tab\t\xC2\x9B!", std::nullopt, {}},
        {"grün", "fix", Outcome::passed, "came true …", std::nullopt, {}}};
    const std::string text = verdict_text(verdicts, run);
    EXPECT_THAT(text, HasSubstr("FAILED     red \\u001b[31m\\nline: tab\\t\\u009b! (at 0.000 s)\n"));
    EXPECT_THAT(text, HasSubstr("PASSED     grün: came true … (at 0.000 s)\n"));
    EXPECT_EQ(text.find('\x1b'), text.npos);
}

TEST(VerdictText, HasALineForEachAndOneForAll) {
    const std::string text = verdict_text(one_of_each(), run);
    EXPECT_THAT(text, HasSubstr("PASSED     lost: came true (at 12.250 s)\n"));
    EXPECT_THAT(text, HasSubstr("NOT RUN    probe: needs the clock"));
    EXPECT_THAT(
        text,
        HasSubstr("1 of 4 expectations met in tunnel.toml (seed 42, 60.500 s), 1 failed, 1 undecided, 1 not run\n"));
}

TEST(VerdictJson, IsReadBack) {
    const auto report = nlohmann::json::parse(verdict_json(one_of_each(), run));
    EXPECT_EQ(report["scenario"], "tunnel.toml");
    EXPECT_EQ(report["seed"], 42);
    EXPECT_EQ(report["start_utc"], "2024-03-05T12:00:00.000Z");
    EXPECT_EQ(report["length_s"], 60.5);
    EXPECT_EQ(report["met"], false);
    EXPECT_EQ(report["evidence"][1], "fixes.csv");
    ASSERT_EQ(report["verdicts"].size(), 4);
    EXPECT_EQ(report["verdicts"][0]["outcome"], "passed");
    EXPECT_EQ(report["verdicts"][0]["run_time_s"], 12.25);
    EXPECT_EQ(report["verdicts"][0]["decided_at_utc"], "2024-03-05T12:00:12.250Z");
    EXPECT_EQ(report["verdicts"][0]["decided_at_gps_ns"], 1'393'675'230'250'000'000);
    EXPECT_FALSE(report["verdicts"][2].contains("decided_at_utc"));
}

TEST(JUnit, IsReadBack) {
    const std::string text = junit_xml(one_of_each(), run);
    pugi::xml_document document;
    const auto read = document.load_string(text.c_str());
    ASSERT_TRUE(read) << read.description();
    const auto suite = document.child("testsuites").child("testsuite");
    EXPECT_STREQ(suite.attribute("name").value(), "tunnel.toml");
    EXPECT_STREQ(suite.attribute("tests").value(), "4");
    EXPECT_STREQ(suite.attribute("failures").value(), "1");
    EXPECT_STREQ(suite.attribute("errors").value(), "1");
    EXPECT_STREQ(suite.attribute("skipped").value(), "1");
    EXPECT_STREQ(suite.attribute("time").value(), "60.500");
    EXPECT_STREQ(suite.attribute("timestamp").value(), "2024-03-05T12:00:00");
    EXPECT_STREQ(suite.child("properties").first_child().attribute("value").value(), "42");
    std::vector<pugi::xml_node> cases;
    for (const auto& node : suite.children("testcase"))
        cases.push_back(node);
    ASSERT_EQ(cases.size(), 4);
    EXPECT_STREQ(cases[0].attribute("name").value(), "lost");
    EXPECT_STREQ(cases[0].attribute("time").value(), "12.250");
    EXPECT_FALSE(cases[0].child("failure"));
    EXPECT_STREQ(cases[1].attribute("name").value(), "a <b> & \"c\"");
    EXPECT_STREQ(cases[1].child("failure").attribute("message").value(), "x\uFFFDy\uFFFDz ]]> <&");
    EXPECT_THAT(cases[1].child("failure").text().get(), HasSubstr("evidence: port0.out fixes.csv"));
    EXPECT_TRUE(cases[2].child("error"));
    EXPECT_STREQ(cases[3].child("skipped").attribute("message").value(), "needs the clock");
}

TEST(JUnit, HasOnlyCharactersThatXmlHas) {
    std::string name;
    for (int byte = 1; byte < 256; ++byte)
        name += static_cast<char>(byte);
    name += "\xED\xA0\x80 \xEF\xBF\xBF \xC0\x80 \xF5\x80\x80\x80 \xE2\x82";  // surrogate, noncharacter, overlong, too
                                                                             // large, cut
    const Verdict verdict{name, name, Outcome::failed, name, std::nullopt, Seconds(1)};
    const std::string text = junit_xml(std::vector{verdict}, run);
    for (const char c : text)
        EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') << static_cast<int>(c);
    EXPECT_THAT(text, HasSubstr("\uFFFD"));
    EXPECT_EQ(text.find("\xED\xA0\x80"), std::string::npos);
    EXPECT_EQ(text.find("\xEF\xBF\xBF"), std::string::npos);
    EXPECT_EQ(text.find("\xC0\x80"), std::string::npos);
}

}  // namespace
}  // namespace skyloop
