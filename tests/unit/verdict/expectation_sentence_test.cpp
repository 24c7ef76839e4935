// The grammar of [[expect]]: every form, and what is said of a wrong one.
#include "run/verdict/expectation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skyloop {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

ExpectedSentence understood(std::string_view text) {
    const auto sentence = parse_expectation(text);
    EXPECT_TRUE(sentence) << text << ": " << sentence.error().sentence;
    return sentence ? *sentence : ExpectedSentence{};
}

std::string in_full(std::string_view text) { return expectation_text(understood(text)); }

// "COLUMN: SENTENCE", or "understood".
std::string mistake_in(std::string_view text) {
    const auto sentence = parse_expectation(text);
    return sentence ? "understood" : std::to_string(sentence.error().column) + ": " + sentence.error().sentence;
}

struct Form {
    std::string_view written, in_full;
};

class ExpectationForms : public testing::TestWithParam<Form> {};

TEST_P(ExpectationForms, AreUnderstoodAndReadBackAsTheSame) {
    const std::string text = in_full(GetParam().written);
    EXPECT_EQ(text, GetParam().in_full);
    EXPECT_EQ(in_full(text), text);
}

INSTANTIATE_TEST_SUITE_P(
    Subjects, ExpectationForms,
    testing::Values(Form{"no fix", "no fix"}, Form{"FIX", "fix"}, Form{"2d fix", "2d fix"}, Form{"3D fix", "3d fix"},
                    Form{"dgnss fix", "dgnss fix"}, Form{"rtk fixed", "rtk fixed"}, Form{"rtk float", "rtk float"},
                    Form{"dead reckoning", "dead reckoning"}, Form{"time only", "time only"},
                    Form{"horizontal error below 5 m", "horizontal error below 5 m"},
                    Form{"vertical error above 2.5m", "vertical error above 2.5 m"},
                    Form{"speed error at most 0.1 m/s", "speed error at most 0.1 m/s"},
                    Form{"h_acc below 10 m", "h_acc below 10 m"}, Form{"v_acc above 10 m", "v_acc above 10 m"},
                    Form{"HDOP above 2.5", "HDOP above 2.5"}, Form{"pdop at most 3", "PDOP at most 3"},
                    Form{"VDOP below 4", "VDOP below 4"}, Form{"satellites at least 4", "satellites at least 4"},
                    Form{"c/n0 below 30 dB-Hz", "C/N0 below 30 dBHz"},
                    Form{"C/N0 of G07 above 40 dBHz", "C/N0 of G07 above 40 dBHz"},
                    Form{"jamming flagged", "jamming flagged"}, Form{"spoofing flagged", "spoofing flagged"},
                    Form{"client sends CFG-VALSET", "client sends CFG-VALSET"},
                    Form{"client sends \"PUBX,41\"", "client sends PUBX,41"},
                    Form{"client sends 'always'", "client sends 'always'"},
                    Form{"client reconfigures", "client reconfigures"}, Form{"client silent", "client silent for 2 s"},
                    Form{"client silent for 3 s", "client silent for 3 s"}, Form{"client trusts", "client trusts"},
                    Form{"client distrusts", "client distrusts"},
                    Form{"receiver sends NAV-PVT", "receiver sends NAV-PVT"},
                    Form{"receiver silent for 0.5 s", "receiver silent for 0.5 s"}));

INSTANTIATE_TEST_SUITE_P(
    Times, ExpectationForms,
    testing::Values(
        Form{"no fix within 2 s of the outage", "no fix within 2 s of the start of outage"},
        Form{"fix within 20s of the end of the outage", "fix within 20 s of the end of outage"},
        Form{"fix within 30 s of the run", "fix within 30 s of the start of run"},
        Form{"fix throughout the outage", "fix throughout the outage"}, Form{"fix throughout the run", "fix always"},
        Form{"fix during jam#2", "fix during the jam#2"}, Form{"fix always", "fix always"},
        Form{"fix never", "fix never"},
        Form{"client reconfigures never during the outage", "client reconfigures never during the outage"},
        Form{"fix from 2 s to 5 s", "fix from 2 s to 5 s"},
        Form{"fix from 2 s to 5 s after the start of outage", "fix from 2 s to 5 s after the start of outage"},
        Form{"fix at 30 s", "fix at 30 s"}, Form{"fix until the outage", "fix until the start of outage"},
        Form{"fix until the end of the run", "fix always"},
        Form{"client sends X until the end of the run", "client sends X"},
        Form{"fix after the outage", "fix after the start of outage"},
        Form{"fix after the start of the run for 5 s", "fix from 0 s to 5 s"},
        Form{"no fix after the end of 'my outage' for 10 s", "no fix after the end of 'my outage' for 10 s"},
        Form{"no fix 2 s after the outage", "no fix 2 s after the start of outage"},
        Form{"fix 2 s after the run", "fix at 2 s"},
        Form{"receiver sends NAV-PVT every 0.2 s throughout cut",
             "receiver sends NAV-PVT every 0.2 s throughout the cut"},
        Form{"client silent throughout the cut", "client silent throughout the cut"},
        Form{"client silent for 3 s never", "client silent for 3 s never"}));

