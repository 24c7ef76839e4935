#include <fmt/format.h>

#include <array>
#include <string>

#include "receiver/protocol/field_lister.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_cfg_device.hpp"
#include "receiver/protocol/ubx_cfg_navigation.hpp"
#include "receiver/protocol/ubx_hardware.hpp"
#include "receiver/protocol/ubx_inertial.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_names.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_raw.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "receiver/protocol/ubx_services.hpp"
#include "receiver/protocol/ubx_time.hpp"

namespace skyloop::inline receiver {
namespace {

// A text as a template argument.
template <std::size_t N>
struct Names {
    constexpr Names(const char (&text)[N]) { std::copy_n(text, N, characters); }  // NOLINT: converts on purpose
    char characters[N]{};
    [[nodiscard]] constexpr std::string_view view() const { return {characters, N - 1}; }
};

// A message with one item in every list and every tail there: as many fields as it can have.
struct Filler {
    template <class... T>
    void operator()(T&...) {}
    template <class T>
    void count(std::vector<T>& list) {
        list.resize(1);
    }
    template <class T>
    void items(std::vector<T>& list) {
        list.resize(1);
    }
    template <class T>
    void rest(std::vector<T>& list, std::size_t, std::size_t) {
        list.resize(1);
    }
    template <class T>
    void if_present(std::optional<T>& field) {
        field.emplace();
    }
    void sized(std::uint64_t&, std::size_t) {}
};

template <class Message, Names names>
std::optional<std::vector<DecodedField>> list_as(ByteSpan payload) {
    const auto message = decode_payload<Message>(payload);
    if (!message) return std::nullopt;
    FieldLister lister(names.view());
    walk_fields(*message, lister);
    return lister.take();
}

template <class Message, Names names>
bool fits() {
    Message message;
    Filler filler;
    walk_fields(message, filler);
    FieldLister lister(names.view());
    walk_fields(std::as_const(message), lister);
    return lister.names_fit();
}

template <class Message, Names names>
constexpr UbxListing listed{Message::message_id, list_as<Message, names>, fits<Message, names>};

// CFG-VALGET and SEC-SIG: the version tells the forms apart, which may have the same length.
template <class Message, Names names, std::uint8_t version>
std::optional<std::vector<DecodedField>> list_version(ByteSpan payload) {
    if (payload.empty() || payload[0] != version) return std::nullopt;
    return list_as<Message, names>(payload);
}

template <class Message, Names names, std::uint8_t version>
constexpr UbxListing listed_version{Message::message_id, list_version<Message, names, version>, fits<Message, names>};

constexpr Names mon_hw_names =
    "pin_select pin_bank pin_direction pin_value noise agc antenna_status antenna_power flags -reserved used_mask "
    "virtual_pins jamming_indicator -reserved pin_interrupts pull_up pull_down";
constexpr Names satellite_names =
    "tow_s*1e-3 version -reserved satellites[gnss_id sv_id cno_dbhz elevation_deg!-91 azimuth_deg residual_m*1e-1 "
    "flags]";

// One line a message.
constexpr auto ubx_listing_table = std::to_array<UbxListing>({
    listed<NavPosecef, "tow_s*1e-3 ecef_m*1e-2 p_acc_m*1e-2">,
    listed<NavPosllh, "tow_s*1e-3 lon_deg*1e-7 lat_deg*1e-7 height_m*1e-3 msl_m*1e-3 h_acc_m*1e-3 v_acc_m*1e-3">,
    listed<NavStatus, "tow_s*1e-3 fix_type flags fix_status flags2 ttff_s*1e-3 since_start_s*1e-3">,
    listed<NavDop, "tow_s*1e-3 gdop*1e-2 pdop*1e-2 tdop*1e-2 vdop*1e-2 hdop*1e-2 ndop*1e-2 edop*1e-2">,
    listed<NavSol,
           "tow_s*1e-3 tow_fraction_ns week fix_type flags ecef_m*1e-2 p_acc_m*1e-2 ecef_v_mps*1e-2 "
           "speed_acc_mps*1e-2 pdop*1e-2 -reserved satellites -reserved">,
    listed<NavPvt,
           "tow_s*1e-3 year month day hour minute second valid t_acc_ns nano_ns fix_type flags flags2 satellites "
           "lon_deg*1e-7 lat_deg*1e-7 height_m*1e-3 msl_m*1e-3 h_acc_m*1e-3 v_acc_m*1e-3 vel_north_mps*1e-3 "
           "vel_east_mps*1e-3 vel_down_mps*1e-3 speed_mps*1e-3 course_deg*1e-5 speed_acc_mps*1e-3 course_acc_deg*1e-5 "
           "pdop*1e-2 flags3 -reserved heading_deg*1e-5 declination_deg*1e-2 declination_acc_deg*1e-2">,
    listed<NavVelned,
           "tow_s*1e-3 vel_north_mps*1e-2 vel_east_mps*1e-2 vel_down_mps*1e-2 speed_3d_mps*1e-2 "
           "speed_mps*1e-2 course_deg*1e-5 speed_acc_mps*1e-2 course_acc_deg*1e-5">,
    listed<NavHpposllh,
           "version -reserved flags tow_s*1e-3 lon_deg*1e-7 lat_deg*1e-7 height_m*1e-3 msl_m*1e-3 "
           "lon_hp_deg*1e-9 lat_hp_deg*1e-9 height_hp_m*1e-4 msl_hp_m*1e-4 h_acc_m*1e-4 v_acc_m*1e-4">,
    listed<NavTimegps, "tow_s*1e-3 tow_fraction_ns week leap_seconds valid t_acc_ns">,
    listed<NavTimeutc, "tow_s*1e-3 t_acc_ns nano_ns year month day hour minute second valid">,
    listed<NavClock, "tow_s*1e-3 bias_ns drift_nsps t_acc_ns f_acc_psps">,
    listed<NavSvinfo,
           "tow_s*1e-3 global_flags -reserved channels[channel!255 sv_id flags quality cno_dbhz "
           "elevation_deg azimuth_deg residual_m*1e-2]">,
    listed<NavSat, satellite_names>,
    listed<NavCov, "tow_s*1e-3 version position_valid velocity_valid -reserved position_m2 velocity_m2ps2">,
    listed<NavSig,
           "tow_s*1e-3 version -reserved signals[gnss_id sv_id sig_id freq_id residual_m*1e-1 cno_dbhz quality "
           "correction_source ionosphere_model flags -reserved]">,
    listed<NavEoe, "tow_s*1e-3">,
    listed<RxmSfrbx, "gnss_id sv_id sig_id freq_id channel version -reserved words">,
    listed<RxmRawx,
           "tow_s week leap_seconds receiver_status version -reserved measurements[range_m phase_cycles "
           "doppler_hz gnss_id sv_id sig_id freq_id lock_time_s*1e-3 cno_dbhz range_deviation_code "
           "phase_deviation_code doppler_deviation_code tracking_status -reserved]">,
    listed<InfError, "text">,
    listed<InfWarning, "text">,
    listed<InfNotice, "text">,
    listed<InfTest, "text">,
    listed<InfDebug, "text">,
    listed<AckAck, "class id">,
    listed<AckNak, "class id">,
    listed<CfgPrtPoll, "port_id">,
    listed<CfgPrt, "ports[port_id -reserved tx_ready mode baud in_protocols out_protocols flags -reserved]">,
    listed<CfgMsgPoll, "class id">,
    listed<CfgMsgCurrentPort, "class id rate">,
    listed<CfgMsg, "class id rates">,
    listed<CfgRst, "clear_mask reset_mode -reserved">,
    listed<CfgRate, "measurement_period_s*1e-3 measurements_per_solution time_reference">,
    listed<CfgCfg, "clear_mask save_mask load_mask device_mask">,
    listed<CfgNav5,
           "mask dynamic_model fix_mode fixed_height_m*1e-2 fixed_height_variance_m2*1e-4 min_elevation_deg "
           "dead_reckoning_limit_s pdop_mask*1e-1 tdop_mask*1e-1 position_acc_mask_m time_acc_mask_m "
           "static_hold_mps*1e-2 dgnss_timeout_s cno_satellites cno_mask_dbhz -reserved static_hold_m "
           "utc_standard -reserved">,
    listed<CfgGnss,
           "version channels_hardware channels_used systems[gnss_id channels_reserved channels_max -reserved "
           "flags]">,
    listed<CfgValset, "version layers transaction -reserved pairs[key value]">,
    listed_version<CfgValgetPoll, "version layer position keys", 0>,
    listed_version<CfgValget, "version layer position pairs[key value]", 1>,
    listed<CfgValdel, "version layers transaction -reserved keys">,
    listed<MonVer, "software hardware extensions">,
    listed<TimTp, "tow_s*1e-3 tow_fraction_ms*2^-32 quantisation_ps week flags reference">,
    listed<SecUniqid, "version -reserved unique_id">,
    listed<NavVelecef, "tow_s*1e-3 ecef_v_mps*1e-2 speed_acc_mps*1e-2">,
    listed<NavHpposecef, "version -reserved tow_s*1e-3 ecef_m*1e-2 ecef_hp_m*1e-4 flags p_acc_m*1e-4">,
    listed<NavOdo, "version -reserved tow_s*1e-3 distance_m total_distance_m distance_deviation_m">,
    listed<NavTimels,
           "tow_s*1e-3 version -reserved leap_source leap_seconds change_source change_s time_to_change_s "
           "change_week change_day -reserved valid">,
    listed<NavTimegal, "tow_s*1e-3 galileo_tow_s tow_fraction_ns week leap_seconds valid t_acc_ns">,
    listed<NavTimebds, "tow_s*1e-3 beidou_tow_s tow_fraction_ns week leap_seconds valid t_acc_ns">,
    listed<NavTimeglo, "tow_s*1e-3 time_of_day_s tow_fraction_ns day four_year_interval valid t_acc_ns">,
    listed<NavOrb, "tow_s*1e-3 version -reserved satellites[gnss_id sv_id flags ephemeris almanac other]">,
    listed<NavSbas,
           "tow_s*1e-3 geo mode system service status -reserved satellites[sv_id flags udre system service "
           "-reserved correction_m*1e-2 -reserved ionosphere_m*1e-2]">,
    listed<NavDgps,
           "tow_s*1e-3 age_s*1e-3 station health status -reserved channels[sv_id flags age_s*1e-3 "
           "correction_m correction_rate_mps]">,
    listed<NavGeofence, "tow_s*1e-3 version status combined fences[state id]">,
    listed<NavSvin,
           "version -reserved tow_s*1e-3 duration_s mean_ecef_m*1e-2 mean_ecef_hp_m*1e-4 -reserved "
           "mean_acc_m*1e-4 observations valid active -reserved">,
    listed<NavRelposned,
           "version -reserved station tow_s*1e-3 relative_ned_m*1e-2 length_m*1e-2 heading_deg*1e-5 "
           "-reserved relative_ned_hp_m*1e-4 length_hp_m*1e-4 acc_ned_m*1e-4 acc_length_m*1e-4 "
           "acc_heading_deg*1e-5 -reserved flags">,
    listed<RxmRtcm, "version flags subtype station message">,
    listed<RxmCor, "version ebno_db*0.125 -reserved status message subtype">,
    listed<TimTm2,
           "channel flags count week_rising week_falling tow_rising_s*1e-3 tow_rising_ns tow_falling_s*1e-3 "
           "tow_falling_ns acc_ns">,
    listed<MonGnss, "version supported default enabled simultaneous -reserved">,
    listed<MonTxbuf,
           "pending usage_percent peak_usage_percent total_usage_percent total_peak_usage_percent errors "
           "-reserved">,
    listed<MonRxbuf, "pending usage_percent peak_usage_percent">,
    listed<MonIo, "ports[rx_bytes tx_bytes parity_errors framing_errors overruns breaks -reserved]">,
    listed<MonComms,
           "version tx_errors -reserved protocols ports[port_id tx_pending tx_bytes tx_usage_percent "
           "tx_peak_usage_percent rx_pending rx_bytes rx_usage_percent rx_peak_usage_percent overruns messages "
           "-reserved skipped_bytes]">,
    listed<MonRf,
           "version -reserved blocks[id flags antenna_status antenna_power post_status -reserved noise agc "
           "jamming_indicator offset_i magnitude_i offset_q magnitude_q -reserved]">,
    listed<NavAtt, "tow_s*1e-3 version -reserved roll_pitch_heading_deg*1e-5 roll_pitch_heading_acc_deg*1e-5">,
    listed<NavPvat,
           "tow_s*1e-3 version valid year month day hour minute second -reserved t_acc_ns nano_ns fix_type flags "
           "flags2 satellites lon_deg*1e-7 lat_deg*1e-7 height_m*1e-3 msl_m*1e-3 h_acc_m*1e-3 v_acc_m*1e-3 "
           "vel_ned_mps*1e-3 speed_mps*1e-3 speed_acc_mps*1e-3 roll_pitch_heading_deg*1e-5 course_deg*1e-5 "
           "roll_pitch_heading_acc_deg*1e-2 declination_deg*1e-2 declination_acc_deg*1e-2 orientation_deg*1e-2 "
           "major_minor_m*1e-3 -reserved">,
    listed<NavTimeqzss, "tow_s*1e-3 qzss_tow_s tow_fraction_ns week leap_seconds valid t_acc_ns">,
    listed<NavRelposned0,
           "version -reserved station tow_s*1e-3 relative_ned_m*1e-2 relative_ned_hp_m*1e-4 -reserved "
           "acc_ned_m*1e-4 flags">,
    listed<NavEell, "tow_s*1e-3 version -reserved orientation_deg*1e-2 major_m*1e-3 minor_m*1e-3">,
    listed<NavSlas,
           "tow_s*1e-3 version -reserved station_lon_deg*1e-3 station_lat_deg*1e-3 station qzss_sv_id flags "
           "satellites[gnss_id sv_id -reserved -reserved correction_m*1e-2]">,
    listed<NavAopstatus, "tow_s*1e-3 config status -reserved">,
    listed<NavPl,
           "version risk_coefficient risk_exponent position_valid position_frame velocity_valid velocity_frame "
           "time_valid invalidity_reasons -reserved tow_s*1e-3 position_level_m*1e-3 velocity_level_mps*1e-3 "
           "position_orientation_deg*1e-2 velocity_orientation_deg*1e-2 time_level_ns -reserved">,
    listed<RxmMeasx,
           "version -reserved gps_tow_s*1e-3 glonass_tow_s*1e-3 beidou_tow_s*1e-3 -reserved qzss_tow_s*1e-3 "
           "gps_tow_acc_ms*2^-4 glonass_tow_acc_ms*2^-4 beidou_tow_acc_ms*2^-4 -reserved qzss_tow_acc_ms*2^-4 flags "
           "-reserved satellites[gnss_id sv_id cno_dbhz multipath doppler_mps*4e-2 doppler_hz*2e-1 whole_chips "
           "fraction_chips*2^-10 code_phase_ms*2^-21 whole_code_phase_ms range_deviation_code -reserved]">,
    listed<RxmSvsi, "tow_s*1e-3 week visible satellites[sv_id flags azimuth_deg elevation_deg age]">,
    listed<RxmRlm, "version type sv_id -reserved beacon message parameters -reserved">,
    listed<RxmPmreqShort, "duration_s*1e-3 flags">,
    listed<RxmPmreq, "version -reserved duration_s*1e-3 flags wakeup_sources">,
    listed<MonMsgpp, "messages skipped_bytes">,
    listed<MonHw, mon_hw_names>,
    listed<MonHwLong, mon_hw_names>,
    listed<MonHwShort, mon_hw_names>,
    listed<MonHw2,
           "offset_i magnitude_i offset_q magnitude_q config_source -reserved low_level_config -reserved "
           "post_status -reserved">,
    listed<MonHw3, "version flags hardware -reserved pins[id mask virtual_pin -reserved]">,
    listed<MonRxr, "flags">,
    listed<MonPatch, "version entries patches[info comparator address data]">,
    listed<MonSpan, "version -reserved blocks[spectrum_db*2^-2 span_hz resolution_hz centre_hz gain_db -reserved]">,
    listed<MonSys,
           "version boot_type cpu_percent cpu_peak_percent memory_percent memory_peak_percent io_percent "
           "io_peak_percent run_time_s notices warnings errors temperature_c -reserved">,
    listed<TimVrfy, "tow_s*1e-3 tow_fraction_ns delta_ms delta_ns week flags -reserved">,
    listed<MgaAck, "type version info_code id payload_start">,
    listed_version<SecSig1, "version -reserved jamming_flags -reserved spoofing_flags -reserved", 1>,
    listed_version<SecSig2, "version flags -reserved bands[centre_khz jammed]", 2>,
    listed<SecSiglog, "version -reserved events[age_s*1e-3 detection event -reserved]">,
    listed<EsfStatus, "tow_s*1e-3 version -reserved fusion_mode -reserved sensors[status1 status2 rate_hz faults]">,
    listed<HnrPvt,
           "tow_s*1e-3 year month day hour minute second valid nano_ns fix_type flags -reserved lon_deg*1e-7 "
           "lat_deg*1e-7 height_m*1e-3 msl_m*1e-3 speed_mps*1e-3 speed_3d_mps*1e-3 course_deg*1e-5 heading_deg*1e-5 "
           "h_acc_m*1e-3 v_acc_m*1e-3 speed_acc_mps*1e-3 course_acc_deg*1e-5 -reserved">,
    listed<HnrAtt, "tow_s*1e-3 version -reserved roll_pitch_heading_deg*1e-5 roll_pitch_heading_acc_deg*1e-5">,
    listed<HnrIns, "validity -reserved tow_s*1e-3 angular_rate_degps*1e-3 acceleration_mps2*1e-2">,
    listed<CfgTp5,
           "pulse version -reserved cable_delay_ns rf_group_delay_ns period period_locked length length_locked "
           "user_delay_ns flags">,
    listed<CfgItfm, "config config2">,
    listed<CfgPms, "version power_setup period_s on_time_s -reserved">,
    listed<CfgRxm, "-reserved power_mode">,
    listed<CfgAnt, "flags pins">,
    listed<CfgLogfilter, "version flags interval_s time_threshold_s speed_threshold_mps position_threshold_m">,
    listed<UpdSos, "command -reserved">,
    listed<UpdSosStatus, "command -reserved response -reserved">,
    listed<CfgNavx5,
           "version mask1 mask2 -reserved min_satellites max_satellites min_cno_dbhz -reserved initial_fix_3d "
           "-reserved ack_aiding week_rollover attenuation_compensation -reserved use_ppp aop_config -reserved "
           "aop_max_error_m -reserved use_adr">,
    listed<CfgSbas, "mode usage channels_max scan_mode2 scan_mode1">,
    listed<CfgOdo,
           "version -reserved flags profile -reserved course_max_speed_mps*1e-1 course_max_acc_m -reserved "
           "velocity_gain course_gain -reserved">,
    listed<CfgDgnss, "mode -reserved">,
    listed<CfgDat, "datum name semi_major_m inverse_flattening shift_m rotation scale_ppm">,
    listed<CfgDatSet, "semi_major_m inverse_flattening shift_m rotation scale_ppm">,
    listed<CfgPm2,
           "version -reserved startup_s -reserved flags update_s*1e-3 search_s*1e-3 grid_offset_s*1e-3 on_time_s "
           "acquisition_s -reserved inactivity_s*1e-3">,
    listed<CfgPwr, "version -reserved state">,
    listed<CfgGeofence,
           "version confidence -reserved pin_on pin_polarity pin -reserved fences[lat_deg*1e-7 lon_deg*1e-7 "
           "radius_m*1e-2]">,
    listed<CfgTmode3,
           "version -reserved flags position position_hp -reserved position_acc_m*1e-4 survey_duration_s "
           "survey_acc_m*1e-4 -reserved">,
    listed<CfgInf, "protocols[protocol -reserved masks]">,
    listed<CfgNmeaShort, "filter nmea_version listed_satellites flags">,
    listed<CfgNmeaV0,
           "filter nmea_version listed_satellites flags systems_off numbering main_talker gsv_talker version">,
    listed<CfgNmea,
           "filter nmea_version listed_satellites flags systems_off numbering main_talker gsv_talker version "
           "beidou_talker -reserved">,
    listed<CfgUsb, "vendor_id product_id -reserved power_ma flags vendor product serial_number">,
});

}  // namespace

std::span<const UbxListing> ubx_listings() { return ubx_listing_table; }

void list_ubx(const UbxFrameView& frame, DecodedMessage& message) {
    message.id = fmt::format("{:02X}-{:02X}", frame.id.message_class, frame.id.id);
    message.name = ubx_message_name(frame.id).value_or("");
    if (frame.payload.empty()) {
        message.fields.push_back({"poll", {std::uint64_t{1}}});
        return;
    }
    for (const UbxListing& listing : ubx_listing_table) {
        if (listing.id != frame.id) continue;
        if (auto fields = listing.list(frame.payload)) {
            message.fields = std::move(*fields);
            return;
        }
    }
    message.payload.assign(frame.payload.begin(), frame.payload.end());
}

}  // namespace skyloop::inline receiver
