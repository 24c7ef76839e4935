/// Logs of Unicore's N4 receivers.
///
/// Sources: BESTNAV, RECTIME, VERSION: offsets of sparkfun/SparkFun_Unicore_GNSS_Arduino_Library and captures of
/// jclark/satpulse (gps/testdata/packets/unicore/UM980). AGRIC: ArduPilot, AP_GPS_NMEA.cpp, with a sample; its binary
/// form adds up to the 232 bytes that its second field says, CRC included. UNIHEADING, PVTSLN: samples with right CRCs
/// (zang09/unicore_um982_driver and PX4-GPSDrivers, src/unicore). OBSVM: the same captures, and
/// rtklibexplorer/RTKLIB, src/rcv/unicore.c.
#pragma once

#include "receiver/protocol/unicore_fields.hpp"

namespace skyloop::inline receiver {

/// Whether there is a solution.
inline constexpr std::array<UnicoreWord, 2> unicore_solution_words{{{0, "SOL_COMPUTED"}, {1, "INSUFFICIENT_OBS"}}};
/// Kinds of solution, of positions, velocities and headings.
inline constexpr std::array<UnicoreWord, 11> unicore_type_words{{{0, "NONE"},
                                                                 {1, "FIXEDPOS"},
                                                                 {2, "FIXEDHEIGHT"},
                                                                 {8, "DOPPLER_VELOCITY"},
                                                                 {16, "SINGLE"},
                                                                 {17, "PSRDIFF"},
                                                                 {18, "SBAS"},
                                                                 {32, "L1_FLOAT"},
                                                                 {34, "NARROW_FLOAT"},
                                                                 {48, "L1_INT"},
                                                                 {50, "NARROW_INT"}}};
inline constexpr std::array<UnicoreWord, 1> unicore_datum_words{{{61, "WGS84"}}};
inline constexpr std::array<UnicoreWord, 2> unicore_clock_words{{{0, "VALID"}, {3, "INVALID"}}};
inline constexpr std::array<UnicoreWord, 2> unicore_utc_words{{{0, "INVALID"}, {1, "VALID"}}};
inline constexpr std::array<UnicoreWord, 2> unicore_model_words{{{17, "\"UM982\""}, {18, "\"UM980\""}}};

/// By name: "NARROW_INT" is 50; 0 for a word that stands in no table.
constexpr std::uint32_t unicore_number(std::span<const UnicoreWord> words, std::string_view word) {
    for (const UnicoreWord& known : words)
        if (known.word == word) return known.number;
    return 0;
}

/// Best position and velocity.
struct UnicoreBestNav {
    static constexpr std::uint16_t message_id = 2118;
    static constexpr std::string_view message_name = "BESTNAV";
    UnicoreEnum<"sol_status", unicore_solution_words> sol_status = 1u;
    UnicoreEnum<"pos_type", unicore_type_words> pos_type{};
    UnicoreNumber<"lat_deg", double, 11> lat{};
    UnicoreNumber<"lon_deg", double, 11> lon{};
    UnicoreNumber<"height_m", double, 4> height{};         ///< above mean sea level
    UnicoreNumber<"undulation_m", float, 4> undulation{};  ///< of the geoid above the ellipsoid
    UnicoreEnum<"datum", unicore_datum_words> datum = 61u;
    UnicoreNumber<"lat_std_m", float, 4> lat_std{};
    UnicoreNumber<"lon_std_m", float, 4> lon_std{};
    UnicoreNumber<"height_std_m", float, 4> height_std{};
    UnicoreText<"station", 4> station{};
    UnicoreNumber<"diff_age_s", float, 3> diff_age{};
    UnicoreNumber<"sol_age_s", float, 3> sol_age{};
    U1<"tracked"> tracked{};
    U1<"used"> used{};
    U1<"used_l1"> used_l1{};
    U1<"used_multi"> used_multi{};
    U1<"reserved"> reserved{};
    UnicoreHex<"ext_sol_status", std::uint8_t, 2> ext_sol_status{};
    UnicoreHex<"gal_bds_mask", std::uint8_t, 2> gal_bds_mask{};
    UnicoreHex<"gps_glo_mask", std::uint8_t, 2> gps_glo_mask{};
    UnicoreEnum<"vel_sol_status", unicore_solution_words> vel_sol_status = 1u;
    UnicoreEnum<"vel_type", unicore_type_words> vel_type{};
    UnicoreNumber<"latency_s", float, 3> latency{};
    UnicoreNumber<"age_s", float, 3> age{};
    UnicoreNumber<"speed_mps", double, 4> speed{};
    UnicoreNumber<"course_deg", double, 6> course{};
    UnicoreNumber<"vel_up_mps", double, 4> vel_up{};
    UnicoreNumber<"vel_up_std_mps", float, 4> vel_up_std{};
    UnicoreNumber<"speed_std_mps", float, 4> speed_std{};
};

/// Time of the receiver's clock and UTC.
struct UnicoreRecTime {
    static constexpr std::uint16_t message_id = 102;
    static constexpr std::string_view message_name = "RECTIME";
    UnicoreEnum<"clock_status", unicore_clock_words> clock_status = 3u;
    UnicoreScientific<"offset_s", 9> offset{};  ///< GPS time minus the receiver's clock
    UnicoreScientific<"offset_std_s", 9> offset_std{};
    UnicoreNumber<"utc_offset_s", double, 11> utc_offset{};  ///< UTC − GPST
    U4<"year"> year{};
    U1<"month"> month{};
    U1<"day"> day{};
    U1<"hour"> hour{};
    U1<"minute"> minute{};
    U4<"millisecond"> millisecond{};  ///< with the seconds
    UnicoreEnum<"utc_status", unicore_utc_words> utc_status{};
};

/// Who the receiver is. Sizes with their closing zeros.
struct UnicoreVersion {
    static constexpr std::uint16_t message_id = 37;
    static constexpr std::string_view message_name = "VERSION";
    UnicoreEnum<"model", unicore_model_words> model = 18u;
    UnicoreText<"firmware", 33> firmware{};
    UnicoreText<"authorization", 129> authorization{};
    UnicoreText<"serial", 66> serial{};
    UnicoreText<"efuse_id", 33> efuse_id{};
    UnicoreText<"compiled", 43> compiled{};
};

/// Position, velocity, baseline and heading for machines: all in one.
struct UnicoreAgric {
    static constexpr std::uint16_t message_id = 11276;
    static constexpr std::string_view message_name = "AGRIC";
    static constexpr std::string_view text_name = "AGRICA";
    Text<"system", 4> system{'G', 'N', 'S', 'S'};
    U1<"length"> length = 232;
    U1<"year"> year{};  ///< since 2000
    U1<"month"> month{};
    U1<"day"> day{};
    U1<"hour"> hour{};
    U1<"minute"> minute{};
    U1<"second"> second{};
    U1<"rtk_status"> rtk_status{};          ///< 0 none, 1 single, 2 differential, 4 fixed, 5 float
    U1<"heading_status"> heading_status{};  ///< the same: 0, 4, 5
    U1<"gps"> gps{};                        ///< satellites in the solution, as below
    U1<"bds"> bds{};
    U1<"glo"> glo{};
    UnicoreNumber<"baseline_north_m", float, 4> baseline_north{};  ///< from base to rover
    UnicoreNumber<"baseline_east_m", float, 4> baseline_east{};
    UnicoreNumber<"baseline_up_m", float, 4> baseline_up{};
    UnicoreNumber<"baseline_north_std_m", float, 4> baseline_north_std{};
    UnicoreNumber<"baseline_east_std_m", float, 4> baseline_east_std{};
    UnicoreNumber<"baseline_up_std_m", float, 4> baseline_up_std{};
    UnicoreNumber<"heading_deg", float, 4> heading{};
    UnicoreNumber<"pitch_deg", float, 4> pitch{};
    UnicoreNumber<"roll_deg", float, 4> roll{};
    UnicoreNumber<"speed_mps", float, 3> speed{};
    UnicoreNumber<"vel_north_mps", float, 3> vel_north{};
    UnicoreNumber<"vel_east_mps", float, 3> vel_east{};
    UnicoreNumber<"vel_up_mps", float, 3> vel_up{};
    UnicoreNumber<"vel_north_std_mps", float, 3> vel_north_std{};
    UnicoreNumber<"vel_east_std_mps", float, 3> vel_east_std{};
    UnicoreNumber<"vel_up_std_mps", float, 3> vel_up_std{};
    UnicoreNumber<"lat_deg", double, 11> lat{};
    UnicoreNumber<"lon_deg", double, 11> lon{};
    UnicoreNumber<"height_m", double, 4> height{};  ///< above mean sea level
    UnicoreNumber<"x_m", double, 4> x{};
    UnicoreNumber<"y_m", double, 4> y{};
    UnicoreNumber<"z_m", double, 4> z{};
    UnicoreNumber<"lat_std_m", float, 4> lat_std{};
    UnicoreNumber<"lon_std_m", float, 4> lon_std{};
    UnicoreNumber<"height_std_m", float, 4> height_std{};
    UnicoreNumber<"x_std_m", float, 4> x_std{};
    UnicoreNumber<"y_std_m", float, 4> y_std{};
    UnicoreNumber<"z_std_m", float, 4> z_std{};
    UnicoreNumber<"base_lat_deg", double, 11> base_lat{};
    UnicoreNumber<"base_lon_deg", double, 11> base_lon{};
    UnicoreNumber<"base_height_m", double, 4> base_height{};
    UnicoreNumber<"second_lat_deg", double, 11> second_lat{};
    UnicoreNumber<"second_lon_deg", double, 11> second_lon{};
    UnicoreNumber<"second_height_m", double, 4> second_height{};
    U4<"tow_s*1e-3"> tow{};
    UnicoreNumber<"diff_age_s", float, 3> diff_age{};
    UnicoreNumber<"course_deg", float, 6> course{};
    UnicoreNumber<"undulation_m", float, 6> undulation{};  ///< of the geoid above the ellipsoid
    UnicoreNumber<"reserved_3", float, 6> reserved_3{};
    UnicoreNumber<"reserved_4", float, 6> reserved_4{};
    U1<"gal"> gal{};
    U1<"reserved_5"> reserved_5{};
    U1<"reserved_6"> reserved_6{};
    U1<"reserved_7"> reserved_7{};

