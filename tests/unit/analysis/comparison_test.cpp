#include "study/analysis/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "base/core/random.hpp"
#include "base/geo/local_frame.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using ::testing::HasSubstr;

const Geodetic compared_place = Geodetic::degrees(36.970631, -121.904695, 10);

// Fixes scattered about the place: white, `sigma` metres per axis, with the truth or without.
FixSeries scattered(const std::string& name, std::size_t n, double sigma, bool with_truth) {
    RandomStream random(3, name);
    const LocalFrame frame(compared_place);
    FixSeries series;
    series.name = name;
    series.dated = with_truth;
    if (with_truth) series.interval = Seconds(1);
    for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Vector3d enu(sigma * random.normal(), sigma * random.normal(), 2 * sigma * random.normal());
        FixSample sample{std::nullopt, true, to_geodetic(frame.to_ecef(Position<Enu>(enu))), std::nullopt};
        if (with_truth) {
            sample.truth = compared_place;
            sample.time = to_gps_time(1727, static_cast<double>(i));
        }
        series.samples.push_back(sample);
    }
    return series;
}

const FigureDifference* figure_of(const Comparison& c, ErrorQuantity quantity, std::string_view name) {
    for (const FigureDifference& d : c.differences)
        if (d.quantity == quantity && d.figure == name) return &d;
    return nullptr;
}

TEST(Comparison, of_a_file_with_itself_is_zero_everywhere) {
    const FixSeries series = scattered("same", 500, 2, true);
    const auto c = compare(series, series);
    ASSERT_TRUE(c) << c.error().message;
    ASSERT_TRUE(c->article);
    EXPECT_EQ(c->article->difference, 0);
    for (const FigureDifference& d : c->differences)
        EXPECT_EQ(d.percent.value_or(0), 0) << d.figure;
    EXPECT_TRUE(c->warnings.empty());
}

TEST(Comparison, gives_the_percentage_of_a_known_scale) {
    // Radial errors scale with sigma: 20 % more in mean and standard deviation is 20 % in the article's figure.
    const FixSeries b = scattered("scaled", 400, 1, true);
    FixSeries a = b;
    const LocalFrame frame(compared_place);
    for (FixSample& s : a.samples) {
        const Eigen::Vector3d enu = frame.to_enu(to_ecef(s.position)).vector();
        s.position = to_geodetic(frame.to_ecef(Position<Enu>(Eigen::Vector3d(1.2 * enu))));
    }
    const auto c = compare(a, b);
    ASSERT_TRUE(c) << c.error().message;
    EXPECT_NEAR(c->article->difference, 20, 1e-4);
    EXPECT_NEAR(*figure_of(*c, ErrorQuantity::horizontal, "p95")->percent, 20, 1e-4);
    EXPECT_NEAR(*figure_of(*c, ErrorQuantity::east, "std")->percent, 20, 1e-4);
    EXPECT_FALSE(figure_of(*c, ErrorQuantity::east, "mean")->percent);
    EXPECT_FALSE(figure_of(*c, ErrorQuantity::east, "p95"));
    const auto reverse = compare(b, a);
    EXPECT_NEAR(*figure_of(*reverse, ErrorQuantity::horizontal, "std")->percent, -100.0 / 6, 1e-4);
}

TEST(Comparison, warns_of_signed_means_and_of_unlike_references) {
    const FixSeries a = scattered("sim", 300, 2, true);
    const FixSeries b = scattered("real", 300, 2, false);
    ComparisonOptions options;
    options.quantity = ErrorQuantity::east;
    const auto c = compare(a, b, options);
    ASSERT_TRUE(c) << c.error().message;
    ASSERT_EQ(c->warnings.size(), 2u);
    EXPECT_THAT(c->warnings[0], HasSubstr("small beside its standard deviation"));
    EXPECT_THAT(c->warnings[1], HasSubstr("about the mean of the file itself"));
    options = {compared_place, ErrorQuantity::horizontal, 0};
    EXPECT_TRUE(compare(a, b, options)->warnings.empty());
    EXPECT_THAT(compare(a, a, options)->warnings.at(0), HasSubstr("reference point is not used"));
}

// A receiver that holds its position: about its own mean nothing but the rounding of coordinates is left.
TEST(Comparison, of_a_constant_reference_has_no_percentages) {
    FixSeries constant{"constant", {}, false, {}, {}};
    for (int i = 0; i < 100; ++i)
        constant.samples.push_back({std::nullopt, true, Geodetic::degrees(47.1234567, 8.7654321, 512.345), {}});
    const auto c = compare(scattered("sim", 100, 2, false), constant);
    ASSERT_TRUE(c) << c.error().message;
    EXPECT_FALSE(c->article);
    for (const FigureDifference& d : c->differences)
        EXPECT_FALSE(d.percent) << error_quantity_name(d.quantity) << " " << d.figure;
    EXPECT_THAT(c->warnings, ::testing::ElementsAre(HasSubstr("mean or a standard deviation of zero")));
    EXPECT_TRUE(compare(constant, scattered("sim", 100, 2, false))->warnings.empty());
}

