#include "detail/text_track.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "motion/trajectory/track.hpp"

namespace skyloop::inline motion {
namespace {

constexpr double fastest_mps = 12000;  // faster than any orbit: a mistake of units

double text_seconds(Nanoseconds span) { return to_seconds(span).value(); }

bool has_height(const TextRow& row) { return row.ellipsoidal_m || row.sea_level_m; }

}  // namespace

TextTrack::TextTrack(const TrackFile& file, std::string format, std::string rows_called)
    : file_(file), rows_called_(std::move(rows_called)) {
    track_.name = file.name;
    track_.format = std::move(format);
}

void TextTrack::begin_part(std::string_view name) {
    if (!parts_.empty() && parts_.back().rows.empty()) parts_.pop_back();
    parts_.push_back({std::string(name.substr(0, 60)), {}});
}

// Makes one thing of places on the Earth, and of what stands for nothing. Fails where a number cannot be.
Result<void> TextTrack::check(TextRow& row) const {
    if (row.position) {
        const double radius = row.position->vector().norm();
        if (!(radius > 6.3e6 && radius < 1.7e7))  // below any ground, beyond what a path is for
            return refusal(row.line, fmt::format("the place lies {:.0f} m from the Earth's centre; expected 6300000 to "
                                                 "17000000",
                                                 radius));
        const Geodetic place = to_geodetic(*row.position);
        row.latitude_deg = place.latitude.deg(), row.longitude_deg = place.longitude.deg();
        row.ellipsoidal_m = place.height.above_ellipsoid.value();
    } else if (const auto place = place_from_degrees(row.latitude_deg, row.longitude_deg,
                                                     row.ellipsoidal_m.value_or(row.sea_level_m.value_or(0)));
               !place) {
        return refusal(row.line, place.error());
    }
    // Phones write -1 for what they do not know.
    if (row.speed_mps && *row.speed_mps < 0) row.speed_mps.reset();
    if (row.course_deg && *row.course_deg == -1) row.course_deg.reset();
    for (const auto& value : {row.speed_mps, row.climb_mps})
        if (value && !(std::abs(*value) <= fastest_mps))
            return refusal(row.line, fmt::format("a speed of {:g} m/s; expected at most {:g}", *value, fastest_mps));
    if (row.separation_m && !(std::abs(*row.separation_m) <= 200))
        return refusal(row.line, fmt::format("the geoid lies {:g} m above the ellipsoid; expected -200 to 200",
                                             *row.separation_m));
    return {};
}

Result<void> TextTrack::add(TextRow row) {
    if (auto checked = check(row); !checked) return checked;
    if (parts_.empty()) begin_part("");
    parts_.back().rows.push_back(row);
    ++taken_;
    return {};
}

Result<void> TextTrack::add_untimed(TextRow row, std::string_view why, std::string_view time) {
    if (auto checked = check(row); !checked) return checked;
    if (parts_.empty()) begin_part("");
    row.timed = false;
    parts_.back().rows.push_back(row);
    untimed_.push_back({std::string(why), row.line});
    if (!time.empty()) ++unusable_times_[std::string(time.substr(0, 64))];
    return {};
}

// Whether the rows without times make a route of the whole, or are left out of it.
void TextTrack::settle_untimed() {
    constexpr std::size_t fewest_timed = 2, hardly_any = 10;  // one in so many
    if (untimed_.empty()) return;
    if (taken_ < fewest_timed || taken_ * hardly_any < taken_ + untimed_.size()) return make_route();
    for (Part& part : parts_)
        std::erase_if(part.rows, [](const TextRow& row) { return !row.timed; });
    for (const Untimed& row : std::exchange(untimed_, {}))
        leave_out(row.why, row.line);
}

std::string TextTrack::why_no_times() const {
    const std::size_t whole = rows();
    std::size_t most = 0;
    for (const auto& [text, count] : unusable_times_)
        most = std::max(most, count);
    if (most > 1 && whole - most < std::max<std::size_t>(whole / 10, 1) + 1)
        return fmt::format("{} of {} times are equal: the file's times are not used", most, whole);
    if (most > 0) return fmt::format("{} of {} {} {}", untimed_.size(), whole, rows_called_, untimed_.back().why);
    return taken_ > 0 ? fmt::format("only {} of {} {} have a time", taken_, whole, rows_called_) : "no times in it";
}

void TextTrack::make_route() {
    track_.route.emplace();
    track_.route->why = why_no_times();
    for (const Part& part : parts_)
        rows_.insert(rows_.end(), part.rows.begin(), part.rows.end());
    for (TextRow& row : rows_)
        row.time = {}, row.jump = false;
    parts_.clear();
    taken_ += untimed_.size();
    untimed_.clear();
    absolute_ = false;
}

void TextTrack::leave_out(std::string_view why, std::size_t line) {
    ++left_out_count_;
    auto known = std::find_if(left_out_.begin(), left_out_.end(), [&](const LeftOut& out) { return out.why == why; });
    if (known == left_out_.end()) known = left_out_.insert(known, LeftOut{std::string(why), 0, line});
    ++known->count;
}

void TextTrack::note(std::string text) { track_.notes.push_back(one_line_of(std::move(text))); }

tl::unexpected<Error> TextTrack::refusal(std::size_t line, const std::string& what) const {
    return fail(ErrorCode::input, line > 0 ? fmt::format("{}:{}: {}", track_.name, line, one_line_of(what))
                                           : fmt::format("{}: {}", track_.name, one_line_of(what)));
}

tl::unexpected<Error> TextTrack::refusal(const std::string& what) const { return refusal(0, what); }

// The parts in the order of time; of those that overlap the longest stays.
void TextTrack::merge_parts() {
    std::erase_if(parts_, [](const Part& part) { return part.rows.empty(); });
    std::stable_sort(parts_.begin(), parts_.end(),
                     [](const Part& a, const Part& b) { return a.rows.size() > b.rows.size(); });
    struct Kept {
        Nanoseconds last{0};
        Part* part = nullptr;
    };
    std::multimap<Nanoseconds, Kept> kept;  // by their first times
    constexpr std::size_t most_told = 5;
    std::size_t overlapping = 0;
    for (Part& part : parts_) {
        const auto [first, last] = std::minmax_element(
            part.rows.begin(), part.rows.end(), [](const TextRow& a, const TextRow& b) { return a.time < b.time; });
        const auto after = kept.lower_bound(last->time);  // begins when this one ends, or later
        if (after == kept.begin() || std::prev(after)->second.last <= first->time) {
            kept.emplace(first->time, Kept{last->time, &part});
        } else if (++overlapping <= most_told) {
            note(fmt::format("the track '{}' of {} {} overlaps a longer one of the file in time and was left out",
                             part.name, part.rows.size(), rows_called_));
        }
    }
    if (overlapping > most_told) note(fmt::format("{} more such tracks were left out", overlapping - most_told));
    for (auto& [first, one] : kept) {
        one.part->rows.front().jump = true;
        rows_.insert(rows_.end(), one.part->rows.begin(), one.part->rows.end());
    }
    if (!rows_.empty()) rows_.front().jump = false;
    parts_.clear();
}

// Receivers put what they do not know at latitude 0, longitude 0.
void TextTrack::drop_zero_places() {
    const auto is_zero = [](const TextRow& row) {
        return !row.position && row.latitude_deg == 0 && row.longitude_deg == 0;
    };
    const auto count = static_cast<std::size_t>(std::count_if(rows_.begin(), rows_.end(), is_zero));
    if (count == 0) return;
    if (count == rows_.size())
        return note(
            fmt::format("all {} {} are at latitude 0, longitude 0, which is where recorders put places that "
                        "they do not know; they are taken as they stand",
                        count, rows_called_));
    bool jump = false;
    std::vector<TextRow> kept;
    for (TextRow& row : rows_) {
        jump |= row.jump;
        if (is_zero(row)) {
            leave_out("are at latitude 0, longitude 0", row.line);
            continue;
        }
        row.jump = std::exchange(jump, false) && !kept.empty();
        kept.push_back(row);
    }
    taken_ -= count;
    rows_ = std::move(kept);
}

// Heights above the sea become heights above the ellipsoid: by the file's own undulation, which undoes what the
// receiver did (FEEDS.md 1.5), or by the geoid.
Result<void> TextTrack::resolve_heights() {
    const bool none = std::none_of(rows_.begin(), rows_.end(), has_height);
    if (none) note(fmt::format("no height in the file; its {} {} are taken at sea level", rows_.size(), rows_called_));
    for (TextRow& row : rows_) {
        if (none) row.sea_level_m = 0;
        if (row.ellipsoidal_m || !row.sea_level_m) continue;
        if (!row.separation_m && !file_.reading.geoid)
            return refusal(row.line, "heights above sea level need the geoid, whose grid is not there");
        const Metres undulation = row.separation_m ? Metres(*row.separation_m)
                                                   : file_.reading.geoid->undulation(Angle::degrees(row.latitude_deg),
                                                                                     Angle::degrees(row.longitude_deg));
        row.ellipsoidal_m = *row.sea_level_m + undulation.value();
    }
    return {};
}

// What rows are counted by: their time, or in a route their number.
double TextTrack::along(std::size_t i) const {
    return track_.route ? static_cast<double>(i) : text_seconds(rows_[i].time - rows_.front().time);
}

// Rows without a height take theirs from the rows before and after, by time.
void TextTrack::fill_heights() {
    std::vector<std::size_t> known;
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (has_height(rows_[i])) known.push_back(i);
    if (known.size() == rows_.size() || known.empty()) return;
    note(fmt::format("{} of {} {} have no height; it is taken from those before and after", rows_.size() - known.size(),
                     rows_.size(), rows_called_));
    auto after = known.begin();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (after != known.end() && *after == i) {
            ++after;
            continue;
        }
        const std::size_t a = after == known.begin() ? *after : *(after - 1);
        const std::size_t b = after == known.end() ? *(after - 1) : *after;
        const double whole = along(b) - along(a), part = along(i) - along(a);
        const double share = whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0;
        const double from = *rows_[a].ellipsoidal_m, to = *rows_[b].ellipsoidal_m;
        rows_[i].ellipsoidal_m = from + share * (to - from);
    }
}

