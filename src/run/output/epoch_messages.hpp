/// An epoch of one receiver as a line of JSON (skyloop-epoch/1, docs/outputs.md).
/// What a receiver reports, as PX4's simulators tell it.
/// From an epoch to the messages of one format.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/time/utc_time.hpp"
#include "firmware/core/navigation_state.hpp"
#include "receiver/protocol/mavlink_vehicle.hpp"
#include "run/fault/run_observer.hpp"
#include "run/output/output_settings.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline run {

/// What a line tells, copied out of the loop.
struct EpochRecord {
    std::string receiver;
    std::uint64_t number = 0;  ///< of the receiver's epochs, from 0
    TruthState truth;
    std::optional<GpsTime> leaves{};  ///< nothing: the receiver says nothing of this epoch
    /// What the receiver says of it.
    struct Report {
        Fix fix;  ///< without its satellites
        int satellites_used = 0;
        bool fix_ok = false;
        std::optional<Angle> course{};
        LeapSeconds leap_seconds = LeapSeconds::announced();  ///< by which it counts UTC
        int jamming_state = 0;                                ///< 0 unknown, 1 ok, 2 warning, 3 critical
        int spoofing = 0;                                     ///< 0 unknown, 1 none, 2 indicated, 3 several indications
    };
    std::optional<Report> report{};
    std::vector<SatelliteSeen> satellites;
};

EpochRecord record_epoch(const EpochSeen& seen, std::string receiver, std::uint64_t number);

/// The line with its end. The same record gives the same bytes.
std::string epoch_line(const EpochRecord& record);

/// HIL_GPS of MAVLink's common.xml. Its values without a fix: fix type 1 and, but for the time while it is known, those
/// that mean unknown. Fix types above 3D are told as 3D, the highest that it has. Velocities beyond the fields are
/// their limits (327.67 m/s, over ground 655.34 m/s).
MavlinkHilGps mavlink_hil_gps(const firmware::NavigationState& state, HilGpsAccuracy accuracy);

/// Makes the messages of an epoch; jobs are run one after the other, in the order in which they are to be sent.
using EpochJob = std::function<std::vector<Bytes>()>;

/// Copies what a format needs of an epoch, on the thread of the loop, and makes its messages later, on another thread.
/// The job outlives the epoch, and not the writer. State: what the format counts from message to message.
/// @param number of the receiver's epochs, from 0
using EpochWriter = std::function<EpochJob(const EpochSeen& seen, const std::string& receiver, std::uint64_t number)>;

/// What some formats tell beside the epoch.
struct WriterSources {
    const NavigationSource* broadcast = nullptr;  ///< records of satellites for RTCM; has to outlive the writer
    std::string version;                          ///< of skyloop, as its RTCM names the receiver's firmware
};

EpochWriter make_epoch_writer(const OutputSettings& settings, const WriterSources& sources = {});

}  // namespace skyloop::inline run
