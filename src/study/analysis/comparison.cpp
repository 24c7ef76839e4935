#include "study/analysis/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace skyloop::inline study {
namespace {

constexpr std::size_t most_windows = 200;  // pairs grow with the square

struct QuantityName {
    ErrorQuantity quantity;
    std::string_view name;
    std::vector<double> PositionErrors::*values;
};
constexpr std::array<QuantityName, error_quantities.size()> quantity_names{{
    {ErrorQuantity::east, "east", &PositionErrors::east},
    {ErrorQuantity::north, "north", &PositionErrors::north},
    {ErrorQuantity::up, "up", &PositionErrors::up},
    {ErrorQuantity::horizontal, "horizontal", &PositionErrors::horizontal},
    {ErrorQuantity::spatial, "3d", &PositionErrors::spatial},
}};

bool is_radial(ErrorQuantity quantity) {
    return quantity == ErrorQuantity::horizontal || quantity == ErrorQuantity::spatial;
}

// A relative difference says something only where the reference is clear of zero: a mean beside its deviation, any
// other figure beside the size of the errors.
bool comparable(std::string_view figure, double of_b, const SampleStatistics& b) {
    if (std::abs(of_b) < rounding_dust_m) return false;
    if (figure == "mean") return std::abs(b.mean) >= b.std / 4;
    return std::abs(of_b) > b.rms * 1e-2;
}

std::vector<FigureDifference> figure_differences(const SeriesStatistics& a, const SeriesStatistics& b) {
    struct Figure {
        std::string_view name;
        double SampleStatistics::*value;
        bool radial_only;
    };
    constexpr std::array<Figure, 7> figures{{{"mean", &SampleStatistics::mean, false},
                                             {"std", &SampleStatistics::std, false},
                                             {"rms", &SampleStatistics::rms, false},
                                             {"cep", &SampleStatistics::median, true},
                                             {"p95", &SampleStatistics::p95, true},
                                             {"min", &SampleStatistics::min, false},
                                             {"max", &SampleStatistics::max, false}}};
    std::vector<FigureDifference> differences;
    for (const ErrorQuantity quantity : error_quantities)
        for (const Figure& figure : figures) {
            if (figure.radial_only && !is_radial(quantity)) continue;
            const SampleStatistics& of_b = b.of(quantity).figures;
            FigureDifference d{quantity, figure.name, a.of(quantity).figures.*figure.value, of_b.*figure.value, {}};
            if (comparable(figure.name, d.b, of_b)) d.percent = 100 * (d.a - d.b) / std::abs(d.b);
            differences.push_back(d);
        }
    return differences;
}

std::string article_warning(const Comparison& comparison) {
    const std::string_view name = error_quantity_name(comparison.quantity);
    const SampleStatistics& of_b = comparison.b.of(comparison.quantity).figures;
    if (comparison.article ? comparison.article->mean_near_zero : of_b.std >= rounding_dust_m)
        return fmt::format(
            "{}: the mean {} error, {:.3f} m, is small beside its standard deviation, {:.3f} m: the relative "
            "difference of the means, and the percentage made with it, says nothing; choose horizontal",
            comparison.b.name, name, std::abs(of_b.mean), of_b.std);
    if (comparison.article) return {};
    return fmt::format("{}: the {} error has a mean or a standard deviation of zero: no percentage can be given",
                       comparison.b.name, name);
}

// One wild fix outweighs thousands of good ones in a mean and a standard deviation.
void add_outlier_warnings(Comparison& comparison) {
    constexpr double wild = 100;  // times the median; of Gaussian errors the largest is not six times
    for (const SeriesStatistics* series : {&comparison.a, &comparison.b}) {
        const SampleStatistics& s = series->of(ErrorQuantity::spatial).figures;
        const double median = std::max(s.median, rounding_dust_m);
        if (s.max > wild * median)
            comparison.warnings.push_back(
                fmt::format("{}: the largest 3d error, {:.0f} m, is {:.0f} times the median: an "
                            "outlier dominates the mean and the standard deviation",
                            series->name, s.max, s.max / median));
    }
}

void add_comparison_warnings(Comparison& comparison, const ComparisonOptions& options) {
    if (const std::string warning = article_warning(comparison); !warning.empty())
        comparison.warnings.push_back(warning);
    add_outlier_warnings(comparison);
    const auto uses_point = [](const SeriesStatistics& s) { return s.reference == ReferenceKind::given_point; };
    if (options.reference && !uses_point(comparison.a) && !uses_point(comparison.b))
        comparison.warnings.emplace_back("the reference point is not used: both files hold their own truth");
    const auto own_mean = [](const SeriesStatistics& s) { return s.reference == ReferenceKind::own_mean; };
    if (own_mean(comparison.a) != own_mean(comparison.b))
        comparison.warnings.push_back(
            fmt::format("{}: errors are about the mean of the file itself, so its bias does not show, while the other "
                        "file's does; a reference point makes them alike",
                        own_mean(comparison.a) ? comparison.a.name : comparison.b.name));
}

void compare_windows(Comparison& comparison, const std::vector<FixSeries>& parts, const ComparisonOptions& options) {
    const SampleStatistics& of_a = comparison.a.of(comparison.quantity).figures;
    std::size_t samples = 0;
    for (const FixSeries& part : parts) {
        WindowComparison window;
        window.first_sample = samples;
        samples += part.samples.size();
        if (part.dated) window.start = part.samples.front().time;
        const PositionErrors errors = position_errors(part, options.reference);
        window.figures = sample_statistics(error_values(errors, comparison.quantity)).value_or(SampleStatistics{});
        window.difference = comparison_percent(of_a, window.figures);
        comparison.windows.push_back(window);
    }
    for (std::size_t i = 0; i < parts.size(); ++i)
        for (std::size_t j = 0; j < parts.size(); ++j)
            if (i != j)
                comparison.yardstick.push_back(
                    {i, j, comparison_percent(comparison.windows[j].figures, comparison.windows[i].figures)});
}

}  // namespace

