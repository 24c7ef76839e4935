/// The sensor models that add errors to the truth, and their names.
/// Parameters of every sensor model that adds errors to the truth (MODELS.md sections 3, 4 and 6).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "base/core/units.hpp"

namespace skyloop::inline receiver {

/// Sensor models of the literature (MODELS.md sections 3 and 6).
enum class ErrorModelKind { ideal, constant_sigma, satellite_count, whole_path, refraction, baseline };

/// All of them, in the order in which people list them.
std::span<const ErrorModelKind> error_model_kinds();
/// "ideal", "constant-sigma", "satellite-count", "whole-path", "refraction", "baseline".
std::string_view error_model_name(ErrorModelKind kind);
std::optional<ErrorModelKind> error_model_from_name(std::string_view name);

/// Which satellites every sensor model may use.
struct SelectionParameters {
    Angle elevation_mask = Angle::degrees(5);  ///< at or above is used
};

/// How the spread over satellites becomes σ_uere (MODELS.md D-08).
enum class UereStatistic { sample_std, rms };

/// How the position noise is oriented (MODELS.md D-10).
enum class NoiseAxes {
    isotropic,   ///< variance E²/3 on each ECEF axis
    covariance,  ///< σ_uere² Q, rotated to ECEF
};

/// The article's sensor model: which satellites it uses, and how their delays become the spread of the position. The
/// powers are in LinkBudgetParameters, the air in AtmosphereParameters.
struct BaselineParameters {
    DbHz snr_cutoff{5};  ///< at or above is used
    UereStatistic statistic = UereStatistic::sample_std;
    double iono_fraction = 1.0;   ///< of the ionospheric delay that enters UERE; 0.5 in the calibrated preset
    double tropo_fraction = 1.0;  ///< of the tropospheric delay; 0.1 in the calibrated preset
    NoiseAxes axes = NoiseAxes::isotropic;
    static BaselineParameters strict() { return {}; }
    static BaselineParameters calibrated() {
        BaselineParameters p;
        p.iono_fraction = 0.5;
        p.tropo_fraction = 0.1;
        return p;
    }
};

struct ConstantSigmaParameters {
    Metres horizontal_sigma{3};  ///< of the horizontal vector; each axis has σ/√2
    Metres vertical_sigma{5};
};

/// Position σ per axis by the number of used satellites: 4, 5, 6, 7, 8, 9 or more.
struct SatelliteCountParameters {
    std::array<double, 6> sigma_m{12, 8, 5, 4, 3, 2.5};
};

/// Exponential refractivity N(h) = N₀ exp(−h/H); what remains of the excess path after correction is the error.
struct RefractionParameters {
    double surface_refractivity = 315;
    Metres scale_height{7350};
    double residual_fraction = 0.05;
};

}  // namespace skyloop::inline receiver
