#include <fmt/format.h>

#include <algorithm>

#include "detail/scenario_keys.hpp"

namespace skyloop::inline run {
namespace {

void read_terms(TableReader& modern, ModernSettings& settings) {
    modern.table("terms", "each cause of error by itself", [&](TableReader& terms) {
        for (const NamedTerm& named : error_terms(settings))
            terms.table(named.name, {named.meaning, ""}, [&](TableReader& table) {
                table.boolean("enabled", named.term->enabled,
                              "false leaves exactly no delay, loss or error of this cause");
                if (!settings.errors && table.has("enabled") && named.term->enabled)
                    table.mistake("enabled",
                                  "is true beside errors = \"none\", which switches every term off; expected "
                                  "one of the two");
                table.number("scale", named.term->scale, {0, 1000}, "of its delay, loss or error");
                table.integer(
                    "seed", named.term->seed, NumberRange::not_negative(),
                    {"random numbers of its own: other dice for this cause, the same for all others", "the run's"});
            });
    });
}

void read_clock(TableReader& table, ModernSettings& settings) {
    ReceiverClockParameters& clock = settings.measurement.clock;
    table.number("h0_s", clock.noise.h0, {0, 1e-10}, "white noise of the frequency, coefficient of the Allan variance");
    table.number("h_minus_2_per_s", clock.noise.h_minus_2, {0, 1e-10},
                 "random walk of the frequency, coefficient of the Allan variance");
    table.quantity("temperature_k", clock.temperature.deviation, {0, 100},
                   "σ of the oscillator's temperature; 0: constant");
    table.quantity("temperature_time_s", clock.temperature.correlation_time, {0, 1e6}, "its correlation time");
    table.number("frequency_per_k", clock.temperature.per_kelvin, {0, 1e-3}, "what it does to the frequency, relative");
    table.quantity("bias_m", clock.bias, {-3e8, 3e8}, "at the start, times the speed of light");
    table.word("steering",
               {{"free", ClockSteering::free_running},
                {"millisecond-jumps", ClockSteering::millisecond_jumps},
                {"continuous", ClockSteering::continuous}},
               clock.steering,
               {"free, whole milliseconds when the bias passes half of one, or within tens of ns",
                "millisecond-jumps; survey continuous"});
    table.where(
        clock.steering != ClockSteering::continuous,
        "with steering = \"free\" or \"millisecond-jumps\"; a clock that is steered continuously starts without drift",
        [&] {
            table.quantity("drift_mps", clock.drift, {-1e5, 1e5},
                           "at the start, times the speed of light; 0 with steering continuous");
        });
}

void read_tracking(TableReader& table, MeasurementParameters& p) {
    table.quantity("code_bandwidth_hz", p.code_loop.bandwidth, {0.001, 100}, {"of the code loop", "0.5; survey 0.2"});
    table.quantity("aiding_threshold_dbhz", p.aiding_threshold, {-100, 100},
                   "C/N0 from which the carrier aids the code loop");
    table.quantity("unaided_bandwidth_hz", p.unaided_bandwidth, {0.001, 100}, "of the code loop below it");
    table.number("code_spacing_chips", p.code_loop.spacing_chips, {0.01, 1.99},
                 {"early to late; of faster codes in proportion", "0.25; survey 0.1"});
    table.quantity("front_end_bandwidth_hz", p.code_loop.front_end_bandwidth, {1e5, 1e9},
                   {"two-sided; of codes above 1.023 Mchip/s at least twice their rate", "8e6; survey 20e6"});
    Seconds integration = p.code_loop.integration;
    table.quantity("integration_s", integration, {1e-4, 10}, "of all loops, before detection");
    p.code_loop.integration = p.phase_loop.integration = p.frequency_loop.integration = integration;
    table.quantity("phase_bandwidth_hz", p.phase_loop.bandwidth, {0.01, 1000}, "of the phase loop");
    table.quantity("frequency_bandwidth_hz", p.frequency_loop.bandwidth, {0.01, 1000}, "of the frequency loop");
    table.quantity(
        "doppler_window_s", p.doppler_window, {0, 10},
        {"of the carrier, whose change over it is the Doppler; 0: that of the frequency loop", "0.1; phone 0.15"});
    table.number("multipath_share", p.multipath_share, {0, 10},
                 "of the echoes' errors where there is no scene, that the correlators leave");
    table.quantity("multipath_smoothing_s", p.multipath_smoothing, {0, 1000},
                   "of these errors, by a code loop that the carrier aids; 0: none");
    table.quantity("range_deviation_floor_m", p.range_deviation_floor, {0, 100},
                   {"of what the receiver says of its ranges, beside the code loop", "multipath.floor_m"});
    table.quantity("range_deviation_weak_m", p.range_deviation_weak, {0, 100},
                   "and of a signal of 30 dB-Hz, tenfold for each 10 dB less");
    table.quantity("cn0_offset_db", p.cn0_offset, {-30, 30}, "of the reported C/N0");
    table.quantity("cn0_resolution_db", p.cn0_resolution, {0, 10}, {"of the reported C/N0; 0: none", "1; survey 0.25"});
    table.number("slips_per_hour", p.slips_per_hour, {0, 1e6}, {"of each carrier in good conditions", "0; phone 1500"});
}

void read_acquisition(TableReader& table, AcquisitionParameters& p) {
    table.quantity("cold_threshold_dbhz", p.cold_threshold, {-100, 100}, "C/N0 that a cold search needs");
    table.quantity("warm_threshold_dbhz", p.warm_threshold, {-100, 100},
                   "C/N0 that a warm or hot search needs, and a lost signal");
    table.quantity("loss_threshold_dbhz", p.loss_threshold, {-100, 100}, "C/N0 below which lock is lost");
    table.quantity("phase_threshold_dbhz", p.phase_threshold, {-100, 100},
                   "C/N0 from which the carrier's phase is locked");
    table.quantity("loss_after_s", p.loss_after, {0, 3600}, "below the threshold for so long, lock is lost");
    table.quantity("reacquisition_s", p.reacquisition, {0, 3600}, "longest search of a signal that was lost");
    table.number("reacquisition_growth", p.reacquisition_growth, {0, 10},
                 "s that this search takes longer for each second that the signal was away, up to 300 s");
    table.quantity("hot_search_s", p.hot_search, {0, 3600}, "longest search of a hot start");
    table.quantity("warm_search_s", p.warm_search, {0, 3600}, "longest search of a warm start");
    table.quantity("cold_search_s", p.cold_search, {0, 3600}, "longest search of a cold start");
    table.quantity("half_cycle_after_s", p.half_cycle_after, {0, 3600},
                   "of phase lock, until the half cycle is resolved");
}

void read_multipath(TableReader& table, StatisticalMultipath& p) {
    table.quantity("floor_m", p.floor, {0, 1000}, {"σ of the code high in the sky", "0.64; survey 0.27, phone 6.6"});
    table.quantity("at_horizon_m", p.at_horizon, {0, 1000},
                   {"σ of the code that comes to it at the horizon", "7.5; survey 0.95, phone 4"});
    table.quantity("static_time_s", p.static_time, {0, 1e6}, {"correlation time at rest", "15; survey 22, phone 0.3"});
    table.quantity("horizon_time_s", p.horizon_time, {0, 1e6},
                   {"what comes to it at the horizon, times exp(−elevation/10°)", "250; survey and phone 0"});
    table.quantity("moving_time_s", p.moving_time, {0, 1e6}, "correlation time above 1 m/s");
}

void read_filter(TableReader& table, FilterParameters& p) {
    table.word("filter", {{"none", FilterKind::none}, {"smoothed", FilterKind::smoothed}}, p.kind,
               {"none: every epoch stands alone", "smoothed; survey none"});
    table.quantity("position_memory_s", p.position_memory, {0.01, 1e5},
                   "how long the filter remembers single positions at rest");
    table.quantity("velocity_memory_s", p.velocity_memory, {0, 100}, "of the reported velocity, in motion; 0: none");
    table.quantity("velocity_rest_memory_s", p.velocity_rest_memory, {0, 1e5},
                   {"of the reported velocity, at rest; 0: none", "0; phone 5"});
    table.quantity("hold_below_mps", p.hold_below, {0, 100},
                   {"speed below which the position is held; that of the receiver's own settings where it is more",
                    "0; phone 0.5"});
    table.quantity("code_smoothing_s", p.code_smoothing, {0, 1e5},
                   "of the code by the carrier, before the solution; 0: none");
    table.quantity("coasting_s", p.coasting, {0, 3600}, "how long a lost fix is carried on, as dead reckoning");
}

void read_corrections(TableReader& table, ModernSettings& settings) {
    table.word("ionosphere_correction",
               {{"none", IonosphereCorrection::none},
                {"broadcast", IonosphereCorrection::broadcast},
                {"klobuchar", IonosphereCorrection::klobuchar}},
               settings.ionosphere_correction,
               {"what the receiver takes off", "klobuchar; none without an ionosphere"});
    table.word("troposphere_correction",
               {{"none", TroposphereCorrection::none},
                {"saastamoinen", TroposphereCorrection::saastamoinen},
                {"niell", TroposphereCorrection::niell}},
               settings.troposphere_correction, {"what the receiver takes off", "niell; none without a troposphere"});
    table.number("relative_humidity", settings.navigation.corrections.relative_humidity, {0, 1},
                 "that the receiver assumes");
    table.boolean("ionosphere_free", settings.navigation.corrections.ionosphere_free,
                  "combines both signals of a satellite where two are tracked, and solves with these satellites alone "
                  "where they suffice");
    table.quantity("ionosphere_memory_s", settings.navigation.corrections.ionosphere_memory, {0, 1e5},
                   "over which the ionosphere that both signals of a satellite show is averaged, to be weighed against "
                   "the model; 0: the model alone");
    if (!table.recording() && table.has("ionosphere_free"))
        settings.ionosphere_free_told_at = table.told_at("ionosphere_free");
}

void read_use(TableReader& table, UseParameters& p) {
    table.quantity("use_from_dbhz", p.from, {0, 100},
                   {"C/N0 from which a satellite is used", "25; survey and phone 0"});
    table.quantity("use_within_db", p.within, {0, 100},
                   {"and by how much it may be weaker than the fourth strongest", "100; phone 12"});
    table.quantity("use_hysteresis_db", p.hysteresis, {0, 100},
                   "by how much weaker it may become before it is no longer used");
    table.quantity("use_after_s", p.after, {0, 3600}, "of tracking, until it is used where there is a fix");
}

void read_solution(TableReader& table, ModernSettings& settings) {
    read_corrections(table, settings);
    NavigationParameters& p = settings.navigation;
    table.quantity("weight_floor_m", p.weights.floor, {0.001, 1000},
                   {"s0 of the variance s0² + s1²/sin² e", "0.42; survey 0.36, phone 3"});
    table.quantity("weight_at_zenith_m", p.weights.at_zenith, {0, 1000},
                   {"s1 of the variance s0² + s1²/sin² e", "0.7; survey 0.36, phone 3"});
    table.quantity("weight_beidou_orbits_m", p.weights.beidou_orbits, {0, 1000},
                   "σ that the receiver adds for orbits and clocks of BeiDou");
    table.quantity("weight_glonass_orbits_m", p.weights.glonass_orbits, {0, 1000},
                   "σ that the receiver adds for orbits and clocks of GLONASS");
    table.quantity("weight_range_rate_mps", p.weights.range_rate, {0.0001, 100},
                   "σ of a range rate beside what the loop knows");
    read_use(table, p.use);
    read_filter(table, p.filter);
    table.boolean("raim", p.integrity.enabled, "the residuals are tested");
    table.number("false_alarm", p.integrity.false_alarm, {1e-12, 0.5},
                 "probability that the test finds a fault where there is none");
    table.integer("most_exclusions", p.integrity.most_exclusions, {0, 20},
                  "how many satellites the test may throw out");
    table.number("position_accuracy_scale", p.accuracy.position_scale, {0, 100},
                 {"of the reported accuracy", "1; phone 0.45"});
    table.number("velocity_accuracy_scale", p.accuracy.velocity_scale, {0, 100}, "of the reported accuracy");
    table.number(
        "accuracy_ionosphere_share", p.accuracy.ionosphere_share, {0, 10},
        "σ that the reported accuracy holds for a wrong correction, as a share of it, the same for all satellites");
    table.number("accuracy_ionosphere_tilt", p.accuracy.ionosphere_tilt, {0, 10},
                 "the same, north and east, for a pierce point 9° away");
    table.number(
        "accuracy_troposphere_share", p.accuracy.troposphere_share, {0, 10},
        "σ that the reported accuracy holds for a wrong correction, as a share of it, the same for all satellites");
    table.quantity(
        "ephemeris_collection_s", settings.ephemeris_collection, {0, 1e5},
        {"of tracking, until a satellite's record has been received", "timing.warm_start_s of the board less 3"});
    table.word("differential",
               {{"none", DifferentialKind::none},
                {"sbas", DifferentialKind::sbas},
                {"rtk-float", DifferentialKind::rtk_float},
                {"rtk-fixed", DifferentialKind::rtk_fixed}},
               p.differential.kind, "corrections from outside, as a regime of the errors");
}

void read_biases(TableReader& table, ReceiverBiases& biases) {
    struct System {
        const char* key;
        Constellation constellation;
        const char* meaning;
    };
    constexpr NumberRange range{-1e4, 1e4};
    for (const System& s : {System{"galileo_m", Constellation::galileo, "of the codes of Galileo against GPS"},
                            System{"beidou_m", Constellation::beidou, "of those of BeiDou"},
                            System{"qzss_m", Constellation::qzss, "of those of QZSS"},
                            System{"glonass_m", Constellation::glonass, "of those of GLONASS, channel 0"},
                            System{"sbas_m", Constellation::sbas, "of those of SBAS"},
                            System{"navic_m", Constellation::navic, "of those of NavIC"}})
        table.quantity(s.key, biases.systems.at(static_cast<std::size_t>(s.constellation)), range, s.meaning);
    table.quantity("glonass_channel_code_m", biases.glonass_channel_code, {-100, 100},
                   "of the codes of GLONASS, for each number of the channel");
    table.quantity("glonass_channel_phase_m", biases.glonass_channel_phase, {-1, 1},
                   "of its carriers' phases, the same");
}

void read_car(TableReader& modern, ModernSettings& settings) {
    ChannelParameters& channel = settings.propagation.channel_model;
    modern.where(channel.acts(), "with surroundings other than open-sky",
                 [&] { modern.boolean("car", settings.car, "the antenna is in a car, below its roof"); });
    if (settings.car) channel.roof = loss_of_car_roof;
}

// What was told idle beside the truth acts after all where the receiver does not correct, or Galileo by the very truth.
void forget_acting_residual(ModernSettings& settings) {
    const IonosphereParameters& truth = settings.propagation.ionosphere_model;
    const auto correction = settings.ionosphere_correction;
    const bool uncorrected =
        correction == IonosphereCorrection::none || settings.navigation.differential.kind != DifferentialKind::none;
    const bool own = correction == IonosphereCorrection::broadcast && truth.model == IonosphereModel::ntcm_g;
    if (truth.residual != Choice::automatic || !(uncorrected || own)) return;
    std::erase_if(settings.idle_keys,
                  [](const std::string& told) { return told.starts_with("model.modern.ionosphere.residual_"); });
}

}  // namespace

void read_modern_receiver_keys(TableReader& modern, ModernSettings& settings) {
    modern.table("clock", "the receiver's oscillator", [&](TableReader& t) { read_clock(t, settings); });
    modern.table("tracking", "the receiver's loops", [&](TableReader& t) { read_tracking(t, settings.measurement); });
    modern.table("biases", "constant delays of the receiver's filters",
                 [&](TableReader& t) { read_biases(t, settings.measurement.biases); });
    modern.table("acquisition", "search, lock and loss",
                 [&](TableReader& t) { read_acquisition(t, settings.measurement.acquisition); });
    modern.table("solution", "what the receiver makes of its measurements",
                 [&](TableReader& t) { read_solution(t, settings); });
}

void read_modern_keys(TableReader& modern, ModernSettings& settings, const std::filesystem::path& folder) {
    const auto preset =
        modern.choice("preset", modern_preset_names,
                      "whose receiver it is: geodetic, a u-blox 6 to M8 with a patch antenna, a telephone's",
                      modern_preset_names[static_cast<std::size_t>(settings.preset)]);
    const auto surroundings =
        modern.choice("surroundings", surroundings_names,
                      "what is around the antenna where there is no scene; sets the numbers of channel",
                      surroundings_names[static_cast<std::size_t>(settings.surroundings)]);
    const bool errors = settings.errors;
    settings = ModernSettings::of(preset ? static_cast<ModernPreset>(*preset) : settings.preset,
                                  surroundings ? static_cast<Surroundings>(*surroundings) : settings.surroundings);
    settings.errors = errors;
    read_car(modern, settings);
    read_terms(modern, settings);
    read_modern_propagation_keys(modern, settings, folder);
    modern.table("multipath", "echoes where there is no scene: σ = floor + horizon · exp(−elevation/10°)",
                 [&](TableReader& t) { read_multipath(t, settings.measurement.multipath_model); });
    read_modern_receiver_keys(modern, settings);
    settings.given = modern.toml_text();
    settings.idle_keys = modern.idle_keys();
    forget_acting_residual(settings);
}

ModernSettings with_board(const ModernSettings& settings, const std::string& board_keys) {
    if (board_keys.empty()) return settings;
    ModernSettings own = ModernSettings::of(settings.preset, settings.surroundings);
    // Both texts have been read before, and hold no mistakes.
    static_cast<void>(read_toml(board_keys, "board", [&](TableReader& t) { read_modern_receiver_keys(t, own); }));
    static_cast<void>(read_toml(settings.given, "scenario", [&](TableReader& t) {
        read_modern_receiver_keys(t, own);
        for (const std::string& other : t.keys())
            t.has_been_read(other);
    }));
    own.measurement.multipath_model = settings.measurement.multipath_model;
    ModernSettings result = settings;
    result.measurement = own.measurement;
    result.navigation = own.navigation;
    result.ionosphere_correction = own.ionosphere_correction;
    result.troposphere_correction = own.troposphere_correction;
    result.ephemeris_collection = own.ephemeris_collection;
    // The terms are the scenario's alone.
    ModernSettings terms = settings;
    const auto from = error_terms(terms), to = error_terms(result);
    for (std::size_t i = 0; i < to.size(); ++i)
        *to[i].term = *from[i].term;
    return result;
}

}  // namespace skyloop::inline run
