#include "motion/trajectory/track_csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "base/core/number_text.hpp"
#include "base/core/table_text.hpp"
#include "base/core/written_place.hpp"
#include "base/geo/local_frame.hpp"
#include "base/time/utc_time.hpp"
#include "detail/track_table.hpp"
#include "motion/trajectory/track.hpp"

namespace skyloop::inline motion {
namespace {

using enum TrackQuantity;

// Whole seconds beyond which a time is none: the year 2261, the end of GpsTime, less a margin.
constexpr double latest_s = 9e9, latest_week = 11400;

class TrackTable {
public:
    TrackTable(const std::string& name, const Geoid* geoid, const std::optional<Geodetic>& origin) : geoid_(geoid) {
        track_.name = name;
        track_.format = "CSV";
        if (origin) local_.emplace(*origin);
    }
    Result<Track> read(std::string_view text);

private:
    Result<void> take_line(std::string_view line);
    Result<void> take_header(std::string_view line);
    Result<void> take_row();
    Result<std::optional<double>> number(TrackQuantity quantity);
    Result<std::optional<Nanoseconds>> time();
    Result<std::optional<Nanoseconds>> dated_time();
    Result<std::optional<Nanoseconds>> counted_time(TrackQuantity quantity);
    Result<std::optional<Nanoseconds>> utc_time();
    Result<std::optional<Nanoseconds>> gps_time();
    Result<std::optional<Position<Ecef>>> place();
    Result<std::optional<Position<Ecef>>> cartesian_place();
    Result<std::optional<Position<Ecef>>> geodetic_place();
    [[nodiscard]] Result<std::optional<Position<Ecef>>> checked_place(const Position<Ecef>& point) const;
    Result<std::optional<Position<Ecef>>> local_place();
    Result<std::optional<Eigen::Vector3d>> three(const std::array<TrackQuantity, 3>& axes);
    Result<void> add_velocity(TrackRow& point);
    Result<void> add_attitude(TrackRow& point);
    Result<void> add_turn(TrackRow& point);
    Result<void> add_reset(TrackRow& point);
    void add_climbs();
    void doubt(std::string note) {
        if (!note.empty()) track_.notes.push_back(std::move(note));
    }
    void add_notes();
    [[nodiscard]] tl::unexpected<Error> refusal(const std::string& what) const {
        return fail(ErrorCode::input, fmt::format("{}:{}: {}", track_.name, line_, what));
    }
    [[nodiscard]] std::string_view cell(TrackQuantity quantity) const {
        const std::size_t index = columns_[quantity]->index;
        return index < cells_.size() ? cells_[index] : std::string_view();
    }

    const Geoid* geoid_;
    std::optional<LocalFrame> local_;
    std::optional<double> last_reset_;
    Track track_;
    std::size_t names_ = 0;  // in the first line
    std::size_t line_ = 0, without_time_ = 0, without_place_ = 0, without_fix_ = 0, rows_ = 0;
    std::string_view below_;  // the line being read
    char separator_ = ',';
    bool has_header_ = false;
    TrackColumns columns_;
    HemisphereColumns hemispheres_;
    TrackDates dates_;
    std::set<std::size_t> level_;  // lines of rows whose velocity has no climb yet
    LineCells cells_;
};

Result<Track> TrackTable::read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        ++line_;
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        below_ = text;
        if (auto taken = take_line(line); !taken) return fail(std::move(taken.error()));
    }
    if (!has_header_)
        return fail(ErrorCode::input,
                    fmt::format("{}: no line with the names of the columns; expected one such as t_s,lat_deg,lon_deg,"
                                "h_ell_m and rows of numbers",
                                track_.name));
    if (const auto letters = hemispheres_.not_understood())
        return fail(ErrorCode::input, fmt::format("{}: {}", track_.name, *letters));
    doubt(leave_out_zero_places(track_, rows_));
    add_climbs();
    if (columns_.has(speed) && columns_.has(course)) doubt(leave_out_foreign_speeds(track_));
    if (columns_.has(since_start) && columns_.date())
        dates_.date(track_, columns_[since_start]->name, columns_.date()->name);
    add_notes();
    return std::move(track_);
}

