#include "campaigns/campaign/run_metrics.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/geo/local_frame.hpp"
#include "study/analysis/statistics.hpp"

namespace skyloop {
namespace {

constexpr std::array<std::string_view, 15> all_metric_names{
    "epochs",
    "fix_share",
    "time_to_first_fix_s",
    "outages",
    "longest_outage_s",
    "horizontal_error_p50_m",
    "horizontal_error_p95_m",
    "horizontal_error_max_m",
    "vertical_error_p50_m",
    "vertical_error_p95_m",
    "vertical_error_max_m",
    "satellites_used_mean",
    "satellites_visible_mean",
    "hdop_mean",
    "cn0_mean_dbhz",
};

void append_errors(std::vector<std::optional<double>>& values, std::span<const double> errors) {
    const auto statistics = sample_statistics(errors);
    if (!statistics) return values.resize(values.size() + 3);
    values.insert(values.end(), {statistics->median, statistics->p95, statistics->max});
}

}  // namespace

std::span<const std::string_view> metric_names() { return all_metric_names; }

void RunMetrics::follow_fix(GpsTime now, bool has_fix) {
    if (has_fix && !first_fix_) first_fix_ = now;
    if (!has_fix && first_fix_ && !lost_at_) lost_at_ = now, ++outages_;
    if (lost_at_) longest_outage_ = std::max(longest_outage_, difference(now, *lost_at_));
    if (has_fix) lost_at_.reset();
    last_epoch_ = now;
}

void RunMetrics::on_epoch(const EpochSeen& seen) {
    if (seen.station != 0) return;
    const Fix& fix = seen.trace.epoch.fix;
    ++epochs_;
    follow_fix(seen.now, fix.has_position());
    visible_.add(static_cast<double>(seen.trace.sky.satellites.size()));
    for (const SatelliteStatus& satellite : fix.satellites)
        if (satellite.cn0) cn0_.add(satellite.cn0->value());
    if (!fix.has_position()) return;
    const auto error = LocalFrame(seen.trace.truth.geodetic).to_enu(to_ecef(fix.position)).vector();
    horizontal_.push_back(std::hypot(error.x(), error.y()));
    vertical_.push_back(std::abs(error.z()));
    used_.add(fix.satellites_used());
    hdop_.add(fix.dop.hdop);
}

std::vector<std::optional<double>> RunMetrics::values() const {
    std::vector<std::optional<double>> values{static_cast<double>(epochs_)};
    const auto fixes = static_cast<double>(horizontal_.size());
    values.push_back(epochs_ > 0 ? std::optional(fixes / static_cast<double>(epochs_)) : std::nullopt);
    values.push_back(first_fix_ ? std::optional(difference(*first_fix_, start_).value()) : std::nullopt);
    values.emplace_back(static_cast<double>(outages_));
    values.emplace_back(longest_outage_.value());
    append_errors(values, horizontal_);
    append_errors(values, vertical_);
    for (const Sum* sum : {&used_, &visible_, &hdop_, &cn0_})
        values.push_back(sum->mean());
    return values;
}

}  // namespace skyloop
