/// For every kind of fault: how it is asked for, where a client sees it, and what is the same again after its end.
#pragma once

#include <algorithm>
#include <string_view>

#include "support/fault_bench.hpp"

namespace skyloop::test {

/// One kind of fault on the bench.
struct FaultRow {
    std::string_view kind;
    std::string_view parameters;  ///< TOML
    /// A message that differs while it lasts; "": any of them, or its coming; "pace": the pace of a live run.
    std::string_view seen_in;
    double settle_s = 1;  ///< after its end, until all is as without it
    /// How far positions may lie apart then, m; below 0: every byte is the same.
    double bound_m = -1;
    FaultBench bench = FaultBench::sensor;
    bool client_must_configure = false;  ///< what it took is gone for good: the client gives it back
};

// Settling times of receivers that measure: they search what they have lost, read its record and let the filter forget.
// Positions then lie apart by what other noise of the channels makes of them.
inline constexpr FaultBench measuring = FaultBench::measuring, sensor = FaultBench::sensor,
                            corrected = FaultBench::corrected;
inline constexpr FaultRow fault_rows[] = {
    {"outage", "", "NAV-PVT", 60, 3, measuring},
    {"cn0_drop", "attenuation_db = 25", "NAV-SAT", 60, 3, measuring},
    {"antenna_open", "", "MON-RF", 60, 3, measuring},
    {"antenna_short", "", "MON-RF", 60, 3, measuring},
    {"jamming", "j_to_s_db = 70", "MON-RF", 60, 3, measuring},
    {"multipath_burst", "", "RXM-RAWX", 60, 3, measuring},
    {"surroundings", "around = \"urban-canyon\"", "RXM-RAWX", 60, 3, measuring},
    {"spoof_takeover", "offset_m = [300, 0, 0]\naligned_s = 5\npull_off_mps = 20", "NAV-PVT", 60, 3, measuring},
    {"meaconing", "rebroadcast_at = [46.51, 30.75, 60]", "NAV-PVT", 60, 3, measuring},
    {"spoof_satellite", "step_m = 500", "RXM-RAWX", 60, 3, measuring},
    {"spoof_flapping", "", "NAV-STATUS", 1, -1, sensor},
    {"satellite_clock_step", "step_ns = 300", "RXM-RAWX", 60, 3, measuring},
    {"satellite_clock_drift", "drift_ns_per_s = 50", "RXM-RAWX", 60, 3, measuring},
    {"wrong_ephemeris", "radial_m = 500", "NAV-PVT", 60, 3, measuring},
    {"unhealthy", "elevation_from_deg = 50", "NAV-SAT", 60, 3, measuring},
    {"ionospheric_storm", "vertical_delay_m = 20", "NAV-PVT", 60, 3, measuring},
    {"scintillation", "s4 = 0.9\nsigma_phi_rad = 1", "RXM-RAWX", 60, 3, measuring},
    {"pseudorange_step", "step_m = 500", "RXM-RAWX", 60, 3, measuring},
    {"pseudorange_ramp", "ramp_mps = 20", "RXM-RAWX", 60, 3, measuring},
    {"cycle_slips", "slips_per_minute = 600", "RXM-RAWX", 60, 3, measuring},
    {"antenna_moved", "", "NAV-PVT", 60, 3, measuring},
    {"position_step", "", "NAV-PVT"},
    {"position_ramp", "", "NAV-PVT"},
    {"drift", "", "NAV-PVT"},
    {"wander", "", "NAV-PVT"},
    {"biased_good_dop", "", "NAV-PVT"},
    {"height_bias", "", "NAV-PVT"},
    {"velocity_bias", "", "NAV-PVT"},
    {"accuracy_scale", "", "NAV-PVT"},
    {"freeze", "", "NAV-PVT"},
    {"stale_position", "", "NAV-PVT"},
    {"zero_position", "", "NAV-PVT"},
    {"wrong_fix_type", "", "NAV-PVT"},
    {"rtk_transition", "", "NAV-PVT"},
    {"heading_lost", "", "NAV-RELPOSNED"},
    {"heading_flipped", "", "NAV-RELPOSNED"},
    {"satellites_misreported", "", "NAV-PVT"},
    {"dropped_epochs", "", "NAV-PVT"},
    {"duplicated_epochs", "", "NAV-PVT"},
    {"reordered_epochs", "delay_s = 1.3", "NAV-PVT", 3},
    {"leap_second_wrong", "", "NAV-PVT"},
    {"leap_second_event", "", "NAV-TIMELS"},
    {"week_rollover", "", "NAV-PVT"},
    {"week_order", "", "NAV-TIMEGPS"},
    {"time_step", "", "NAV-PVT"},
    {"time_backwards", "", "NAV-PVT"},
    {"time_drift", "", "NAV-PVT"},
    {"date_unknown", "", "NAV-PVT"},
    {"receiver_silent", "", "NAV-PVT"},
    {"receiver_deaf", "", "MON-VER"},
    {"never_answers", "", "CFG-VALGET"},
    {"answers_selectively", "messages = \"CFG-VALGET\"", "CFG-VALGET"},
    {"no_version", "", "MON-VER"},
    {"withheld_messages", "messages = \"NAV-PVT\"", "NAV-PVT"},
    {"refuses_keys", "keys = \"CFG-RATE-NAV\"", "ACK-NAK"},
    {"refuses_messages", "messages = \"CFG-VALSET\"", "ACK-NAK"},
    {"wrong_version", "software = \"EXT CORE 9.99\"", "MON-VER"},
    {"jamming_flag_hidden", "", "MON-RF"},
    {"forgets_configuration", "", "NAV-PVT", 15, -1, sensor, true},
    {"reboots", "", "", 30, 0, sensor},
    {"slow_cold_start", "without_fix_s = 30", "NAV-PVT", 30, 0, sensor},
    {"changed_baud", "", "NAV-PVT"},
    {"slow_answers", "delay_s = 0.7", "", 2},
    {"solution_latency", "", "", 2},
    {"clock_drift", "", "pace"},
    {"byte_loss", "", ""},
    {"bit_flips", "", ""},
    {"checksum_errors", "", ""},
    {"truncated_messages", "", ""},
    {"merged_messages", "", ""},
    {"inserted_garbage", "", ""},
    {"wire_delay", "", "", 2},
    {"wire_jitter", "", "", 2},
    {"stall", "", "", 2},
    {"duplicate_messages", "", ""},
    {"reordered_messages", "", ""},
    {"saturated_uart", "baud = 9600", "", 5},
    {"line_break", "", "NAV-PVT"},
    {"unplugged", "", "NAV-PVT"},
    {"power_cut", "", "NAV-PVT", 60, 0, sensor},
    {"speed_mismatch", "", "NAV-PVT"},
    {"one_direction_dead", "", "NAV-PVT"},
    {"base_misplaced", "", "NAV-PVT", 60, 0.1, corrected},
    {"base_multipath", "", "NAV-PVT", 60, 0.1, corrected},
    {"corrections_lost", "", "NAV-PVT", 60, 0.1, corrected},
    {"corrections_late", "", "NAV-PVT", 60, 0.1, corrected},
    {"corrections_frozen", "", "NAV-PVT", 60, 0.1, corrected},
    {"corrections_rare", "", "NAV-PVT", 60, 0.1, corrected},
    {"glonass_biases_missing", "", "RXM-RTCM", 60, 0.1, corrected},
    {"base_in_other_frame", "", "NAV-PVT", 60, 0.1, corrected},
    {"wrong_mount_point", "of_receiver = \"rover\"", "NAV-PVT", 60, 0.1, corrected},
};

/// For failures.
inline void PrintTo(const FaultRow& row, std::ostream* out) { *out << row.kind; }

/// The row of a kind, or null.
inline const FaultRow* fault_row(std::string_view kind) {
    const auto found = std::find_if(std::begin(fault_rows), std::end(fault_rows),
                                    [&](const FaultRow& row) { return row.kind == kind; });
    return found == std::end(fault_rows) ? nullptr : &*found;
}

/// How long a run is in which this fault has ended and settled, s.
inline double length_of(const FaultRow& row) { return bench_end_s + row.settle_s + 12; }

/// The bench without faults, once for all tests.
inline const BenchRun& sound_run(FaultBench bench) {
    static const BenchRun of_sensor = bench_run(FaultBench::sensor, "", 145);
    static const BenchRun of_measuring = bench_run(FaultBench::measuring, "", 145);
    static const BenchRun of_corrected = bench_run(FaultBench::corrected, "", 145);
    return bench == FaultBench::sensor ? of_sensor : bench == FaultBench::measuring ? of_measuring : of_corrected;
}

}  // namespace skyloop::test
