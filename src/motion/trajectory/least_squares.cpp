#include "detail/least_squares.hpp"

#include <Eigen/QR>

namespace skyloop::inline motion {

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return a.colPivHouseholderQr().solve(b);
}

}  // namespace skyloop::inline motion
