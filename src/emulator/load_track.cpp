#include "skyloop/emulator/load_track.hpp"

#include <fmt/format.h>

#include "skyloop/base/text_file.hpp"
#include "skyloop/time/utc_time.hpp"
#include "skyloop/tracks/read_track.hpp"
#include "skyloop/trajectory/recorded_path.hpp"

namespace skyloop {
namespace {

// What shows only beside the run.
std::vector<std::string> track_warnings(const FileSettings& file, const RecordedPath& path, const Scenario& scenario,
                                        GpsTime start) {
    std::vector<std::string> warnings;
    for (const std::string& note : file.track->notes)
        warnings.push_back(fmt::format("{}: {}", file.track->name, note));
    if (path.contradictions() > 0)
        warnings.push_back(fmt::format("{}: between {} pairs of rows the velocities do not fit the places",
                                       file.track->name, path.contradictions()));
    const GpsTime first = first_row_at(file, start);
    const GpsTime last = advanced(first, path.duration());
    if (last <= start)
        warnings.push_back(
            fmt::format("{}: its last row is {:.0f} s before the start of the run; the vehicle stands "
                        "there",
                        file.track->name, difference(start, last).value()));
    if (scenario.run.duration && first >= advanced(start, *scenario.run.duration))
        warnings.push_back(
            fmt::format("{}: its first row is {:.0f} s after the start of the run, which ends before; "
                        "the vehicle stands there",
                        file.track->name, difference(first, start).value()));
    return warnings;
}

// One path; nothing to load unless it is of a file or generated.
Result<LoadedTrack> load_one(TrajectorySettings& way, const Scenario& scenario, const Geoid* geoid, GpsTime start) {
    if (auto* generated = std::get_if<GeneratedSettings>(&way)) return load_generated(*generated, scenario.run.seed);
    auto* file = std::get_if<FileSettings>(&way);
    if (!file) return LoadedTrack{};
    const auto text = read_text_file(file->path);
    if (!text) return fail(text.error());
    const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(text->data()), text->size());
    auto track = read_track(bytes, file->path.string(), {geoid, file->origin});
    if (!track) return fail(track.error());
    auto gaps = clean_track(*track, file->gap);
    if (!gaps) return fail(gaps.error());
    if (file->keeps_time && !track->origin)
        return fail(
            ErrorCode::usage,
            fmt::format("{}: counts from its own start, and trajectory.time = \"recorded\" asks for a GPS time; "
                        "expected a file with dates (a table: the column utc, unix_s, or gps_week and tow_s)",
                        track->name));
    file->gaps = std::move(*gaps);
    file->track = std::make_shared<const Track>(std::move(*track));
    const RecordedPath path(*file->track, file->gaps, start);
    return LoadedTrack{
        fmt::format("{}, {} rows in {:.3f} s", file->track->name, file->track->points.size(), path.duration().value()),
        track_warnings(*file, path, scenario, start)};
}

}  // namespace

GpsTime first_row_at(const FileSettings& file, GpsTime start) {
    return file.keeps_time && file.track->origin ? *file.track->origin + file.track->points.front().time : start;
}

Result<LoadedTrack> load_track(Scenario& scenario, const Geoid* geoid, GpsTime start) {
    auto loaded = load_one(scenario.trajectory, scenario, geoid, start);
    if (!loaded) return loaded;
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i) {
        if (!scenario.receivers[i].trajectory) continue;
        const auto own = load_one(*scenario.receivers[i].trajectory, scenario, geoid, start);
        const std::string whose = fmt::format("receiver '{}': ", receiver_name(scenario, i));
        if (!own) return fail(own.error().code, whose + own.error().message);
        for (const std::string& warning : own->warnings)
            loaded->warnings.push_back(whose + warning);
        if (own->description.empty()) continue;
        if (!loaded->description.empty()) loaded->description += "; ";
        loaded->description += whose + own->description;
    }
    return loaded;
}

}  // namespace skyloop
