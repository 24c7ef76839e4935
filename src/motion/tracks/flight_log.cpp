#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/core/std_additions.hpp"
#include "base/geo/local_frame.hpp"
#include "detail/flight_log.hpp"
#include "receiver/observed/ulog.hpp"

namespace skyloop::inline motion {

double ardupilot_metres_per_degree_east(double latitude_deg, double north_m) {
    const double middle_deg = latitude_deg + north_m / ardupilot_metres_per_degree / 2;
    return ardupilot_metres_per_degree * std::cos(middle_deg * std::numbers::pi / 180);
}

GlobalSample on_ardupilot_map(const GlobalSample& origin, const Eigen::Vector3d& ned_m) {
    return {origin.ns, origin.latitude_deg + ned_m.x() / ardupilot_metres_per_degree,
            origin.longitude_deg + ned_m.y() / ardupilot_metres_per_degree_east(origin.latitude_deg, ned_m.x()),
            origin.height_m - ned_m.z()};
}

GlobalSample on_px4_map(const GlobalSample& origin, const Eigen::Vector3d& ned_m) {
    constexpr double radius_m = 6'371'000, degree = std::numbers::pi / 180;
    const double phi = origin.latitude_deg * degree, north = ned_m.x() / radius_m, east = ned_m.y() / radius_m;
    const double c = std::hypot(north, east);
    GlobalSample there{origin.ns, origin.latitude_deg, origin.longitude_deg, origin.height_m - ned_m.z()};
    if (c == 0) return there;
    const double sine = std::cos(c) * std::sin(phi) + north * std::sin(c) * std::cos(phi) / c;
    there.latitude_deg = std::asin(std::clamp(sine, -1.0, 1.0)) / degree;
    there.longitude_deg +=
        std::atan2(east * std::sin(c), c * std::cos(phi) * std::cos(c) - north * std::sin(phi) * std::sin(c)) / degree;
    return there;
}

namespace {

// A step up to which rows count as continuous.
constexpr std::int64_t continuous_ns = 2'500'000'000;

std::int64_t covered_ns(const FlightOffer& offer) {
    std::int64_t covered = 0;
    for (const auto& rows : offer.starts)
        for (std::size_t i = 1; i < rows.size(); ++i)
            if (const std::int64_t step = rows[i].ns - rows[i - 1].ns; step > 0 && step <= continuous_ns)
                covered += step;
    return covered;
}

// Makes rows of a track out of those of a log.
class FlightTrack {
public:
    FlightTrack(FlightLog log, const Geoid* geoid) : log_(std::move(log)), geoid_(geoid) {
        track_.name = log_.name;
        track_.format = log_.format;
        track_.notes = std::move(log_.notes);
    }
    Result<Track> make();

private:
    void order(std::vector<FlightRow>& rows);
    Result<void> add_start(std::vector<FlightRow>& rows, FlightClock& clock);
    Result<TrackRow> row_of(const FlightRow& row, const AttitudeSeries& attitudes);
    void add_notes();

