/// The powers of the link between a satellite and the antenna, with the article's defaults.
#pragma once

#include "base/core/units.hpp"

namespace skyloop {

/// How the transmitted power is given (MODELS.md D-05).
enum class PowerMode {
    eirp,           ///< P_sat − L_s with P_sat the EIRP
    received_spec,  ///< P_sat − L_s replaced by the specified minimum
};

/// Powers and losses that do not depend on the air (MODELS.md 3.6, 3.11).
struct LinkBudgetParameters {
    PowerMode power_mode = PowerMode::eirp;
    DecibelWatts satellite_power{26.8};             ///< EIRP towards the Earth
    DecibelWatts specified_received_power{-158.5};  ///< IS-GPS-200, table 3-Va
    double thermal_noise_dbw_hz = -204.0;           ///< noise density, dBW/Hz: 10 log10(k_B · 290 K)
    Decibels reflection_loss{3.0103};               ///< of one wall: half of the power
};

}  // namespace skyloop
