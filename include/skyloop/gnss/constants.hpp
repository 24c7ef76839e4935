/// Constants of the interface documents (MODELS.md section 1).
#pragma once

namespace skyloop {

/// Speed of light in vacuum, m/s (IS-GPS-200, 20.3.3.3.3.2).
inline constexpr double speed_of_light = 299792458.0;
/// Earth's rotation rate, rad/s (IS-GPS-200, table 20-IV); of GPS, Galileo, QZSS, and of every Sagnac rotation.
inline constexpr double earth_rotation_rate = 7.2921151467e-5;
/// Earth's gravitational constant, m³/s² (IS-GPS-200, table 20-IV); of GPS and QZSS.
inline constexpr double gravitational_constant_gps = 3.986005e14;
/// Carrier of GPS L1, Galileo E1, QZSS L1 and SBAS L1, Hz.
inline constexpr double carrier_frequency_l1 = 1575.42e6;
/// GPS L2, Hz.
inline constexpr double carrier_frequency_l2 = 1227.60e6;

}  // namespace skyloop
