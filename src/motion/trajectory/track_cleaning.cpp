#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/std_additions.hpp"
#include "detail/track_order.hpp"
#include "motion/trajectory/track.hpp"

namespace skyloop::inline motion {
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

namespace {

double seconds_from(const TrackRow& from, const TrackRow& to) { return to_seconds(to.time - from.time).value(); }

// Of the row in the middle of a track with dates, which count from 1980. Others count from their own start.
Nanoseconds middle_time(const Track& track) {
    if (!track.origin || track.points.empty()) return Nanoseconds(0);
    std::vector<Nanoseconds> times;
    times.reserve(track.points.size());
    for (const TrackRow& row : track.points)
        times.push_back(row.time);
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    return *middle;
}

// Times that lie far from the others'. Dates beyond what times may be count from the middle of the track on.
void leave_out_what_is_no_time(Track& track) {
    const Nanoseconds middle = middle_time(track);
    TouchedRows no_time;
    std::erase_if(track.points, [&](const TrackRow& row) {
        const double away_s = to_seconds(row.time).value() - to_seconds(middle).value();
        const bool bad = std::abs(away_s) > to_seconds(longest_track_time).value();
        if (bad) no_time.add(row);
        return bad;
    });
    no_time.tell(track, "rows have a time further than 70 years from the others' and were left out");
    if (middle <= longest_track_time) return;
    *track.origin += middle;
    for (TrackRow& row : track.points)
        row.time -= middle;
}

// Coordinates that are no place, and velocities that are none.
void leave_out_what_is_no_number(Track& track) {
    // From below the deepest ground to far above the satellites.
    constexpr double nearest_m = 6.3e6, furthest_m = 1e8;
    TouchedRows no_place, no_velocity;
    std::erase_if(track.points, [&](const TrackRow& row) {
        const double distance = row.position.vector().norm();
        const bool bad = !(distance >= nearest_m && distance <= furthest_m);
        if (bad) no_place.add(row);
        return bad;
    });
    for (TrackRow& row : track.points) {
        if (!row.velocity || row.velocity->vector().norm() <= furthest_m) continue;
        no_velocity.add(row);
        row.velocity.reset();
    }
    no_place.tell(track, "rows have no place on the Earth and were left out");
    no_velocity.tell(track, "rows have a velocity that is no number, which was left out");
}

std::size_t end_of_equal(const TrackRows& rows, std::size_t begin) {
    std::size_t end = begin + 1;
    while (end < rows.size() && rows[end].time == rows[begin].time)
        ++end;
    return end;
}

bool all_at_one_place(const TrackRows& rows, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin + 1; i < end; ++i)
        if ((rows[i].position - rows[begin].position).length().value() > 0) return false;
    return true;
}

// Three rows or more of one time at different places: the stamps are coarser than the rows.
bool stamps_are_coarse(const TrackRows& rows) {
    for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
        end = end_of_equal(rows, begin);
        if (end - begin >= 3 && !all_at_one_place(rows, begin, end)) return true;
    }
    return false;
}

// Spreads the rows of each stamp evenly until the next one.
void spread_coarse_stamps(Track& track) {
    const Nanoseconds step = median_step(track.points);
    TrackRows& rows = track.points;
    std::size_t spread = 0;
    for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
        end = end_of_equal(rows, begin);
        const Nanoseconds until = end < rows.size() ? std::min(rows[end].time - rows[begin].time, 2 * step) : step;
        const auto count = static_cast<std::int64_t>(end - begin);
        for (std::int64_t i = 1; i < count; ++i)
            rows[begin + static_cast<std::size_t>(i)].time += until / count * i;
        spread += end - begin - 1;
    }
    track.notes.push_back(fmt::format("the times are coarser than the rows: {} rows were spread over steps of {:g} s",
                                      spread, to_seconds(step).value()));
}

void leave_out_repeated(Track& track) {
    // What a path of 140 years, counted in doubles of seconds, can still tell apart.
    constexpr Nanoseconds nearest = std::chrono::microseconds(1);
    TouchedRows repeated;
    TrackRows kept;
    kept.reserve(track.points.size());
    for (TrackRow& row : track.points) {
        if (kept.empty() || row.time - kept.back().time >= nearest) {
            kept.push_back(std::move(row));
        } else {
            repeated.add(row);
            const bool jump = kept.back().jump || row.jump;
            kept.back() = std::move(row);
            kept.back().jump = jump;
        }
    }
    track.points = std::move(kept);
    repeated.tell(track, "rows repeat the time of the row before; the last one of each counts");
}

double speed_between(const TrackRows& rows, std::size_t from, std::size_t to) {
    return (rows[to].position - rows[from].position).length().value() / seconds_from(rows[from], rows[to]);
}

// Whether the step to a row is far out of what its neighbours do.
bool is_leap(const TrackRows& rows, std::size_t to, double ordinary_mps) {
    constexpr double least_m = 100, least_mps = 100, out_of_line = 10;
    const double speed = speed_between(rows, to - 1, to);
    return (rows[to].position - rows[to - 1].position).length().value() > least_m && speed > least_mps &&
           speed > out_of_line * ordinary_mps;
}

