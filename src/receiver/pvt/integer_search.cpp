#include "receiver/pvt/integer_search.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace skyloop::inline receiver {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Q = Lᵀ D L with a lower triangle of unit diagonal, and the transformation z = Zᵀ a that has been made of it.
struct Decorrelation {
    MatrixXd l;
    VectorXd d;
    MatrixXd z;
};

bool factorise(MatrixXd q, Decorrelation& f) {
    const Index n = q.rows();
    f.l = MatrixXd::Zero(n, n);
    f.d = VectorXd::Zero(n);
    f.z = MatrixXd::Identity(n, n);
    for (Index i = n - 1; i >= 0; --i) {
        f.d(i) = q(i, i);
        if (!(f.d(i) > 0)) return false;
        f.l.row(i).head(i + 1) = q.row(i).head(i + 1) / f.d(i);
        for (Index j = 0; j < i; ++j)
            q.row(j).head(j + 1) -= f.d(i) * f.l(i, j) * f.l.row(i).head(j + 1);
    }
    return true;
}

// Takes whole multiples of column i off column j.
void reduce(Decorrelation& f, Index i, Index j) {
    const double whole = std::round(f.l(i, j));
    if (whole == 0) return;
    const Index below = f.l.rows() - i;
    f.l.col(j).tail(below) -= whole * f.l.col(i).tail(below);
    f.z.col(j) -= whole * f.z.col(i);
}

// Exchanges ambiguities j and j + 1. @param variance what d(j + 1) becomes
void exchange(Decorrelation& f, Index j, double variance) {
    const double eta = f.d(j) / variance, lambda = f.d(j + 1) * f.l(j + 1, j) / variance;
    const double slope = f.l(j + 1, j);
    f.d(j) = eta * f.d(j + 1);
    f.d(j + 1) = variance;
    const VectorXd upper = f.l.row(j).head(j), lower = f.l.row(j + 1).head(j);
    f.l.row(j).head(j) = (lower - slope * upper).transpose();
    f.l.row(j + 1).head(j) = (eta * upper + lambda * lower).transpose();
    f.l(j + 1, j) = lambda;
    const Index below = f.l.rows() - j - 2;
    f.l.col(j).tail(below).swap(f.l.col(j + 1).tail(below));
    f.z.col(j).swap(f.z.col(j + 1));
}

// Until no exchange of neighbours makes the later one more certain.
void decorrelate(Decorrelation& f) {
    constexpr double worth_it = 1 - 1e-6;
    const Index n = f.l.rows();
    Index reduced_from = n - 2;
    for (Index j = n - 2; j >= 0;) {
        if (j <= reduced_from)
            for (Index i = j + 1; i < n; ++i)
                reduce(f, i, j);
        const double variance = f.d(j) + f.l(j + 1, j) * f.l(j + 1, j) * f.d(j + 1);
        if (variance < worth_it * f.d(j + 1)) {
            exchange(f, j, variance);
            reduced_from = j;
            j = n - 2;
        } else {
            --j;
        }
    }
}

// Whole numbers around a centre, the nearest first, then alternately on both sides.
struct Alternating {
    double centre = 0, value = 0, step = 0;

    void begin(double at) {
        centre = at;
        value = std::round(at);
        step = at >= value ? 1 : -1;
    }
    void next() {
        value += step;
        step = -step - (step > 0 ? 1 : -1);
    }
    [[nodiscard]] double off() const { return centre - value; }
};

// The two best so far.
struct Found {
    std::array<VectorXd, 2> vectors;
    std::array<double, 2> norms{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

    void take(const VectorXd& vector, double norm) {
        if (norm >= norms[1]) return;
        norms[1] = norm;
        vectors[1] = vector;
        if (norms[1] >= norms[0]) return;
        std::swap(norms[0], norms[1]);
        std::swap(vectors[0], vectors[1]);
    }
};

// From the last, most certain one to the first, within the ellipsoid of the second best.
class Search {
public:
    Search(const Decorrelation& f, const VectorXd& floats)
        : f_(f), floats_(floats), level_(static_cast<std::size_t>(f.l.rows())), distance_(VectorXd::Zero(f.l.rows())) {}

    std::optional<Found> run() {
        constexpr int longest = 200'000;
        const Index n = f_.l.rows();
        Index k = n - 1;
        enter(k);
        for (int steps = 0; steps < longest; ++steps) {
            Alternating& here = level_[static_cast<std::size_t>(k)];
            const double norm = distance_(k) + here.off() * here.off() / f_.d(k);
            if (norm < found_.norms[1]) {
                if (k > 0) {
                    --k;
                    distance_(k) = norm;
                    enter(k);
                    continue;
                }
                found_.take(present(), norm);
                here.next();
                continue;
            }
            if (k == n - 1) return found_;
            ++k;
            level_[static_cast<std::size_t>(k)].next();
        }
        return std::nullopt;
    }

private:
    [[nodiscard]] VectorXd present() const {
        VectorXd values(f_.l.rows());
        for (Index i = 0; i < values.size(); ++i)
            values(i) = level_[static_cast<std::size_t>(i)].value;
        return values;
    }
    // The centre of one, given those that come after it.
    void enter(Index k) {
        double centre = floats_(k);
        for (Index i = k + 1; i < floats_.size(); ++i)
            centre -= f_.l(i, k) * level_[static_cast<std::size_t>(i)].off();
        level_[static_cast<std::size_t>(k)].begin(centre);
    }

    const Decorrelation& f_;
    const VectorXd& floats_;
    std::vector<Alternating> level_;
    VectorXd distance_;  // of those after each
    Found found_;
};

double bootstrapped_success(const VectorXd& variances) {
    double success = 1;
    for (const double variance : variances)
        success *= std::erf(0.5 / std::sqrt(2 * variance));
    return success;
}

}  // namespace

double IntegerCandidates::ratio() const {
    return best_norm > 0 ? second_norm / best_norm : std::numeric_limits<double>::infinity();
}

double IntegerCandidates::gap() const {
    constexpr double taken_by_place = 3, least_variance = 0.35;
    const double free = std::max(1.0, static_cast<double>(best.size()) - taken_by_place);
    return (second_norm - best_norm) / std::max(least_variance, best_norm / free);
}

double IntegerCandidates::misfit() const { return best_norm / static_cast<double>(best.size()); }

std::optional<IntegerCandidates> search_integers(const VectorXd& floats, const MatrixXd& covariance) {
    Decorrelation f;
    if (floats.size() == 0 || !floats.allFinite() || !factorise(covariance, f)) return std::nullopt;
    decorrelate(f);
    // The whole part is put back after: products of large numbers must not blur the rest.
    const VectorXd whole = floats.array().round();
    const VectorXd rest = f.z.transpose() * (floats - whole);
    const std::optional<Found> found = Search(f, rest).run();
    if (!found || !std::isfinite(found->norms[1])) return std::nullopt;
    const Eigen::PartialPivLU<MatrixXd> back(f.z.transpose());
    const auto in_cycles = [&](const VectorXd& z) { return VectorXd(whole + VectorXd(back.solve(z).array().round())); };
    IntegerCandidates candidates{in_cycles(found->vectors[0]), in_cycles(found->vectors[1]), found->norms[0],
                                 found->norms[1], bootstrapped_success(f.d)};
    return candidates;
}

}  // namespace skyloop::inline receiver
