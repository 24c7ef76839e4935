// Whole numbers that fit best, against a search through all of them.
#include "receiver/pvt/integer_search.hpp"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/core/random.hpp"

namespace skyloop {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

double squared_distance(const VectorXd& floats, const MatrixXd& covariance, const VectorXd& whole) {
    const VectorXd off = floats - whole;
    return off.dot(covariance.inverse() * off);
}

// The two least squared distances of all vectors within `reach` of the rounded one.
std::vector<double> least_two(const VectorXd& floats, const MatrixXd& covariance, int reach) {
    std::vector<double> norms;
    VectorXd step = VectorXd::Constant(floats.size(), -reach);
    const VectorXd middle = floats.array().round();
    for (Eigen::Index i = 0; i < step.size();) {
        norms.push_back(squared_distance(floats, covariance, middle + step));
        for (i = 0; i < step.size() && ++step(i) > reach; ++i)
            step(i) = -reach;
    }
    std::partial_sort(norms.begin(), norms.begin() + 2, norms.end());
    return {norms[0], norms[1]};
}

// De Jonge and Tiberius 1996, The LAMBDA method for integer ambiguity estimation: implementation aspects, section 4.8.
TEST(IntegerSearch, FindsThoseOfThePublishedExample) {
    VectorXd floats(3);
    floats << 5.450, 3.100, 2.970;
    MatrixXd covariance(3, 3);
    covariance << 6.290, 5.978, 0.544, 5.978, 6.292, 2.340, 0.544, 2.340, 6.288;
    const auto found = search_integers(floats, covariance);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->best, VectorXd(Eigen::Vector3d(5, 3, 4)));
    EXPECT_EQ(found->second, VectorXd(Eigen::Vector3d(6, 4, 4)));
    EXPECT_NEAR(found->best_norm, 0.2183, 1e-4);
    EXPECT_NEAR(found->second_norm, 0.3073, 1e-4);
    EXPECT_NEAR(found->ratio(), 0.3073 / 0.2183, 1e-3);
}

TEST(IntegerSearch, FindsWhatASearchThroughAllFinds) {
    RandomStream dice(7, "integer_search");
    for (int trial = 0; trial < 60; ++trial) {
        const Eigen::Index n = 1 + trial % 4;
        MatrixXd root(n, n);
        VectorXd floats(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            floats(i) = 1e7 + 3 * dice.normal();
            for (Eigen::Index j = 0; j < n; ++j)
                root(i, j) = 0.7 * dice.normal();
        }
        const MatrixXd covariance = root * root.transpose() + 0.02 * MatrixXd::Identity(n, n);
        const auto found = search_integers(floats, covariance);
        ASSERT_TRUE(found) << trial;
        const std::vector<double> expected = least_two(floats, covariance, 6);
        EXPECT_NEAR(found->best_norm, expected[0], 1e-6 * (1 + expected[0])) << trial;
        EXPECT_NEAR(found->second_norm, expected[1], 1e-6 * (1 + expected[1])) << trial;
        EXPECT_NEAR(squared_distance(floats, covariance, found->best), found->best_norm, 1e-6 * (1 + expected[0]));
        EXPECT_NEAR(squared_distance(floats, covariance, found->second), found->second_norm, 1e-6 * (1 + expected[1]));
    }
}

TEST(IntegerSearch, TellsHowSureRoundingIs) {
    const auto success = [](double deviation) {
        return search_integers(VectorXd::Constant(1, 0.1), MatrixXd::Constant(1, 1, deviation * deviation))->success;
    };
    EXPECT_NEAR(success(0.5), 0.6827, 1e-4) << "half a cycle is one deviation";
    EXPECT_NEAR(success(0.25), 0.9545, 1e-4);
}

// Of variances that are too small or too large, the best one's own misfit is the measure, down to a third.
TEST(IntegerSearch, MeasuresTheSecondByTheMisfitOfTheBest) {
    IntegerCandidates candidates;
    candidates.best = VectorXd::Zero(8);
    candidates.second_norm = 40;
    candidates.best_norm = 10;  // 2 for each of five
    EXPECT_DOUBLE_EQ(candidates.gap(), 15);
    candidates.best_norm = 2.5;
    EXPECT_DOUBLE_EQ(candidates.gap(), 75);
    candidates.best_norm = 0;
    EXPECT_DOUBLE_EQ(candidates.gap(), 40 / 0.35);
    candidates.best = VectorXd::Zero(3);  // which the place takes
    candidates.best_norm = 10;
    EXPECT_DOUBLE_EQ(candidates.gap(), 3);
}

TEST(IntegerSearch, RefusesWhatIsNoCovariance) {
    EXPECT_FALSE(search_integers(VectorXd(), MatrixXd()));
    EXPECT_FALSE(search_integers(VectorXd::Zero(2), MatrixXd::Zero(2, 2)));
    MatrixXd indefinite(2, 2);
    indefinite << 1, 2, 2, 1;
    EXPECT_FALSE(search_integers(VectorXd::Zero(2), indefinite));
    EXPECT_FALSE(search_integers(VectorXd::Constant(1, std::nan("")), MatrixXd::Identity(1, 1)));
}

}  // namespace
}  // namespace skyloop
