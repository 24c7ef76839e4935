#include "firmware/base_station.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/config/config_keys.hpp"
#include "firmware/config/legacy_keys.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::uint64_t survey_mode = 1;
constexpr double independent_after_s = 100;
constexpr double best_deviation_m = 1e-3;  // whatever a model says of itself

}  // namespace

std::optional<SurveyLimits> survey_limits(const ConfigStore& config) {
    if (config.value(key::tmode_mode) != survey_mode) return std::nullopt;
    const auto tenths_of_mm = static_cast<double>(config.value(legacy_key::tmode_svin_acc_limit));
    return SurveyLimits{Seconds(static_cast<double>(config.value(legacy_key::tmode_svin_min_dur))),
                        Metres(tenths_of_mm * 1e-4)};
}

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

namespace {

constexpr std::uint64_t fixed_mode = 2;

// Three items in cm or 1e-7°, each with a hundredth part beyond it in an item of its own.
std::array<double, 3> coordinates(const ConfigStore& config, std::uint32_t first, std::uint32_t first_beyond) {
    std::array<double, 3> values{};
    for (std::uint32_t i = 0; i < 3; ++i)
        values[i] = static_cast<double>(config.signed_value(first + i)) +
                    static_cast<double>(config.signed_value(first_beyond + i)) * 1e-2;
    return values;
}

Position<Ecef> configured_position(const ConfigStore& config) {
    if (config.flag(legacy_key::tmode_pos_type)) {
        const auto [latitude, longitude, height] =
            coordinates(config, legacy_key::tmode_geodetic, legacy_key::tmode_geodetic_hp);
        return to_ecef(Geodetic::degrees(latitude * 1e-7, longitude * 1e-7, height * 1e-2));
    }
    const auto [x, y, z] = coordinates(config, legacy_key::tmode_ecef, legacy_key::tmode_ecef_hp);
    return Position<Ecef>(x * 1e-2, y * 1e-2, z * 1e-2);
}

}  // namespace

std::optional<BasePlace> base_place(const ConfigStore& config, const std::optional<BaseSurvey>& survey) {
    if (survey && survey->done()) return BasePlace{*survey->mean(), survey->accuracy()};
    if (config.value(key::tmode_mode) != fixed_mode) return std::nullopt;
    const double tenths_of_mm = static_cast<double>(config.value(legacy_key::tmode_fixed_pos_acc));
    return BasePlace{configured_position(config), Metres(tenths_of_mm * 1e-4)};
}

}  // namespace skyloop::firmware
