#include "detail/track_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "base/core/std_additions.hpp"

namespace skyloop::inline motion {
namespace {

// By more than a clock is ever set back while it counts on.
bool falls_back(const TrackRow& from, const TrackRow& to) {
    constexpr Nanoseconds set_back = std::chrono::seconds(2);
    return to.time < from.time - set_back;
}

bool is_earlier(const TrackRow& a, const TrackRow& b) { return a.time < b.time; }

// A row out of the order of those around it: it came late, or its time is wrong.
struct StrayRow {
    TrackRow row;
    bool ahead = false;   // of the row behind it; else behind the one before it
    double beside_m = 0;  // from the nearer one of the rows in order beside it in the file
};

double metres_between(const TrackRow& a, const TrackRow& b) { return (b.position - a.position).length().value(); }

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

// How many of the last rows ran ahead of the one that follows, which goes on from the row before them.
std::size_t count_ahead(const TrackRows& rows, const TrackRow& next, std::size_t most) {
    for (std::size_t count = 1; count <= most && count < rows.size(); ++count)
        if (next.time > rows[rows.size() - 1 - count].time) return count;
    return 0;
}

// How many rows come before the one that goes on from the time that was reached; 0: none does so soon, or one of them
// says that it begins anew.
std::size_t count_behind(std::span<const TrackRow> rows, Nanoseconds reached, std::size_t most) {
    for (std::size_t count = 0; count <= most && count < rows.size(); ++count) {
        if (rows[count].jump) return 0;
        if (rows[count].time >= reached) return count;
    }
    return 0;
}

// Whether rows go on in time, and none of them says that it begins anew.
bool are_of_one_part(std::span<const TrackRow> rows) {
    return std::adjacent_find(rows.begin(), rows.end(), falls_back) == rows.end() &&
           std::none_of(rows.begin(), rows.end(), [](const TrackRow& row) { return row.jump; });
}

// Takes rows out so that the others go on in time, but for parts that begin anew.
class StrayRows {
public:
    explicit StrayRows(Track& track) : track_(track) {}
    std::vector<StrayRow> take_out();

private:
    void take_ahead(std::size_t count, TrackRow& next);
    void take_ends();

    Track& track_;
    TrackRows kept_;
    std::vector<StrayRow> strays_;
};

// Either the rows before one that falls back ran ahead, or it comes late, with those behind it: whichever are fewer.
std::vector<StrayRow> StrayRows::take_out() {
    // A clock that counts from the file's own start may begin anew: there one alone is a stray.
    const std::size_t most = track_.origin ? 3 : 1;
    const std::span<TrackRow> rows(track_.points);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!kept_.empty() && falls_back(kept_.back(), rows[i])) {
            const std::size_t ahead = count_ahead(kept_, rows[i], most);
            const std::size_t behind = count_behind(rows.subspan(i), kept_.back().time, most);
            if (ahead > 0 && (behind == 0 || ahead <= behind)) {
                take_ahead(ahead, rows[i]);
            } else if (behind > 0) {
                const TrackRow& next = rows[i + behind];
                for (const TrackRow& late : rows.subspan(i, behind))
                    strays_.push_back(
                        {late, false, std::min(metres_between(kept_.back(), late), metres_between(late, next))});
                i += behind;
            }
        }
        kept_.push_back(rows[i]);
    }
    take_ends();
    track_.points = std::move(kept_);
    return std::move(strays_);
}

void StrayRows::take_ahead(std::size_t count, TrackRow& next) {
    const auto first = kept_.end() - static_cast<std::ptrdiff_t>(count);
    for (auto row = first; row != kept_.end(); ++row) {
        next.jump |= std::exchange(row->jump, false);
        strays_.push_back({*row, true, std::min(metres_between(*(first - 1), *row), metres_between(*row, next))});
    }
    kept_.erase(first, kept_.end());
}

// The first row, where it stands alone before a part that goes on earlier. The last one, where it stands alone behind a
// part that was later, may be a clock that began anew, unless it has a date.
void StrayRows::take_ends() {
    constexpr std::size_t fewest = 3;
    if (kept_.size() <= fewest) return;
    const std::size_t last = kept_.size() - 1;
    const std::span<const TrackRow> rows(kept_);
    const bool first_strays = falls_back(rows[0], rows[1]) && are_of_one_part(rows.subspan(1, fewest));
    const bool last_strays = track_.origin && falls_back(rows[last - 1], rows[last]) && !rows[last].jump &&
                             are_of_one_part(rows.subspan(last - fewest, fewest));
    if (last_strays) {
        strays_.push_back({rows[last], false, metres_between(rows[last - 1], rows[last])});
        kept_.pop_back();
    }
    if (first_strays) {
        strays_.push_back({rows[0], true, metres_between(rows[0], rows[1])});
        kept_.erase(kept_.begin());
    }
}

std::vector<TrackRows> parts_of(TrackRows rows) {
    std::vector<TrackRows> parts;
    for (TrackRow& row : rows) {
        if (parts.empty() || falls_back(parts.back().back(), row)) parts.emplace_back();
        parts.back().push_back(std::move(row));
    }
    return parts;
}