    FlightLog log_;
    const Geoid* geoid_;
    Track track_;
    std::size_t astray_ = 0, undated_ = 0, starts_ = 0, on_geoid_ = 0, on_told_ = 0, moving_ = 0, standing_ = 0;
    std::int64_t next_ns_ = 0;  // of an undated start: after the one before
};

Result<Track> FlightTrack::make() {
    const bool dated = std::any_of(log_.clocks.begin(), log_.clocks.end(),
                                   [](const FlightClock& clock) { return clock.gps_offset_ns.has_value(); });
    if (dated) track_.origin = GpsTime{};
    for (std::size_t i = 0; i < log_.places.starts.size(); ++i) {
        std::vector<FlightRow>& rows = log_.places.starts[i];
        if (rows.empty()) continue;
        if (dated && !log_.clocks[i].gps_offset_ns) {
            undated_ += rows.size();
            continue;
        }
        order(rows);
        if (auto added = add_start(rows, log_.clocks[i]); !added) return fail(added.error());
    }
    if (track_.points.empty())
        return fail(ErrorCode::input, fmt::format("{}: a log ({}) without any place that has a time; expected some",
                                                  track_.name, track_.format));
    add_notes();
    return std::move(track_);
}

// A time that damage has moved is far from the middle one.
void FlightTrack::order(std::vector<FlightRow>& rows) {
    constexpr std::int64_t farthest_ns = 30 * seconds_per_day * 1'000'000'000;
    std::vector<std::int64_t> times;
    for (const FlightRow& row : rows)
        times.push_back(row.ns);
    const std::int64_t middle = *middle_offset(times);
    astray_ += std::erase_if(rows, [&](const FlightRow& row) { return std::abs(row.ns - middle) > farthest_ns; });
    std::stable_sort(rows.begin(), rows.end(), [](const FlightRow& a, const FlightRow& b) { return a.ns < b.ns; });
}

Result<void> FlightTrack::add_start(std::vector<FlightRow>& rows, FlightClock& clock) {
    clock.attitudes.sort();
    const std::int64_t shift = clock.gps_offset_ns.value_or(next_ns_ - rows.front().ns);
    bool first = starts_++ > 0;
    for (const FlightRow& row : rows) {
        const std::int64_t ns = row.ns + shift;
        if (ns < 0 || ns > longest_flight_clock_ns) {
            ++astray_;
            continue;
        }
        auto done = row_of(row, clock.attitudes);
        if (!done) return fail(done.error());
        done->time = Nanoseconds(ns);
        done->jump = row.jump || std::exchange(first, false);
        track_.points.push_back(*done);
    }
    constexpr std::int64_t pause_ns = 1'000'000'000;
    if (!track_.points.empty()) next_ns_ = track_.points.back().time.count() + pause_ns;
    return {};
}

Result<TrackRow> FlightTrack::row_of(const FlightRow& row, const AttitudeSeries& attitudes) {
    Geodetic place = row.place;
    if (row.above_sea && geoid_) {
        place.height.above_ellipsoid += geoid_->undulation(place.latitude, place.longitude);
        ++on_geoid_;
    } else if (row.above_sea && log_.undulation_m) {
        place.height.above_ellipsoid += Metres(*log_.undulation_m);
        ++on_told_;
    } else if (row.above_sea) {
        return fail(ErrorCode::input,
                    fmt::format("{}: the heights of {} are above the sea, and the geoid's grid is not there; expected "
                                "the grid, or heights above the ellipsoid",
                                track_.name, log_.places.name));
    }
    TrackRow done;
    done.position = to_ecef(place);
    if (row.velocity_ned) {
        const Eigen::Vector3d& v = *row.velocity_ned;
        done.velocity = LocalFrame(place).to_ecef(Velocity<Enu>(v.y(), v.x(), -v.z()));
        ++moving_;
    }
    if (const auto turn = row.turn ? row.turn : attitudes.at(row.ns)) {
        done.attitude = Attitude(*turn);
        ++standing_;
    }
    return done;
}

void FlightTrack::add_notes() {
    const std::size_t rows = track_.points.size();
    if (moving_ < rows) add_count_note(track_.notes, rows - moving_, "rows have no velocity");
    if (standing_ < rows) add_count_note(track_.notes, rows - standing_, "rows have no attitude");
    add_count_note(track_.notes, on_geoid_, "heights above the sea were taken above EGM96");
    if (on_told_ > 0)
        track_.notes.push_back(
            fmt::format("{} heights above the sea were taken above the geoid of the log, at {:.1f} m", on_told_,
                        *log_.undulation_m));
    if (starts_ > 1)
        track_.notes.push_back(fmt::format("the autopilot started {} times; no way leads from one start to the next{}",
                                           starts_, track_.origin ? "" : ", which follows after 1 s"));
    add_count_note(track_.notes, undated_, "rows of starts without a GPS time were left out");
    add_count_note(track_.notes, astray_, "rows with a time far from all others were left out");
    if (!track_.origin) track_.notes.emplace_back("the log tells no GPS time; it counts from its own start");
}

}  // namespace

std::optional<std::int64_t> flight_clock_ns(std::optional<double> microseconds) {
    constexpr double longest_us = static_cast<double>(longest_flight_clock_ns) / 1000;
    if (!microseconds || !(*microseconds >= 0 && *microseconds <= longest_us)) return std::nullopt;
    return static_cast<std::int64_t>(*microseconds) * 1000;
}

std::optional<std::int64_t> gps_ns_of_posix_us(double microseconds) {
    const auto time = time_of_posix_us(microseconds);
    return time ? std::optional(time->time_since_epoch().count()) : std::nullopt;
}

std::optional<Eigen::Quaterniond> logged_quaternion(std::optional<double> w, std::optional<double> x,
                                                    std::optional<double> y, std::optional<double> z) {
    if (!w || !x || !y || !z) return std::nullopt;
    const Eigen::Quaterniond turn(*w, *x, *y, *z);
    if (!(turn.squaredNorm() > 0.8 && turn.squaredNorm() < 1.2)) return std::nullopt;
    return turn.normalized();
}

std::optional<Eigen::Vector3d> logged_velocity(std::optional<double> north, std::optional<double> east,
                                               std::optional<double> down) {
    constexpr double fastest = 20'000;
    if (!north || !east || !down) return std::nullopt;
    const Eigen::Vector3d velocity(*north, *east, *down);
    if (!(velocity.cwiseAbs().maxCoeff() <= fastest && velocity.allFinite())) return std::nullopt;
    return velocity;
}

std::optional<Eigen::Quaterniond> logged_angles(std::optional<double> roll_deg, std::optional<double> pitch_deg,
                                                std::optional<double> yaw_deg) {
    constexpr double most = 720;
    if (!roll_deg || !pitch_deg || !yaw_deg) return std::nullopt;
    for (const double angle : {*roll_deg, *pitch_deg, *yaw_deg})
        if (!(std::abs(angle) <= most)) return std::nullopt;
    return Attitude::roll_pitch_yaw(Angle::degrees(*roll_deg), Angle::degrees(*pitch_deg), Angle::degrees(*yaw_deg))
        .body_to_ned();
}

std::optional<FlightRow> flight_row(std::int64_t ns, double latitude_deg, double longitude_deg, double height_m) {
    if (latitude_deg == 0 && longitude_deg == 0) return std::nullopt;
    const auto place = place_from_degrees(latitude_deg, longitude_deg, height_m);
    if (!place) return std::nullopt;
    return FlightRow{ns, *place};
}

std::optional<std::size_t> chosen_offer(std::span<const FlightOffer> offers) {
    std::int64_t most = 0;
    for (const FlightOffer& offer : offers)
        most = std::max(most, covered_ns(offer));
    for (std::size_t i = 0; i < offers.size(); ++i)
        if (const std::int64_t covered = covered_ns(offers[i]); covered > 0 && covered >= most / 2) return i;
    // All of them sparse: the one that says most.
    std::optional<std::size_t> best;
    std::size_t most_rows = 1;
    for (std::size_t i = 0; i < offers.size(); ++i) {
        std::size_t rows = 0;
        for (const auto& start : offers[i].starts)
            rows += start.size();
        if (rows > most_rows) most_rows = rows, best = i;
    }
    return best;
}

std::string told_choice(const FlightOffer& offer, std::size_t index) {
    std::vector<std::int64_t> steps;
    std::size_t count = 0;
    for (const auto& rows : offer.starts) {
        count += rows.size();
        for (std::size_t i = 1; i < rows.size(); ++i)
            if (rows[i].ns > rows[i - 1].ns) steps.push_back(rows[i].ns - rows[i - 1].ns);
    }
    const auto step = middle_offset(steps);
    const std::string rate = step ? fmt::format(" at {:.1f} Hz", 1e9 / static_cast<double>(*step)) : "";
    return fmt::format("the places are the {} of {}{}{}", count, offer.name, rate,
                       index == 0 ? "" : ", for better sources cover less than half of the log");
}

Result<Track> track_of_flight(FlightLog log, const Geoid* geoid) { return FlightTrack(std::move(log), geoid).make(); }

bool AutopilotStarts::follows(std::int64_t ns, std::int64_t last) {
    constexpr std::int64_t disorder_ns = 2'000'000'000, pause_ns = 600'000'000'000;
    return ns >= last - disorder_ns && ns <= last + pause_ns;
}

std::optional<std::size_t> AutopilotStarts::of(std::int64_t ns) {
    confirmed_ = false;
    if (!last_ || follows(ns, *last_)) {
        last_ = std::max(last_.value_or(0), ns);
        candidate_.reset();
        return start_;
    }
    if (!candidate_ || !follows(ns, *candidate_)) {
        candidate_ = ns;
        return std::nullopt;
    }
    constexpr std::size_t most_starts = 1000;
    if (ns < *last_ && ++start_ >= most_starts) --start_;
    last_ = ns;
    candidate_.reset();
    confirmed_ = true;
    return start_;
}

std::optional<std::int64_t> middle_offset(std::vector<std::int64_t>& offsets) {
    if (offsets.empty()) return std::nullopt;
    return middle_of(offsets);
}

void add_count_note(std::vector<std::string>& notes, std::size_t count, const std::string& what) {
    if (count > 0) notes.push_back(fmt::format("{} {}", count, what));
}

}  // namespace skyloop::inline motion
