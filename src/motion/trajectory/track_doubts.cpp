#include "motion/trajectory/track_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "base/core/middle.hpp"

namespace skyloop {
namespace {

// Exact: the degrees were zeros.
bool is_zero_place(const TrackRow& row) {
    const Eigen::Vector3d& place = row.position.vector();
    return place.y() == 0 && place.z() == 0 && place.x() > 0;
}

}  // namespace

std::string leave_out_zero_places(Track& track, std::size_t rows) {
    const auto count = static_cast<std::size_t>(std::count_if(track.points.begin(), track.points.end(), is_zero_place));
    if (count == 0) return {};
    if (count == track.points.size())
        return fmt::format(
            "all {} rows are at latitude 0, longitude 0, which is where recorders put places that they "
            "do not know; they are taken as they stand",
            count);
    std::vector<TrackRow> kept;
    kept.reserve(track.points.size() - count);
    std::size_t first_line = 0;
    bool jump = false;
    for (TrackRow& row : track.points) {
        jump |= row.jump;
        if (is_zero_place(row)) {
            if (first_line == 0) first_line = row.line;
            continue;
        }
        row.jump = std::exchange(jump, false) && !kept.empty();
        kept.push_back(row);
    }
    track.points = std::move(kept);
    return fmt::format("{} of {} rows are at latitude 0, longitude 0 (first in line {}) and were left out", count, rows,
                       first_line);
}

std::optional<double> speed_ratio(std::span<const TrackRow> rows) {
    constexpr double moving_mps = 2;
    constexpr std::size_t fewest = 5;
    constexpr Nanoseconds near_rows = std::chrono::seconds(20);
    std::vector<double> ratios;
    for (std::size_t i = 1; i + 1 < rows.size(); ++i) {
        const TrackRow &before = rows[i - 1], &row = rows[i], &after = rows[i + 1];
        const Nanoseconds span = after.time - before.time;
        if (!row.velocity || row.jump || after.jump || span.count() <= 0 || span > near_rows) continue;
        const double moved = (after.position - before.position).length().value() / to_seconds(span).value();
        if (moved > moving_mps) ratios.push_back(row.velocity->length().value() / moved);
    }
    if (ratios.size() < fewest) return std::nullopt;
    return middle_of(ratios);
}

std::string leave_out_foreign_speeds(Track& track) {
    constexpr double least = 0.7, most = 1.4;
    const auto ratio = speed_ratio(track.points);
    if (!ratio || (*ratio > least && *ratio < most)) return {};
    for (TrackRow& row : track.points)
        row.velocity.reset();
    return fmt::format("the speeds are {:.3g} times those of the places and are not used: another unit?", *ratio);
}

}  // namespace skyloop
