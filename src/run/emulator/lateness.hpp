/// How late epochs came, in real time.
#pragma once

#include <array>
#include <cstdint>

#include "base/time/gps_time.hpp"

namespace skyloop {

/// Counts of epochs by lateness.
class LatenessHistogram {
public:
    /// Upper bounds of the bins, ms; the last bin has none.
    static constexpr std::array<double, 9> bounds_ms{0.1, 0.3, 1, 3, 10, 30, 100, 300, 1000};

    void add(Nanoseconds lateness);
    [[nodiscard]] const std::array<std::uint64_t, bounds_ms.size() + 1>& counts() const { return counts_; }
    [[nodiscard]] Nanoseconds largest() const { return largest_; }
    [[nodiscard]] Nanoseconds latest() const { return latest_; }
    /// Mean over all epochs, ms.
    [[nodiscard]] double mean_ms() const;

private:
    std::array<std::uint64_t, bounds_ms.size() + 1> counts_{};
    Nanoseconds largest_{0};
    Nanoseconds latest_{0};
    std::uint64_t epochs_ = 0;
    double sum_ms_ = 0;
};

}  // namespace skyloop
