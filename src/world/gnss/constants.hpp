/// Constants of the interface documents (MODELS.md section 1).
#pragma once

namespace skyloop::inline world {

/// Speed of light in vacuum, m/s (IS-GPS-200, 20.3.3.3.3.2).
inline constexpr double speed_of_light = 299792458.0;
/// Earth's rotation rate, rad/s (IS-GPS-200, table 20-IV); of GPS, Galileo, QZSS, NavIC, and of every Sagnac rotation.
inline constexpr double earth_rotation_rate = 7.2921151467e-5;
/// The same in the orbit equations of BeiDou (B1I ICD 3.0, table 5-11) and GLONASS (ICD L1, L2 GLONASS 5.1, table 3.2).
inline constexpr double earth_rotation_rate_beidou = 7.292115e-5;
inline constexpr double earth_rotation_rate_glonass = 7.292115e-5;
/// Earth's gravitational constant, m³/s² (IS-GPS-200, table 20-IV); of GPS, QZSS and NavIC.
inline constexpr double gravitational_constant_gps = 3.986005e14;
/// Of Galileo (OS SIS ICD 2.0, table 58) and BeiDou (B1I ICD 3.0, table 5-11), m³/s².
inline constexpr double gravitational_constant_galileo = 3.986004418e14;
inline constexpr double gravitational_constant_beidou = 3.986004418e14;
/// Of GLONASS, m³/s², with the second zonal harmonic and the Earth's equatorial radius, m, of PZ-90
/// (ICD L1, L2 GLONASS 5.1, table 3.2).
inline constexpr double gravitational_constant_glonass = 3.9860044e14;
inline constexpr double second_zonal_harmonic_glonass = 1.0826257e-3;
inline constexpr double equatorial_radius_glonass = 6378136.0;
/// Carrier of GPS L1, Galileo E1, QZSS L1 and SBAS L1, Hz.
inline constexpr double carrier_frequency_l1 = 1575.42e6;
/// GPS L2, Hz.
inline constexpr double carrier_frequency_l2 = 1227.60e6;
/// GPS L5 and Galileo E5a, Hz.
inline constexpr double carrier_frequency_l5 = 1176.45e6;

}  // namespace skyloop::inline world
