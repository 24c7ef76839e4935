#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <string_view>

#include "skyloop/base/middle.hpp"
#include "skyloop/trajectory/track.hpp"

namespace skyloop {
namespace {

using TrackRows = std::vector<TrackRow>;

// More than a clock is ever set back by while it counts on: the source began anew.
constexpr Nanoseconds new_beginning = std::chrono::seconds(2);

// Of a row from the origin of its times, and of a whole track: sums and differences of such times are times, too.
constexpr Nanoseconds longest_time = std::chrono::hours(24 * 365 * 70);

// What cleaning has left out or changed, and where it did so first.
struct Touched {
    std::size_t count = 0;
    std::string first_line;
    void add(const TrackRow& row) {
        if (count++ == 0 && row.line > 0) first_line = fmt::format(", first in line {}", row.line);
    }
    void tell(Track& track, std::string_view what) const {
        if (count > 0) track.notes.push_back(fmt::format("{} {}{}", count, what, first_line));
    }
};

double seconds_from(const TrackRow& from, const TrackRow& to) { return to_seconds(to.time - from.time).value(); }

Nanoseconds median_step(const TrackRows& rows) {
    std::vector<Nanoseconds> steps;
    for (std::size_t i = 1; i < rows.size(); ++i)
        if (rows[i].time > rows[i - 1].time) steps.push_back(rows[i].time - rows[i - 1].time);
    if (steps.empty()) return std::chrono::seconds(1);
    return middle_of(steps);
}

// Coordinates that are no place, and velocities that are none.
void leave_out_what_is_no_number(Track& track) {
    // From below the deepest ground to far above the satellites.
    constexpr double nearest_m = 6.3e6, furthest_m = 1e8;
    Touched no_place, no_time, no_velocity;
    std::erase_if(track.points, [&](const TrackRow& row) {
        if (row.time < -longest_time || row.time > longest_time) return no_time.add(row), true;
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
    no_time.tell(track, "rows have a time further than 70 years from the others' and were left out");
    no_place.tell(track, "rows have no place on the Earth and were left out");
    no_velocity.tell(track, "rows have a velocity that is no number, which was left out");
}

// Some programs write the newest row first. Where the way begins anew is told by the later one of two rows.
void turn_round_what_falls(Track& track) {
    TrackRows& rows = track.points;
    constexpr std::size_t fewest = 3;
    const auto goes_on = [](const TrackRow& a, const TrackRow& b) { return b.time > a.time; };
    if (rows.size() < fewest || std::adjacent_find(rows.begin(), rows.end(), goes_on) != rows.end() ||
        rows.front().time == rows.back().time)
        return;
    std::reverse(rows.begin(), rows.end());
    for (std::size_t i = rows.size() - 1; i > 0; --i)
        rows[i].jump = rows[i - 1].jump;
    rows.front().jump = false;
    track.notes.emplace_back("the rows stand newest first and were turned round");
}

// Whether the first row alone stands before a part that goes on earlier and does not say that it begins anew.
bool first_ran_ahead(const std::vector<TrackRows>& parts) {
    constexpr std::size_t fewest_behind = 3;
    return parts.size() > 1 && parts[0].size() == 1 && parts[1].size() >= fewest_behind && !parts[1].front().jump;
}

// Where the source began anew: the first rows of parts whose times go back by more than two seconds. A single stamp
// that ran ahead is left out.
std::vector<TrackRows> parts_of(Track& track) {
    Touched ahead;
    std::vector<TrackRows> parts;
    for (TrackRow& row : track.points) {
        if (parts.empty()) parts.emplace_back();
        TrackRows& part = parts.back();
        if (part.empty() || row.time >= part.back().time - new_beginning) {
            part.push_back(std::move(row));
        } else if (part.size() >= 2 && row.time > part[part.size() - 2].time) {
            ahead.add(part.back());
            part.back() = std::move(row);
        } else {
            parts.push_back({std::move(row)});
        }
    }
    if (first_ran_ahead(parts)) {
        ahead.add(parts.front().front());
        parts.erase(parts.begin());
    }
    ahead.tell(track, "rows have a time that ran ahead and were left out");
    return parts;
}

struct PartSpan {
    Nanoseconds from, to;
};

PartSpan span_of(const TrackRows& part) {
    const auto [first, last] = std::minmax_element(
        part.begin(), part.end(), [](const TrackRow& a, const TrackRow& b) { return a.time < b.time; });
    return {first->time, last->time};
}

// Whether the parts fill times of their own, in whatever order; then they are put in order. A part that began by a jump
// was no piece of the one before: wherever it stands now, no way leads from one to the next.
bool put_in_order(std::vector<TrackRows>& parts) {
    std::vector<TrackRows> sorted = parts;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const TrackRows& a, const TrackRows& b) { return span_of(a).from < span_of(b).from; });
    for (std::size_t i = 1; i < sorted.size(); ++i)
        if (span_of(sorted[i]).from <= span_of(sorted[i - 1]).to) return false;
    const bool apart =
        std::any_of(parts.begin() + 1, parts.end(), [](const TrackRows& part) { return part.front().jump; });
    parts = std::move(sorted);
    for (TrackRows& part : parts)
        if (apart) part.front().jump = true;
    parts.front().front().jump = false;
    return true;
}

// Rows in one order of time, but for what goes back by less than a new beginning.
void join_parts(Track& track) {
    std::vector<TrackRows> parts = parts_of(track);
    const Nanoseconds step = parts.empty() ? Nanoseconds(0) : median_step(parts.front());
    const bool of_one_clock = parts.size() > 1 && track.origin && put_in_order(parts);
    if (of_one_clock)
        track.notes.push_back(
            fmt::format("{} parts do not follow each other in time; they were put in its order", parts.size()));
    Touched beginnings, too_late;
    TrackRows rows;
    for (TrackRows& part : parts) {
        if (!rows.empty() && rows.back().time - rows.front().time > longest_time) {
            too_late.add(part.front());
            continue;
        }
        if (!rows.empty() && !of_one_clock) {
            beginnings.add(part.front());
            part.front().jump = true;
            const Nanoseconds shift = span_of(rows).to + step - span_of(part).from;
            for (TrackRow& row : part)
                row.time += shift;
        }
        rows.insert(rows.end(), std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
    }
    track.points = std::move(rows);
    too_late.tell(track, "parts of a track longer than 70 years were left out");
    beginnings.tell(track,
                    "times the time goes back by more than 2 s: a new beginning, which follows at once, by a jump");
}

void leave_out_backward(Track& track) {
    Touched backward;
    TrackRows kept;
    kept.reserve(track.points.size());
    for (TrackRow& row : track.points) {
        if (kept.empty() || row.time >= kept.back().time)
            kept.push_back(std::move(row));
        else
            backward.add(row);
    }
    track.points = std::move(kept);
    backward.tell(track, "rows go back in time and were left out");
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
    Touched repeated;
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
    Touched lone, jumps;
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
    leave_out_what_is_no_number(track);
    turn_round_what_falls(track);
    join_parts(track);
    leave_out_backward(track);
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

}  // namespace skyloop