void TextTrack::place_rows() {
    for (const TextRow& row : rows_) {
        TrackRow point;
        point.time = row.time;
        point.line = row.line;
        point.jump = row.jump;
        point.attitude = row.attitude;
        point.position = row.position
                             ? *row.position
                             : to_ecef(Geodetic::degrees(row.latitude_deg, std::remainder(row.longitude_deg, 360),
                                                         *row.ellipsoidal_m));
        track_.points.push_back(point);
    }
}

void TextTrack::add_velocities() {
    constexpr double standing_mps = 0.1;  // below which receivers leave the course out
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const TextRow& row = rows_[i];
        std::optional<Velocity<Enu>> velocity = row.velocity;
        const bool stands = row.speed_mps && std::abs(*row.speed_mps) < standing_mps;
        if (!velocity && row.speed_mps && (row.course_deg || stands)) {
            const double azimuth = Angle::degrees(row.course_deg.value_or(0)).rad();
            velocity = Velocity<Enu>(*row.speed_mps * std::sin(azimuth), *row.speed_mps * std::cos(azimuth),
                                     row.climb_mps ? *row.climb_mps : climb_by_heights(track_.points, i));
        }
        if (velocity) track_.points[i].velocity = LocalFrame(to_geodetic(track_.points[i].position)).to_ecef(*velocity);
    }
    if (const std::string told = leave_out_foreign_speeds(track_); !told.empty()) note(told);
}

