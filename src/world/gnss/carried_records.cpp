#include "world/gnss/carried_records.hpp"

namespace skyloop {
namespace {

bool same_record(const GlonassEphemeris& a, const GlonassEphemeris& b) {
    return a.toe == b.toe && a.position_m == b.position_m && a.velocity_mps == b.velocity_mps &&
           a.acceleration_mps2 == b.acceleration_mps2 && a.clock_bias == b.clock_bias && a.clock_drift == b.clock_drift;
}

}  // namespace

const GlonassEphemeris& CarriedRecords::at(const GlonassEphemeris& record, GpsTime time) {
    const auto minutes = std::chrono::duration_cast<std::chrono::minutes>(time - record.toe);
    const GpsTime base = record.toe + minutes;
    Carried& kept = carried_[record.satellite];
    if (!same_record(kept.origin, record) || kept.record.toe != base) {
        kept.origin = record;
        kept.record = std::get<GlonassEphemeris>(carried_to(record, base));
    }
    return kept.record;
}

}  // namespace skyloop
