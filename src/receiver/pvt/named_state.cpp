#include "detail/named_state.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <utility>

namespace skyloop::inline receiver {

using Eigen::Index;

void NamedState::arrange(std::vector<StateName> wanted, const std::function<double(const StateName&)>& variance) {
    if (wanted == names_) return;
    const auto size = static_cast<Index>(wanted.size());
    Eigen::VectorXd new_values = Eigen::VectorXd::Zero(size);
    Eigen::MatrixXd new_covariance = Eigen::MatrixXd::Zero(size, size);
    std::vector<std::pair<Index, Index>> moved;  // where it is, where it was
    for (Index i = 0; i < size; ++i) {
        const StateName& name = wanted[static_cast<std::size_t>(i)];
        if (std::ranges::binary_search(names_, name))
            moved.emplace_back(i, index(name));
        else
            new_covariance(i, i) = variance(name);
    }
    for (const auto& [to, from] : moved) {
        new_values(to) = values(from);
        for (const auto& [other_to, other_from] : moved)
            new_covariance(to, other_to) = covariance(from, other_from);
    }
    names_ = std::move(wanted);
    values = std::move(new_values);
    covariance = std::move(new_covariance);
}

Index NamedState::index(const StateName& name) const { return std::ranges::lower_bound(names_, name) - names_.begin(); }

void NamedState::restart(Index part, double value, double variance) {
    values(part) = value;
    covariance.row(part).setZero();
    covariance.col(part).setZero();
    covariance(part, part) = variance;
}

void NamedState::relax(Index part, double left, double variance) {
    values(part) *= left;
    covariance.row(part) *= left;
    covariance.col(part) *= left;
    covariance(part, part) += (1 - left * left) * variance;
}

void NamedState::absorb(const Eigen::MatrixXd& design, const Eigen::VectorXd& misfit, const Eigen::MatrixXd& noise) {
    const Eigen::MatrixXd spread = covariance * design.transpose();
    const Eigen::LLT<Eigen::MatrixXd> expected(design * spread + noise);
    if (expected.info() != Eigen::Success) return;
    values += spread * expected.solve(misfit);
    // With S = L Lᵀ the loss of variance is W Wᵀ of W = (P Hᵀ) L⁻ᵀ, which keeps the covariance symmetric.
    const Eigen::MatrixXd gained = expected.matrixL().solve(spread.transpose());
    covariance.noalias() -= gained.transpose() * gained;
}

}  // namespace skyloop::inline receiver