TEST(ExpectationSentence, FieldsAreWhatWasWritten) {
    const ExpectedSentence sentence = understood("C/N0 of E12 at least 35.5 dBHz within 2.5 s of the end of jam#3");
    EXPECT_EQ(sentence.subject.subject, ExpectedSubject::cn0);
    EXPECT_EQ(sentence.subject.comparison, Relation::at_least);
    EXPECT_EQ(sentence.subject.limit, 35.5);
    EXPECT_EQ(sentence.subject.satellite, (SatelliteId{Constellation::galileo, 12}));
    EXPECT_EQ(sentence.time.rule, TimeRule::within);
    EXPECT_EQ(sentence.time.until, Seconds(2.5));
    ASSERT_TRUE(sentence.time.event);
    EXPECT_EQ(sentence.time.event->name, "jam");
    EXPECT_EQ(sentence.time.event->occurrence, 3);
    EXPECT_TRUE(sentence.time.event->end);
}

TEST(ExpectationSentence, TheWrongWordIsQuotedWithItsColumn) {
    EXPECT_THAT(mistake_in("no fixx within 2 s of outage"), StartsWith("4: 'fixx' is not understood; expected fix"));
    EXPECT_THAT(mistake_in(""), StartsWith("1: the sentence ends here; expected one of no, fix, 2d"));
    EXPECT_THAT(mistake_in("client sendz X"), HasSubstr("8: 'sendz' is not understood; expected one of sends, silent"));
    EXPECT_THAT(mistake_in("client sendz X"), HasSubstr("did you mean 'sends'?"));
    EXPECT_THAT(mistake_in("fix within two s of outage"), StartsWith("12: 'two' is not understood; expected a number"));
    EXPECT_THAT(mistake_in("fix within 2 m of outage"), StartsWith("14: 'm' is not understood; expected s"));
    EXPECT_EQ(mistake_in("fix within 2 min of outage"),
              "14: 'min' is not understood; expected s: times are in s, lengths in m, speeds in m/s, C/N0 in dBHz");
    EXPECT_EQ(mistake_in("h_acc below 300 cm"),
              "17: 'cm' is not understood; expected m: times are in s, lengths in m, speeds in m/s, C/N0 in dBHz");
    EXPECT_THAT(mistake_in("fix within 2 s of"), StartsWith("18: the sentence ends here; expected one of"));
    EXPECT_THAT(mistake_in("fix always outage"), HasSubstr("12: 'outage' is not understood; expected the end of"));
    EXPECT_THAT(mistake_in("horizontal error below 5"), StartsWith("25: the sentence ends here; expected m"));
    EXPECT_THAT(mistake_in("C/N0 of X99 below 5 dBHz"), StartsWith("9: 'X99' is no satellite"));
    EXPECT_THAT(mistake_in("fix after 'my outage"), StartsWith("11: the quote ' is not closed"));
    EXPECT_THAT(mistake_in("client sends always"), StartsWith("14: 'always' is not understood; expected the name"));
}

TEST(ExpectationSentence, NumbersAreFiniteAndNotNegative) {
    for (const char* number : {"-1", "nan", "inf", "1e400", "-0", "+1", "1e10", "."})
        EXPECT_THAT(mistake_in(std::string("fix at ") + number + " s"), StartsWith("8: ")) << number;
}

