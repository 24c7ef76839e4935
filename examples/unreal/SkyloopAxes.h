// Unreal's axes in the field's: centimetres and a left-handed frame with Z up become metres north, east, down.
// Plain C++, so that it can be tested outside the engine. Which way is north depends on the project:
//   - GeoReferencing plugin, Cesium, CARLA: X points east, Y south;
//   - AirSim: X points north, Y east.
#pragma once

#include <array>
#include <cmath>

namespace SkyloopAxes {

using Vector = std::array<double, 3>;
using Quaternion = std::array<double, 4>;  // w, x, y, z

// Metres (or metres a second) north, east, down of centimetres (a second) along Unreal's axes.
inline Vector ToNed(double X, double Y, double Z, bool bXIsNorth) {
    const double Unit = 0.01;
    if (bXIsNorth) return {X * Unit, Y * Unit, -Z * Unit};
    return {-Y * Unit, X * Unit, -Z * Unit};
}

// The turn from the body (forward, right, down) to north, east, down, of an actor's quaternion.
inline Quaternion ToBodyToNed(double X, double Y, double Z, double W, bool bXIsNorth) {
    if (bXIsNorth) return {W, -X, -Y, Z};
    const double Half = std::sqrt(0.5);  // a quarter of a turn about down
    return {Half * (W - Z), Half * (Y - X), -Half * (X + Y), Half * (Z + W)};
}

}  // namespace SkyloopAxes
