#include <array>

#include "base/core/json.hpp"
#include "base/time/utc_time.hpp"
#include "study/analysis/comparison.hpp"

namespace skyloop::inline study {
namespace {

template <class Value>
Json json_or_null(const std::optional<Value>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json seconds_json(const std::optional<Seconds>& seconds) { return seconds ? Json(seconds->value()) : Json(nullptr); }

std::string_view reference_word(ReferenceKind kind) {
    constexpr std::array<std::string_view, 3> words{"truth", "given point", "own mean"};
    return words[static_cast<std::size_t>(kind)];
}

Json figures_json(const SampleStatistics& s) {
    return {{"n", s.n},       {"mean_m", s.mean}, {"std_m", s.std}, {"rms_m", s.rms}, {"median_m", s.median},
            {"p95_m", s.p95}, {"min_m", s.min},   {"max_m", s.max}};
}

Json percent_json(const std::optional<ComparisonPercent>& p) {
    if (!p) return nullptr;
    const auto agreement = p->agreement();
    return {{"difference_percent", p->difference},
            {"agreement_percent", agreement ? Json(*agreement) : Json(nullptr)},
            {"mean_difference_percent", p->mean_part},
            {"std_difference_percent", p->std_part},
            {"mean_near_zero", p->mean_near_zero}};
}

// null where a lag has too few pairs.
Json lagged_json(const QuantityStatistics& q, bool in_seconds) {
    Json json = Json::array();
    for (std::size_t i = 0; i < correlation_lags.size(); ++i)
        json.push_back({{in_seconds ? "lag_s" : "lag_samples", correlation_lags[i]},
                        {"value", q.lagged[i] ? Json(q.lagged[i]->value) : Json(nullptr)},
                        {"pairs", q.lagged[i] ? q.lagged[i]->pairs : 0}});
    return json;
}

Json signal_strength_json(const SignalStrengthByElevation& strengths) {
    Json json = Json::array();
    for (std::size_t i = 0; i < SignalStrengthByElevation::bins; ++i) {
        const RunningStatistics& bin = strengths.bin(i);
        if (bin.n() == 0) continue;
        const double from = SignalStrengthByElevation::bin_width_deg * static_cast<double>(i);
        json.push_back({{"from_deg", from},
                        {"to_deg", from + SignalStrengthByElevation::bin_width_deg},
                        {"n", bin.n()},
                        {"mean_dbhz", bin.mean()},
                        {"std_dbhz", bin.std()}});
    }
    return json;
}

Json distances_json(const Comparison& comparison) {
    Json json = Json::object();
    for (const ErrorQuantity quantity : error_quantities) {
        const DistributionDistance& d = comparison.distances[static_cast<std::size_t>(quantity)];
        json[std::string(error_quantity_name(quantity))] = {{"total_variation", d.total_variation},
                                                            {"bins", d.bins},
                                                            {"bin_width_m", d.bin_width},
                                                            {"kolmogorov_smirnov", d.kolmogorov_smirnov}};
    }
    return json;
}

Json series_json(const SeriesStatistics& s) {
    Json json{{"name", s.name}, {"samples", s.samples}, {"fixes", s.fixes}, {"interval_s", seconds_json(s.interval)}};
    json["reference"] = {{"kind", reference_word(s.reference)}};
    if (s.point) {
        json["reference"]["lat_deg"] = s.point->latitude.deg();
        json["reference"]["lon_deg"] = s.point->longitude.deg();
        json["reference"]["height_m"] = s.point->height.above_ellipsoid.value();
    }
    for (const ErrorQuantity quantity : error_quantities) {
        const QuantityStatistics& q = s.of(quantity);
        Json figures = figures_json(q.figures);
        figures["correlation_samples"] = json_or_null(q.correlation_samples);
        figures["correlation_time_s"] = seconds_json(q.correlation_time);
        figures["epoch_noise_m"] = json_or_null(q.epoch_noise);
        figures["autocorrelation"] = lagged_json(q, s.interval.has_value());
        json["errors"][std::string(error_quantity_name(quantity))] = std::move(figures);
    }
    json["cep_m"] = s.cep();
    json["r95_m"] = s.r95();
    json["satellites_used"] = nullptr;
    if (s.satellites_used)
        json["satellites_used"] = {
            {"n", s.satellites_used->n}, {"mean", s.satellites_used->mean}, {"std", s.satellites_used->std}};
    json["cn0_by_elevation"] = signal_strength_json(s.signal_strength);
    return json;
}

Json differences_json(const Comparison& comparison) {
    Json json = Json::object();
    for (const FigureDifference& d : comparison.differences)
        json[std::string(error_quantity_name(d.quantity))][std::string(d.figure)] = json_or_null(d.percent);
    return json;
}

Json windows_json(const Comparison& comparison) {
    Json json = Json::array();
    for (const WindowComparison& w : comparison.windows) {
        Json row{{"first_sample", w.first_sample}};
        row["time_utc"] = w.start ? Json(utc_text(*w.start, 3)) : Json(nullptr);
        row["figures"] = figures_json(w.figures);
        row["against_a"] = percent_json(w.difference);
        json.push_back(std::move(row));
    }
    return json;
}

Json yardstick_json(const Comparison& comparison) {
    Json json = Json::array();
    for (const WindowPair& pair : comparison.yardstick)
        json.push_back({{"reference", pair.reference},
                        {"candidate", pair.candidate},
                        {"difference_percent", pair.difference ? Json(pair.difference->difference) : Json(nullptr)}});
    return json;
}

}  // namespace

std::string comparison_json(const Comparison& comparison) {
    Json json{{"a", series_json(comparison.a)}, {"b", series_json(comparison.b)}};
    json["difference_percent"] = differences_json(comparison);
    json["distribution_distance"] = distances_json(comparison);
    json["comparison"] = percent_json(comparison.article);
    json["quantity"] = error_quantity_name(comparison.quantity);
    if (comparison.window > 0) {
        json["window_fixes"] = comparison.window;
        json["windows"] = windows_json(comparison);
        json["window_pairs"] = yardstick_json(comparison);
    }
    json["warnings"] = comparison.warnings;
    // File names need not be UTF-8; what is not is shown as a replacement character instead of throwing.
    return json_text(json, 2) + "\n";
}

}  // namespace skyloop::inline study
