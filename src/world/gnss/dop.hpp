/// Dilution of precision.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "base/core/units.hpp"

namespace skyloop::inline world {

/// Dilutions of precision, dimensionless, and the cofactor matrix's variances east, north, up (MODELS.md 3.9). Not a
/// number: unknown, since the satellites do not tell of that direction.
struct Dop {
    double gdop = 0, pdop = 0, hdop = 0, vdop = 0, tdop = 0, edop = 0, ndop = 0;
};

/// A direction in the sky.
struct SkyDirection {
    Angle azimuth;
    Angle elevation;
};

/// The cofactor matrix Q = (HᵀH)⁻¹ of position and one clock from unit weights, rows east, north, up, clock; H has rows
/// (cos el sin az, cos el cos az, sin el, 1). Nothing for fewer than four directions or a singular geometry.
std::optional<Eigen::Matrix4d> cofactor_matrix(std::span<const SkyDirection> satellites);

/// DOP of position and one clock from unit weights: Q = (HᵀH)⁻¹ with rows (cos el sin az, cos el cos az, sin el, 1).
/// Nothing for fewer than four directions or a singular geometry.
std::optional<Dop> dilution_of_precision(std::span<const SkyDirection> satellites);

}  // namespace skyloop::inline world
