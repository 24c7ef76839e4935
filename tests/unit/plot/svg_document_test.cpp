#include "study/plot/svg_document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "unit/plot/well_formed.hpp"

namespace skyloop {
namespace {

using ::testing::HasSubstr;

TEST(WellFormed, finds_what_is_wrong) {
    EXPECT_EQ(test::xml_fault("<a b=\"1\"><c/>x &amp; y</a>"), "");
    for (const char* bad :
         {"", "<a>", "<a></b>", "<a/><b/>", "<a b=1/>", "<a b=\"1\" b=\"2\"/>", "<a>&x</a>", "<a", "x<a/>", "<a>></a>"})
        EXPECT_NE(test::xml_fault(bad), "") << bad;
}

TEST(SvgDocument, numbers_are_short_and_never_negative_zero_or_nan) {
    EXPECT_EQ(svg_number(1.005), "1");
    EXPECT_EQ(svg_number(12.346), "12.35");
    EXPECT_EQ(svg_number(-12.5), "-12.5");
    EXPECT_EQ(svg_number(-0.004), "0");
    EXPECT_EQ(svg_number(100), "100");
    EXPECT_EQ(svg_number(std::numeric_limits<double>::quiet_NaN()), "0");
    EXPECT_EQ(svg_number(-std::numeric_limits<double>::infinity()), "0");
}

TEST(SvgDocument, text_is_escaped_and_made_valid_utf8) {
    EXPECT_EQ(svg_escape("a<b>&\"c\"'"), "a&lt;b&gt;&amp;&quot;c&quot;&#39;");
    EXPECT_EQ(svg_escape("46.5° · …"), "46.5° · …");
    EXPECT_EQ(svg_escape(std::string("a\x01\nb\0c", 6)), "abc");
    EXPECT_EQ(svg_escape("\xff|\xc3|\xe2\x82|\xc0\xaf|\xed\xa0\x80"),
              "\uFFFD|\uFFFD|\uFFFD\uFFFD|\uFFFD\uFFFD|\uFFFD\uFFFD\uFFFD");
    EXPECT_EQ(svg_escape("\xf0\x9f\x9b\xb0"), "\xf0\x9f\x9b\xb0");
}

TEST(SvgDocument, every_shape_is_well_formed_and_open_groups_are_closed) {
    SvgDocument svg(640, 480, "a \"title\" <&>");
    svg.begin_group("outer", "tip & more");
    svg.begin_group("inner");
    svg.rectangle({1, 2}, {3, 4}, 5, {.fill = "#fff", .stroke = "#000", .width = 2, .opacity = 0.5, .dash = "4 3"});
    svg.circle({1, 2}, 3, {});
    svg.ellipse({1, 2}, {3, 4}, 30, {.stroke = "#000"});
    svg.line({0, 0}, {1, 1}, {.stroke = "#000"});
    svg.path(SvgPath().move_to({0, 0}).line_to({1.5, 2}).close(), {.fill = "#123456"});
    svg.path(SvgPath(), {});
    svg.text({.at = {10, 20},
              .text = "<G07>",
              .size = 10,
              .anchor = "middle",
              .bold = true,
              .halo = "#fff",
              .rotation_deg = 90});
    const std::string text = svg.str();
    EXPECT_EQ(test::xml_fault(text), "");
    for (const char* part : {"viewBox=\"0 0 640 480\"", "d=\"M0 0L1.5 2Z\"", "rotate(30 1 2)", "&lt;G07&gt;",
                             "stroke-dasharray=\"4 3\"", "y=\"23.6\"", "tip &amp; more"})
        EXPECT_THAT(text, HasSubstr(part));
    EXPECT_EQ(test::occurrences(text, "<path"), 1u);
    EXPECT_EQ(test::occurrences(text, "<g "), test::occurrences(text, "</g>"));
}

TEST(SvgDocument, ending_a_group_that_was_not_begun_does_nothing) {
    SvgDocument svg(10, 10, "");
    svg.end_group();
    EXPECT_EQ(test::xml_fault(svg.str()), "");
}

}  // namespace
}  // namespace skyloop
