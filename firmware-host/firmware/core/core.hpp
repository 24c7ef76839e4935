/// The receiver's parts in a row.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/core/epoch_reporter.hpp"
#include "firmware/core/parts.hpp"
#include "firmware/core/port_input.hpp"
#include "firmware/core/port_speeds.hpp"
#include "firmware/core/power_save.hpp"
#include "firmware/core/sleep.hpp"

namespace skyloop::firmware {

/// What Receiver documents. It does not move: its parts refer to each other.
class Receiver::Core {
public:
    Core(BoardProfile board, const ReceiverOptions& options, const MakerRow& row);

    void start(GpsTime now);
    void input(PortId port, ByteSpan bytes, GpsTime now);
    void on_epoch(const Epoch& epoch, const ReportEdit& edit);
    const ReceiverSettings& settings_at(GpsTime epoch);
    void happen(const ReceiverEvent& event, GpsTime now);
    std::vector<Sent> output(GpsTime now);
    /// After the maker's settings have been changed from outside, before start().
    void begin_as_stored();
    void remember(const Geodetic& position, Metres undulation) { tracker_.remember(position, undulation); }

    [[nodiscard]] ReceiverParts& parts() { return parts_; }
    [[nodiscard]] const ReceiverSettings& settings() const { return settings_; }
    [[nodiscard]] ReceiverCounters counters() const;
    [[nodiscard]] std::optional<GpsTime> report_time() const { return report_time_; }
    [[nodiscard]] std::optional<GpsTime> next_change() const;

private:
    // Input.
    bool receive(PortUnit& unit, const StreamPiece& piece, GpsTime now);
    void remember_for_late_sentences(NavigationState& state);
    [[nodiscard]] bool accepts(PortId port, StreamKind kind) const;
    void report_corrections(const CorrectionAnswer& answer, GpsTime now);
    void carry_out(PortUnit& unit, CommandOutcome outcome, GpsTime now);
    void reply(PortUnit& unit, CommandOutcome& outcome, GpsTime now);
    [[nodiscard]] bool stays_silent_to(UbxMessageId message) const;
    [[nodiscard]] GpsTime answer_time(GpsTime now, Seconds work);
    void act_until(GpsTime now, std::vector<Sent>& sent);

    // Settings and restarts.
    void adopt_settings();
    void apply_changes(GpsTime now);
    void reset(const Reset& how, GpsTime now);
    void set_navigating(bool on, GpsTime now);
    void restart_navigation(const Forgotten& forgotten, GpsTime now, Seconds silence);
    /// How it starts anew.
    struct Boot {
        Seconds takes;  ///< until it listens
        bool banner = true;
        bool keeps_ram = false;
        BootCause cause = BootCause::power;
    };
    void boot(const Forgotten& forgotten, GpsTime now, const Boot& how);
    void reboot(const Forgotten& forgotten, GpsTime now, BootCause cause, bool banner = true);
    void send_banner(GpsTime now, bool woken);
    void reset_odometer();

    // Power.
    void plan_sleep(const SleepRequest& request, GpsTime now, GpsTime from);
    void power_off();
    void wake_by_clock(GpsTime now);
    void wake(GpsTime now);
    void follow_power();

    ReceiverParts parts_;
    ReceiverOptions options_;
    StateTracker tracker_;
    PowerSave power_;
    CorrectionInput corrections_;
    PortInput input_;
    PortSpeeds speeds_;
    EpochReporter reporter_;
    SleepControl sleep_;
    ReceiverSettings settings_;  ///< as configured, with what a run of the receiver adds: restarts, rests
    ReceiverCounters counters_;
    std::uint64_t revision_ = 0;                                   ///< of the settings, as adopted
    GpsTime busy_until_{};                                         ///< commands are worked off one by one
    GpsTime deaf_until_{};                                         ///< the receiver boots: input is lost
    GpsTime silent_until_{};                                       ///< no epoch is reported
    std::optional<GpsTime> report_time_;                           ///< of the last epoch; nothing: it is not reported
    GpsTime last_answer_{};                                        ///< planned; later ones do not overtake it
    std::vector<std::shared_ptr<const NavigationState>> earlier_;  ///< NavigationState::earlier of the next one
};

}  // namespace skyloop::firmware
