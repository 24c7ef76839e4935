#include "world/propagation/propagation_parameters.hpp"

#include <gtest/gtest.h>

#include <set>

namespace skyloop {
namespace {

TEST(AtmosphereParameters, DefaultLayersFollowOneAnotherFromTheGround) {
    const auto layers = default_layers();
    ASSERT_EQ(layers.size(), 4u);
    EXPECT_EQ(layers[0].name, "troposphere");
    EXPECT_EQ(layers[0].base, Metres(0));
    EXPECT_EQ(layers[0].vapour_g_m3, 7.5);
    for (std::size_t i = 1; i < layers.size(); ++i) {
        EXPECT_EQ(layers[i].base, layers[i - 1].top);
        EXPECT_EQ(layers[i].vapour_g_m3, 0);
        EXPECT_TRUE(layers[i].enabled);
    }
    EXPECT_EQ(layers.back().top, Metres(600000));
}

TEST(CloudCatalogue, IsInOrderOfDensityFromFogToThunderstorm) {
    const auto& clouds = cloud_catalogue();
    ASSERT_EQ(clouds.size(), 7u);
    EXPECT_EQ(clouds.front().kind, "fog");
    EXPECT_EQ(clouds.back().kind, "thunderstorm");
    std::set<std::string> kinds;
    for (std::size_t i = 0; i < clouds.size(); ++i) {
        EXPECT_LT(clouds[i].base, clouds[i].top) << clouds[i].kind;
        EXPECT_TRUE(kinds.insert(clouds[i].kind).second) << clouds[i].kind;
    }
    for (std::size_t i = 1; i < clouds.size(); ++i)
        EXPECT_GT(clouds[i].density_g_m3, clouds[i - 1].density_g_m3) << clouds[i].kind;
}

TEST(EnvironmentCatalogue, RunsFromCountrysideToIndustry) {
    const auto& environments = environment_catalogue();
    ASSERT_EQ(environments.size(), 6u);
    EXPECT_EQ(environments.front().name, "countryside");
    EXPECT_EQ(environments.front().noise, Decibels(1));
    EXPECT_EQ(environments.back().name, "industrial");
    EXPECT_EQ(environments.back().noise, Decibels(40));
    for (std::size_t i = 1; i < environments.size(); ++i)
        EXPECT_GT(environments[i].noise, environments[i - 1].noise) << environments[i].name;
}

}  // namespace
}  // namespace skyloop
