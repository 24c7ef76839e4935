/// Every number of the modern profile's propagation, with the switch, scale and seed of each cause.
#pragma once

#include <optional>
#include <vector>

#include "base/core/random.hpp"
#include "base/core/units.hpp"
#include "world/gnss/atmosphere.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/shell_ionosphere.hpp"
#include "world/gnss/signal.hpp"
#include "world/propagation/antenna_and_noise.hpp"
#include "world/propagation/channel_parameters.hpp"
#include "world/propagation/surroundings_stretch.hpp"

namespace skyloop::inline world {

/// How far orbits and clocks are from what is broadcast: 1 σ of the user's range error of each system, SISRE
/// (MODELS.md 7.1).
struct SignalInSpaceParameters {
    Metres gps{0.35};
    Metres sbas{0.8};
    Metres galileo{0.20};
    Metres beidou2{1.2};   ///< C01 … C18
    Metres beidou3{0.45};  ///< from C19
    Metres qzss{0.8};
    Metres glonass{1.5};
    Metres navic{1.2};
    Seconds correlation_time{7200};
};

/// What the true ionosphere is taken from (MODELS.md 7.2).
enum class IonosphereModel {
    klobuchar,  ///< the broadcast model of GPS
    ntcm_g,     ///< the closed model that Galileo's broadcast drives
    nequick_g,  ///< the three-dimensional model that Galileo's broadcast drives
    ionex,      ///< maps
    constant,   ///< one vertical content, everywhere and always
};

/// Whether something is done, where the program may decide by itself.
enum class Choice { automatic, on, off };

/// What travels through the ionosphere (IonosphereWaves), and how much of it.
struct IonosphereWaveParameters {
    Tecu content{0.35};          ///< 1 σ, vertical; 0: a calm ionosphere
    MetresPerSecond speed{120};  ///< of waves and irregularities
};

/// The true ionosphere and how it departs from its model (MODELS.md 7.2).
struct IonosphereParameters {
    IonosphereModel model = IonosphereModel::ntcm_g;
    /// Where the navigation data has none: GPS's broadcast of 1 January 2004.
    KlobucharCoefficients klobuchar{{0.1118e-7, -0.7451e-8, -0.5961e-7, 0.1192e-6},
                                    {0.1167e6, -0.2294e6, -0.1311e6, 0.1049e7}};
    /// Where the navigation data has none: that of a day like the one of the Klobuchar coefficients above, for the two
    /// stand for one Sun. Half of the middle set of the benchmark of the Galileo ionosphere document, Azpar 72: the
    /// mean of the vertical delays of NTCM-G is then 3.1 m at L1, that of Klobuchar's model 2.6 m, and they differ
    /// by 1.2 m rms (60° S to 60° N, all hours of a day in March). The whole of it, a medium Sun, has 5.9 m and differs
    /// by 4.2 m.
    EffectiveIonisation ionisation{60.565, 0.1756, 0.006732};
    Tecu constant_content{20};  ///< vertical
    /// The stochastic residual. Automatic: unless the receiver corrects with another model than the true one, which
    /// leaves a residual by itself.
    Choice residual = Choice::automatic;
    double common = 0.28;    ///< 1 σ, of the delay
    double gradient = 0.14;  ///< 1 σ north and east, of the delay, where the pierce point lies 9° away
    Seconds common_time{7200};
    double single = 0.05;  ///< 1 σ of each satellite by itself, of the delay
    Seconds single_time{1800};
    IonosphereWaveParameters waves{};  ///< beside it, whatever the receiver corrects with
};

/// Where the air at the antenna comes from (MODELS.md 7.3).
enum class WeatherSource {
    standard,  ///< the standard atmosphere and a relative humidity, as receivers assume it
    gpt,       ///< pressure and temperature of the climate, and a relative humidity
    given,     ///< pressure, temperature and relative humidity at the antenna
    p835,      ///< mean annual global reference atmosphere
};

/// How zenith delays become slant delays.
enum class TroposphereMappingModel {
    niell,
    gmf,
    vmf1,      ///< with given a_h and a_w at the height of the antenna
    cosecant,  ///< 1/sin e
};

/// The true troposphere and how its vapour wanders (MODELS.md 7.3).
struct TroposphereParameters {
    WeatherSource weather = WeatherSource::standard;
    double relative_humidity = 0.5;      ///< 0 … 1; of all weathers but p835
    double pressure_hpa = 1013.25;       ///< of `given`, at the antenna
    Kelvin temperature{288.15};          ///< of `given`, at the antenna
    double sea_level_vapour_g_m3 = 7.5;  ///< of p835
    TroposphereMappingModel mapping = TroposphereMappingModel::niell;
    Vmf1Coefficients vmf1{1.25e-3, 5.8e-4};
    Metres gradient_north{0};  ///< delay per 1/(sin e tan e + 0.0032)
    Metres gradient_east{0};

