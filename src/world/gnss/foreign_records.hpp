/// Records that were broadcast under one satellite's number and describe the orbit of another.
#pragma once

#include <string>
#include <vector>

#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

/// A record that was taken out, and why.
struct DroppedRecord {
    Ephemeris record;
    /// "G01: record with toe 2010-07-01T06:00:00 lies 40000 km from its neighbours (it is the orbit of G25); dropped"
    std::string reason;
};

/// Takes the foreign records out of `records`: those marked healthy whose position, half way in time to each
/// neighbouring record of the same satellite, is not where the neighbours put it. Records hours apart agree within
/// kilometres; a foreign one is off by hundreds or thousands. The majority of the neighbours decides; where two records
/// stand alone against each other, the one that repeats the orbit of another satellite goes. Unhealthy records,
/// those of SBAS satellites and almanacs are never dropped.
std::vector<DroppedRecord> drop_foreign_records(std::vector<Ephemeris>& records);

}  // namespace skyloop::inline world
