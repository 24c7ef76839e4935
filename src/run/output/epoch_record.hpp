/// An epoch of one receiver as a line of JSON (skyloop-epoch/1, docs/outputs.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/time/utc_time.hpp"
#include "run/fault/epoch_views.hpp"

namespace skyloop {

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

}  // namespace skyloop