TEST(Comparison, warns_of_a_wild_fix) {
    FixSeries b = scattered("glitch", 300, 2, true);
    b.samples[7].position.height.above_ellipsoid += Metres(1000);
    const auto c = compare(scattered("sim", 300, 2, true), b);
    ASSERT_TRUE(c) << c.error().message;
    ASSERT_EQ(c->warnings.size(), 1u);
    EXPECT_THAT(c->warnings[0], HasSubstr("glitch: the largest 3d error"));
}

TEST(Comparison, needs_two_fixes_and_a_whole_window) {
    FixSeries one = scattered("one", 1, 2, true);
    const FixSeries many = scattered("many", 100, 2, true);
    const auto short_file = compare(one, many);
    ASSERT_FALSE(short_file);
    EXPECT_THAT(short_file.error().message, HasSubstr("one: holds 1 fix; a standard deviation needs at least 2"));
    const auto no_window = compare(many, many, {std::nullopt, ErrorQuantity::horizontal, 101});
    ASSERT_FALSE(no_window);
    EXPECT_EQ(no_window.error().code, ErrorCode::usage);
    EXPECT_THAT(no_window.error().message, HasSubstr("100 fixes make 0 windows of 101"));
}

TEST(Comparison, windows_are_measured_one_by_one_and_pairwise) {
    const FixSeries a = scattered("sim", 200, 2, true);
    const FixSeries b = scattered("real", 350, 2, true);
    const auto c = compare(a, b, {std::nullopt, ErrorQuantity::horizontal, 100});
    ASSERT_TRUE(c) << c.error().message;
    ASSERT_EQ(c->windows.size(), 3u);
    EXPECT_EQ(c->windows[2].first_sample, 200u);
    EXPECT_EQ(c->windows[2].start, to_gps_time(1727, 200.0));
    ASSERT_EQ(c->yardstick.size(), 6u);
    const auto single = compare(a, slice(b, {100, 1, 100}));
    EXPECT_DOUBLE_EQ(c->windows[1].difference->difference, single->article->difference);
    const auto pair = compare(slice(b, {200, 1, 100}), slice(b, {0, 1, 100}));
    EXPECT_EQ(c->yardstick[1].reference, 0u);
    EXPECT_EQ(c->yardstick[1].candidate, 2u);
    EXPECT_DOUBLE_EQ(c->yardstick[1].difference->difference, pair->article->difference);
}

// So that none is empty, whatever the receiver has missed.
TEST(Comparison, windows_hold_as_many_fixes_each) {
    const FixSeries a = scattered("sim", 200, 2, true);
    FixSeries b = a;
    for (std::size_t i = 0; i < 100; ++i)
        b.samples[i].has_fix = i % 2 == 0;
    const auto c = compare(a, b, {std::nullopt, ErrorQuantity::horizontal, 60});
    ASSERT_TRUE(c) << c.error().message;
    ASSERT_EQ(c->windows.size(), 2u);
    EXPECT_EQ(c->windows[0].figures.n, 60u);
    EXPECT_EQ(c->windows[1].figures.n, 60u);
    EXPECT_EQ(c->windows[1].first_sample, 110u);
    EXPECT_EQ(c->windows[1].start, to_gps_time(1727, 110.0));
    EXPECT_THAT(comparison_text(*c), HasSubstr("A against each window of B (60 fixes each,"));
    EXPECT_THAT(comparison_json(*c), HasSubstr("\"window_fixes\": 60"));
}

TEST(Comparison, text_is_aligned_and_names_units_and_the_article_figure) {
    const auto c = compare(scattered("sim", 200, 2, true), scattered("real", 300, 2.5, false),
                           {std::nullopt, ErrorQuantity::horizontal, 100});
    ASSERT_TRUE(c) << c.error().message;
    const std::string text = comparison_text(*c);
    for (const char* word :
         {"A (candidate)", "200 fixes in 200 samples, one every 1 s", "own truth", "errors about the own mean",
          "horizontal, radial", "50 % (CEP)", "< 1 s", "agreement", "Yardstick", "sample 101", "warning: real"})
        EXPECT_THAT(text, HasSubstr(word));
    EXPECT_THAT(text, ::testing::ContainsRegex("difference [0-9]+\\.[0-9] %, agreement [0-9]+\\.[0-9] %"));
    EXPECT_EQ(text.find("nan"), std::string::npos);
    // Every row of figures ends in the same column.
    std::istringstream lines(text);
    std::size_t rows = 0;
    for (std::string line; std::getline(lines, line);)
        if (line.find("standard deviation ") != std::string::npos && line.find(" m ") != std::string::npos) {
            EXPECT_EQ(line.size(), 83u) << line;
            ++rows;
        }
    EXPECT_EQ(rows, 5u);
    EXPECT_EQ(text, comparison_text(*c));
}

