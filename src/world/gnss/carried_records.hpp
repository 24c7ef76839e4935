/// GLONASS records brought near the present, so that a look at a satellite integrates seconds and not minutes.
#pragma once

#include <map>

#include "world/gnss/orbit.hpp"

namespace skyloop {

/// Gives for each GLONASS record the same orbit at the last whole minute from its toe towards an instant. Whole minutes
/// are the steps of the integration itself, so that carrying changes no bit of it.
///
/// State: the last result for each satellite. It hangs on record and minute alone: no answer depends on what was asked
/// before.
class CarriedRecords {
public:
    const GlonassEphemeris& at(const GlonassEphemeris& record, GpsTime time);

private:
    struct Carried {
        GlonassEphemeris origin;
        GlonassEphemeris record;
    };
    std::map<SatelliteId, Carried> carried_;
};

}  // namespace skyloop