std::string_view error_quantity_name(ErrorQuantity quantity) {
    return quantity_names[static_cast<std::size_t>(quantity)].name;
}

std::optional<ErrorQuantity> error_quantity_from_name(std::string_view name) {
    for (const QuantityName& row : quantity_names)
        if (row.name == name) return row.quantity;
    return std::nullopt;
}

const std::vector<double>& error_values(const PositionErrors& errors, ErrorQuantity quantity) {
    return errors.*quantity_names[static_cast<std::size_t>(quantity)].values;
}

namespace {

QuantityStatistics quantity_statistics(const FixSeries& series, const FixTimes& times,
                                       const std::vector<double>& values) {
    QuantityStatistics q;
    q.figures = sample_statistics(values).value_or(SampleStatistics{});
    const TimeCorrelation correlation(times, values);
    if (const auto lag = correlation.time_to_1_e()) q.correlation_samples = *lag / times.step;
    if (q.correlation_samples && series.interval) q.correlation_time = *series.interval * *q.correlation_samples;
    q.epoch_noise = correlation.epoch_noise();
    for (std::size_t i = 0; i < correlation_lags.size(); ++i)
        q.lagged[i] = correlation.at_lag(correlation_lags[i]);
    return q;
}

std::optional<SampleStatistics> satellites_used_statistics(const FixSeries& series) {
    std::vector<double> counts;
    for (const FixSample& sample : series.samples)
        if (sample.has_fix && sample.satellites_used) counts.push_back(*sample.satellites_used);
    return sample_statistics(counts);
}

void measure_distances(Comparison& comparison, const PositionErrors& a, const PositionErrors& b) {
    for (const ErrorQuantity quantity : error_quantities)
        comparison.distances[static_cast<std::size_t>(quantity)] =
            distribution_distance(error_values(a, quantity), error_values(b, quantity))
                .value_or(DistributionDistance{});
}

}  // namespace

Result<SeriesStatistics> series_statistics(const FixSeries& series, const std::optional<Geodetic>& point) {
    SeriesStatistics result;
    result.name = series.name;
    result.samples = series.samples.size();
    result.fixes = series.fixes();
    result.interval = series.interval;
    if (result.fixes < 2)
        return fail(ErrorCode::input, fmt::format("{}: holds {} fix{}; a standard deviation needs at least 2",
                                                  series.name, result.fixes, result.fixes == 1 ? "" : "es"));
    const PositionErrors errors = position_errors(series, point);
    result.reference = errors.reference;
    result.point = errors.point;
    const FixTimes times = fix_times(series);
    for (const ErrorQuantity quantity : error_quantities)
        result.quantities[static_cast<std::size_t>(quantity)] =
            quantity_statistics(series, times, error_values(errors, quantity));
    result.satellites_used = satellites_used_statistics(series);
    result.signal_strength = series.signal_strength();
    return result;
}

Result<Comparison> compare(const FixSeries& a, const FixSeries& b, const ComparisonOptions& options) {
    const Result<SeriesStatistics> of_a = series_statistics(a, options.reference);
    if (!of_a) return fail(of_a.error());
    const Result<SeriesStatistics> of_b = series_statistics(b, options.reference);
    if (!of_b) return fail(of_b.error());
    Comparison comparison;
    comparison.a = *of_a;
    comparison.b = *of_b;
    comparison.quantity = options.quantity;
    measure_distances(comparison, position_errors(a, options.reference), position_errors(b, options.reference));
    comparison.differences = figure_differences(*of_a, *of_b);
    comparison.article = comparison_percent(of_a->of(options.quantity).figures, of_b->of(options.quantity).figures);
    for (const FixSeries* series : {&a, &b})
        comparison.warnings.insert(comparison.warnings.end(), series->warnings.begin(), series->warnings.end());
    add_comparison_warnings(comparison, options);
    if (options.window == 0) return comparison;

    const std::size_t count = of_b->fixes / options.window;
    if (count == 0 || count > most_windows)
        return fail(ErrorCode::usage, fmt::format("{}: {} fixes make {} windows of {}; expected 1 to {} windows",
                                                  b.name, of_b->fixes, count, options.window, most_windows));
    comparison.window = options.window;
    compare_windows(comparison, windows(b, options.window), options);
    return comparison;
}

}  // namespace skyloop::inline study
