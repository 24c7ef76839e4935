/// Which of the tracked satellites a receiver uses.
#pragma once

#include <map>

#include "base/time/gps_time.hpp"
#include "receiver/pvt/navigation_parameters.hpp"
#include "world/flow/observations.hpp"

namespace skyloop::inline receiver {

/// By UseParameters.
///
/// State: of each satellite since when it is tracked and whether it is used; whether the last epoch had a fix.
class SatelliteChoice {
public:
    explicit SatelliteChoice(const UseParameters& parameters) : parameters_(parameters) {}
    /// An epoch; they come in ascending time.
    void begin(const Observations& observations);
    /// Whether a satellite of that epoch is used. @param first of its signals; each is asked for once an epoch
    bool takes(const Observation& first);
    /// The epoch has a sound fix in three dimensions, or none.
    void solved(bool soundly) { solved_ = soundly; }
    /// The receiver has started anew, and has no fix.
    void reset() { *this = SatelliteChoice(parameters_); }

private:
    struct Candidate {
        GpsTime since, seen;
        bool used = false;
    };
    UseParameters parameters_;
    std::map<SatelliteId, Candidate> candidates_;
    GpsTime now_;
    DbHz from_;  // C/N0, in this epoch
    bool solved_ = false;
};

}  // namespace skyloop::inline receiver
