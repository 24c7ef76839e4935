/// The part of a recording that other programs can solve: observations.rnx and navigation.rnx.
#pragma once

#include <filesystem>
#include <map>

#include "base/core/result.hpp"
#include "run/emulator/output_file.hpp"
#include "world/flow/trace.hpp"
#include "world/gnss/navigation_source.hpp"
#include "world/rinex/navigation_writer.hpp"
#include "world/rinex/observation_file.hpp"

namespace skyloop {

/// What the two files begin with.
struct RinexRecordingSetup {
    ObservationHeader observations;
    NavigationTextHeader navigation;
};

/// Writes what was measured, and each record of an orbit when it first serves a satellite in the sky. An almanac is
/// written as ephemerides of the hours that the run has: no reader takes orbits with a time of reference days away.
class RinexRecording {
public:
    static Result<RinexRecording> create(const std::filesystem::path& folder, const RinexRecordingSetup& setup);

    void record(const Trace& trace, const NavigationSource& broadcast);
    [[nodiscard]] OutputFile& observations() { return observations_; }
    [[nodiscard]] OutputFile& navigation() { return navigation_; }
    [[nodiscard]] const OutputFile& observations() const { return observations_; }
    [[nodiscard]] const OutputFile& navigation() const { return navigation_; }

private:
    explicit RinexRecording(const RinexRecordingSetup& setup) : writer_(setup.observations) {}

    ObservationWriter writer_;
    OutputFile observations_, navigation_;
    // The last record of a satellite.
    struct Written {
        GpsTime toe;
        int issue = 0;
        GpsTime until;  // its successor is due
    };

    std::map<SatelliteId, Written> written_;
};

}  // namespace skyloop