Result<void> TrackTable::take_line(std::string_view line) {
    constexpr std::size_t longest = 65536;
    if (line.size() > longest) return refusal(fmt::format("a line of {} characters; expected a table", line.size()));
    const std::string_view plain = trimmed_cell(line);
    if (says_nothing(plain)) return {};
    // "sep=;" is a word of Excel to itself.
    if (!has_header_) return plain.starts_with("sep=") ? Result<void>() : take_header(line);
    split_table_line(line, separator_, cells_);
    if (const auto mistake = width_mistake(cells_, names_)) return refusal(*mistake);
    cells_.resize(std::min(cells_.size(), names_));
    return take_row();
}

Result<void> TrackTable::take_header(std::string_view line) {
    separator_ = separator_in(trimmed_cell(line));
    split_table_line(line, separator_, cells_);
    LineCells first;
    split_table_line(first_row_line(below_), separator_, first);
    auto columns = TrackColumns::of(cells_, first);
    if (!columns) return refusal(columns.error().message);
    columns_ = std::move(*columns);
    if (columns_.has(altitude) && !columns_.has(height) && !columns_.has(x) && !geoid_)
        return refusal(
            fmt::format("{} needs the geoid, whose grid is not there; expected h_ell_m, metres above the "
                        "ellipsoid",
                        columns_[altitude]->name));
    if (columns_.has_local() && !local_)
        return refusal("local metres; expected trajectory.origin = [latitude, longitude, height], where they begin");
    if (!columns_.has_time())
        track_.route = RouteOrder{"no column says the time (t_s, unix_s, utc, …)"};
    else if (!columns_.has(since_start))
        track_.origin = GpsTime{};
    has_header_ = true;
    names_ = cells_.size();
    if (columns_.has(latitude) && columns_.has(longitude))
        hemispheres_ =
            HemisphereColumns({cells_.begin(), cells_.end()}, {columns_[latitude]->index, columns_[longitude]->index});
    return {};
}

Result<void> TrackTable::take_row() {
    ++rows_;
    if (columns_.has(fix)) {
        const auto told = number(fix);
        if (!told) return fail(told.error());
        if (*told && **told < 2) return ++without_fix_, Result<void>();
    }
    const auto when = time();
    if (!when) return fail(when.error());
    const auto where = place();
    if (!where) return fail(where.error());
    if (!*when) return ++without_time_, Result<void>();
    if (!*where) return ++without_place_, Result<void>();
    TrackRow point{**when, **where, {}, {}, line_};
    if (const auto added = add_velocity(point); !added) return added;
    if (const auto added = add_attitude(point); !added) return added;
    if (const auto added = add_reset(point); !added) return added;
    track_.points.push_back(point);
    return {};
}

Result<std::optional<double>> TrackTable::number(TrackQuantity quantity) {
    if (!columns_.has(quantity)) return std::nullopt;
    const std::string_view text = cell(quantity);
    if (is_absent(text)) return std::nullopt;
    const auto value = number_of_cell(text, *columns_[quantity], quantity);
    if (value) return value;
    return refusal(
        fmt::format("{} is '{:.40}'; expected a number with a decimal point", columns_[quantity]->name, text));
}

// Nanoseconds of a count: whole counts stay whole, which a double of them would not.
Result<std::optional<Nanoseconds>> TrackTable::counted_time(TrackQuantity quantity) {
    const auto seconds = number(quantity);
    if (!seconds) return fail(seconds.error());
    if (!*seconds) return std::nullopt;
    if (std::abs(**seconds) > latest_s)
        return refusal(
            fmt::format("{} is '{}'; expected less than {:g} s", columns_[quantity]->name, cell(quantity), latest_s));
    const std::string_view text = cell(quantity);
    if (const auto whole = number_in<std::int64_t>(text))
        return Nanoseconds(*whole * std::llround(columns_[quantity]->scale * 1e9));
    return to_nanoseconds(Seconds(**seconds));
}

Result<std::optional<Nanoseconds>> TrackTable::utc_time() {
    const std::string_view text = cell(utc);
    if (is_absent(text)) return std::nullopt;
    const auto time = time_of_utc_cell(text);
    if (!time) return refusal(fmt::format("{}: {}", columns_[utc]->name, time.error().message));
    return time->time_since_epoch();
}

Result<std::optional<Nanoseconds>> TrackTable::gps_time() {
    const auto week = number(gps_week), seconds = number(tow);
    if (!week) return fail(week.error());
    if (!seconds) return fail(seconds.error());
    if (!*week || !*seconds) return std::nullopt;
    if (**week < 0 || **week > latest_week || **week != std::floor(**week) || std::abs(**seconds) > latest_s / 10)
        return refusal(fmt::format("gps_week is '{}' and tow_s '{}'; expected a week of 0 to {} and seconds in it",
                                   cell(gps_week), cell(tow), latest_week));
    return skyloop::to_gps_time(static_cast<std::int64_t>(**week), **seconds).time_since_epoch();
}

