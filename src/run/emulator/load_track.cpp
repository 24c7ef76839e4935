#include "run/emulator/load_track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include "base/core/files.hpp"
#include "base/time/utc_time.hpp"
#include "motion/tracks/read_track.hpp"
#include "motion/trajectory/recorded_path.hpp"
#include "motion/trajectory/route.hpp"

namespace skyloop::inline run {
namespace {

// In a run that begins at `start`, were nothing delayed or skipped.
GpsTime first_row_at(const FileSettings& file, GpsTime start) {
    return file.keeps_time && file.track->origin ? *file.track->origin + file.track->points.front().time : start;
}

std::shared_ptr<const FilePath> path_of_file(const FileSettings& file, GpsTime start) {
    const GpsTime first = first_row_at(file, start);
    if (file.route) return std::make_shared<const RoutePath>(*file.route, first);
    return std::make_shared<const RecordedPath>(*file.track, file.gaps, first, file.curve());
}

// Where the path lies in the run.
std::vector<std::string> time_warnings(const FileSettings& file, const PlayedPath& path, const Scenario& scenario,
                                       GpsTime start) {
    std::vector<std::string> warnings;
    const GpsTime first = path.run_time_of(file.playback.skip.value()), last = path.first_end();
    if (last <= start && file.playback.end != EndOfPath::loop)
        warnings.push_back(
            fmt::format("{}: its last row is {:.0f} s before the start of the run; the vehicle stands "
                        "there",
                        file.track->name, difference(start, last).value()));
    if (scenario.run.duration && first >= advanced(start, *scenario.run.duration))
        warnings.push_back(
            fmt::format("{}: its first row is {:.0f} s after the start of the run, which ends before; "
                        "the vehicle stands there",
                        file.track->name, difference(first, start).value()));
    if (path.jumps_back())
        warnings.push_back(
            fmt::format("{}: its last row is far from its first one; each round begins with a jump", file.track->name));
    return warnings;
}

// What shows only beside the run.
std::vector<std::string> track_warnings(const FileSettings& file, const CurveReport& report) {
    std::vector<std::string> warnings;
    for (const std::string& note : file.track->notes)
        warnings.push_back(fmt::format("{}: {}", file.track->name, note));
    if (file.route_told && !file.route)
        warnings.push_back(fmt::format("{}: its rows have times; speed_mps and route_tolerance_m are of files without",
                                       file.track->name));
    if (report.contradictions > 0)
        warnings.push_back(fmt::format("{}: between {} pairs of rows the velocities do not fit the places",
                                       file.track->name, report.contradictions));
    if (report.smoothing.outliers > 0)
        warnings.push_back(fmt::format("{}: {} rows lie further than 5 sigma from the smooth path and do not count",
                                       file.track->name, report.smoothing.outliers));
    return warnings;
}

std::string rate_text(const Track& track) {
    std::vector<Nanoseconds> steps;
    for (std::size_t i = 1; i < track.points.size(); ++i)
        steps.push_back(track.points[i].time - track.points[i - 1].time);
    std::sort(steps.begin(), steps.end());
    const auto part = [&](double of) {
        return to_seconds(steps[static_cast<std::size_t>(of * static_cast<double>(steps.size() - 1))]).value();
    };
    return fmt::format("steps of {:g} s at the median, {:g} to {:g} s", part(0.5), part(0), part(1));
}

std::string smoothing_text(const FileSettings& file, const SmoothingReport& report) {
    constexpr double rough_mps2 = 1;
    if (report.taken)
        return fmt::format("smoothed: noise of {:.3g} m in plan and {:.3g} m up, rows moved by {:.3g} m at most",
                           report.taken->in_plan, report.taken->up, report.largest_shift);
    if (file.smoothing != Smoothing::none) return "kept as they are: no noise beyond the vehicle's motion";
    const PositionNoise noise = noise_of(*file.track, file.vehicle.value_or(VehicleClass::car));
    const double step = to_seconds(file.track->points[1].time - file.track->points[0].time).value();
    const double jitter = std::sqrt(6.0) * std::max(noise.in_plan, noise.up) / (step * step);
    if (jitter < rough_mps2) return "kept as they are";
    return fmt::format(
        "kept as they are; they are rough by {:.3g} m in plan and {:.3g} m up, which smooth = \"noise\" evens out",
        noise.in_plan, noise.up);
}

// All that was found in the file, for who asks.
std::vector<std::string> track_details(const FileSettings& file, const CurveReport& report) {
    const Track& track = *file.track;
    std::vector<std::string> details{fmt::format("format: {}", track.format.empty() ? "table of text" : track.format)};
    if (track.origin)
        details.push_back(fmt::format("times: {} to {}", utc_text(*track.origin + track.points.front().time, 3),
                                      utc_text(*track.origin + track.points.back().time, 3)));
    details.push_back("rows: " + rate_text(track));
    if (!file.gaps.empty()) details.push_back(fmt::format("gaps: {}", file.gaps.size()));
    if (report.stretches > 1) details.push_back(fmt::format("jumps: {}", report.stretches - 1));
    details.push_back("places: " + smoothing_text(file, report.smoothing));
    details.push_back(
        report.rows_with_velocity == track.points.size() ? "velocity: of the rows"
        : report.rows_with_velocity > 0
            ? fmt::format("velocity: of {} rows; of the others by their places", report.rows_with_velocity)
            : "velocity: by the places of the rows");
    details.push_back(report.attitude == AttitudeSource::rows
                          ? fmt::format("attitude: of {} rows", report.rows_with_attitude)
                      : report.attitude == AttitudeSource::none
                          ? "attitude: upright, looks where it goes; vehicle = \"plane\", … banks"
                          : fmt::format("attitude: {}, as a {}", attitude_source_name(report.attitude),
                                        traits_of(*file.vehicle).name));
    if (report.cubic_pieces > 0)
        details.push_back(fmt::format("curve: {} pieces whose acceleration steps", report.cubic_pieces));
    return details;
}

// What its time and its playback ask for together. @param length of the track or the route, s
Result<void> check_playback(const FileSettings& file, const Track& track, double length) {
    const Playback& playback = file.playback;
    if (!std::isfinite(length) && playback.end != EndOfPath::hold)
        return fail(ErrorCode::usage,
                    fmt::format("{}: one place alone, where the vehicle stands for ever; expected end = "
                                "\"hold\", and duration_s in [run]",
                                track.name));
    if (file.keeps_time && track.route)
        return fail(ErrorCode::usage, fmt::format("{}: {}, and trajectory.time = \"recorded\" asks for times; expected "
                                                  "time = \"run\"",
                                                  track.name, track.route->why));
    if (file.keeps_time && !track.origin)
        return fail(
            ErrorCode::usage,
            fmt::format("{}: counts from its own start, and trajectory.time = \"recorded\" asks for a GPS time; "
                        "expected the column utc, unix_s, or gps_week and tow_s",
                        track.name));
    if (file.keeps_time && (playback.delay.value() != 0 || playback.skip.value() != 0 || playback.time_scale != 1))
        return fail(ErrorCode::usage,
                    fmt::format("{}: trajectory.time = \"recorded\" keeps the times of the rows; expected no "
                                "start_delay_s, skip_s or time_scale beside it",
                                track.name));
    if (playback.skip.value() >= length)
        return fail(ErrorCode::usage, fmt::format("{}: skip_s is {:g} s, and the track lasts {:g} s", track.name,
                                                  playback.skip.value(), length));
    return {};
}

// A time without signals, after the start of the run.
struct SilentSpan {
    double from = 0, to = 0;         // s
    std::optional<Seconds> every{};  // comes again
};

// The gaps as the run meets them: what was skipped comes with the next round, if there is one.
std::vector<SilentSpan> silent_spans(const FileSettings& file, const PlayedPath& path, GpsTime start) {
    std::vector<SilentSpan> spans;
    const auto in_run = [&](Nanoseconds time) {
        const Seconds of_track = to_seconds(time - file.track->points.front().time);
        return difference(path.run_time_of(of_track.value()), start).value();
    };
    const auto period = path.period();
    for (const TrackGap& gap : file.gaps) {
        const double from = in_run(gap.from), to = in_run(gap.to);
        if (from < 0 && to > 0) spans.push_back({0, to});
        if (from >= 0)
            spans.push_back({from, to, period});
        else if (period)
            spans.push_back({from + period->value(), to + period->value(), period});
    }
    return spans;
}

// No signal arrives at the receivers on this path while it crosses a gap.
void add_outages(Scenario& scenario, const FileSettings& file, std::span<const SilentSpan> spans,
                 std::span<const std::size_t> receivers) {
    if (receivers.empty()) return;
    for (std::size_t i = 0; i < spans.size(); ++i) {
        FaultEntry outage;
        outage.kind = "outage";
        outage.when.name = fmt::format("gap {} of {}", i + 1, file.path.filename().string());
        outage.when.at = Seconds(spans[i].from);
        outage.when.length = Seconds(spans[i].to - spans[i].from);
        outage.when.every = spans[i].every;
        outage.receivers.assign(receivers.begin(), receivers.end());
        scenario.faults.push_back(std::move(outage));
    }
}

Result<void> read_and_clean(FileSettings& file, const Geoid* geoid) {
    const auto text = read_text_file(file.path);
    if (!text) return fail(text.error());
    const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(text->data()), text->size());
    auto track = read_track(bytes, file.path.string(), {geoid, file.origin});
    if (!track) return fail(track.error());
    file.route.reset();
    file.gaps.clear();
    if (track->route) {
        auto route = fly_route(*track, file.route_settings());
        if (!route) return fail(route.error());
        file.route = std::make_shared<const FlownRoute>(std::move(*route));
    } else {
        auto gaps = clean_track(*track, file.gap, file.gap_policy);
        if (!gaps) return fail(gaps.error());
        file.gaps = std::move(*gaps);
    }
    const double length = file.route ? file.route->shape->duration()
                                     : to_seconds(track->points.back().time - track->points.front().time).value();
    if (const auto fits = check_playback(file, *track, length); !fits) return fits;
    file.track = std::make_shared<const Track>(std::move(*track));
    return {};
}

// What there is to say of places without times.
LoadedTrack told_route(const FileSettings& file) {
    const FlownRoute& route = *file.route;
    const double seconds = route.shape->duration();
    const std::string& name = file.track->name;
    LoadedTrack loaded;
    loaded.description = std::isfinite(seconds)
                             ? fmt::format("{}, a route of {} points in {:.3f} s", name, route.places, seconds)
                             : fmt::format("{}, one place", name);
    for (const auto* notes : {&file.track->notes, &route.notes})
        for (const std::string& note : *notes)
            loaded.warnings.push_back(fmt::format("{}: {}", name, note));
    loaded.details.push_back(fmt::format("format: {}", file.track->format));
    if (std::isfinite(seconds))
        loaded.details.push_back(fmt::format("route: {} of {} points are flown to{}, as a {}",
                                             route.waypoints.size() - route.corners + route.circles, route.places,
                                             route.circles > 0 ? fmt::format(", {} of them by circles of {} corners in "
                                                                             "all",
                                                                             route.circles, route.corners)
                                                               : "",
                                             traits_of(route.vehicle).name));
    return loaded;
}

LoadedTrack told_track(const FileSettings& file, const RecordedPath& path) {
    return {
        fmt::format("{}, {} rows in {:.3f} s", file.track->name, file.track->points.size(), path.duration().value()),
        track_warnings(file, path.report()), track_details(file, path.report())};
}

// One path; nothing to load unless it is of a file. @param receivers that ride on it
Result<LoadedTrack> load_one(TrajectorySettings& way, Scenario& scenario, std::span<const std::size_t> receivers,
                             const Geoid* geoid, GpsTime start) {
    if (auto* generated = std::get_if<GeneratedSettings>(&way)) return load_generated(*generated, scenario.run.seed);
    auto* file = std::get_if<FileSettings>(&way);
    if (!file) return LoadedTrack{};
    if (const auto read = read_and_clean(*file, geoid); !read) return fail(read.error());
    const std::shared_ptr<const FilePath> whole = path_of_file(*file, start);
    const auto* recorded = dynamic_cast<const RecordedPath*>(whole.get());
    LoadedTrack loaded = recorded ? told_track(*file, *recorded) : told_route(*file);
    const PlayedPath path(whole, first_row_at(*file, start), file->playback);
    if (file->playback.alters())
        file->way = std::make_shared<const PlayedPath>(path);
    else
        file->way = whole;
    if (!std::isfinite(path.path().duration().value())) return loaded;
    for (std::string& warning : time_warnings(*file, path, scenario, start))
        loaded.warnings.push_back(std::move(warning));
    if (file->gap_policy == GapPolicy::outage)
        add_outages(scenario, *file, silent_spans(*file, path, start), receivers);
    loaded.path_end = path.first_end();
    if (file->playback.end != EndOfPath::stop) return loaded;
    loaded.end = loaded.path_end;
    if (*loaded.end <= start)
        return fail(ErrorCode::usage, fmt::format("{}: its last row is before the start of the run, and end = \"stop\" "
                                                  "leaves nothing to run",
                                                  file->track->name));
    return loaded;
}

// What one receiver's own path adds to the scenario's.
void add_own(LoadedTrack& loaded, const LoadedTrack& own, const std::string& whose) {
    for (const std::string& warning : own.warnings)
        loaded.warnings.push_back(whose + warning);
    for (const std::string& detail : own.details)
        loaded.details.push_back(whose + detail);
    if (own.end) loaded.end = loaded.end ? std::min(*loaded.end, *own.end) : *own.end;
    if (own.description.empty()) return;
    if (!loaded.description.empty()) loaded.description += "; ";
    loaded.description += whose + own.description;
}

bool stops_at_its_end(const TrajectorySettings& way) {
    const auto* file = std::get_if<FileSettings>(&way);
    return file && file->playback.end == EndOfPath::stop;
}

}  // namespace

