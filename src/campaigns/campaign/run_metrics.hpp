/// Figures of one run.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "run/fault/run_observer.hpp"

namespace skyloop {

/// Names of all figures, units in them, in the order of tables: fix_share, horizontal_error_p95_m, …
std::span<const std::string_view> metric_names();

/// Watches the solutions of the first receiver, as fixes.csv holds them. State: two numbers an epoch with a fix.
class RunMetrics : public RunObserver {
public:
    explicit RunMetrics(GpsTime start) : start_(start) {}
    void on_epoch(const EpochSeen& seen) override;
    /// In the order of metric_names(). Nothing where there is none, such as errors of a run without a fix.
    [[nodiscard]] std::vector<std::optional<double>> values() const;

private:
    struct Sum {
        double sum = 0;
        std::uint64_t count = 0;
        void add(double value) { sum += value, ++count; }
        [[nodiscard]] std::optional<double> mean() const {
            return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
        }
    };
    void follow_fix(GpsTime now, bool has_fix);

    GpsTime start_;
    std::uint64_t epochs_ = 0, outages_ = 0;
    std::vector<double> horizontal_, vertical_;  // m
    std::optional<GpsTime> first_fix_, lost_at_, last_epoch_;
    Seconds longest_outage_{0};
    Sum used_, visible_, hdop_, cn0_;
};

}  // namespace skyloop
