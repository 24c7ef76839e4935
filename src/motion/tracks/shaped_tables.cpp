// Tables without a header, told by the shape of their first row.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "detail/text_track.hpp"

namespace skyloop::inline motion {
namespace {

constexpr std::string_view shaped_comments = "#%";

// The first row as numbers; empty where a cell is none.
struct FirstRow {
    char separator = ' ';
    std::vector<double> numbers;
};

FirstRow first_row_of(const TrackFile& file) {
    FirstRow first;
    TextLines lines(file.text);
    constexpr std::size_t most_lines = 1000;  // of comments before it
    while (lines.next() && lines.number() < most_lines) {
        const std::string_view line = trimmed_cell(lines.line());
        if (line.empty() || shaped_comments.find(line.front()) != std::string_view::npos) continue;
        first.separator = separator_in(line);
        std::vector<std::string_view> cells;
        split_table_line(line, first.separator, cells);
        for (const std::string_view cell : cells) {
            const auto number = text_number(cell);
            if (!number) return {};
            first.numbers.push_back(*number);
        }
        break;
    }
    return first;
}

Result<Nanoseconds> counted_seconds(const TableCells& table, double seconds) {
    constexpr double latest_s = 9e9;
    if (!(std::abs(seconds) < latest_s))
        return table.refusal(fmt::format("the time is {:g} s; expected less than {:g}", seconds, latest_s));
    return to_nanoseconds(Seconds(seconds));
}

using Numbers = std::vector<double>;
using ShapedRow = std::function<Result<void>(const TableCells&, const Numbers&, TextRow&)>;

// The track of all rows of the file, each of `count` numbers or more.
Result<Track> track_of_rows(const TrackFile& file, TextTrack& track, std::size_t count, const ShapedRow& take,
                            std::string_view expected) {
    TableCells table(file, first_row_of(file).separator, shaped_comments);
    while (table.next()) {
        const auto numbers = table.numbers(0, count);
        if (!numbers) return fail(numbers.error());
        TextRow row;
        row.line = table.line();
        if (const auto taken = take(table, *numbers, row); !taken) return fail(taken.error());
        if (const auto added = track.add(row); !added) return fail(added.error());
    }
    return track.finish(expected);
}

// gps-sdr-sim's user motion (its README): time from the start, then ECEF metres, or latitude, longitude and height
// above the ellipsoid; told apart by the numbers, as no angle is beyond 360.
Result<Track> read_sim_motion(const TrackFile& file) {
    const FirstRow first = first_row_of(file);
    bool ecef = false;
    for (std::size_t i = 1; i < 3; ++i)
        ecef |= std::abs(first.numbers[i]) > 360;
    TextTrack track(file, ecef ? "motion of gps-sdr-sim, ECEF" : "motion of gps-sdr-sim, geodetic");
    track.count_from_start();
    const auto take = [&](const TableCells& table, const Numbers& v, TextRow& row) -> Result<void> {
        const auto time = counted_seconds(table, v[0]);
        if (!time) return fail(time.error());
        row.time = *time;
        if (ecef) {
            row.position = Position<Ecef>(v[1], v[2], v[3]);
        } else {
            row.latitude_deg = v[1], row.longitude_deg = v[2];
            row.ellipsoidal_m = v[3];
        }
        return {};
    };
    return track_of_rows(file, track, 4, take, "rows of a time and a place");
}

// TUM's format of trajectories (RGB-D benchmark, "file formats"): time, x, y, z, and a quaternion with w last, here of
// a body with axes forward, left, up in axes east, north, up.
Result<Track> read_tum(const TrackFile& file) {
    TextTrack track(file, "TUM");
    if (!file.reading.origin)
        return track.refusal(
            "local metres (time, x, y, z and a quaternion); expected trajectory.origin = [latitude, "
            "longitude, height], where they begin");
    const LocalFrame frame(*file.reading.origin);
    const FirstRow first = first_row_of(file);
    const bool posix = first.numbers[0] > static_cast<double>(gps_epoch_posix_s);
    if (!posix) track.count_from_start();
    track.note("local metres are taken as east, north, up; the body's axes as forward, left, up");
    const auto take = [&](const TableCells& table, const Numbers& v, TextRow& row) -> Result<void> {
        const auto counted = counted_seconds(table, v[0]);
        if (!counted) return fail(counted.error());
        const auto time = posix ? posix_since_1980(table.cell(0)) : std::optional(*counted);
        if (!time) return table.refusal(fmt::format("the time is '{:.40}'; expected POSIX seconds", table.cell(0)));
        row.time = *time;
        row.position = frame.to_ecef(Position<Enu>(v[1], v[2], v[3]));
        const Eigen::Quaterniond turn(v[7], v[4], v[5], v[6]);  // w first
        if (std::abs(turn.norm() - 1) < 0.05) row.attitude = attitude_of_flu_in_enu(turn);
        return {};
    };
    return track_of_rows(file, track, 8, take, "rows of a time, x, y, z and a quaternion");
}

// KITTI's OXTS packets, one row each (devkit, readme of raw data): latitude, longitude, altitude, roll, pitch, yaw
// (from east, against the clock), velocities north and east, forward, left and up, … They have no times, but come at 10
// Hz.
Result<Track> read_oxts(const TrackFile& file) {
    TextTrack track(file, "KITTI OXTS");
    track.count_from_start();
    track.note("the rows have no times and are taken at 10 Hz, as KITTI gives them");
    std::int64_t index = 0;
    const auto take = [&](const TableCells&, const Numbers& v, TextRow& row) -> Result<void> {
        row.time = std::chrono::milliseconds(100) * index++;
        row.latitude_deg = v[0], row.longitude_deg = v[1];
        row.sea_level_m = v[2];
        // Roll counts the left side up, pitch the front down.
        row.attitude = Attitude::roll_pitch_yaw(Angle::radians(v[3]), Angle::radians(-v[4]),
                                                Angle::radians(std::numbers::pi / 2 - v[5]));
        row.velocity = Velocity<Enu>(v[7], v[6], v[10]);
        return {};
    };
    return track_of_rows(file, track, 11, take, "rows of 30 numbers");
}

// Inertial Explorer's table of UrbanNav (its README, "ground truth"): POSIX time, GPS week, time of week, latitude and
// longitude in degrees, minutes and seconds, height above the ellipsoid, velocity in the body (right, forward, up),
// its acceleration, roll, pitch, heading, quality.
constexpr std::size_t explorer_columns = 20;

double sexagesimal(const Numbers& v, std::size_t at, std::string_view first) {
    const double size = std::abs(v[at]) + v[at + 1] / 60 + v[at + 2] / 3600;
    return first.starts_with('-') ? -size : size;  // the sign of "-0 30 00" too
}

Result<Track> read_explorer(const TrackFile& file) {
    TextTrack track(file, "Inertial Explorer");
    const auto take = [](const TableCells& table, const Numbers& v, TextRow& row) -> Result<void> {
        const auto time = week_since_1980(v[1], v[2]);
        if (!time) return table.refusal("no GPS week and time of week in the second and third cell");
        row.time = *time;
        row.latitude_deg = sexagesimal(v, 3, table.cell(3));
        row.longitude_deg = sexagesimal(v, 6, table.cell(6));
        row.ellipsoidal_m = v[9];
        row.attitude = Attitude::roll_pitch_yaw(Angle::degrees(v[16]), Angle::degrees(v[17]), Angle::degrees(v[18]));
        const Eigen::Vector3d ned = row.attitude->body_to_ned() * Eigen::Vector3d(v[11], v[10], -v[12]);
        row.velocity = Velocity<Enu>(ned.y(), ned.x(), -ned.z());
        return {};
    };
    return track_of_rows(file, track, explorer_columns, take, "rows of 20 numbers");
}

struct ShapedDialect {
    std::size_t columns;
    bool (*fits)(const FirstRow&);
    Result<Track> (*read)(const TrackFile&);
};

constexpr std::array shaped_dialects{
    ShapedDialect{4, [](const FirstRow& row) { return row.numbers[0] == 0; }, read_sim_motion},
    ShapedDialect{8,
                  [](const FirstRow& row) {
                      return std::abs(std::hypot(std::hypot(row.numbers[4], row.numbers[5]),
                                                 std::hypot(row.numbers[6], row.numbers[7])) -
                                      1) < 0.05;
                  },
                  read_tum},
    ShapedDialect{explorer_columns,
                  [](const FirstRow& row) {
                      const double gps = row.numbers[1] * static_cast<double>(seconds_per_week) + row.numbers[2] +
                                         static_cast<double>(gps_epoch_posix_s);
                      return std::abs(row.numbers[0] - gps) < 60;
                  },
                  read_explorer},
    ShapedDialect{30, [](const FirstRow&) { return true; }, read_oxts}};

const ShapedDialect* shaped_dialect_of(const TrackFile& file) {
    const FirstRow first = first_row_of(file);
    for (const ShapedDialect& dialect : shaped_dialects)
        if (first.numbers.size() == dialect.columns && dialect.fits(first)) return &dialect;
    return nullptr;
}

}  // namespace

bool is_shaped_dialect(const TrackFile& file) { return shaped_dialect_of(file) != nullptr; }

Result<Track> read_shaped_dialect(const TrackFile& file) { return shaped_dialect_of(file)->read(file); }

}  // namespace skyloop::inline motion