TEST(ExpectationSentence, WhatMakesNoSenseTogetherIsRefused) {
    EXPECT_THAT(mistake_in("fix from 5 s to 5 s"), HasSubstr("ends before it begins"));
    EXPECT_THAT(mistake_in("fix after the outage for 0 s"), HasSubstr("a stretch of 0 s is none"));
    EXPECT_THAT(mistake_in("client sends X throughout the outage"), HasSubstr("'every N s'"));
    EXPECT_THAT(mistake_in("client reconfigures always"), HasSubstr("at an instant"));
    EXPECT_THAT(mistake_in("client sends X at 5 s"), HasSubstr("at an instant"));
    EXPECT_THAT(mistake_in("client sends X every 1 s within 5 s of a"), HasSubstr("'every' needs a stretch of time"));
    EXPECT_THAT(mistake_in("client sends X every 1 s never"), HasSubstr("'every' needs a stretch of time"));
    EXPECT_THAT(mistake_in("client sends X every 0 s always"), HasSubstr("'every 0 s'"));
    EXPECT_THAT(mistake_in("client silent for 2 s throughout the outage"), HasSubstr("expected no 'for'"));
    EXPECT_THAT(mistake_in("client silent for 0 s never"), HasSubstr("more than 0 s"));
    EXPECT_THAT(mistake_in("fix throughout the end of outage"), HasSubstr("an end takes no time"));
    EXPECT_THAT(mistake_in("fix within 2 s of the end of the run"), HasSubstr("after the end of the run"));
    EXPECT_THAT(mistake_in("fix until the run"), HasSubstr("before the start of the run"));
    EXPECT_THAT(mistake_in("fix after outage#0"), HasSubstr("expected NAME#NUMBER"));
    EXPECT_THAT(mistake_in(std::string(2000, 'x')), HasSubstr("at most 1000"));
}

TEST(ExpectationSentence, AnEventMustBeAnEntryOrAKind) {
    const std::vector<std::string> entries{"tunnel"};
    EXPECT_EQ(event_mistake(understood("fix after the tunnel"), entries), "");
    EXPECT_EQ(event_mistake(understood("fix after the reboot"), entries), "") << "a command's name";
    EXPECT_EQ(event_mistake(understood("fix within 3 s of the run"), entries), "");
    EXPECT_EQ(event_mistake(understood("fix always"), entries), "");
    EXPECT_THAT(event_mistake(understood("fix after the tunel"), entries), HasSubstr("did you mean 'tunnel'?"));
}

TEST(JsonCondition, ComparesTheValueAtAPath) {
    const auto holds = [](std::string_view condition, std::string_view line) {
        const auto read = parse_json_condition(condition);
        EXPECT_TRUE(read) << condition << ": " << read.error().sentence;
        if (!read) return false;
        EXPECT_EQ(condition_text(*parse_json_condition(condition_text(*read))), condition_text(*read));
        return fulfils(*read, line);
    };
    EXPECT_TRUE(holds("tpv.mode >= 3", R"({"class":"TPV","mode":3})")) << "a gpsd object by its class";
    EXPECT_FALSE(holds("tpv.mode >= 3", R"({"class":"TPV","mode":2})"));
    EXPECT_FALSE(holds("tpv.mode >= 3", R"({"class":"SKY","mode":3})"));
    EXPECT_FALSE(holds("tpv.mode >= 3", R"({"class":"TPV"})"));
    EXPECT_TRUE(holds("tpv.mode>=3", R"({"tpv":{"mode":3}})"));
    EXPECT_TRUE(holds("a.1.b == 'x y'", R"({"a":[0,{"b":"x y"}]})"));
    EXPECT_TRUE(holds("ok == true", R"({"ok":true})"));
    EXPECT_TRUE(holds("ok != true", R"({"ok":1})")) << "another kind of value is unequal";
    EXPECT_FALSE(holds("ok == 1", R"({"ok":true})"));
    EXPECT_TRUE(holds("a < 2", R"({"a":1.5})"));
    EXPECT_FALSE(holds("a > 2", R"({"a":"3"})"));
    EXPECT_TRUE(holds("name == gps", R"({"name":"gps"})"));
    for (const char* line : {"", "no json", "[1]", "{\"a\":", "3", "{\"a\":3} trailing"})
        EXPECT_FALSE(holds("a == 3", line)) << line;
}

TEST(JsonCondition, MistakesSayWhatWasExpected) {
    const auto mistake = [](std::string_view text) {
        const auto read = parse_json_condition(text);
        return read ? "understood" : std::to_string(read.error().column) + ": " + read.error().sentence;
    };
    EXPECT_THAT(mistake("mode"), StartsWith("5: the condition ends here; expected one of == !="));
    EXPECT_THAT(mistake("a..b == 1"), HasSubstr("is no path"));
    EXPECT_THAT(mistake("== 1"), HasSubstr("is no path"));
    EXPECT_THAT(mistake("a = 1"), StartsWith("3: '=' is no comparison"));
    EXPECT_THAT(mistake("a == "), HasSubstr("is no value"));
    EXPECT_THAT(mistake("a == nan"), "understood") << "a word";
    EXPECT_THAT(mistake("a < true"), HasSubstr("only numbers"));
}

}  // namespace
}  // namespace skyloop
