#include "firmware/core/base_station.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop::firmware {
namespace {

constexpr double independent_after_s = 100;
constexpr double best_deviation_m = 1e-3;  // whatever a model says of itself

}  // namespace

void BaseSurvey::take(const Fix& fix, bool counts) {
    if (done_) return;
    time_ = difference(fix.time, began_);
    if (counts) {
        const double deviation = std::hypot(fix.horizontal_accuracy.value(), fix.vertical_accuracy.value());
        const double weight = 1 / std::pow(std::max(best_deviation_m, deviation), 2);
        const double passed = positions_ == 0 ? independent_after_s : difference(fix.time, last_).value();
        information_ += weight * std::clamp(passed / independent_after_s, 0.0, 1.0);
        weights_ += weight;
        weighted_ += weight * to_ecef(fix.position).vector();
        last_ = fix.time;
        ++positions_;
    }
    done_ = positions_ > 0 && time_ >= limits_.least && accuracy() <= limits_.accuracy;
}

std::optional<Position<Ecef>> BaseSurvey::mean() const {
    if (positions_ == 0) return std::nullopt;
    return Position<Ecef>(weighted_ / weights_);
}

Metres BaseSurvey::accuracy() const { return Metres(1 / std::sqrt(information_)); }

std::optional<BasePlace> base_place(const std::optional<BasePlace>& given, const std::optional<BaseSurvey>& survey) {
    if (survey && survey->done()) return BasePlace{*survey->mean(), survey->accuracy()};
    return given;
}

}  // namespace skyloop::firmware