TrackRows joined_rows(std::vector<TrackRows>& parts) {
    TrackRows rows;
    for (TrackRows& part : parts)
        rows.insert(rows.end(), std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
    return rows;
}

struct PartSpan {
    Nanoseconds from, to;
};

PartSpan span_of(const TrackRows& part) {
    const auto [first, last] = std::minmax_element(part.begin(), part.end(), is_earlier);
    return {first->time, last->time};
}

// Parts by their beginnings. A part that began by a jump was no piece of the one before: wherever it stands now, no way
// leads from one to the next.
void sort_parts(std::vector<TrackRows>& parts) {
    const bool apart =
        std::any_of(parts.begin() + 1, parts.end(), [](const TrackRows& part) { return part.front().jump; });
    std::stable_sort(parts.begin(), parts.end(),
                     [](const TrackRows& a, const TrackRows& b) { return span_of(a).from < span_of(b).from; });
    for (TrackRows& part : parts)
        part.front().jump |= apart;
    parts.front().front().jump = false;
}

bool overlap(const std::vector<TrackRows>& parts) {
    const auto reaches = [](const TrackRows& a, const TrackRows& b) { return span_of(b).from <= span_of(a).to; };
    return std::adjacent_find(parts.begin(), parts.end(), reaches) != parts.end();
}

// Parts of one clock, each row with its own time.
void put_parts_in_order(Track& track) {
    std::vector<TrackRows> parts = parts_of(std::move(track.points));
    if (parts.size() > 1) {
        sort_parts(parts);
        track.notes.push_back(
            fmt::format("{} parts do not follow each other in time; they were put in its order", parts.size()));
    }
    const bool sorts_rows = overlap(parts);
    track.points = joined_rows(parts);
    if (!sorts_rows) return;
    std::stable_sort(track.points.begin(), track.points.end(), is_earlier);
    track.points.front().jump = false;
}

// Parts of a clock that began anew follow each other at once.
void join_beginnings(Track& track) {
    std::vector<TrackRows> parts = parts_of(std::move(track.points));
    const Nanoseconds step = parts.empty() ? Nanoseconds(0) : median_step(parts.front());
    TouchedRows beginnings, too_late;
    TrackRows rows;
    for (TrackRows& part : parts) {
        if (!rows.empty() && rows.back().time - rows.front().time > longest_track_time) {
            too_late.add(part.front());
            continue;
        }
        if (!rows.empty()) {
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
    TouchedRows backward;
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

// Rows of before the recorder knew the date: a few, longer before all others than those take.
void leave_out_undated(Track& track) {
    constexpr std::size_t most = 3;
    constexpr Nanoseconds least = std::chrono::hours(24);
    TrackRows& rows = track.points;
    for (std::size_t count = most; count > 0; --count) {
        if (2 * count >= rows.size() || rows[count].jump) continue;
        const Nanoseconds gap = rows[count].time - rows[count - 1].time;
        if (gap <= std::max(least, rows.back().time - rows[count].time)) continue;
        TouchedRows undated;
        std::for_each_n(rows.begin(), count, [&](const TrackRow& row) { undated.add(row); });
        rows.erase(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(count));
        return undated.tell(track, "rows have a time long before all others and were left out");
    }
}

// Whether a stray row came late: it is nearer to where the way was at its time than to where the way is at its place in
// the file. Else its time is wrong.
bool came_late(const TrackRows& rows, const StrayRow& stray) {
    const auto after = std::lower_bound(rows.begin(), rows.end(), stray.row, is_earlier);
    if (after == rows.begin() || after == rows.end() || after->time == stray.row.time || after->jump) return false;
    const TrackRow& before = *(after - 1);
    const double share = static_cast<double>((stray.row.time - before.time).count()) /
                         static_cast<double>((after->time - before.time).count());
    const Displacement<Ecef> way = after->position - before.position;
    return (stray.row.position - (before.position + way * share)).length().value() < stray.beside_m;
}

void settle_strays(Track& track, const std::vector<StrayRow>& strays) {
    if (strays.empty()) return;
    TouchedRows late, ahead, behind;
    TrackRows fitting;
    for (const StrayRow& stray : strays) {
        if (track.origin && came_late(track.points, stray)) {
            late.add(stray.row);
            fitting.push_back(stray.row);
        } else {
            (stray.ahead ? ahead : behind).add(stray.row);
        }
    }
    track.points.insert(track.points.end(), fitting.begin(), fitting.end());
    std::stable_sort(track.points.begin(), track.points.end(), is_earlier);
    late.tell(track, "rows do not stand where their time belongs and were put in its order");
    ahead.tell(track, "rows have a time that ran ahead and were left out");
    behind.tell(track, "rows have a time that fell back and were left out");
}

}  // namespace

void TouchedRows::add(const TrackRow& row) {
    if (count_++ == 0 && row.line > 0) first_line_ = fmt::format(", first in line {}", row.line);
}

void TouchedRows::tell(Track& track, std::string_view what) const {
    if (count_ > 0) track.notes.push_back(fmt::format("{} {}{}", count_, what, first_line_));
}

Nanoseconds median_step(const TrackRows& rows) {
    std::vector<Nanoseconds> steps;
    for (std::size_t i = 1; i < rows.size(); ++i)
        if (rows[i].time > rows[i - 1].time) steps.push_back(rows[i].time - rows[i - 1].time);
    if (steps.empty()) return std::chrono::seconds(1);
    return middle_of(steps);
}

void put_rows_in_order(Track& track) {
    turn_round_what_falls(track);
    const std::vector<StrayRow> strays = StrayRows(track).take_out();
    if (track.origin)
        put_parts_in_order(track);
    else
        join_beginnings(track);
    leave_out_backward(track);
    if (track.origin) leave_out_undated(track);
    settle_strays(track, strays);
}

}  // namespace skyloop::inline motion
