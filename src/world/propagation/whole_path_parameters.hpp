/// One gaseous attenuation for the whole path, with the numbers of ITU-R P.676 at L1.
#pragma once

namespace skyloop {

/// Zenith attenuation as sea-level specific attenuation times equivalent height (MODELS.md section 6).
///
/// The equivalent heights are those of P.676, so the specific attenuations are too, and not the article's rational
/// formulas: P.676-13 annex 1 at 1575.42 MHz, 1013.25 hPa of dry air, 288.15 K. The vapour's is taken in proportion to
/// the density; what that leaves out, vapour that broadens its own lines, is about 1e-4 dB at the zenith.
struct WholePathParameters {
    double oxygen_height_km = 5.35;
    double vapour_height_km = 1.84;
    double vapour_g_m3 = 7.5;
    double oxygen_db_per_km = 6.3883e-3;
    double vapour_db_per_km_per_g_m3 = 1.68767e-5;
};

}  // namespace skyloop