    /// 1 σ of the wet delay at the zenith in a field over the globe (WetField); that of C_n = 2.4·10⁻⁷ m^(−1/3).
    Metres residual{0.036};
    Metres residual_in_rain{0.042};
    Metres residual_in_thunderstorm{0.047};  ///< from `thunderstorm_rain` or with a deck of that name
    MetresPerSecond wind{8};                 ///< by which the field drifts
    double thunderstorm_rain_mm_h = 50;
};

/// Losses on the way that the atmosphere's own parameters do not tell (MODELS.md 7.5).
struct LossParameters {
    Metres rain_cell{20000};  ///< horizontal extent of the rain towards any side
    /// Trees all around: depth of the crowns that a level ray crosses. 0: none.
    Metres canopy_depth{0};
    double canopy_density = 1;              ///< share of that depth that is leaves and branches, 0 … 1
    Angle canopy_top = Angle::degrees(35);  ///< elevation up to which crowns stand
    double canopy_db_per_m = 0.8;           ///< 0.6 … 1.0 at L1
    Decibels most_foliage{12};
    Decibels antenna_film{0};  ///< of water or ice on the antenna, 0 … 3 dB
};

/// Powers, noise and jamming (MODELS.md 7.7, 7.8).
struct ModernLinkParameters {
    /// Received in an isotropic antenna on the ground, at every elevation, from the nominal orbit of the system.
    struct ReceivedPower {
        DecibelWatts gps{-157.0};
        DecibelWatts sbas{-158.0};
        DecibelWatts galileo{-156.5};
        DecibelWatts beidou{-157.0};
        DecibelWatts qzss{-157.0};
        DecibelWatts glonass{-158.0};
        DecibelWatts navic{-157.5};
    } received;
    /// Where it has points, all satellites send by it and distance counts in full; linear between ascending angles,
    /// constant beyond.
    std::vector<SatellitePowerPoint> satellite_pattern;
    AntennaPattern antenna;
    ReceiverNoise noise;
    Decibels implementation_loss{2.5};
    Decibels platform_noise{0};                ///< over N0: vehicle 1 … 3, poor installation 3 … 8
    std::optional<NoiseEnvironment> man_made;  ///< of P.372, extrapolated to the carrier
    Decibels satellite_spread{1.5};            ///< 1 σ, constant of each satellite
    Decibels ripple{0.5};                      ///< 1 σ, of each satellite
    Decibels ripple_at_horizon{0};             ///< what comes to it there, times exp(−e/20°): echoes of the ground
    Seconds ripple_time{60};
    /// A jammer of one received power: J over −157 dBW, the nominal signal in an isotropic antenna.
    std::optional<Decibels> jammer_to_signal;
    JammerKind jammer = JammerKind::matched;
};

/// Irregularities of the ionosphere (MODELS.md 7.11).
struct ScintillationParameters {
    double s4 = 0;      ///< amplitude index at L1 towards the zenith, 0 … 0.7
    Angle sigma_phi{};  ///< 1 σ of the phase at L1 towards the zenith
    /// The indices above are those of the worst hour under the crests of the equatorial anomaly; elsewhere and at
    /// other hours they fade.
    bool equatorial_evening = false;
    double evening_peak_h = 21;             ///< local time
    double evening_width_h = 2;             ///< 1 σ
    Angle crest = Angle::degrees(30);       ///< modified dip latitude of the crests, either side
    Angle crest_width = Angle::degrees(8);  ///< 1 σ, towards the poles; between the crests half is left
};

/// Which of the values of SignalInSpaceParameters or ReceivedPower, one for each system, is that of a satellite.
template <class Values>
auto of_system(const Values& values, SatelliteId satellite) {
    switch (satellite.constellation) {
        case Constellation::sbas:
            return values.sbas;
        case Constellation::galileo:
            return values.galileo;
        case Constellation::beidou:
            if constexpr (requires { values.beidou; })
                return values.beidou;
            else
                return satellite.number <= 18 ? values.beidou2 : values.beidou3;
        case Constellation::qzss:
            return values.qzss;
        case Constellation::glonass:
            return values.glonass;
        case Constellation::navic:
            return values.navic;
        case Constellation::gps:
            break;
    }
    return values.gps;
}

/// All of it.
struct ModernPropagationParameters {
    SignalInSpaceParameters signal_in_space_model;
    IonosphereParameters ionosphere_model;
    TroposphereParameters troposphere_model;
    LossParameters loss_model;
    ChannelParameters channel_model;
    std::vector<SurroundingsStretch> stretches;  ///< with surroundings of their own
    ModernLinkParameters link;
    ScintillationParameters scintillation_model;

    ErrorTerm signal_in_space;
    ErrorTerm satellite_antenna, receiver_antenna;  ///< phase centres; with precise products
    ErrorTerm wind_up, solid_tide;                  ///< the same
    ErrorTerm ionosphere;                           ///< the model's delay, and with it the residual
    ErrorTerm ionosphere_residual;                  ///< what departs from the model
    ErrorTerm troposphere;                          ///< the model's delay
    ErrorTerm troposphere_residual;
    ErrorTerm gas, clouds, rain, foliage;
    ErrorTerm channel;          ///< shadowing and echoes of the surroundings
    ErrorTerm antenna;          ///< gain and film; off: an isotropic antenna
    ErrorTerm satellite_power;  ///< spread and ripple
    ErrorTerm scintillation;
    ErrorTerm interference;
};

}  // namespace skyloop::inline world
