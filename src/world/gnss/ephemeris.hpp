/// Broadcast orbits and clocks of the satellites of every system.
/// Where broadcast orbits come from: recorded files or a nominal sky.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/time/gps_time.hpp"
#include "world/gnss/satellite.hpp"

namespace skyloop::inline world {

/// Which message brought a record. One satellite may send several with different clocks and group delays.
enum class NavigationMessage {
    lnav,     ///< GPS, QZSS and NavIC legacy navigation
    inav,     ///< Galileo E1-B and E5b-I: the clock is that of the pair E1, E5b
    fnav,     ///< Galileo E5a-I: the clock is that of the pair E1, E5a
    d1,       ///< BeiDou MEO and IGSO
    d2,       ///< BeiDou GEO
    fdma,     ///< GLONASS strings of the FDMA signals
    sbas,     ///< SBAS message 9
    modern,   ///< GPS and QZSS CNAV and CNAV-2, BeiDou B-CNAV1 to 3
    almanac,  ///< a coarse orbit, good to kilometres for a week or more
};

/// A Kepler-type record of GPS, QZSS, Galileo, BeiDou or NavIC (IS-GPS-200, 20.3.3.4.3, tables 20-I and 20-III, and
/// their counterparts in the other interface documents), or an almanac of them. Angles in radians, times in GPST.
struct KeplerEphemeris {
    SatelliteId satellite;
    NavigationMessage message = NavigationMessage::lnav;
    GpsTime toe;  ///< reference time of the orbit
    GpsTime toc;  ///< reference time of the clock

    double sqrt_a = 0;  ///< √m
    double e = 0;
    double i0 = 0;
    double idot = 0;       ///< rad/s
    double omega0 = 0;     ///< longitude of the ascending node at the start of the system's week of toe
    double omega = 0;      ///< argument of perigee
    double omega_dot = 0;  ///< rad/s
    double m0 = 0;
    double delta_n = 0;                                           ///< rad/s
    double cuc = 0, cus = 0, crc = 0, crs = 0, cic = 0, cis = 0;  ///< rad, rad, m, m, rad, rad
    double axis_rate = 0, delta_n_rate = 0;                       ///< m/s, rad/s²; of modern messages alone

    double af0 = 0, af1 = 0, af2 = 0;  ///< s, s/s, s/s²
    double tgd = 0;                    ///< s; TGD, of NavIC that of S band, of Galileo BGD(E1,E5a), of BeiDou TGD1
    double tgd2 = 0;                   ///< s; of Galileo BGD(E1,E5b), of BeiDou TGD2