Result<std::optional<Nanoseconds>> TrackTable::time() {
    if (!columns_.has_time()) return Nanoseconds(0);
    if (!columns_.has(since_start)) return dated_time();
    const auto counted = counted_time(since_start);
    if (!counted || !*counted || !columns_.date()) return counted;
    // A date that cannot be read costs no row whose count can.
    if (const auto dated = dated_time(); dated && *dated) dates_.add(**counted, **dated);
    return counted;
}

Result<std::optional<Nanoseconds>> TrackTable::dated_time() {
    if (columns_.has(gps_week) && columns_.has(tow)) return gps_time();
    if (columns_.has(utc)) return utc_time();
    const auto counted = counted_time(posix);
    if (!counted || !*counted) return counted;
    return from_posix(**counted, LeapSeconds::announced()).time_since_epoch();
}

Result<std::optional<Position<Ecef>>> TrackTable::place() {
    if (columns_.has(x) && columns_.has(y) && columns_.has(z)) return cartesian_place();
    return columns_.has_local() ? local_place() : geodetic_place();
}

// Three columns of one row; nothing where one of them is empty.
Result<std::optional<Eigen::Vector3d>> TrackTable::three(const std::array<TrackQuantity, 3>& axes) {
    Eigen::Vector3d values;
    for (Eigen::Index i = 0; i < 3; ++i) {
        const auto value = number(axes[static_cast<std::size_t>(i)]);
        if (!value) return fail(value.error());
        if (!*value) return std::nullopt;
        values[i] = **value;
    }
    return values;
}

Result<std::optional<Position<Ecef>>> TrackTable::cartesian_place() {
    const auto values = three({x, y, z});
    if (!values) return fail(values.error());
    if (!*values) return std::nullopt;
    return checked_place(Position<Ecef>(**values));
}

Result<std::optional<Position<Ecef>>> TrackTable::checked_place(const Position<Ecef>& point) const {
    if (const auto mistake = mistake_of_place(point)) return refusal(*mistake);
    return point;
}

Result<std::optional<Position<Ecef>>> TrackTable::local_place() {
    const bool upwards = columns_.has(local_up);
    const auto values = three({local_east, local_north, upwards ? local_up : local_down});
    if (!values) return fail(values.error());
    if (!*values) return std::nullopt;
    const Eigen::Vector3d& v = **values;
    return checked_place(local_->to_ecef(Position<Enu>(v.x(), v.y(), upwards ? v.z() : -v.z())));
}

Result<std::optional<Position<Ecef>>> TrackTable::geodetic_place() {
    const auto lat = number(latitude), lon = number(longitude), ellipsoidal = number(height), msl = number(altitude);
    for (const auto* value : {&lat, &lon, &ellipsoidal, &msl})
        if (!*value) return fail(value->error());
    if (!*lat || !*lon || !(*ellipsoidal || *msl)) return std::nullopt;
    if (!*ellipsoidal && !geoid_)
        return refusal(
            "a height above sea level alone; expected one above the ellipsoid, the geoid's grid not being there");
    const auto sided = hemispheres_.place(cells_, {**lat, **lon}, line_);
    if (!sided) return refusal(sided.error());
    const auto checked = place_from_degrees((*sided)[0], (*sided)[1], ellipsoidal->value_or(msl->value_or(0)));
    if (!checked) return refusal(checked.error());
    Geodetic where = *checked;
    if (!*ellipsoidal)
        where.height.above_ellipsoid = Metres(**msl) + geoid_->undulation(where.latitude, where.longitude);
    return to_ecef(where);
}