// Errors four times as large differ by 300 %: no agreement is left that could be told, in text, JSON or windows.
TEST(Comparison, has_no_agreement_below_zero) {
    const auto c = compare(scattered("sim", 200, 8, true), scattered("sim", 200, 2, true),
                           {std::nullopt, ErrorQuantity::horizontal, 100});
    ASSERT_TRUE(c) << c.error().message;
    ASSERT_NEAR(c->article->difference, 300, 1e-3);
    EXPECT_FALSE(c->article->agreement());
    const std::string text = comparison_text(*c);
    EXPECT_THAT(text, HasSubstr("\ndifference 300.0 %\n"));
    EXPECT_THAT(text, ::testing::Not(HasSubstr("agreement -")));
    EXPECT_THAT(text, ::testing::Not(HasSubstr(", agreement")));
    EXPECT_THAT(text, ::testing::ContainsRegex("[23][0-9][0-9]\\.[0-9] %          -\n"));
    EXPECT_THAT(comparison_json(*c), HasSubstr("\"agreement_percent\": null"));
}

TEST(Comparison, json_holds_the_same_figures) {
    const auto c = compare(scattered("si\"m\xff", 200, 2, true), scattered("real", 300, 2.5, false),
                           {std::nullopt, ErrorQuantity::horizontal, 100});
    ASSERT_TRUE(c) << c.error().message;
    const std::string json = comparison_json(*c);
    for (const char* word : {"\"difference_percent\"", "\"agreement_percent\"", "\"window_pairs\"", "\"own mean\"",
                             "\"p95_m\"", "\"interval_s\": null", "\"name\": \"si\\\"m\xef\xbf\xbd\""})
        EXPECT_THAT(json, HasSubstr(word));
    EXPECT_EQ(json.back(), '\n');
    EXPECT_EQ(json, comparison_json(*c));
}

TEST(Comparison, error_quantities_have_names_both_ways) {
    for (const ErrorQuantity quantity : error_quantities)
        EXPECT_EQ(error_quantity_from_name(error_quantity_name(quantity)), quantity);
    EXPECT_FALSE(error_quantity_from_name("vertical"));
}

// MEASURED.md: standard deviations of the two receivers 1.80 2.05 4.48 / 1.67 1.85 3.98 m, means about the surveyed
// point -0.32 -0.82 / +0.15 +0.19 m.
TEST(Comparison, of_the_two_real_lea6_receivers_gives_the_measured_figures) {
    SKYLOOP_REQUIRE_SHARED(folder, "receivers/aptos_20130214_lea6");
    const auto first = read_fix_series(folder / "2013.02.14-024312_ublox1_geodetic.dlm");
    const auto second = read_fix_series(folder / "2013.02.14-024312_ublox2_geodetic.dlm");
    ASSERT_TRUE(first && second);
    const auto c = compare(*first, *second, {compared_place, ErrorQuantity::horizontal, 7200});
    ASSERT_TRUE(c) << c.error().message;
    EXPECT_NEAR(c->a.of(ErrorQuantity::east).figures.std, 1.80, 0.01);
    EXPECT_NEAR(c->a.of(ErrorQuantity::north).figures.std, 2.05, 0.01);
    EXPECT_NEAR(c->a.of(ErrorQuantity::up).figures.std, 4.48, 0.01);
    EXPECT_NEAR(c->b.of(ErrorQuantity::east).figures.std, 1.67, 0.01);
    EXPECT_NEAR(c->b.of(ErrorQuantity::north).figures.std, 1.85, 0.01);
    EXPECT_NEAR(c->a.of(ErrorQuantity::east).figures.mean, -0.32, 0.01);
    EXPECT_NEAR(c->a.of(ErrorQuantity::north).figures.mean, -0.82, 0.01);
    EXPECT_NEAR(c->b.of(ErrorQuantity::east).figures.mean, 0.15, 0.01);
    EXPECT_NEAR(c->b.of(ErrorQuantity::north).figures.mean, 0.19, 0.01);
    EXPECT_EQ(c->windows.size(), 5u);
    EXPECT_EQ(c->yardstick.size(), 20u);
}

}  // namespace
}  // namespace skyloop