// A single row far away is an error; rows that stay there are a jump (FEEDS.md 1.14).
void find_teleports(Track& track) {
    TrackRows& rows = track.points;
    TouchedRows lone, jumps;
    std::vector<bool> left_out(rows.size(), false);
    for (std::size_t i = 1; i + 1 < rows.size(); ++i) {
        if (rows[i].jump || rows[i + 1].jump || left_out[i - 1]) continue;
        const double past = speed_between(rows, i - 1, i + 1);
        if (!is_leap(rows, i, past) || !is_leap(rows, i + 1, past)) continue;
        lone.add(rows[i]);
        left_out[i] = true;
    }
    std::size_t at = 0;
    std::erase_if(rows, [&](const TrackRow&) { return left_out[at++]; });
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const double before = i >= 2 && !rows[i - 1].jump ? speed_between(rows, i - 2, i - 1) : 0;
        const double after = i + 1 < rows.size() ? speed_between(rows, i, i + 1) : before;
        if (rows.size() < 3 || rows[i].jump || !is_leap(rows, i, std::max(before, after))) continue;
        jumps.add(rows[i]);
        rows[i].jump = true;
    }
    lone.tell(track, "rows lie far from both neighbours and were left out");
    jumps.tell(track, "times the path leaps and stays there, which is a jump");
}

struct GapWords {
    std::string_view what, more;
};

GapWords words_of(GapPolicy policy) {
    return std::array<GapWords, 4>{{{"the path is bridged there", "bridged"},
                                    {"the path stands there and then jumps", "stood through"},
                                    {"that time is left out", "left out"},
                                    {"the path is bridged there and no signal is received",
                                     "bridged without a "
                                     "signal"}}}[static_cast<std::size_t>(policy)];
}

std::vector<TrackGap> gaps_of(Track& track, Seconds longest, GapPolicy policy) {
    constexpr std::size_t most_told = 5;
    std::vector<TrackGap> gaps;
    for (std::size_t i = 1; i < track.points.size(); ++i) {
        const Nanoseconds from = track.points[i - 1].time, to = track.points[i].time;
        if (track.points[i].jump || to - from <= to_nanoseconds(longest)) continue;
        gaps.push_back({from, to});
        if (gaps.size() <= most_told)
            track.notes.push_back(fmt::format("no row between {:.3f} s and {:.3f} s of the track; {}",
                                              to_seconds(from - track.points.front().time).value(),
                                              to_seconds(to - track.points.front().time).value(),
                                              words_of(policy).what));
    }
    if (gaps.size() > most_told)
        track.notes.push_back(fmt::format("{} more such gaps are {}", gaps.size() - most_told, words_of(policy).more));
    return gaps;
}

// The rows after each gap come a usual step after those before; further away, at the speed that they had, and further
// than the gap lets them, by a jump.
void leave_out_gaps(Track& track, std::span<const TrackGap> gaps, Seconds longest) {
    const Nanoseconds step = median_step(track.points);
    Nanoseconds shift{0};
    TrackRows rows = track.points;
    std::size_t next = 0;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const Nanoseconds to = track.points[i].time;
        if (next < gaps.size() && gaps[next].to == to) {
            ++next;
            constexpr double least_mps = 1;
            const double before = i >= 2 ? speed_between(track.points, i - 2, i - 1) : 0;
            const double way = (rows[i].position - rows[i - 1].position).length().value();
            const double needed_s = way / std::max(before, least_mps);
            rows[i].jump = needed_s > longest.value();
            const Nanoseconds taken = rows[i].jump ? step : std::max(step, to_nanoseconds(Seconds(needed_s)));
            shift += (to - track.points[i - 1].time) - taken;
        }
        rows[i].time = to - shift;
    }
    track.points = std::move(rows);
}

}  // namespace

Result<std::vector<TrackGap>> clean_track(Track& track, Seconds gap, GapPolicy policy) {
    leave_out_what_is_no_time(track);
    leave_out_what_is_no_number(track);
    put_rows_in_order(track);
    if (stamps_are_coarse(track.points)) spread_coarse_stamps(track);
    leave_out_repeated(track);
    if (track.points.size() < 2)
        return fail(
            ErrorCode::input,
            fmt::format("{}: {} rows with a time and a place of their own; expected two or more{}{}", track.name,
                        track.points.size(), track.notes.empty() ? "" : "; ", fmt::join(track.notes, "; ")));
    find_teleports(track);
    std::vector<TrackGap> gaps = gaps_of(track, gap, policy);
    if (policy == GapPolicy::hold) {
        std::size_t next = 0;
        for (TrackRow& row : track.points)
            if (next < gaps.size() && row.time == gaps[next].to) row.jump = true, ++next;
    }
    if (policy == GapPolicy::compress) leave_out_gaps(track, gaps, gap);
    if (policy == GapPolicy::hold || policy == GapPolicy::compress) gaps.clear();
    return gaps;
}

}  // namespace skyloop::inline motion