    int iode = 0;               ///< of Galileo IODnav, of BeiDou AODE
    int iodc = 0;               ///< of BeiDou AODC
    int health = 0;             ///< the system's own bits; see healthy()
    double accuracy_m = 0;      ///< user range or signal-in-space accuracy, m; negative: unknown
    double fit_interval_h = 0;  ///< of QZSS a flag: 1 is more than two hours (RINEX 3.05, table A12)
    /// False where the user range accuracy has index 15, above the 6144 m of index 14: no accuracy is predicted
    /// (IS-GPS-200, 20.3.3.3.1.3; QZSS, NavIC and BeiDou likewise), and the satellite is not used (MODELS.md A.6).
    /// Almanacs tell none, and Galileo's signal-in-space accuracy has no such meaning.
    [[nodiscard]] bool accuracy_predicted() const {
        if (message == NavigationMessage::almanac || satellite.constellation == Constellation::galileo) return true;
        return accuracy_m >= 0 && accuracy_m <= 6144;
    }
    [[nodiscard]] bool healthy() const { return accuracy_predicted() && health_bits_clear(); }
    /// No bit is set that says otherwise; of Galileo, of the signal that carries the message: E1-B (I/NAV) or
    /// E5a (F/NAV), RINEX 3.05, table A8. The last bit of QZSS is about L1C/B, which nobody here tracks and the
    /// satellites send unhealthy for years (IS-QZSS-PNT-004, SV health).
    [[nodiscard]] bool health_bits_clear() const {
        if (satellite.constellation == Constellation::qzss) return (health & ~1) == 0;
        if (satellite.constellation != Constellation::galileo || message == NavigationMessage::almanac)
            return health == 0;
        return (health & (message == NavigationMessage::fnav ? 0b000'111'000 : 0b000'000'111)) == 0;
    }
};

/// A state vector of GLONASS (ICD L1, L2 GLONASS 5.1, table 4.5), in the ECEF frame PZ-90 as it was broadcast, taken as
/// WGS 84. Metres and seconds.
struct GlonassEphemeris {
    SatelliteId satellite;
    GpsTime toe;                                ///< t_b
    std::array<double, 3> position_m{};         ///< ECEF at toe
    std::array<double, 3> velocity_mps{};       ///< ECEF
    std::array<double, 3> acceleration_mps2{};  ///< of Moon and Sun
    double clock_bias = 0;                      ///< −τ_n: satellite clock − system time at toe, s
    double clock_drift = 0;                     ///< γ_n, s/s
    double group_delay_l2 = 0;                  ///< Δτ_n: delay of L2 over that of L1, s
    int frequency_channel = 0;                  ///< −7 … +13
    int iode = 0;                               ///< t_b in quarter hours of the Moscow day
    int health = 0;                             ///< 0: healthy
    double accuracy_m = 0;                      ///< 0: not told
    [[nodiscard]] bool healthy() const { return health == 0; }
};

/// Accuracies by F_T of GLONASS, m (ICD L1, L2 GLONASS 5.1, table 4.4); 15 is no value.
inline constexpr std::array<double, 15> glonass_accuracies_m{1, 2, 2.5, 4, 5, 7, 10, 12, 14, 16, 32, 64, 128, 256, 512};

/// Position, velocity and acceleration of an SBAS satellite (DO-229, message 9), in ECEF. Metres and seconds.
struct SbasEphemeris {
    SatelliteId satellite;
    GpsTime toe;  ///< t_0
    std::array<double, 3> position_m{};
    std::array<double, 3> velocity_mps{};
    std::array<double, 3> acceleration_mps2{};
    double clock_bias = 0;   ///< a_Gf0, s
    double clock_drift = 0;  ///< a_Gf1, s/s
    int iode = 0;            ///< IODN
    int health = 0;  ///< bits 0-3: of message 17, 0: ranging off; 4: that is not known; 5: URA 15 (RINEX 3.05, 5.4.4)
    double accuracy_m = 0;
    /// A URA of 15 says that it is not for ranging.
    [[nodiscard]] bool healthy() const { return (health & 0b10'0000) == 0 && (health & 0b1'0001) != 1; }
};

/// A record of any system.
using Ephemeris = std::variant<KeplerEphemeris, GlonassEphemeris, SbasEphemeris>;

inline SatelliteId satellite_of(const Ephemeris& record) {
    return std::visit([](const auto& r) { return r.satellite; }, record);
}
/// The reference time of the orbit.
inline GpsTime toe_of(const Ephemeris& record) {
    return std::visit([](const auto& r) { return r.toe; }, record);
}
inline int iode_of(const Ephemeris& record) {
    return std::visit([](const auto& r) { return r.iode; }, record);
}
inline bool is_healthy(const Ephemeris& record) {
    return std::visit([](const auto& r) { return r.healthy(); }, record);
}
inline NavigationMessage message_of(const Ephemeris& record) {
    if (const auto* kepler = std::get_if<KeplerEphemeris>(&record)) return kepler->message;
    return std::holds_alternative<GlonassEphemeris>(record) ? NavigationMessage::fdma : NavigationMessage::sbas;
}
/// True for a geostationary BeiDou satellite, whose orbit is given in a tilted frame: C01 … C05 and from C59 on
/// (BDS-SIS-ICD B1I 3.0, 5.2.4.12 and table 3-1).
constexpr bool is_beidou_geo(SatelliteId id) {
    return id.constellation == Constellation::beidou && (id.number <= 5 || id.number >= 59);
}

/// Which record of a satellite serves an instant.
enum class EphemerisRule {
    forward,  ///< the newest healthy record with 0 ≤ t − toe ≤ validity (MODELS.md 3.3, baseline)
    nearest,  ///< the record with the smallest |t − toe| ≤ validity
};

/// The eight coefficients of the single-frequency ionosphere model (IS-GPS-200, 20.3.3.5.1.7), semicircle powers.
struct KlobucharCoefficients {
    std::array<double, 4> alpha{};  ///< s, s/semicircle, …
    std::array<double, 4> beta{};   ///< s, s/semicircle, …
    bool operator==(const KlobucharCoefficients&) const = default;
};

/// What broadcasts say of the ionosphere, by system. Coefficients that are noughts throughout say nothing: so do
/// satellites that have none, and converters that have heard none (NeQuick-G document, 3.1; RTKLIB takes them so, too).
struct BroadcastIonosphere {
    BroadcastIonosphere() = default;
    /// Of GPS alone.
    BroadcastIonosphere(std::optional<KlobucharCoefficients> of_gps) : gps(of_gps) {}  // NOLINT: the usual case
    BroadcastIonosphere(std::nullopt_t) {}                                             // NOLINT: none

    std::optional<KlobucharCoefficients> gps, qzss, beidou, navic;
    /// a_i0, a_i1, a_i2: effective ionisation level of Galileo, sfu and by degree (OS SIS ICD 2.0, table 69).
    std::optional<std::array<double, 3>> galileo;
};

/// The instants for which a source can give orbits.
struct TimeSpan {
    GpsTime first;
    GpsTime last;
};

/// Orbits and broadcast parameters over time.
class NavigationSource {
public:
    virtual ~NavigationSource() = default;
    /// Every satellite that the source knows, ascending.
    [[nodiscard]] virtual std::vector<SatelliteId> satellites() const = 0;
    /// The record that serves `satellite` at `time`, or nothing.
    [[nodiscard]] virtual std::optional<Ephemeris> ephemeris(SatelliteId satellite, GpsTime time) const = 0;
    /// What the satellites say of the ionosphere.
    [[nodiscard]] virtual const BroadcastIonosphere& ionosphere() const = 0;
    /// The coefficients of GPS.
    [[nodiscard]] const std::optional<KlobucharCoefficients>& klobuchar() const { return ionosphere().gps; }
    /// The instants for which there are orbits; nothing when there is no limit.
    [[nodiscard]] virtual std::optional<TimeSpan> span() const = 0;
    /// For people: "brdc1820.10n" or "nominal GPS constellation".
    [[nodiscard]] virtual std::string description() const = 0;
};

}  // namespace skyloop::inline world
