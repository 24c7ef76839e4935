#include "skyloop/trajectory/track.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace skyloop {
namespace {

std::string told_line(const TrackRow& point) {
    return point.line > 0 ? fmt::format(", first in line {}", point.line) : std::string();
}

// What cleaning has left out, and where it did so first.
struct LeftOut {
    std::size_t count = 0;
    std::string first_line;
    void add(const TrackRow& point) {
        if (count++ == 0) first_line = told_line(point);
    }
};

std::vector<TrackGap> gaps_of(Track& track, Seconds longest) {
    constexpr std::size_t most_told = 5;
    std::vector<TrackGap> gaps;
    for (std::size_t i = 1; i < track.points.size(); ++i) {
        const Nanoseconds from = track.points[i - 1].time, to = track.points[i].time;
        if (to - from <= to_nanoseconds(longest)) continue;
        gaps.push_back({from, to});
        if (gaps.size() <= most_told)
            track.notes.push_back(
                fmt::format("no row between {:.3f} s and {:.3f} s of the track; the path is bridged "
                            "there",
                            to_seconds(from - track.points.front().time).value(),
                            to_seconds(to - track.points.front().time).value()));
    }
    if (gaps.size() > most_told)
        track.notes.push_back(fmt::format("{} more such gaps are bridged", gaps.size() - most_told));
    return gaps;
}

}  // namespace

Result<std::vector<TrackGap>> clean_track(Track& track, Seconds gap) {
    LeftOut repeated, backward;
    std::vector<TrackRow> kept;
    kept.reserve(track.points.size());
    for (const TrackRow& point : track.points) {
        if (kept.empty() || point.time > kept.back().time) {
            kept.push_back(point);
        } else if (point.time == kept.back().time) {
            repeated.add(point);
            kept.back() = point;
        } else {
            backward.add(point);
        }
    }
    track.points = std::move(kept);
    if (repeated.count > 0)
        track.notes.push_back(fmt::format("{} rows repeat the time of the row before; the last one of each counts{}",
                                          repeated.count, repeated.first_line));
    if (backward.count > 0)
        track.notes.push_back(
            fmt::format("{} rows go back in time and were left out{}", backward.count, backward.first_line));
    if (track.points.size() < 2)
        return fail(ErrorCode::input,
                    fmt::format("{}: {} rows with a time and a place of their own; expected two or more", track.name,
                                track.points.size()));
    return gaps_of(track, gap);
}

}  // namespace skyloop
