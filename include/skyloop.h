/// skyloop inside another program: GNSS receivers that are not there, led instant by instant.
///
/// One handle is one run of a scenario: one vehicle or several, each with its receivers. The caller says where the
/// vehicle is and how far time goes, and reads and writes the bytes on the receivers' ports; docs/c_api.md tells how.
///
/// Time: nanoseconds of the caller's own clock, which the library calls simulated time. Nothing waits, and after
/// sky_create() nothing looks at a clock of the machine.
/// Determinism: the same scenario, seed and calls give the same bytes, on one build of the library.
/// Ownership: every buffer is the caller's and is copied from or into; no pointer is kept but `log` and `log_user`.
/// Threads: one handle for one thread at a time; a call beside another one on the same handle, from the log function
/// too, does nothing and gives SKY_E_BUSY. Different handles know nothing of each other.
/// Errors: negative numbers; sky_last_error() has the sentence. Nothing is thrown. After SKY_E_INTERNAL a handle can
/// only be destroyed. Once a command has ended the run, what leads it (sky_set_truth(), sky_advance(), sky_write(),
/// sky_set_baud(), sky_set_los(), sky_command()) gives SKY_E_STATE.
/// Language: C99 or C++11 and later.
/// ABI: structures grow at their ends alone and say their own size; symbols are never removed while SKY_ABI_MAJOR and
/// the library's SONAME (libskyloop.so.0) stay. A program built for minor n runs with every later one.
#ifndef SKYLOOP_H
#define SKYLOOP_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define SKY_API __attribute__((visibility("default")))
#else
#define SKY_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define SKY_ABI_MAJOR 0
#define SKY_ABI_MINOR 1

/// A run. Made by sky_create(), ended by sky_destroy().
typedef struct sky_emulator sky_emulator;

/// 0, or what went wrong.
typedef int32_t sky_status;
enum {
    SKY_OK = 0,
    SKY_E_ARG = -1,          ///< a null pointer, a size, a number of port or receiver that does not exist
    SKY_E_STATE = -2,        ///< not now: the run has ended, too much waits, the geoid is not there
    SKY_E_NOMEM = -3,        ///< no memory
    SKY_E_IO = -4,           ///< the outside world refused: no such file, no permission
    SKY_E_PARSE = -5,        ///< a scenario or a command that is wrong
    SKY_E_TIME = -6,         ///< time goes back, or too far ahead
    SKY_E_RANGE = -7,        ///< a number that is not finite, or out of its bounds
    SKY_E_UNSUPPORTED = -8,  ///< what this version does not know, or a led run cannot do
    SKY_E_BUSY = -9,         ///< another call on this handle is going on
    SKY_E_INTERNAL = -100    ///< a mistake inside the library; only sky_destroy() may follow
};

/// How much a sentence of the log matters.
enum { SKY_LOG_ERROR = 0, SKY_LOG_WARNING = 1, SKY_LOG_DETAIL = 2 };
/// Told sentences while a call on the handle goes on, sky_destroy() among them, by its thread. It must not call back
/// into the same handle.
typedef void (*sky_log_fn)(void* user, int32_t level, const char* utf8);

/// Fields of sky_create_info that count; others are what the scenario says.
enum {
    SKY_CREATE_SEED = 1,   ///< seed
    SKY_CREATE_ORIGIN = 2  ///< origin_lla; else the `origin` of the first receiver's live [trajectory], else the place
                           ///< of its vehicle (not of its antenna) at the start
};

/// What sky_create() is told. Fill it with zeros first.
typedef struct sky_create_info {
    uint32_t struct_size;       ///< sizeof(sky_create_info)
    uint32_t abi_major;         ///< SKY_ABI_MAJOR
    uint32_t set;               ///< SKY_CREATE_…
    uint32_t reserved;          ///< 0
    const char* scenario_text;  ///< TOML (docs/scenario.md); null: scenario_file is read
    const char* scenario_file;  ///< its path; with a text its name, and paths in it are relative to it; both null:
                                ///< the embedded defaults
    const char* data_dir;       ///< where boards/ and geoids/ lie; null: $SKYLOOP_DATA_DIR, else the installation
    const char* record_dir;     ///< a folder for a recording as of skyloop simulate --out; null: none
    const char* start_utc;      ///< ISO 8601 in UTC, or "now"; null: what the scenario says
    sky_log_fn log;             ///< null: nobody
    void* log_user;             ///< handed to it
    char* error;                ///< where the sentence of a failed sky_create() goes, cut to its room and ended by a
                                ///< zero, empty after SKY_OK; null: nowhere. Without a struct_size that reaches as
                                ///< far as error_capacity there is none
    uint64_t error_capacity;    ///< bytes there
    int64_t start_sim_ns;       ///< the caller's time at the start of the run
    uint64_t seed;              ///< SKY_CREATE_SEED
    double origin_lla[3];       ///< SKY_CREATE_ORIGIN: of SKY_POS_LOCAL_NED, degrees and metres above the ellipsoid
} sky_create_info;