bool ends_with_its_path(const Scenario& scenario) {
    return stops_at_its_end(scenario.trajectory) ||
           std::any_of(scenario.receivers.begin(), scenario.receivers.end(), [](const ReceiverEntry& receiver) {
               return receiver.trajectory && stops_at_its_end(*receiver.trajectory);
           });
}

Result<LoadedTrack> load_track(Scenario& scenario, const Geoid* geoid, GpsTime start) {
    std::vector<std::size_t> riders;
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i)
        if (!scenario.receivers[i].trajectory) riders.push_back(i);
    auto loaded = load_one(scenario.trajectory, scenario, riders, geoid, start);
    if (!loaded) return loaded;
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i) {
        if (!scenario.receivers[i].trajectory) continue;
        const std::size_t rider[] = {i};
        const auto own = load_one(*scenario.receivers[i].trajectory, scenario, rider, geoid, start);
        const std::string whose = fmt::format("receiver '{}': ", receiver_name(scenario, i));
        if (!own) return fail(own.error().code, whose + own.error().message);
        add_own(*loaded, *own, whose);
    }
    return loaded;
}

Result<LoadedTrack> load_generated(GeneratedSettings& path, std::uint64_t run_seed) {
    auto plan = plan_generated(path.path, run_seed);
    if (!plan) return fail(ErrorCode::input, "trajectory: " + plan.error());
    path.shape = plan->shape;
    LoadedTrack loaded;
    const double seconds = plan->shape->duration();
    loaded.description = plan->summary.empty() ? std::string("generated path") : plan->summary;
    loaded.description += std::isfinite(seconds) ? fmt::format(", {:.1f} s", seconds) : ", without an end";
    for (const std::string& note : plan->notes)
        loaded.warnings.push_back("trajectory: " + note);
    return loaded;
}

}  // namespace skyloop::inline run
