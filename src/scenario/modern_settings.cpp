#include "skyloop/scenario/modern_settings.hpp"

namespace skyloop {
namespace {

// A geodetic receiver with a choke-ring antenna (Ashtech, Trimble): narrow correlators, a steered clock, no filter.
void make_survey(ModernSettings& s) {
    s.measurement.code_loop.bandwidth = Hertz(0.25);
    s.measurement.code_loop.spacing_chips = 0.1;
    s.measurement.code_loop.front_end_bandwidth = Hertz(20e6);
    s.measurement.clock.steering = ClockSteering::continuous;
    s.measurement.cn0_resolution = Decibels(0.25);
    s.measurement.multipath_model = {Metres(0.10), Metres(0.30), Seconds(90), Seconds(5)};
    s.navigation.filter.kind = FilterKind::none;
    s.navigation.weights = {Metres(0.5), Metres(0.5)};
}

// A u-blox 6 to M8 with a patch antenna.
void make_consumer(ModernSettings& s) {
    s.measurement.clock.steering = ClockSteering::millisecond_jumps;
    s.measurement.multipath_model = {Metres(0.5), Metres(1.0), Seconds(120), Seconds(5)};
    s.navigation.filter.kind = FilterKind::smoothed;
}

// A linearly polarised antenna behind glass and a hand: 10 dB less, and echoes of either hand.
void make_phone(ModernSettings& s) {
    s.propagation.link.antenna = AntennaPattern(Decibels(-4), Decibels(9), 1.0);
    s.propagation.link.implementation_loss = Decibels(3.5);
    s.propagation.link.ripple = Decibels(2);
    s.propagation.link.ripple_time = Seconds(10);
    s.measurement.clock.steering = ClockSteering::millisecond_jumps;
    s.measurement.multipath_model = {Metres(3), Metres(4), Seconds(30), Seconds(3)};
    s.measurement.slips_per_hour = 60;
    s.navigation.filter.kind = FilterKind::smoothed;
    s.navigation.weights = {Metres(3), Metres(3)};
}

}  // namespace

ModernSettings::ModernSettings() { make_consumer(*this); }

ModernSettings ModernSettings::of(ModernPreset preset, Surroundings surroundings) {
    ModernSettings settings;
    settings.navigation = {};
    settings.measurement = {};
    settings.preset = preset;
    settings.surroundings = surroundings;
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
    return settings;
}

std::vector<NamedTerm> error_terms(ModernSettings& settings) {
    ModernPropagationParameters& p = settings.propagation;
    MeasurementParameters& m = settings.measurement;
    return {{"signal_in_space", &p.signal_in_space},
            {"ionosphere", &p.ionosphere},
            {"ionosphere_residual", &p.ionosphere_residual},
            {"troposphere", &p.troposphere},
            {"troposphere_residual", &p.troposphere_residual},
            {"gas", &p.gas},
            {"clouds", &p.clouds},
            {"rain", &p.rain},
            {"foliage", &p.foliage},
            {"antenna", &p.antenna},
            {"satellite_power", &p.satellite_power},
            {"scintillation", &p.scintillation},
            {"interference", &p.interference},
            {"code_noise", &m.code_noise},
            {"phase_noise", &m.phase_noise},
            {"doppler_noise", &m.doppler_noise},
            {"multipath", &m.multipath},
            {"receiver_clock", &m.receiver_clock},
            {"cycle_slips", &m.cycle_slips}};
}

ModernSettings effective(ModernSettings settings) {
    if (!settings.errors)
        for (const NamedTerm& named : error_terms(settings))
            named.term->enabled = false;
    CorrectionParameters& c = settings.navigation.corrections;
    const bool air = settings.propagation.troposphere.factor() != 0;
    const bool plasma = settings.propagation.ionosphere.factor() != 0;
    c.ionosphere = settings.ionosphere_correction.value_or(plasma ? c.ionosphere : IonosphereCorrection::none);
    c.troposphere = settings.troposphere_correction.value_or(air ? c.troposphere : TroposphereCorrection::none);
    return settings;
}

}  // namespace skyloop
