#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "detail/scenario_keys.hpp"

namespace skyloop {
namespace {

void read_terms(TableReader& modern, ModernSettings& settings) {
    modern.table("terms", [&](TableReader& terms) {
        for (const NamedTerm& named : error_terms(settings))
            terms.table(named.name, [&](TableReader& table) {
                table.boolean("enabled", named.term->enabled);
                if (!settings.errors && table.has("enabled") && named.term->enabled)
                    table.mistake("enabled",
                                  "is true beside errors = \"none\", which switches every term off; expected "
                                  "one of the two");
                table.number("scale", named.term->scale, {0, 1000});
                if (!table.has("seed")) return;
                std::uint64_t seed = 1;
                table.integer("seed", seed, NumberRange::not_negative());
                named.term->seed = seed;
            });
    });
}

void read_clock(TableReader& table, ModernSettings& settings) {
    ReceiverClockParameters& clock = settings.measurement.clock;
    table.number("h0_s", clock.noise.h0, {0, 1e-10});
    table.number("h_minus_2_per_s", clock.noise.h_minus_2, {0, 1e-10});
    table.quantity("temperature_k", clock.temperature.deviation, {0, 100});
    table.quantity("temperature_time_s", clock.temperature.correlation_time, {0, 1e6});
    table.number("frequency_per_k", clock.temperature.per_kelvin, {0, 1e-3});
    table.quantity("bias_m", clock.bias, {-3e8, 3e8});
    table.quantity("drift_mps", clock.drift, {-1e5, 1e5});
    static constexpr std::array<Word<ClockSteering>, 3> steerings{
        {{"free", ClockSteering::free_running},
         {"millisecond-jumps", ClockSteering::millisecond_jumps},
         {"continuous", ClockSteering::continuous}}};
    table.word("steering", steerings, clock.steering);
    if (clock.steering == ClockSteering::continuous)
        tell_idle(table, settings, "clock", {"drift_mps"},
                  "with steering = \"free\" or \"millisecond-jumps\"; a clock that is steered continuously starts "
                  "without drift");
}

void read_tracking(TableReader& table, MeasurementParameters& p) {
    table.quantity("code_bandwidth_hz", p.code_loop.bandwidth, {0.001, 100});
    table.number("code_spacing_chips", p.code_loop.spacing_chips, {0.01, 1.99});
    table.quantity("front_end_bandwidth_hz", p.code_loop.front_end_bandwidth, {1e5, 1e9});
    Seconds integration = p.code_loop.integration;
    table.quantity("integration_s", integration, {1e-4, 10});
    p.code_loop.integration = p.phase_loop.integration = p.frequency_loop.integration = integration;
    table.quantity("phase_bandwidth_hz", p.phase_loop.bandwidth, {0.01, 1000});
    table.quantity("frequency_bandwidth_hz", p.frequency_loop.bandwidth, {0.01, 1000});
    table.quantity("cn0_resolution_db", p.cn0_resolution, {0, 10});
    table.number("slips_per_hour", p.slips_per_hour, {0, 1e6});
}

void read_acquisition(TableReader& table, AcquisitionParameters& p) {
    table.quantity("cold_threshold_dbhz", p.cold_threshold, {-100, 100});
    table.quantity("warm_threshold_dbhz", p.warm_threshold, {-100, 100});
    table.quantity("loss_threshold_dbhz", p.loss_threshold, {-100, 100});
    table.quantity("phase_threshold_dbhz", p.phase_threshold, {-100, 100});
    table.quantity("loss_after_s", p.loss_after, {0, 3600});
    table.quantity("reacquisition_s", p.reacquisition, {0, 3600});
    table.quantity("hot_search_s", p.hot_search, {0, 3600});
    table.quantity("warm_search_s", p.warm_search, {0, 3600});
    table.quantity("cold_search_s", p.cold_search, {0, 3600});
    table.quantity("half_cycle_after_s", p.half_cycle_after, {0, 3600});
}

void read_multipath(TableReader& table, StatisticalMultipath& p) {
    table.quantity("floor_m", p.floor, {0, 1000});
    table.quantity("at_horizon_m", p.at_horizon, {0, 1000});
    table.quantity("static_time_s", p.static_time, {0, 1e6});
    table.quantity("moving_time_s", p.moving_time, {0, 1e6});
}

void read_filter(TableReader& table, FilterParameters& p) {
    static constexpr std::array<Word<FilterKind>, 2> kinds{
        {{"none", FilterKind::none}, {"smoothed", FilterKind::smoothed}}};
    table.word("filter", kinds, p.kind);
    table.quantity("position_memory_s", p.position_memory, {0.01, 1e5});
    table.quantity("code_smoothing_s", p.code_smoothing, {0, 1e5});
    table.quantity("coasting_s", p.coasting, {0, 3600});
}

void read_corrections(TableReader& table, ModernSettings& settings) {
    static constexpr std::array<Word<std::optional<IonosphereCorrection>>, 3> ionospheres{
        {{"none", IonosphereCorrection::none},
         {"broadcast", IonosphereCorrection::broadcast},
         {"klobuchar", IonosphereCorrection::klobuchar}}};
    table.word("ionosphere_correction", ionospheres, settings.ionosphere_correction);
    static constexpr std::array<Word<std::optional<TroposphereCorrection>>, 3> tropospheres{
        {{"none", TroposphereCorrection::none},
         {"saastamoinen", TroposphereCorrection::saastamoinen},
         {"niell", TroposphereCorrection::niell}}};
    table.word("troposphere_correction", tropospheres, settings.troposphere_correction);
    table.number("relative_humidity", settings.navigation.corrections.relative_humidity, {0, 1});
    table.boolean("ionosphere_free", settings.navigation.corrections.ionosphere_free);
}

void read_solution(TableReader& table, ModernSettings& settings) {
    read_corrections(table, settings);
    NavigationParameters& p = settings.navigation;
    table.quantity("weight_floor_m", p.weights.floor, {0.001, 1000});
    table.quantity("weight_at_zenith_m", p.weights.at_zenith, {0, 1000});
    table.quantity("weight_beidou_orbits_m", p.weights.beidou_orbits, {0, 1000});
    table.quantity("weight_glonass_orbits_m", p.weights.glonass_orbits, {0, 1000});
    read_filter(table, p.filter);
    table.boolean("raim", p.integrity.enabled);
    table.number("false_alarm", p.integrity.false_alarm, {1e-12, 0.5});
    table.integer("most_exclusions", p.integrity.most_exclusions, {0, 20});
    table.number("position_accuracy_scale", p.accuracy.position_scale, {0, 100});
    table.number("velocity_accuracy_scale", p.accuracy.velocity_scale, {0, 100});
    table.number("accuracy_ionosphere_share", p.accuracy.ionosphere_share, {0, 10});
    table.number("accuracy_ionosphere_tilt", p.accuracy.ionosphere_tilt, {0, 10});
    table.number("accuracy_troposphere_share", p.accuracy.troposphere_share, {0, 10});
    if (table.has("ephemeris_collection_s")) {
        Seconds collection = p.ephemeris_collection;
        table.quantity("ephemeris_collection_s", collection, {0, 1e5});
        settings.ephemeris_collection = collection;
    }
    static constexpr std::array<Word<DifferentialKind>, 4> kinds{{{"none", DifferentialKind::none},
                                                                  {"sbas", DifferentialKind::sbas},
                                                                  {"rtk-float", DifferentialKind::rtk_float},
                                                                  {"rtk-fixed", DifferentialKind::rtk_fixed}}};
    table.word("differential", kinds, p.differential.kind);
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

void tell_idle(TableReader& table, ModernSettings& settings, std::string_view name,
               std::initializer_list<std::string_view> keys, std::string_view acts) {
    for (const std::string_view key : keys)
        if (table.has(key))
            settings.idle_keys.push_back(
                fmt::format("model.modern.{}.{}: has no effect here; it acts {}", name, key, acts));
}

void read_modern_keys(TableReader& modern, ModernSettings& settings, const std::filesystem::path& folder) {
    const auto preset =
        modern.choice("preset", modern_preset_names, modern_preset_names[static_cast<std::size_t>(settings.preset)]);
    const auto surroundings = modern.choice("surroundings", surroundings_names,
                                            surroundings_names[static_cast<std::size_t>(settings.surroundings)]);
    const bool errors = settings.errors;
    settings = ModernSettings::of(preset ? static_cast<ModernPreset>(*preset) : settings.preset,
                                  surroundings ? static_cast<Surroundings>(*surroundings) : settings.surroundings);
    settings.errors = errors;
    read_terms(modern, settings);
    read_modern_propagation_keys(modern, settings, folder);
    modern.table("clock", [&](TableReader& t) { read_clock(t, settings); });
    modern.table("tracking", [&](TableReader& t) { read_tracking(t, settings.measurement); });
    modern.table("acquisition", [&](TableReader& t) { read_acquisition(t, settings.measurement.acquisition); });
    modern.table("multipath", [&](TableReader& t) { read_multipath(t, settings.measurement.multipath_model); });
    modern.table("solution", [&](TableReader& t) { read_solution(t, settings); });
    forget_acting_residual(settings);
}

}  // namespace skyloop
