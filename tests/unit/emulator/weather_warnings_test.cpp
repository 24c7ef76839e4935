// What a run says of an atmosphere that cannot act as it is written.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "run/emulator/assembly.hpp"
#include "support/run_parts.hpp"

namespace skyloop {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// Warnings of a scenario with these layers, from base to top, m. @param more keys of the last one
std::vector<std::string> warnings_of_layers(std::initializer_list<std::pair<int, int>> layers,
                                            const std::string& model = "baseline", const std::string& more = "") {
    std::string text = fmt::format("[model]\nname = \"{}\"\n", model);
    for (const auto& [base, top] : layers)
        text += fmt::format("[[atmosphere.layer]]\nname = \"l{0}\"\nbase_m = {0}\ntop_m = {1}\n", base, top);
    return scenario_warnings(test::emulator_scenario(text + more), nullptr);
}

TEST(WeatherWarnings, SayWhichLayersOverlap) {
    const auto overlap = Contains(HasSubstr("overlap"));
    EXPECT_THAT(warnings_of_layers({}), Not(overlap));
    EXPECT_THAT(warnings_of_layers({{0, 12000}, {12000, 50000}}), Not(overlap));
    EXPECT_THAT(warnings_of_layers({{10000, 50000}, {0, 12000}}),
                Contains("atmosphere.layer: l0 (0 to 12000 m) and l10000 (10000 to 50000 m) overlap: the air that they "
                         "share weakens signals twice"));
    EXPECT_THAT(warnings_of_layers({{0, 50000}, {1000, 2000}, {3000, 4000}}),
                Contains(HasSubstr("l1000 (1000 to 2000 m) overlap, the first of 2 such pairs: ")));
}

TEST(WeatherWarnings, TakeOnlyLayersThatAct) {
    const auto overlap = Contains(HasSubstr("overlap"));
    EXPECT_THAT(warnings_of_layers({{0, 12000}, {10000, 50000}}, "baseline", "enabled = false\n"), Not(overlap));
    EXPECT_THAT(warnings_of_layers({{0, 12000}, {10000, 50000}}, "whole-path"), Not(overlap));
}

}  // namespace
}  // namespace skyloop
