#include "detail/rinex_recording.hpp"

#include <algorithm>
#include <utility>

#include "world/gnss/carried_almanac.hpp"

namespace skyloop {
namespace {

// As GPS sends them: reference times in the middle of two hours, each with an issue of its own.
constexpr std::chrono::hours ephemeris_spacing{2};

KeplerEphemeris ephemeris_of_almanac(const KeplerEphemeris& almanac, GpsTime time) {
    const std::int64_t number = (time.time_since_epoch() + ephemeris_spacing / 2) / ephemeris_spacing;
    KeplerEphemeris record = carried_almanac(almanac, GpsTime(number * ephemeris_spacing));
    constexpr std::int64_t issues = 256;
    constexpr double usual_accuracy_m = 2.4, usual_fit_h = 4;
    record.message = NavigationMessage::lnav;
    record.iode = record.iodc = static_cast<int>(number % issues);
    // In the run the almanac is the truth.
    record.accuracy_m = usual_accuracy_m;
    // Of QZSS a flag, whose 0 is its usual two hours.
    record.fit_interval_h = record.satellite.constellation == Constellation::qzss ? 0 : usual_fit_h;
    return record;
}

}  // namespace

Result<RinexRecording> RinexRecording::create(const std::filesystem::path& folder, const RinexRecordingSetup& setup) {
    RinexRecording recording(setup);
    for (const auto& [file, name] : {std::pair{&recording.observations_, "observations.rnx"},
                                     std::pair{&recording.navigation_, "navigation.rnx"}}) {
        auto created = OutputFile::create(folder / name);
        if (!created) return fail(created.error());
        *file = std::move(*created);
    }
    recording.observations_.write(recording.writer_.header());
    recording.navigation_.write(navigation_header_text(setup.navigation));
    return recording;
}

void RinexRecording::record(const Trace& trace, const NavigationSource& broadcast) {
    for (const SatelliteInView& satellite : trace.sky.satellites) {
        const GpsTime now = trace.truth.time;
        const auto found = written_.find(satellite.id);
        if (found != written_.end() && found->second.toe == satellite.toe && found->second.issue == satellite.iode &&
            now < found->second.until)
            continue;
        Written& written = written_[satellite.id];
        written = {satellite.toe, satellite.iode, GpsTime::max()};
        auto record = broadcast.ephemeris(satellite.id, now);
        if (!record) continue;
        if (message_of(*record) == NavigationMessage::almanac) {
            record = ephemeris_of_almanac(std::get<KeplerEphemeris>(*record), now);
            written.until = toe_of(*record) + ephemeris_spacing / 2;
        }
        // Nobody is served by what has not been sent.
        navigation_.write(navigation_record_text(*record, std::min(now, toe_of(*record))));
    }
    if (!trace.epoch.observations.signals.empty()) observations_.write(writer_.epoch(trace.epoch.observations));
}

}  // namespace skyloop