/// What a sky_truth says: one of the four positions, and what else is known.
enum {
    SKY_POS_ECEF = 1,           ///< pos: x, y, z, metres, WGS 84
    SKY_POS_LLA_ELLIPSOID = 2,  ///< pos: latitude, longitude, degrees; metres above the WGS-84 ellipsoid
    SKY_POS_LLA_MSL = 4,        ///< pos: latitude, longitude, degrees; metres above sea level (EGM96)
    SKY_POS_LOCAL_NED = 8,      ///< pos: north, east, down from the origin, less than 1e7 m, in its tangent plane
    SKY_VEL = 16,
    SKY_ACC = 32,
    SKY_ATT = 64,
    SKY_RATE = 128,
    SKY_RESET = 256  ///< the vehicle was moved by hand: no way leads from the sample before to this one
};

/// Where a vehicle is at one instant: in each frame less than 1000 km above the ellipsoid and not at latitude and
/// longitude 0, which sources say that know no place; as a latitude and longitude no more than 10 km below it. North,
/// east, down are those of its own place; of SKY_POS_LOCAL_NED velocity and acceleration are along the axes of the
/// origin, as its positions are.
typedef struct sky_truth {
    uint32_t struct_size;  ///< sizeof(sky_truth)
    uint32_t fields;       ///< SKY_POS_… | SKY_VEL | …
    int64_t sim_time_ns;
    uint32_t vehicle;    ///< 0: the scenario's; n + 1: that of receiver n, where it has a [receiver.trajectory]
    uint32_t reserved;   ///< 0
    double pos[3];       ///< SKY_POS_…
    double vel_ned[3];   ///< SKY_VEL: over ground, m/s; less than 12 km/s
    double acc_ned[3];   ///< SKY_ACC: of the motion, gravity not in it, less than 1000 m/s²
    double q_nb[4];      ///< SKY_ATT: w, x, y, z; turns forward, right, down into north, east, down
    double rate_frd[3];  ///< SKY_RATE: about forward, right, down, less than 200 rad/s
} sky_truth;

/// How far a run has come.
typedef struct sky_progress {
    uint32_t struct_size;    ///< sizeof(sky_progress)
    uint32_t ports;          ///< of all receivers
    uint64_t epochs;         ///< of all receivers since the start
    int64_t now_ns;          ///< simulated time
    int64_t next_event_ns;   ///< the next epoch, fault or end of a burst, or look at a wire with a fault or a client of
                             ///< the scenario's, each ms to 10 ms; nothing but single bytes comes before it
    uint64_t bytes_pending;  ///< that sky_read() would give, on all ports
    uint64_t ports_pending;  ///< bit n: port n has some; ports from 64 on are not shown
} sky_progress;

/// Types of sky_fix: as NAV-PVT fixType, with the two kinds of carrier solution.
enum {
    SKY_FIX_NONE = 0,
    SKY_FIX_DEAD_RECKONING = 1,
    SKY_FIX_2D = 2,
    SKY_FIX_3D = 3,
    SKY_FIX_TIME_ONLY = 5,
    SKY_FIX_DGNSS = 6,
    SKY_FIX_RTK_FLOAT = 7,
    SKY_FIX_RTK_FIXED = 8
};

/// What a receiver reported of its last epoch, faults among it. Without a position only the first line means something.
typedef struct sky_fix {
    uint32_t struct_size;                              ///< sizeof(sky_fix)
    uint8_t type, ok, satellites_used, jamming_state;  ///< SKY_FIX_…; 1 within limits; jamming: 0 unknown … 3 critical
    uint64_t epochs;                                   ///< of this receiver since the start; 0: there is none yet
    int64_t sim_time_ns;                               ///< of the epoch
    int64_t gps_time_ns;                               ///< since 1980-01-06, as the receiver believes
    double lat_deg, lon_deg, height_ellipsoid_m, height_msl_m;
    double vel_ned[3];                                  ///< m/s
    double error_enu_m[3];                              ///< reported less true position
    float pdop, hdop, vdop, reserved;                   ///< in a 2D fix with a held height PDOP and VDOP are NaN
    float h_acc_m, v_acc_m, speed_acc_mps, course_deg;  ///< 1 σ estimates; course over ground
} sky_fix;

/// Bits of sky_sat.flags.
enum {
    SKY_SAT_TRACKED = 1,  ///< the receiver reports a strength
    SKY_SAT_USED = 2,     ///< in its solution
    SKY_SAT_HEALTHY = 4,
    SKY_SAT_SEEN = 8  ///< in line of sight at the last epoch, by the scenario's scene and sky_set_los()
};

/// One satellite above a receiver's horizon.
typedef struct sky_sat {
    uint8_t gnss_id, sv_id;  ///< as UBX counts them: 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS,
                             ///< 7 NavIC
    uint8_t flags;           ///< SKY_SAT_…
    uint8_t reserved;
    float az_deg, el_deg;  ///< azimuth clockwise from true north
    float cn0_dbhz;        ///< reported; 0: not tracked
    float los_ned[3];      ///< unit vector from the antenna to it
} sky_sat;