    static void fields(auto& m, auto& v) {
        v(m.system, m.length, m.year, m.month, m.day, m.hour, m.minute, m.second, m.rtk_status, m.heading_status, m.gps,
          m.bds, m.glo);
        v(m.baseline_north, m.baseline_east, m.baseline_up, m.baseline_north_std, m.baseline_east_std,
          m.baseline_up_std, m.heading, m.pitch, m.roll, m.speed, m.vel_north, m.vel_east, m.vel_up, m.vel_north_std,
          m.vel_east_std, m.vel_up_std);
        v(m.lat, m.lon, m.height, m.x, m.y, m.z, m.lat_std, m.lon_std, m.height_std, m.x_std, m.y_std, m.z_std,
          m.base_lat, m.base_lon, m.base_height, m.second_lat, m.second_lon, m.second_height);
        v(m.tow, m.diff_age, m.course, m.undulation, m.reserved_3, m.reserved_4, m.gal, m.reserved_5, m.reserved_6,
          m.reserved_7);
    }
};

/// The vector between two antennas: its heading leads from the master to the slave.
struct UnicoreHeading {
    static constexpr std::string_view message_name = "UNIHEADING";
    UnicoreEnum<"sol_status", unicore_solution_words> sol_status = 1u;
    UnicoreEnum<"pos_type", unicore_type_words> pos_type{};
    UnicoreNumber<"length_m", float, 4> length{};
    UnicoreNumber<"heading_deg", float, 4> heading{};
    UnicoreNumber<"pitch_deg", float, 4> pitch{};
    UnicoreNumber<"reserved", float, 4> reserved{};
    UnicoreNumber<"heading_std_deg", float, 4> heading_std{};
    UnicoreNumber<"pitch_std_deg", float, 4> pitch_std{};
    UnicoreText<"station", 4> station{};
    U1<"tracked"> tracked{};
    U1<"used"> used{};
    U1<"observed"> observed{};
    U1<"used_multi"> used_multi{};
    UnicoreHex<"sol_source", std::uint8_t, 1> sol_source{};
    UnicoreHex<"ext_sol_status", std::uint8_t, 2> ext_sol_status{};
    UnicoreHex<"gal_bds_mask", std::uint8_t, 1> gal_bds_mask{};
    UnicoreHex<"gps_glo_mask", std::uint8_t, 1> gps_glo_mask{};
};

/// The number of a satellite.
struct UnicorePrn {
    U2<"prn"> prn{};
};

/// Position, velocity, heading and dilution of precision: all in one, for vehicles.
struct UnicorePvtsln {
    static constexpr std::string_view message_name = "PVTSLN";
    UnicoreEnum<"pos_type", unicore_type_words> pos_type{};
    UnicoreNumber<"height_m", float, 4> height{};  ///< above mean sea level
    UnicoreNumber<"lat_deg", double, 11> lat{};
    UnicoreNumber<"lon_deg", double, 11> lon{};
    UnicoreNumber<"height_std_m", float, 4> height_std{};
    UnicoreNumber<"lat_std_m", float, 4> lat_std{};
    UnicoreNumber<"lon_std_m", float, 4> lon_std{};
    UnicoreNumber<"diff_age_s", float, 3> diff_age{};
    UnicoreEnum<"psr_type", unicore_type_words> psr_type{};
    UnicoreNumber<"psr_height_m", float, 4> psr_height{};
    UnicoreNumber<"psr_lat_deg", double, 11> psr_lat{};
    UnicoreNumber<"psr_lon_deg", double, 11> psr_lon{};
    UnicoreNumber<"undulation_m", float, 4> undulation{};
    U1<"tracked"> tracked{};
    U1<"used"> used{};
    U1<"psr_tracked"> psr_tracked{};
    U1<"psr_used"> psr_used{};
    UnicoreNumber<"vel_north_mps", double, 4> vel_north{};
    UnicoreNumber<"vel_east_mps", double, 4> vel_east{};
    UnicoreNumber<"vel_up_mps", double, 4> vel_up{};
    UnicoreEnum<"heading_type", unicore_type_words> heading_type{};
    UnicoreNumber<"length_m", float, 4> length{};
    UnicoreNumber<"heading_deg", float, 4> heading{};
    UnicoreNumber<"pitch_deg", float, 4> pitch{};
    U1<"heading_tracked"> heading_tracked{};
    U1<"heading_used"> heading_used{};
    U1<"heading_observed"> heading_observed{};
    U1<"heading_multi"> heading_multi{};
    UnicoreNumber<"gdop", float, 4> gdop{};
    UnicoreNumber<"pdop", float, 4> pdop{};
    UnicoreNumber<"hdop", float, 4> hdop{};
    UnicoreNumber<"htdop", float, 4> htdop{};
    UnicoreNumber<"tdop", float, 4> tdop{};
    UnicoreNumber<"cutoff_deg", float, 1> cutoff{};
    List<"prns", UnicorePrn> prns{};  ///< of the satellites in the solution; their count stands before them

