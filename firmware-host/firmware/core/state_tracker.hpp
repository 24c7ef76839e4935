/// How a receiver's report of itself goes on from epoch to epoch.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "firmware/core/monitor_drift.hpp"
#include "firmware/core/navigation_state.hpp"
#include "firmware/core/told_heading.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop::firmware {

/// What a restart forgets (CFG-RST navBbrMask; RECEIVER.md 4.8).
struct Forgotten {
    bool ephemerides = false, almanac = false, health = false, ionosphere = false, position = false, clock = false,
         utc = false, rtc = false;
    static Forgotten by_mask(std::uint16_t nav_bbr_mask);
    /// What is gone at a start of that kind: nothing, the ephemerides, everything.
    static Forgotten of(StartKind kind);
    /// hot: nothing but the state of tracking; warm: ephemerides; cold: time or place too.
    [[nodiscard]] StartKind kind() const;
};

/// Validity of time and date, time to first fix, coasting, limits of the dynamic models and of export, static hold,
/// course freezing, monitors, odometer and the fixed place of a base: RECEIVER.md 4.8 to 4.12.
///
/// State: what was reported before, and since when what is so. Times of update() never go back but with a restart.
class StateTracker {
public:
    /// What it knew before its first start is not simulated: the time, and all of it.
    /// @param seed of what wanders by itself
    explicit StateTracker(const BoardProfile& board, std::uint64_t seed = 1) : board_(board), drift_(board, seed) {
        state_.time.time = state_.time.date = state_.time.leap_seconds = true;
    }

    /// Where it was when it was last on: for the next start().
    void remember(const Geodetic& position, Metres geoid_undulation) {
        last_fix_.position = position;
        last_fix_.geoid_undulation = geoid_undulation;
        state_.ever_had_fix = state_.position_known = true;
    }
    /// The receiver starts, with what it knew and has not forgotten. An earlier start that has not come to a fix yet
    /// and had forgotten more goes on beneath. @param running it has been on for long, and knows all
    void start(GpsTime now, const Forgotten& forgotten, bool running = false);
    /// The whole receiver starts, navigation with it: to be followed by start().
    void boot(GpsTime now, BootCause cause = BootCause::power) {
        booted_ = now;
        boot_cause_ = cause;
    }
    /// The next epoch, in the receiver's own words. @param corrections of CorrectionInput at that instant
    const NavigationState& update(const Epoch& epoch, const ReceiverConfig& config,
                                  const CorrectionStatus& corrections);
    [[nodiscard]] const NavigationState& state() const { return state_; }
    /// A client has changed the configuration: a survey-in ends with its mode, and begins anew with other limits.
    void adopt(const ReceiverConfig& config);
    void reset_odometer() { state_.odometer_m = state_.odometer_deviation_m = 0; }

private:
    void learn_time();
    [[nodiscard]] std::optional<Constellation> told_leap_seconds() const;
    [[nodiscard]] std::optional<GpsTime> first_tracking() const;
    void keep_level(const ReceiverConfig& config);
    [[nodiscard]] bool hears_too_little(const ReceiverConfig& config) const;
    void keep_within_limits(const ReceiverConfig& config);
    [[nodiscard]] Seconds acquisition_time(StartKind kind) const;
    void begin_acquisition(GpsTime now, StartKind kind);
    void acquire();
    void coast(const Fix& before);
    void hold(const ReceiverConfig& config);
    void apply_corrections(const CorrectionStatus& corrections);
    void survey(const ReceiverConfig& config);
    void stand_still(const ReceiverConfig& config);
    void freeze_course();
    void count_distance(const Fix& before);
    void monitor(const ReceiverConfig& config);
    [[nodiscard]] BandMonitor monitor_band(const QuietBand& quiet, Decibels interference, bool watched) const;

    const BoardProfile& board_;
    MonitorDrift drift_;
    NavigationState state_;
    std::optional<GpsTime> started_;  ///< nothing: long ago
    std::optional<GpsTime> booted_;   ///< nothing: long ago, and there was no epoch yet
    BootCause boot_cause_ = BootCause::power;
    StartKind start_kind_ = StartKind::hot;  ///< the coldest since the last fix
    /// Models that measure nothing have a fix from then on; nothing: from the first epoch on.
    std::optional<GpsTime> acquired_at_;
    bool measured_ = false;                           ///< the model acquires satellites itself
    std::map<Constellation, GpsTime> first_tracked_;  ///< since the start
    std::optional<GpsTime> first_fix_;
    std::optional<GpsTime> last_good_;  ///< epoch of the last solution that was not coasted
    bool last_good_was_ok_ = false;     ///< within limits, DOP and accuracy masks
    Fix last_fix_;
    std::optional<Fix> held_;  ///< the fix of static hold
    TurnRate turn_rate_;
    int epochs_beyond_limits_ = 0;
};

/// The number of a dynamic model in CFG-NAVSPG-DYNMODEL.
std::uint64_t dynamic_model_number(DynamicModel model);
/// The model of a number of CFG-NAVSPG-DYNMODEL.
DynamicModel dynamic_model_of(std::uint64_t number);
/// Whether a dynamic model allows a fix (RECEIVER.md 4.8, table of dynamic models; generation as in Identity).
/// @param number of CFG-NAVSPG-DYNMODEL
bool within_dynamic_model(std::uint64_t number, const Fix& fix, int generation);
/// Height above sea level up to which the airborne models have a fix.
Metres airborne_ceiling(int generation);
/// Whether the limits of export allow a fix, by its height above sea level and its speed in space.
bool within_export_limits(ExportLimits limits, const Fix& fix);
/// Whether a board tells a fix there and so fast: by its dynamic model, where the board has limits of those, by its
/// limits of export, and by the 500 m/s of all receivers. @param dynamic_model as of within_dynamic_model()
bool within_limits(const BoardProfile& board, std::uint64_t dynamic_model, const Fix& fix);

}  // namespace skyloop::firmware
