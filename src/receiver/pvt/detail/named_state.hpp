/// The state of a Kalman filter whose parts come and go.
#pragma once

#include <Eigen/Core>

#include <compare>
#include <functional>
#include <vector>

#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline receiver {

/// One part of the state.
struct StateName {
    enum class Kind { place_x, place_y, place_z, wet, ionosphere, ambiguity };
    Kind kind = Kind::place_x;
    SatelliteId satellite{};
    Signal signal{};
    auto operator<=>(const StateName&) const = default;
};

/// Values and their covariance. The place comes first.
class NamedState {
public:
    /// Parts that are not wanted go, others keep what is known of them, new ones have no value and their variance.
    /// @param wanted ascending
    void arrange(std::vector<StateName> wanted, const std::function<double(const StateName&)>& variance);
    [[nodiscard]] Eigen::Index size() const { return values.size(); }
    [[nodiscard]] const std::vector<StateName>& names() const { return names_; }
    /// Of a part that is there.
    [[nodiscard]] Eigen::Index index(const StateName& name) const;
    /// What was known of a part is forgotten.
    void restart(Eigen::Index part, double value, double variance);
    /// A part that returns to 0 with time. @param left of its value  @param variance without any knowledge
    void relax(Eigen::Index part, double left, double variance);
    /// Measurements `misfit = design · (true values − values) + noise`.
    void absorb(const Eigen::MatrixXd& design, const Eigen::VectorXd& misfit, const Eigen::MatrixXd& noise);

    Eigen::VectorXd values;
    Eigen::MatrixXd covariance;

private:
    std::vector<StateName> names_;  // ascending
};

}  // namespace skyloop::inline receiver
