#include "run/scenario/modern_settings.hpp"

#include <algorithm>

namespace skyloop::inline run {
namespace {

struct MultipathNumbers {
    Metres floor, at_horizon;
    Seconds static_time, horizon_time{0};
};

void set_multipath(ModernSettings& s, const MultipathNumbers& numbers) {
    s.measurement.multipath_model.floor = numbers.floor;
    s.measurement.multipath_model.at_horizon = numbers.at_horizon;
    s.measurement.multipath_model.static_time = numbers.static_time;
    s.measurement.multipath_model.horizon_time = numbers.horizon_time;
}

void set_weights(ModernSettings& s, Metres both) {
    s.navigation.weights.floor = both;
    s.navigation.weights.at_zenith = both;
}

// A geodetic receiver with a choke-ring antenna: carrier-aided narrow correlators, a steered clock, no filter.
void make_survey(ModernSettings& s) {
    s.measurement.code_loop.bandwidth = Hertz(0.2);
    s.measurement.code_loop.spacing_chips = 0.1;
    s.measurement.code_loop.front_end_bandwidth = Hertz(20e6);
    s.measurement.clock.steering = ClockSteering::continuous;
    s.measurement.cn0_resolution = Decibels(0.25);
    s.propagation.link.ripple_at_horizon = Decibels(1);
    set_multipath(s, {Metres(0.27), Metres(0.95), Seconds(22)});
    s.navigation.filter.kind = FilterKind::none;
    set_weights(s, Metres(0.36));
}

// A u-blox 6 to M8 with a patch antenna.
void make_consumer(ModernSettings& s) {
    s.measurement.clock.steering = ClockSteering::millisecond_jumps;
    s.propagation.link.antenna = AntennaPattern(Decibels(3.4), Decibels(19.5), 1.3);
    s.propagation.link.ripple_at_horizon = Decibels(6);
    s.propagation.link.ripple_time = Seconds(20);
    set_multipath(s, {Metres(0.64), Metres(7.5), Seconds(15), Seconds(250)});
    s.navigation.filter.position_memory = Seconds(20);
    s.navigation.weights.floor = Metres(0.42);
    s.navigation.weights.at_zenith = Metres(0.7);
    s.navigation.use.from = DbHz(25);
}

// A linearly polarised antenna behind glass and a hand: 7 dB less towards the zenith, and echoes of either hand.
void make_phone(ModernSettings& s) {
    s.propagation.link.antenna = AntennaPattern(Decibels(-9.5), Decibels(9), 1.0);
    s.propagation.link.implementation_loss = Decibels(3.8);
    s.propagation.link.ripple = Decibels(2);
    s.propagation.link.ripple_time = Seconds(10);
    s.measurement.clock.steering = ClockSteering::millisecond_jumps;
    set_multipath(s, {Metres(6.6), Metres(4), Seconds(0.3)});
    s.measurement.doppler_window = Seconds(0.15);
    s.measurement.multipath_model.phase_ratio = 0.0002;
    // Its tracking sleeps for most of each second: a third of the epochs of the phase begin anew.
    s.measurement.slips_per_hour = 1500;
    s.navigation.filter.hold_below = MetresPerSecond(0.5);
    s.navigation.accuracy.position_scale = 0.45;
    s.navigation.filter.velocity_rest_memory = Seconds(5);
    s.navigation.use.within = Decibels(12);
    s.navigation.filter.position_memory = Seconds(20);
    set_weights(s, Metres(3));
}

// Crowns of trees up to 35° and walls whose echoes last while a satellite moves by a degree or less. An antenna that
// keeps echoes off in the open keeps them off here: the multipath grows by the same factors for all receivers.
void surround_by_houses(ModernSettings& s) {
    constexpr double floor_growth = 3.3, horizon_growth = 0.65;
    s.propagation.loss_model.canopy_depth = Metres(11);
    StatisticalMultipath& m = s.measurement.multipath_model;
    m.floor = floor_growth * m.floor;
    m.at_horizon = horizon_growth * m.at_horizon;
    m.static_time = Seconds(100);
    m.horizon_time = Seconds(0);
}

}  // namespace

ModernSettings ModernSettings::of(ModernPreset preset, Surroundings surroundings) {
    ModernSettings settings;
    settings.preset = preset;
    settings.surroundings = surroundings;
    // A receiver that has heard no coefficients takes those of an ordinary day.
    settings.navigation.corrections.default_ionosphere = true;
    // NTCM-G, which the true ionosphere follows by default, would leave Galileo alone without an ionospheric error.
    settings.navigation.corrections.ionosphere = IonosphereCorrection::klobuchar;
    switch (preset) {
        case ModernPreset::survey:
            make_survey(settings);
            break;
        case ModernPreset::consumer:
            make_consumer(settings);
            break;
        case ModernPreset::phone:
            make_phone(settings);
            break;
    }
    if (surroundings == Surroundings::residential) surround_by_houses(settings);
    settings.propagation.channel_model = channel_of(surroundings);
    return settings;
}

std::vector<NamedTerm> error_terms(ModernSettings& settings) {
    ModernPropagationParameters& p = settings.propagation;
    MeasurementParameters& m = settings.measurement;
    return {{"signal_in_space", &p.signal_in_space, "orbit and clock of the satellite against what it broadcasts"},
            {"satellite_antenna", &p.satellite_antenna, "phase centres of the satellites; with sky.antennas"},
            {"receiver_antenna", &p.receiver_antenna, "phase centre of the receiver; with receiver.antenna_type"},
            {"wind_up", &p.wind_up, "phase of antennas that turn against each other; with sky.orbits"},
            {"solid_tide", &p.solid_tide, "the solid Earth's tides under the antenna; with sky.orbits"},
            {"ionosphere", &p.ionosphere, "delay of the true ionosphere, and with it the residual"},
            {"ionosphere_residual", &p.ionosphere_residual,
             "how the day departs from the model of the truth, and disturbances that travel"},
            {"troposphere", &p.troposphere, "delay of the air"},
            {"troposphere_residual", &p.troposphere_residual, "turbulent vapour that drifts by"},
            {"gas", &p.gas, "loss in oxygen and vapour"},
            {"clouds", &p.clouds, "loss in clouds"},
            {"rain", &p.rain, "loss in rain"},
            {"foliage", &p.foliage, "loss in trees"},
            {"channel", &p.channel, "what surroundings without a scene do: shadowing, fading, echoes"},
            {"antenna", &p.antenna, "gain of the receiving antenna less the film on it"},
            {"satellite_power", &p.satellite_power, "spread between satellites, and its ripple"},
            {"scintillation", &p.scintillation, "restless ionosphere: fading, noise of the loops, loss of lock"},
            {"interference", &p.interference, "what a jammer takes from C/N0"},
            {"code_noise", &m.code_noise, "of the code loop"},
            {"phase_noise", &m.phase_noise, "of the phase loop"},
            {"doppler_noise", &m.doppler_noise, "of the frequency loop"},
            {"multipath", &m.multipath, "echoes, in the code and a hundredth of it in the carrier"},
            {"receiver_biases", &m.receiver_biases, "delays of its filters, by system and by channel of GLONASS"},
            {"receiver_clock", &m.receiver_clock, "bias and drift of the oscillator"},
            {"cycle_slips", &m.cycle_slips, "breaks of the carrier's count and unresolved half cycles"}};
}

// What corrections from outside leave of each error. Both ends of a baseline see the same orbits, clocks and air; with
// carrier phases the receiver's own noise and echoes are those of the carrier. The Doppler is its own in any case.
void apply_differential(ModernSettings& s) {
    const DifferentialKind kind = s.navigation.differential.kind;
    if (kind == DifferentialKind::none) return;
    // What is left of the ionosphere is what the corrections from outside did not take.
    s.ionosphere_correction = IonosphereCorrection::none;
    const bool sbas = kind == DifferentialKind::sbas;
    const double common = sbas ? s.navigation.differential.sbas_left : 0;
    for (ErrorTerm* term : {&s.propagation.signal_in_space, &s.propagation.ionosphere})
        term->scale *= common;
    if (sbas) return;  // which leaves the troposphere and the antenna's surroundings to the receiver
    s.troposphere_correction = TroposphereCorrection::none;
    for (ErrorTerm* term : {&s.propagation.troposphere, &s.propagation.troposphere_residual})
        term->scale = 0;
    const double own = kind == DifferentialKind::rtk_float ? 0.15 : 0.008;
    for (ErrorTerm* term : {&s.measurement.multipath, &s.measurement.code_noise})
        term->scale *= own;
}

ModernSettings effective(ModernSettings settings) {
    apply_differential(settings);
    if (!settings.errors) {
        for (const NamedTerm& named : error_terms(settings))
            named.term->enabled = false;
        // A filter has errors of its own: it follows a turn a little late.
        settings.navigation.filter.kind = FilterKind::none;
    }
    settings.measurement.scintillation = settings.propagation.scintillation;
    CorrectionParameters& c = settings.navigation.corrections;
    const bool air = settings.propagation.troposphere.factor() != 0;
    const bool plasma = settings.propagation.ionosphere.factor() != 0;
    c.ionosphere = settings.ionosphere_correction.value_or(plasma ? c.ionosphere : IonosphereCorrection::none);
    c.troposphere = settings.troposphere_correction.value_or(air ? c.troposphere : TroposphereCorrection::none);
    // A receiver that is told to leave the air alone knows that it is there.
    AccuracyParameters& a = settings.navigation.accuracy;
    a.whole_ionosphere = plasma && c.ionosphere == IonosphereCorrection::none;
    a.whole_troposphere = air && c.troposphere == TroposphereCorrection::none;
    return settings;
}

}  // namespace skyloop::inline run
