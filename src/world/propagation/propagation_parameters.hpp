/// The air that signals cross: every number of the layered atmosphere, with the article's defaults.
/// The powers of the link between a satellite and the antenna, with the article's defaults.
/// One gaseous attenuation for the whole path, with the numbers of ITU-R P.676 at L1.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/core/units.hpp"

namespace skyloop::inline world {

/// How the equivalent concentration k of a layer is taken (MODELS.md 3.6).
enum class ConcentrationMode {
    mean,      ///< the mean of exp(−h/H) over the layer
    midpoint,  ///< its value in the middle of the layer
    fixed,     ///< a given number
};

/// One uniform shell of air.
struct AtmosphericLayer {
    std::string name;
    Metres base;
    Metres top;
    double vapour_g_m3 = 0;
    bool enabled = true;
    ConcentrationMode concentration = ConcentrationMode::mean;
    double fixed_concentration = 1.0;  ///< used in mode `fixed`
};

/// A deck of cloud: no shape, no refraction, a density over a thickness.
struct CloudDeck {
    std::string kind;
    Metres base;
    Metres top;
    double density_g_m3 = 0;
};

enum class RainModel {
    p838,       ///< ITU-R P.838-3
    as_vapour,  ///< liquid water 0.072 R^0.88 g/m³ in the vapour formula (MODELS.md D-14)
};

struct Rain {
    double rate_mm_h = 0;
    Metres top{4000};
    RainModel model = RainModel::p838;
};

/// Where the total electron content comes from (MODELS.md D-15).
enum class TecSource {
    automatic,  ///< the broadcast coefficients when there are any, else the constant
    header,
    constant,
    ionex,  ///< maps, of a file
};

/// The atmosphere of the baseline profile (MODELS.md 3.6–3.8, 3.11).
struct AtmosphereParameters {
    Kelvin sea_level_temperature{288.15};
    double gravity_mps2 = 9.80665;
    double molar_mass_kg_per_mol = 0.0289644;
    double gas_constant = 8.314462618;     ///< J/(mol K)
    Metres earth_radius{6371000};          ///< of the spherical shells
    double oxygen_constant = 0.277;        ///< GHz²; as printed, 0.227 in the primary source
    std::vector<AtmosphericLayer> layers;  ///< empty: default_layers()
    std::vector<CloudDeck> clouds;
    bool clouds_apply_concentration = false;
    Rain rain;

    TecSource tec_source = TecSource::automatic;
    Tecu total_electron_content{30.86};     ///< vertical
    Decibels ionosphere_loss{0};            ///< constant part of L_iono, below the base
    Decibels riometer_absorption_30mhz{0};  ///< zenith absorption at 30 MHz; scaled by (30 MHz/f)²/sin e′
    Metres ionosphere_base{60000};          ///< where e′ is taken: the ionosphere absorbs there, and not above

    Metres zenith_dry_delay{2.3};  ///< a of E_z,dry = a exp(−b h)
    double zenith_dry_decay_per_m = 0.116e-3;
    Metres zenith_wet_delay{0};

    Decibels environment_noise{1};  ///< over the thermal noise, 1 (countryside) … 40 (industrial area)
};

/// Troposphere, stratosphere, mesosphere and thermosphere of MODELS.md 3.6.
std::vector<AtmosphericLayer> default_layers();

/// Kinds of cloud with their density and default heights (MODELS.md A.7), in order of density.
const std::vector<CloudDeck>& cloud_catalogue();

/// A named environment and its noise over thermal (MODELS.md D-07).
struct Environment {
    std::string_view name;
    Decibels noise;
};
/// countryside 1, village 5, suburb 12, city 20, dense-city 30, industrial 40 dB.
const std::vector<Environment>& environment_catalogue();

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
    int max_reflections = 16;                       ///< a path with more is no path
};

/// Zenith attenuation as sea-level specific attenuation times equivalent height (MODELS.md section 6).
///
/// The equivalent heights are those of P.676, so the specific attenuations are too, and not the article's rational
/// formulas: P.676-13 annex 1 at 1575.42 MHz and 288.15 K. The heights are of a total pressure of 1013.25 hPa, of which
/// 7.5 g/m³ of vapour have 9.97 hPa, and annex 1 takes the rest, the dry air's. The vapour's is taken in proportion to
/// the density; what that leaves out, vapour that broadens its own lines, is about 1e-4 dB at the zenith.
struct WholePathParameters {
    double oxygen_height_km = 5.35;
    double vapour_height_km = 1.84;
    double vapour_g_m3 = 7.5;
    double oxygen_db_per_km = 6.2788e-3;
    double vapour_db_per_km_per_g_m3 = 1.67379e-5;
};

}  // namespace skyloop::inline world
