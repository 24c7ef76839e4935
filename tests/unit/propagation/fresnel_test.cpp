#include "world/propagation/reflection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

using test::OracleRow;

SurfaceMaterial material_of(const OracleRow& row) {
    static const std::map<std::string, std::string> ours{
        {"dry_ground", "dry-ground"}, {"medium_dry_ground", "medium-ground"}, {"wet_ground", "wet-ground"}};
    const std::string name = row.text("material");
    const auto known = ours.find(name);
    const auto material = surface_material(known == ours.end() ? name : known->second);
    if (!material) ADD_FAILURE() << "no material " << name;
    return material.value_or(SurfaceMaterial{});
}

TEST(Fresnel, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("reflection_fresnel.csv")) {
        SCOPED_TRACE(row.id());
        const Hertz carrier(row.number("f_GHz") * 1e9);
        const SurfaceMaterial material = material_of(row);
        const double tolerance = row.number("tol");
        EXPECT_NEAR(permittivity_p2040(material, carrier), row.number("eps_r"), tolerance);
        EXPECT_NEAR(conductivity_p2040(material, carrier), row.number("sigma_S_m"), tolerance);
        const FresnelReflection r = fresnel_reflection(complex_permittivity_p2040(material, carrier),
                                                       Angle::degrees(row.number("incidence_deg")));
        EXPECT_NEAR(std::abs(r.te), row.number("abs_R_TE"), tolerance);
        EXPECT_NEAR(std::abs(r.tm), row.number("abs_R_TM"), tolerance);
        EXPECT_NEAR(std::abs(r.same_hand()), row.number("abs_same_hand"), tolerance);
        EXPECT_NEAR(std::abs(r.opposite_hand()), row.number("abs_opposite_hand"), tolerance);
        // The table prints losses with nine digits.
        EXPECT_NEAR(r.power_loss().value(), row.number("reflected_power_loss_dB"), tolerance + 5e-8);
    }
}

TEST(Fresnel, ConservesPowerBetweenTheHands) {
    const auto glass = complex_permittivity_p2040(*surface_material("glass"), Hertz(carrier_frequency_l1));
    const FresnelReflection r = fresnel_reflection(glass, Angle::degrees(55));
    const double hands = std::norm(r.same_hand()) + std::norm(r.opposite_hand());
    EXPECT_NEAR(-10 * std::log10(hands), r.power_loss().value(), 1e-12);
}

TEST(Fresnel, KnowsNineMaterials) {
    EXPECT_EQ(surface_materials().size(), 9u);
    EXPECT_FALSE(surface_material("cheese"));
}

TEST(Roughness, DullsSteepReflectionsMost) {
    const Hertz l1(carrier_frequency_l1);
    EXPECT_EQ(roughness_factor(Metres(0), Angle::degrees(0), l1), 1);
    EXPECT_NEAR(roughness_factor(Metres(0.01), Angle::degrees(0), l1), 0.804, 0.001);
    EXPECT_GT(roughness_factor(Metres(0.01), Angle::degrees(80), l1), 0.99);
}

}  // namespace
}  // namespace skyloop
