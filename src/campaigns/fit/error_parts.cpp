#include "campaigns/fit/error_parts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace skyloop::inline campaigns {
namespace {

// One axis of an epoch, by its parts; nothing where one of the runs had no fix.
template <class Part>
std::vector<std::optional<Part>> course_of(const ScaledRuns& runs, Eigen::Index axis) {
    std::vector<std::optional<Part>> course(runs.base.enu.size());
    for (std::size_t i = 0; i < course.size(); ++i) {
        if (!runs.base.enu[i]) continue;
        Part part = Part::Zero();
        part[0] = (*runs.base.enu[i])[axis];
        const bool complete = std::all_of(runs.changed.begin(), runs.changed.end(), [&](const auto& changed) {
            if (i >= changed.run.enu.size() || !changed.run.enu[i]) return false;
            part[1 + static_cast<Eigen::Index>(changed.cause)] =
                ((*changed.run.enu[i])[axis] - (*runs.base.enu[i])[axis]) / changed.by;
            return true;
        });
        if (complete) course[i] = part;
    }
    return course;
}

template <class Part>
Part mean_of(const std::vector<std::optional<Part>>& course) {
    Part sum = Part::Zero();
    double n = 0;
    for (const auto& one : course)
        if (one) sum += *one, ++n;
    return n > 0 ? Part(sum / n) : sum;
}

}  // namespace

ErrorParts::ErrorParts(const std::vector<ScaledRuns>& seeds, const CauseScales& about, bool placed)
    : about_(about), placed_(placed), seeds_(static_cast<double>(seeds.size())) {
    for (AxisForms& axis : forms_)
        axis.lagged.fill(Form::Zero());
    const std::size_t epochs = seeds.empty() ? 0 : seeds.front().base.enu.size();
    for (std::size_t lag = 0; lag < fitted_lags.size(); ++lag)  // as TimeCorrelation asks for a quarter of the pairs
        long_enough_[lag] = fitted_lags[lag] <= 0.75 * static_cast<double>(epochs);
    for (const ScaledRuns& runs : seeds)
        add(runs);
}

void ErrorParts::add(const ScaledRuns& runs) {
    for (std::size_t axis = 0; axis < axes; ++axis) {
        AxisForms& forms = forms_[axis];
        const auto course = course_of<Part>(runs, static_cast<Eigen::Index>(axis));
        const Part mean = mean_of(course);
        std::array<double, 1 + fitted_lags.size()> n{};
        AxisForms sums;
        sums.lagged.fill(Form::Zero());
        for (std::size_t i = 0; i < course.size(); ++i) {
            if (!course[i]) continue;
            const Part about_mean = *course[i] - mean;
            ++n[0];
            sums.squares += *course[i] * course[i]->transpose();
            sums.variance += about_mean * about_mean.transpose();
            for (std::size_t lag = 0; lag < fitted_lags.size(); ++lag) {
                const std::size_t later = i + static_cast<std::size_t>(fitted_lags[lag]);
                if (later >= course.size() || !course[later]) continue;
                ++n[1 + lag];
                sums.lagged[lag] += about_mean * (*course[later] - mean).transpose();
            }
        }
        forms.squares += sums.squares / std::max(n[0], 1.0);
        forms.variance += sums.variance / std::max(n[0], 1.0);
        for (std::size_t lag = 0; lag < fitted_lags.size(); ++lag)
            forms.lagged[lag] += sums.lagged[lag] / std::max(n[1 + lag], 1.0);
    }
}

SpreadFigures ErrorParts::spread(std::size_t first_axis, std::size_t count, const Part& scale) const {
    const auto value_of = [&](auto&& form_of) {
        double value = 0;
        for (std::size_t axis = first_axis; axis < first_axis + count; ++axis)
            value += scale.dot(form_of(forms_[axis]) * scale) / seeds_;
        return value;
    };
    SpreadFigures figures;
    const double variance = value_of([](const AxisForms& f) -> const Form& { return f.variance; });
    figures.deviation = std::sqrt(std::max(variance, 0.0));
    if (placed_)
        figures.rms = std::sqrt(std::max(value_of([](const AxisForms& f) -> const Form& { return f.squares; }), 0.0));
    for (std::size_t lag = 0; lag < fitted_lags.size(); ++lag)
        if (long_enough_[lag] && variance > 0)
            figures.correlation[lag] =
                value_of([lag](const AxisForms& f) -> const Form& { return f.lagged[lag]; }) / variance;
    return figures;
}

FitFigures ErrorParts::figures(const CauseScales& scales) const {
    Part scale;
    scale[0] = 1;
    for (std::size_t cause = 0; cause < scales.size(); ++cause)
        scale[1 + static_cast<Eigen::Index>(cause)] = scales[cause] - about_[cause];
    return {spread(0, 2, scale), spread(2, 1, scale)};
}

}  // namespace skyloop::inline campaigns
