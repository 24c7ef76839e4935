/// Faults that make one edit, in a word.
#pragma once

#include <cmath>
#include <utility>

#include "base/geo/geodesic.hpp"
#include "run/fault/fault_kind.hpp"

namespace skyloop {

/// A fault that edits epochs, before the firmware sees them: what the receiver believes, its coasting and limits among
/// it.
inline Fault fault_of_epoch(Edit<Epoch> edit) {
    Fault fault;
    fault.epoch = std::move(edit);
    return fault;
}
/// A fault that edits what is reported, of which the receiver itself knows nothing.
inline Fault fault_of_report(Edit<firmware::NavigationState> edit) {
    Fault fault;
    fault.report = std::move(edit);
    return fault;
}
/// A fault of how the receiver behaves.
inline Fault fault_of_firmware(Edit<firmware::FirmwareFaults> edit) {
    Fault fault;
    fault.firmware = std::move(edit);
    return fault;
}

/// A place that lies off another one: metres at its height, which set out east and north and follow the ellipsoid, and
/// metres up. A tangent plane would be 8 m above the ground after 10 km.
inline Geodetic displaced(const Geodetic& from, double east_m, double north_m, double up_m) {
    const Metres height = from.height.above_ellipsoid;
    const double wider = 1 + height.value() / curvature_radii(from.latitude).prime_vertical;
    const GeodesicPoint to =
        geodesic_direct(from, Angle::radians(std::atan2(east_m, north_m)), Metres(std::hypot(east_m, north_m) / wider));
    return {to.latitude, to.longitude, {height + Metres(up_m)}};
}

/// A velocity over ground with what follows from it: speed, and the course of a vehicle that moves.
inline void put_velocity(Fix& fix, const VelocityNed& velocity) {
    fix.velocity = velocity;
    fix.speed = MetresPerSecond(std::hypot(velocity.north, velocity.east));
    const double course = Angle::radians(std::atan2(velocity.east, velocity.north)).deg();
    if (fix.speed.value() > 0) fix.course = Angle::degrees(course < 0 ? course + 360 : course);
}

}  // namespace skyloop