Result<void> TrackTable::add_velocity(TrackRow& point) {
    constexpr double fastest = 12000;  // m/s: faster than any orbit, a mistake of units
    double values[7];
    bool there[7];
    const TrackQuantity all[] = {north, east, down, up, speed, course, climb};
    for (int i = 0; i < 7; ++i) {
        const auto value = number(all[i]);
        if (!value) return fail(value.error());
        there[i] = value->has_value();
        values[i] = value->value_or(0);
        if (i != 5 && std::abs(values[i]) > fastest)
            return refusal(
                fmt::format("{} is '{}'; expected at most {:g} m/s", columns_[all[i]]->name, cell(all[i]), fastest));
    }
    const LocalFrame frame(to_geodetic(point.position));
    const double rises = there[2] ? -values[2] : there[3] ? values[3] : values[6];
    const bool vertical = there[2] || there[3] || there[6];
    const bool told = columns_.has(down) || columns_.has(up) || columns_.has(climb);
    if (told && !vertical) return {};
    if (there[0] && there[1]) {
        point.velocity = frame.to_ecef(Velocity<Enu>(values[1], values[0], rises));
        if (!vertical) level_.insert(line_);
    } else if (there[4] && there[5]) {
        const double azimuth = Angle::degrees(values[5]).rad();
        point.velocity =
            frame.to_ecef(Velocity<Enu>(values[4] * std::sin(azimuth), values[4] * std::cos(azimuth), rises));
        if (!vertical) level_.insert(line_);
    }
    return {};
}

// Their climb is the slope of the heights.
void TrackTable::add_climbs() {
    for (std::size_t row = 0; row < track_.points.size(); ++row) {
        TrackRow& point = track_.points[row];
        if (!level_.contains(point.line)) continue;
        const LocalFrame frame(to_geodetic(point.position));
        const Eigen::Vector3d level = frame.to_enu(*point.velocity).vector();
        point.velocity = frame.to_ecef(Velocity<Enu>(level.x(), level.y(), climb_by_heights(track_.points, row)));
    }
}

Result<void> TrackTable::add_attitude(TrackRow& point) {
    const auto r = number(roll), p = number(pitch), w = number(yaw);
    for (const auto* value : {&r, &p, &w})
        if (!*value) return fail(value->error());
    if (*r && *p && *w)
        point.attitude = Attitude::roll_pitch_yaw(Angle::degrees(**r), Angle::degrees(**p), Angle::degrees(**w));
    return columns_.has(qw) ? add_turn(point) : Result<void>();
}

// A quaternion of the turn from the body to north, east, down.
Result<void> TrackTable::add_turn(TrackRow& point) {
    const auto w = number(qw);
    if (!w) return fail(w.error());
    const auto v = three({qx, qy, qz});
    if (!v) return fail(v.error());
    if (!*w || !*v) return {};
    const Eigen::Quaterniond turn(**w, (**v).x(), (**v).y(), (**v).z());
    constexpr double largest_error = 0.05;  // of its length: more is no quaternion of a turn (FEEDS.md 3.1)
    if (!(std::abs(turn.norm() - 1) < largest_error))
        return refusal(fmt::format("the length of the quaternion is {:g}; expected 1", turn.norm()));
    point.attitude = Attitude(turn);
    return {};
}

Result<void> TrackTable::add_reset(TrackRow& point) {
    const auto told = number(reset);
    if (!told) return fail(told.error());
    if (!*told) return {};
    point.jump = last_reset_ && *last_reset_ != **told;
    last_reset_ = *told;
    return {};
}

void TrackTable::add_notes() {
    const auto tell = [&](std::size_t number_of, std::string_view what) {
        if (number_of > 0) track_.notes.push_back(fmt::format("{} of {} rows {}", number_of, rows_, what));
    };
    tell(without_time_, "have no time and were left out");
    tell(without_place_, "have no place and were left out");
    tell(without_fix_, "have a fix below 2 and were left out");
    const auto with_velocity = static_cast<std::size_t>(
        std::count_if(track_.points.begin(), track_.points.end(), [](const TrackRow& p) { return p.velocity; }));
    if (with_velocity > 0 && with_velocity < track_.points.size())
        track_.notes.push_back(
            fmt::format("{} of {} rows have a velocity; the others take theirs from their neighbours", with_velocity,
                        track_.points.size()));
    const auto any = [&](TrackQuantity a, TrackQuantity b) { return columns_.has(a) || columns_.has(b); };
    if (with_velocity == 0 && (any(north, east) || any(speed, course)))
        track_.notes.emplace_back(
            "no row has a whole velocity (north and east, or speed and course); velocities are "
            "taken from the places");
    for (const std::string& what : columns_.understood())
        track_.notes.push_back(what);
    for (const std::string& what : hemispheres_.notes(columns_.unused()))
        track_.notes.push_back(what);
}

}  // namespace

Result<Track> read_track_csv(std::string_view text, const std::string& name, const Geoid* geoid,
                             const std::optional<Geodetic>& origin) {
    return TrackTable(name, geoid, origin).read(text);
}

}  // namespace skyloop::inline motion
