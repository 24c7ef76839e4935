#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/time/utc_time.hpp"
#include "study/analysis/comparison.hpp"

namespace skyloop::inline study {
namespace {

std::string heading_of(ErrorQuantity quantity) {
    switch (quantity) {
        case ErrorQuantity::horizontal:
            return "horizontal, radial";
        case ErrorQuantity::spatial:
            return "3D, radial";
        default:
            return std::string(error_quantity_name(quantity));
    }
}

std::string_view figure_label(ErrorQuantity quantity, std::string_view figure) {
    if (figure == "std") return "standard deviation";
    if (figure == "cep") return quantity == ErrorQuantity::spatial ? "50 % (SEP)" : "50 % (CEP)";
    if (figure == "p95") return "95 %";
    return figure;
}

std::string reference_text(const SeriesStatistics& s) {
    if (!s.point) return "errors about the file's own truth";
    const std::string_view what =
        s.reference == ReferenceKind::given_point ? "errors about the point" : "errors about the own mean";
    return fmt::format("{} {:.7f}, {:.7f}, {:.2f} m", what, s.point->latitude.deg(), s.point->longitude.deg(),
                       s.point->height.above_ellipsoid.value());
}

std::string series_text(std::string_view label, const SeriesStatistics& s) {
    std::string interval = s.interval ? fmt::format(", one every {:g} s", s.interval->value()) : "";
    return fmt::format("{:<14} {}\n{:15}{} fixes in {} samples{}; {}\n", label, s.name, "", s.fixes, s.samples,
                       interval, reference_text(s));
}

// Three decimals, never a negative zero.
std::string metres_text(double metres) {
    constexpr double shown_as_zero = 0.0005;
    return fmt::format("{:.3f} m", std::abs(metres) < shown_as_zero ? 0.0 : metres);
}

std::string percent_text(const std::optional<double>& percent) {
    if (!percent) return "-";
    constexpr double shown_as_zero = 0.05;
    return std::abs(*percent) < shown_as_zero ? std::string("0.0 %") : fmt::format("{:+.1f} %", *percent);
}

// Below one sampling interval nothing is known of the correlation but that.
std::string correlation_cell(const QuantityStatistics& q) {
    if (!q.correlation_samples) return "-";
    const bool below_one = *q.correlation_samples < 1;
    if (q.correlation_time) {
        const double shown = q.correlation_time->value() / (below_one ? *q.correlation_samples : 1);
        return below_one ? fmt::format("< {:g} s", shown) : fmt::format("{:.1f} s", shown);
    }
    return below_one ? std::string("< 1 sample") : fmt::format("{:.1f} samples", *q.correlation_samples);
}

std::string figure_row(std::string_view heading, std::string_view figure, std::string_view a, std::string_view b,
                       std::string_view difference) {
    std::string row = fmt::format("{:<20}{:<20}{:>15}{:>15}{:>13}", heading, figure, a, b, difference);
    row.resize(row.find_last_not_of(' ') + 1);
    return row + "\n";
}

std::string optional_metres_text(const std::optional<double>& metres) { return metres ? metres_text(*metres) : "-"; }

std::string satellites_cell(const SeriesStatistics& s) {
    if (!s.satellites_used) return "-";
    return fmt::format("{:.1f} +- {:.1f}", s.satellites_used->mean, s.satellites_used->std);
}

std::string satellites_row(const Comparison& comparison) {
    const SeriesStatistics& a = comparison.a;
    const SeriesStatistics& b = comparison.b;
    if (!a.satellites_used && !b.satellites_used) return {};
    std::optional<double> percent;
    if (a.satellites_used && b.satellites_used && b.satellites_used->mean > 0)
        percent = 100 * (a.satellites_used->mean / b.satellites_used->mean - 1);
    return figure_row("satellites used", "mean +- std", satellites_cell(a), satellites_cell(b), percent_text(percent));
}

std::string figures_text(const Comparison& comparison) {
    std::string text = figure_row("error", "figure", "A", "B", "difference");
    text += std::string(83, '-') + "\n";
    for (const ErrorQuantity quantity : error_quantities) {
        std::string heading = heading_of(quantity);
        for (const FigureDifference& d : comparison.differences) {
            if (d.quantity != quantity) continue;
            text += figure_row(heading, figure_label(quantity, d.figure), metres_text(d.a), metres_text(d.b),
                               percent_text(d.percent));
            heading.clear();
        }
        const QuantityStatistics& a = comparison.a.of(quantity);
        const QuantityStatistics& b = comparison.b.of(quantity);
        text += figure_row("", "epoch to epoch", optional_metres_text(a.epoch_noise),
                           optional_metres_text(b.epoch_noise), "");
        text += figure_row("", "1/e correlation", correlation_cell(a), correlation_cell(b), "");
    }
    return text + satellites_row(comparison);
}

std::string article_text(const Comparison& comparison) {
    const std::string name = heading_of(comparison.quantity);
    if (!comparison.article) return fmt::format("{} error: no percentage can be given\n", name);
    const ComparisonPercent& p = *comparison.article;
    return fmt::format(
        "{} error of A against B: mean differs by {:.1f} %, standard deviation by {:.1f} %\n"
        "{}\n",
        name, p.mean_part, p.std_part, p.text());
}

std::string difference_cell(const std::optional<ComparisonPercent>& p) {
    return p ? fmt::format("{:.1f} %", p->difference) : std::string("-");
}

// Smallest, middle and largest of some percentages, or nothing when there is none.
std::string spread_text(std::vector<double> values) {
    if (values.empty()) return "no percentage can be given\n";
    const SampleStatistics s = sample_statistics(values).value_or(SampleStatistics{});
    return fmt::format("smallest {:.1f} %, median {:.1f} %, largest {:.1f} %\n", s.min, s.median, s.max);
}

std::string windows_text(const Comparison& comparison) {
    std::string text = fmt::format("\nA against each window of B ({} fixes each, {} error, metres)\n",
                                   comparison.window, heading_of(comparison.quantity));
    text += fmt::format("{:>6}  {:<22}{:>7}{:>9}{:>9}{:>9}{:>12}{:>11}\n", "window", "from", "fixes", "mean", "std",
                        "95 %", "difference", "agreement");
    std::vector<double> percents;
    for (std::size_t i = 0; i < comparison.windows.size(); ++i) {
        const WindowComparison& w = comparison.windows[i];
        const std::string from = w.start ? utc_text(*w.start) : fmt::format("sample {}", w.first_sample + 1);
        text += fmt::format("{:>6}  {:<22}{:>7}", i + 1, from, w.figures.n);
        for (const double figure : {w.figures.mean, w.figures.std, w.figures.p95})
            text += fmt::format("{:>9.3f}", figure);
        const auto agreement = w.difference ? w.difference->agreement() : std::nullopt;
        text += fmt::format("{:>12}{:>11}\n", difference_cell(w.difference),
                            agreement ? fmt::format("{:.1f} %", *agreement) : "-");
        if (w.difference) percents.push_back(w.difference->difference);
    }
    return text + "difference: " + spread_text(std::move(percents));
}

// A matrix while it fits a terminal; beyond that its spread says what matters.
std::string yardstick_text(const Comparison& comparison) {
    constexpr std::size_t widest_matrix = 12;
    const std::size_t count = comparison.windows.size();
    if (count < 2) return {};
    std::string text =
        "\nYardstick: windows of B against each other, difference in percent (row: reference, column: candidate)\n";
    std::vector<double> percents;
    for (const WindowPair& pair : comparison.yardstick)
        if (pair.difference) percents.push_back(pair.difference->difference);
    if (count <= widest_matrix) {
        text += fmt::format("{:>6}", "");
        for (std::size_t j = 0; j < count; ++j)
            text += fmt::format("{:>8}", j + 1);
        auto pair = comparison.yardstick.begin();
        for (std::size_t i = 0; i < count; ++i) {
            text += fmt::format("\n{:>6}", i + 1);
            for (std::size_t j = 0; j < count; ++j) {
                const bool given = i != j && pair->difference;
                text += fmt::format("{:>8}", given ? fmt::format("{:.1f}", pair->difference->difference) : "-");
                if (i != j) ++pair;
            }
        }
        text += "\n";
    }
    return text + "difference: " + spread_text(std::move(percents));
}

// Two digits, never a negative zero.
std::string correlation_value(const std::optional<LaggedCorrelation>& r) {
    if (!r) return "-";
    constexpr double shown_as_zero = 0.005;
    return fmt::format("{:.2f}", std::abs(r->value) < shown_as_zero ? 0.0 : r->value);
}

std::string autocorrelation_text(const Comparison& comparison) {
    const auto unit = [](const SeriesStatistics& s) { return s.interval ? "s" : "samples"; };
    std::string text = fmt::format("\n{:<20}{:<12}", "autocorrelation", "at lag");
    for (const double lag : correlation_lags)
        text += fmt::format("{:>10}", lag);
    text += "\n" + std::string(82, '-') + "\n";
    for (const ErrorQuantity quantity : error_quantities) {
        std::string heading = heading_of(quantity);
        for (const auto& [label, series] : {std::pair("A", &comparison.a), std::pair("B", &comparison.b)}) {
            text += fmt::format("{:<20}{:<12}", heading, fmt::format("{}, {}", label, unit(*series)));
            for (const auto& r : series->of(quantity).lagged)
                text += fmt::format("{:>10}", correlation_value(r));
            text += "\n";
            heading.clear();
        }
    }
    return text;
}

std::string distances_text(const Comparison& comparison) {
    std::string text = fmt::format("\n{:<40}{:>18}{:>22}\n{}\n", "distance between the distributions",
                                   "total variation", "Kolmogorov-Smirnov", std::string(80, '-'));
    for (const ErrorQuantity quantity : error_quantities) {
        const DistributionDistance& d = comparison.distances[static_cast<std::size_t>(quantity)];
        text +=
            fmt::format("{:<40}{:>18.3f}{:>22.3f}\n", heading_of(quantity), d.total_variation, d.kolmogorov_smirnov);
    }
    return text;
}

std::string strength_cell(const RunningStatistics& bin) {
    return bin.n() == 0 ? std::string("-") : fmt::format("{:.1f} +- {:.1f}", bin.mean(), bin.std());
}

std::string signal_strength_text(const Comparison& comparison) {
    const SignalStrengthByElevation& a = comparison.a.signal_strength;
    const SignalStrengthByElevation& b = comparison.b.signal_strength;
    if (a.empty() && b.empty()) return {};
    std::string text = fmt::format("\n{:<24}{:>16}{:>10}{:>16}{:>10}{:>10}\n{}\n", "C/N0, dB-Hz, elevation",
                                   "A mean +- std", "n", "B mean +- std", "n", "A - B", std::string(86, '-'));
    for (std::size_t i = 0; i < SignalStrengthByElevation::bins; ++i) {
        const RunningStatistics& of_a = a.bin(i);
        const RunningStatistics& of_b = b.bin(i);
        if (of_a.n() + of_b.n() == 0) continue;
        const bool both = of_a.n() > 0 && of_b.n() > 0;
        text +=
            fmt::format("{:<24}{:>16}{:>10}{:>16}{:>10}{:>10}\n", fmt::format("{:>2} to {} deg", 10 * i, 10 * i + 10),
                        strength_cell(of_a), of_a.n(), strength_cell(of_b), of_b.n(),
                        both ? fmt::format("{:+.1f}", of_a.mean() - of_b.mean()) : "-");
    }
    return text;
}

}  // namespace

std::string comparison_text(const Comparison& comparison) {
    std::string text = series_text("A (candidate)", comparison.a) + series_text("B (reference)", comparison.b) + "\n";
    text += figures_text(comparison) + autocorrelation_text(comparison) + distances_text(comparison) +
            signal_strength_text(comparison) + "\n" + article_text(comparison);
    if (comparison.window > 0) text += windows_text(comparison) + yardstick_text(comparison);
    for (const std::string& warning : comparison.warnings)
        text += "warning: " + warning + "\n";
    return text;
}

}  // namespace skyloop::inline study