/// What a ray cast has found. Reflections are those over ways longer than the direct one.
enum { SKY_LOS_UNKNOWN = 0, SKY_LOS_CLEAR = 1, SKY_LOS_ATTENUATED = 2, SKY_LOS_BLOCKED = 3 };
typedef struct sky_los {
    uint8_t gnss_id, sv_id;
    uint8_t state;           ///< SKY_LOS_…; unknown takes back what was told of this satellite
    uint8_t reflections;     ///< 0 … 4
    float attenuation_db;    ///< of the direct ray, 0 … 100: SKY_LOS_ATTENUATED alone
    float excess_m[4];       ///< of each reflection's way over the direct one, 0 … 100 000
    float reflection_db[4];  ///< its strength over the free direct ray, −100 … 0
} sky_los;

/// Major version << 16 | minor of the library that is loaded.
SKY_API uint32_t sky_abi_version(void);

/// Begins a run. @param out the handle; null after a failure
SKY_API sky_status sky_create(const sky_create_info* info, sky_emulator** out);

/// Ends a run, writes what is left of its recording; what cannot be written is told to the log, as SKY_LOG_ERROR. Null
/// is nothing. No other call on it may be going on.
SKY_API void sky_destroy(sky_emulator* emulator);

/// Says where a vehicle is. From the first time on the scenario's own trajectory of that vehicle does not count any
/// more. Times ascend; they may lie up to 2 s behind the present of the run and up to 2 s ahead of it. Without SKY_ATT
/// an attitude that was told before goes on, turned by its turn rate, which fades; SKY_RESET ends it.
SKY_API sky_status sky_set_truth(sky_emulator* emulator, const sky_truth* truth);

/// Does everything that happens up to and at this instant, in order. Between pushed positions the vehicle's way is
/// interpolated; beyond the newest it goes on with its velocity and an acceleration that fades, then comes to rest. The
/// same instant may be asked for again; one call goes at most a day ahead. A command that ends the run ends the call
/// with SKY_OK, and now_ns tells when that was; the next gives SKY_E_STATE. SKY_E_IO: the recording could not be
/// written. @param out may be null
SKY_API sky_status sky_advance(sky_emulator* emulator, int64_t sim_time_ns, sky_progress* out);

/// Takes bytes that have left a receiver's port by now, at its line speed. Ports are those of the scenario, receiver by
/// receiver in its order; a receiver without any has one. @return how many; 0: none now
SKY_API int64_t sky_read(sky_emulator* emulator, uint32_t port, void* buffer, size_t capacity);

/// Sends bytes to a receiver: they set out now, or after those before them, and arrive at the line speed.
/// @return how many were taken: all, unless a megabyte waits already
SKY_API int64_t sky_write(sky_emulator* emulator, uint32_t port, const void* bytes, size_t size);

/// Sets the line speed of the caller's own end of a UART, as tcsetattr() would: with another speed than the receiver's
/// both ends hear garbage. @param baud bit/s, 1 … 50 000 000; 0, as at first: always that of the receiver
SKY_API sky_status sky_set_baud(sky_emulator* emulator, uint32_t port, uint32_t baud);

/// What receiver number `receiver` of the scenario last reported; SKY_FIX_NONE once it has been silent for 2 s, as
/// without power.
SKY_API sky_status sky_get_fix(sky_emulator* emulator, uint32_t receiver, sky_fix* out);

/// All satellites above a receiver's antenna at its last epoch; before the first, now, with SKY_SAT_HEALTHY as their
/// only flag. @param stride bytes from one
/// element to the next, at least sizeof(sky_sat) of version 0.1 @return how many there are, though at most `capacity`
/// are written
SKY_API int64_t sky_get_sats(sky_emulator* emulator, uint32_t receiver, sky_sat* out, size_t capacity, size_t stride);

/// Says what a receiver's satellites are seen through, from its next epoch on, until something else is said of them.
/// Others stay as they are. @param stride as of sky_get_sats()
SKY_API sky_status sky_set_los(sky_emulator* emulator, uint32_t receiver, const sky_los* los, size_t count,
                               size_t stride);

/// Faults and other commands at the present instant, as JSON: {"command": "start_fault", "kind": "jamming",
/// "j_to_s_db": 40, "for_s": 20}. The commands are those of the control interface (docs/faults.md); pause, resume, step
/// and speed are SKY_E_UNSUPPORTED, for time is the caller's, and so is move_to once sky_set_truth() leads a vehicle.
SKY_API sky_status sky_command(sky_emulator* emulator, const char* json);

/// Text about the run as JSON, ended by a zero where it fits. @param what "status", "config", "ports", "faults"
/// (kinds that sky_command() can start) or "commands" @return the bytes of the text without its zero; nothing is
/// written unless there is room for all of it and the zero. "status" stays the same until the next sky_advance()
SKY_API int64_t sky_query(sky_emulator* emulator, const char* what, char* buffer, size_t capacity);

/// The sentence of the last call that failed, UTF-8, ended by a zero; empty when none has. Cut to its room, at the end
/// of a character. @return the bytes of the whole sentence without its zero
SKY_API int64_t sky_last_error(sky_emulator* emulator, char* buffer, size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
