/// Statistics of the land mobile satellite channel in two states.
#pragma once

#include <span>

#include "base/core/units.hpp"

namespace skyloop::inline world {

/// Surroundings that Recommendation ITU-R P.681-11 has measured at 1.5 to 3 GHz.
enum class P681Environment { urban, suburban, village, wooded, residential };

/// One state (P.681-11, section 6.2 and Annex 2). Its durations are log-normal, at least `shortest_m`; the mean
/// attenuation of the direct signal in an event is normal, and with it go the spread of the shadowing and the power of
/// the diffuse part. All dB are against an open sky.
struct P681State {
    double duration_mu, duration_sigma;  ///< of ln metres
    double shortest_m;
    double mean_db, mean_sigma_db;         ///< of M_A, negative: weaker than an open sky
    double diffuse_slope, diffuse_db;      ///< h1, h2: MP = h1 M_A + h2
    double shadowing_slope, shadowing_db;  ///< g1, g2: Σ_A = g1 M_A + g2
    /// Mean of the durations, of which those below `shortest_m` are drawn again, m.
    [[nodiscard]] double mean_duration_m() const;
};

/// Both states at one elevation.
struct P681Row {
    double elevation_deg;
    P681State good, bad;
    double correlation_m;        ///< L_corr of the shadowing
    double ramp_per_db, ramp_m;  ///< f1, f2: a change of state takes f1 |ΔM_A| + f2 metres
    /// Share of the distance in the bad state.
    [[nodiscard]] double bad_share() const;
};

/// The rows of an environment, ascending in elevation. Digits as published in two public transcriptions of the
/// Recommendation's tables (Simu5G 09b21e3b, NtnChannelModel.cc; getLMSParamsP681 of MATLAB); village and residential
/// are in the second one alone.
std::span<const P681Row> p681_rows(P681Environment environment);

}  // namespace skyloop::inline world
