/// Linear least squares.
#pragma once

#include <Eigen/Core>

namespace skyloop::inline motion {

/// The x for which |A x − b| is least, column by column of b; by Householder's QR with pivots, whatever A's rank. One
/// kind of matrix for all: compilers take long over each.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace skyloop::inline motion