void TextTrack::tell_velocities() {
    const auto& points = track_.points;
    const auto with = static_cast<std::size_t>(
        std::count_if(points.begin(), points.end(), [](const TrackRow& point) { return point.velocity; }));
    const bool speeds = std::any_of(rows_.begin(), rows_.end(), [](const TextRow& row) { return row.speed_mps; });
    const bool courses = std::any_of(rows_.begin(), rows_.end(), [](const TextRow& row) { return row.course_deg; });
    if (speeds && !courses) {
        for (TrackRow& point : track_.points)  // zeros alone would be told as all that there is
            point.velocity.reset();
        note("speeds without a course are not used; velocities are taken from the places");
    } else if (with > 0 && with < points.size()) {
        note(fmt::format("{} of {} {} have a velocity", with, points.size(), rows_called_));
    }
}

std::string TextTrack::told_left_out(const LeftOut& out) const {
    return fmt::format("{} of {} {} {}{}", out.count, rows(), rows_called_, out.why,
                       out.first_line > 0 ? fmt::format(" (first in line {})", out.first_line) : "");
}

Result<Track> TextTrack::finish(std::string_view expected) {
    settle_untimed();
    if (!track_.route) merge_parts();
    drop_zero_places();
    std::vector<std::string> told;
    for (const LeftOut& out : left_out_)
        told.push_back(told_left_out(out));
    if (rows_.empty())
        return refusal(told.empty() ? fmt::format("no {} in it; expected {}", rows_called_, expected)
                                    : fmt::format("{}; expected {}", fmt::join(told, ", "), expected));
    for (const std::string& what : told)
        note(what + " and were left out");
    if (const auto resolved = resolve_heights(); !resolved) return fail(resolved.error());
    fill_heights();
    place_rows();
    if (!track_.route) {
        add_velocities();
        tell_velocities();
    }
    if (absolute_) track_.origin = GpsTime{};
    return std::move(track_);
}

}  // namespace skyloop::inline motion