    static void fields(auto& m, auto& v) {
        v(m.pos_type, m.height, m.lat, m.lon, m.height_std, m.lat_std, m.lon_std, m.diff_age, m.psr_type, m.psr_height,
          m.psr_lat, m.psr_lon, m.undulation, m.tracked, m.used, m.psr_tracked, m.psr_used);
        v(m.vel_north, m.vel_east, m.vel_up, m.heading_type, m.length, m.heading, m.pitch, m.heading_tracked,
          m.heading_used, m.heading_observed, m.heading_multi, m.gdop, m.pdop, m.hdop, m.htdop, m.tdop, m.cutoff);
        if constexpr (requires { v.counted(m.prns); })
            v.counted(m.prns);
        else
            v.items(m.prns);
    }
};

/// One signal as it was measured.
struct UnicoreObservation {
    U2<"glonass_channel"> glonass_channel{};  ///< + 7; 0 of other systems
    U2<"prn"> prn{};                          ///< of GLONASS + 37
    UnicoreNumber<"pseudorange_m", double, 3> pseudorange{};
    UnicoreNumber<"adr_cycles", double, 6> adr{};  ///< the phase, falling as the range grows
    U2<"pseudorange_std_m*1e-2"> pseudorange_std{};
    U2<"adr_std_cycles*1e-4"> adr_std{};
    UnicoreNumber<"doppler_hz", float, 3> doppler{};
    U2<"cn0_dbhz*1e-2"> cn0{};
    U2<"reserved"> reserved{};
    UnicoreNumber<"lock_s", float, 3> lock{};
    /// Bits: 5-9 channel, 10 phase locked, 12 code locked, 16-18 system, 21-25 signal.
    UnicoreHex<"tracking", std::uint32_t, 8> tracking{};
};

/// Measurements of the master antenna.
struct UnicoreObsVm {
    static constexpr std::uint16_t message_id = 12;
    static constexpr std::string_view message_name = "OBSVM";
    U4<"count"> count{};
    List<"observations", UnicoreObservation> observations{};

    static void fields(auto& m, auto& v) {
        v(m.count);
        v.rest(m.observations, 0, 65535);
    }
};

/// All of them.
using KnownUnicoreLogs = MessageTypes<UnicoreBestNav, UnicoreRecTime, UnicoreVersion, UnicoreAgric, UnicoreHeading,
                                      UnicorePvtsln, UnicoreObsVm>;

/// Logs that have a binary form whose layout is known.
template <class Message>
concept UnicoreBinaryLog = requires {
    Message::message_id;
};

}  // namespace skyloop::inline receiver
