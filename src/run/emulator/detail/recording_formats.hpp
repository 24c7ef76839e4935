/// Rows of the output tables (INTERFACE.md section 3).
/// The part of a recording that other programs can solve: observations.rnx and navigation.rnx.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "base/core/result.hpp"
#include "run/emulator/run_files.hpp"
#include "world/flow/trace.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/rinex/rinex_writer.hpp"

namespace skyloop::inline run {

inline constexpr std::string_view fixes_header =
    "time_utc,gps_week,tow_s,true_lat_deg,true_lon_deg,true_height_m,lat_deg,lon_deg,height_m,"
    "east_error_m,north_error_m,up_error_m,vel_north_mps,vel_east_mps,vel_down_mps,speed_mps,course_deg,"
    "fix_type,satellites_used,satellites_visible,gdop,pdop,hdop,vdop,tdop,h_acc_m,v_acc_m,"
    "s_acc_mps,t_acc_m,clock_bias_m,true_clock_bias_m,sigma_uere_m,error_scale_m\n";

inline constexpr std::string_view satellites_header =
    "time_utc,satellite,azimuth_deg,elevation_deg,range_m,line_of_sight,paths,excess_path_m,iono_delay_m,tropo_delay_m,"
    "gas_loss_db,cloud_loss_db,rain_loss_db,cn0_dbhz,pseudorange_m,used,"
    "orbit_clock_error_m,multipath_m,code_noise_m,phase_noise_m,doppler_noise_hz,foliage_loss_db,antenna_gain_dbic,"
    "power_offset_db,interference_loss_db,amplitude_scintillation,phase_scintillation_rad,residual_m,"
    "false_range_m,state,shadowing_db,fading_db,free_space_loss_db,iono_loss_db,reflection_loss_db,"
    "received_power_dbw\n";

/// What comes behind `satellites_header`, in the place of its end, in a run with precise products.
inline constexpr std::string_view precise_satellites_header =
    ",satellite_antenna_m,receiver_antenna_m,solid_tide_m,wind_up_cycles\n";

/// The row of fixes.csv of one epoch; without a position its columns are empty.
std::string fix_row(const Trace& trace);

/// The rows of satellites.csv of one epoch. Delays and errors are those of the satellite's first signal.
/// `pseudorange_m` is what the receiver measured; sensor models that add errors to the truth measure nothing, and there
/// it is what a receiver with a perfect clock and no noise would measure through the applied delays. Without it a
/// satellite is not tracked: nothing measures its first signal, or a sensor model reports no C/N0 of it.
/// @param precise with the columns of `precise_satellites_header`
std::string satellite_rows(const Trace& trace, bool precise = false);

/// What the two files begin with.
struct RinexRecordingSetup {
    ObservationHeader observations;
    NavigationTextHeader navigation;
};

/// Writes what was measured, and each record of an orbit when it first serves a satellite in the sky. An almanac is
/// written as ephemerides of the hours that the run has: no reader takes orbits with a time of reference days away.
class RinexRecording {
public:
    static Result<RinexRecording> create(const std::filesystem::path& folder, const RinexRecordingSetup& setup);

    void record(const Trace& trace, const NavigationSource& broadcast);
    [[nodiscard]] OutputFile& observations() { return observations_; }
    [[nodiscard]] OutputFile& navigation() { return navigation_; }
    [[nodiscard]] const OutputFile& observations() const { return observations_; }
    [[nodiscard]] const OutputFile& navigation() const { return navigation_; }

private:
    explicit RinexRecording(const RinexRecordingSetup& setup) : writer_(setup.observations) {}

    ObservationWriter writer_;
    OutputFile observations_, navigation_;
    // The last record of a satellite.
    struct Written {
        GpsTime toe;
        int issue = 0;
        GpsTime until;  // its successor is due
    };

    std::map<SatelliteId, Written> written_;
};

}  // namespace skyloop::inline run
