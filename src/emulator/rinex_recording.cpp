#include "rinex_recording.hpp"

namespace skyloop {

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
        const std::pair issue{satellite.toe, satellite.iode};
        const auto found = written_.find(satellite.id);
        if (found != written_.end() && found->second == issue) continue;
        written_[satellite.id] = issue;
        if (const auto record = broadcast.ephemeris(satellite.id, trace.truth.time))
            navigation_.write(navigation_record_text(*record));
    }
    if (!trace.epoch.observations.signals.empty()) observations_.write(writer_.epoch(trace.epoch.observations));
}

}  // namespace skyloop
