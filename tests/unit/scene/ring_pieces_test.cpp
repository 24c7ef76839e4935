#include "world/scene/city_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/core/random.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop {
namespace {

using Eigen::Vector2d;
using Ring = std::vector<Vector2d>;

double area_of_ring(const Ring& ring) {
    double sum = 0;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
        sum += ring[j].x() * ring[i].y() - ring[j].y() * ring[i].x();
    return std::abs(sum) / 2;
}

/// A comb: a back and ten teeth, so that many cuts leave several parts.
Ring comb() {
    Ring ring{{0, 0}};
    ring.emplace_back(1000, 0);
    for (int tooth = 9; tooth >= 0; --tooth)
        for (const auto& [east, north] : {std::pair{60, 900}, {30, 900}, {30, 50}, {0, 50}})
            ring.emplace_back(100 * tooth + east, north);
    return ring;
}

TEST(RingPieces, ANarrowRingStaysWhole) {
    const Ring square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    const auto pieces = ring_pieces(square, 10);
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_EQ(pieces.front(), square);
}

TEST(RingPieces, CoverWhatTheRingCovers) {
    const auto pieces = ring_pieces(comb(), 130);
    EXPECT_GT(pieces.size(), 40U);
    double area = 0;
    std::vector<FoliageVolume> parts;
    for (const Ring& piece : pieces) {
        area += area_of_ring(piece);
        parts.push_back({piece, 0, 1});
        for (const Vector2d& corner : piece)
            EXPECT_LE((corner - piece.front()).cwiseAbs().maxCoeff(), 130);
    }
    EXPECT_NEAR(area, area_of_ring(comb()), 1e-6);
    const std::vector<FoliageVolume> whole{{comb(), 0, 1}};
    RandomStream random(3, "ring pieces");
    for (int i = 0; i < 500; ++i) {
        const SceneRay ray{{1000 * random.uniform(), 1000 * random.uniform(), 0.5},
                           Eigen::Vector3d(random.normal(), random.normal(), 0).normalized()};
        EXPECT_NEAR(foliage_length(parts, ray), foliage_length(whole, ray), 1e-6) << i;
    }
}

TEST(RingPieces, NothingComesOfWhatHasNoArea) {
    EXPECT_TRUE(ring_pieces({}, 10).empty());
    EXPECT_TRUE(ring_pieces({{0, 0}, {900, 0}}, 10).empty());
    EXPECT_TRUE(ring_pieces({{0, 0}, {900, 0}, {400, 0}}, 10).empty());
    EXPECT_TRUE(ring_pieces({{0, 0}, {900, 0}, {400, std::numeric_limits<double>::quiet_NaN()}}, 10).empty());
}

TEST(RingPieces, TheirNumberIsBounded) {
    EXPECT_LE(ring_pieces({{0, 0}, {1e6, 0}, {1e6, 1e6}, {0, 1e6}}, 10).size(), 256U * 256U);
}

}  // namespace
}  // namespace skyloop
