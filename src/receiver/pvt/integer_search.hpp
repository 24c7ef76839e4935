/// Whole numbers of cycles that fit floating ones best: the LAMBDA method.
#pragma once

#include <Eigen/Core>

#include <optional>

namespace skyloop::inline receiver {

/// The two best integer vectors.
struct IntegerCandidates {
    Eigen::VectorXd best, second;
    double best_norm = 0, second_norm = 0;  ///< squared distances from the floating ones, by their covariance
    /// Probability that the best one is right if the covariance is: that of rounding one after the other, which is a
    /// lower bound (Teunissen 1998, Success probability of integer GPS ambiguity rounding and bootstrapping, eq. 32).
    double success = 0;

    /// How much worse the second best is, as receivers tell it.
    [[nodiscard]] double ratio() const;
    /// The difference test: by how much worse the second best is, in units of what the best one misfits by, for each of
    /// the ambiguities that the place leaves free; of variances that are too large, at most three times. Twice the
    /// logarithm of how much more probable the best one is (Verhagen 2005, The GNSS integer ambiguities, chapter 3).
    /// Other than of the ratio, its limit is the same for few ambiguities and for many.
    [[nodiscard]] double gap() const;
    /// Of the best one, squared, for each ambiguity; 1 where the covariance is right.
    [[nodiscard]] double misfit() const;
};

/// Least squares over whole numbers: decorrelation by unimodular transformations (Teunissen 1995, The least-squares
/// ambiguity decorrelation adjustment), then a search that goes deep first and shrinks (Chang, Yang and Zhou 2005,
/// MLAMBDA, section 4).
/// @param floats n floating ambiguities, cycles  @param covariance of them, n × n, cycles²
/// @return nothing for none, for a covariance that is not positive definite, and where the search takes too long
std::optional<IntegerCandidates> search_integers(const Eigen::VectorXd& floats, const Eigen::MatrixXd& covariance);

}  // namespace skyloop::inline receiver
