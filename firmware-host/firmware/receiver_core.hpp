/// The receiver's parts in a row.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/core/random.hpp"
#include "firmware/config/config_handler.hpp"
#include "firmware/corrections_and_assistance.hpp"
#include "firmware/firmware_faults.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/messages/other_protocols.hpp"
#include "firmware/nmea_commands.hpp"
#include "firmware/port.hpp"
#include "firmware/power_save.hpp"
#include "firmware/receiver.hpp"
#include "firmware/septentrio/console.hpp"
#include "firmware/state_tracker.hpp"

namespace skyloop::firmware {

/// What Receiver documents. It does not move: its parts refer to each other.
class Receiver::Core {
public:
    Core(BoardProfile board, const ReceiverOptions& options);
    Core(const Core&) = delete;
    Core& operator=(const Core&) = delete;

    void start(GpsTime now);
    void input(PortId port, ByteSpan bytes, GpsTime now);
    void on_epoch(const Epoch& epoch, const ReportEdit& edit);
    const ReceiverSettings& settings_at(GpsTime epoch);
    void set_faults(const FirmwareFaults& faults) { faults_ = faults; }
    void happen(const ReceiverEvent& event, GpsTime now);
    std::vector<Sent> output(GpsTime now);
    [[nodiscard]] const PortUnit* unit(PortId port) const { return find_unit(units_, port); }
    Result<void> configure(const std::map<std::uint32_t, std::uint64_t>& items);
    Result<void> restore(const std::string& text, const std::string& name);
    void remember(const Geodetic& position, Metres undulation) { tracker_.remember(position, undulation); }

    [[nodiscard]] const Outbox& outbox() const { return outbox_; }
    [[nodiscard]] const ConfigStore& store() const { return store_; }
    [[nodiscard]] const BoardProfile& board() const { return board_; }
    [[nodiscard]] const ReceiverSettings& settings() const { return settings_; }
    [[nodiscard]] ReceiverCounters counters() const;
    [[nodiscard]] const NavigationState& state() const { return *reported_; }
    [[nodiscard]] std::shared_ptr<const NavigationState> kept_state() const { return reported_; }
    [[nodiscard]] std::optional<GpsTime> report_time() const { return report_time_; }
    [[nodiscard]] std::optional<GpsTime> next_change() const;

private:
    // What a client's message has led to, on its way out.
    struct Reply {
        std::vector<Bytes> answers;
        std::optional<Bytes> verdict;  ///< ACK or NAK
        Seconds work{0};
        UbxMessageId to{};  ///< the client's message; of a sentence without an id 00-00
    };

    // Input.
    void give_up_unfinished(PortUnit& unit, GpsTime now);
    void plan_to_give_way(const PortUnit& unit);
    void give_way(PortUnit& unit, GpsTime now);
    void work_off(PortUnit& unit, const std::vector<StreamPiece>& pieces, GpsTime now);
    void dispatch(PortUnit& unit, const StreamPiece& piece, GpsTime now);
    void dispatch_ubx(PortUnit& unit, ByteSpan frame, GpsTime now);
    void dispatch_sentence(PortUnit& unit, ByteSpan line, GpsTime now);
    void carry_out(PortUnit& unit, CommandOutcome outcome, UbxMessageId id, GpsTime now);
    void read_command_lines(PortUnit& unit, ByteSpan bytes, GpsTime now);
    void answer_corrections(const CorrectionAnswer& answer, GpsTime now);
    [[nodiscard]] bool accepts(const PortUnit& unit, StreamKind kind) const;
    void configure(PortUnit& unit, const UbxFrameView& frame, GpsTime now);
    [[nodiscard]] ConfigOutcome configured(const UbxFrameView& frame, PortId from);
    void command(PortUnit& unit, const UbxFrameView& frame, GpsTime now);
    void assist(PortUnit& unit, const UbxFrameView& frame, GpsTime now);
    void save_on_shutdown(PortUnit& unit, const UbxFrameView& frame, GpsTime now);
    void reset_odometer();

    // Power.
    // A time of being off, planned or under way.
    struct Sleep {
        std::optional<GpsTime> until;  ///< nothing: until it is woken
        std::uint32_t wakes = 0;       ///< what does, by bits
        bool saves_power = false;      ///< by itself; otherwise a client has asked for it
        GpsTime since{};               ///< once under way
    };
    void request_backup(PortUnit& unit, const UbxFrameView& frame, GpsTime now);
    void change_power_state(PortUnit& unit, const UbxFrameView& frame, GpsTime now);
    void rest(const PowerSave::Rest& rest, GpsTime from);
    void stand_by(GpsTime from);
    void fall_asleep(const Sleep& sleep, GpsTime from);
    void plan_lying_down(GpsTime at);
    void lie_down(GpsTime now);
    void tell_being_off();
    [[nodiscard]] bool wakes_by(GpsTime now) const;
    void look_at_clock(GpsTime now);
    void feel(PortId port, GpsTime now);
    void wake(GpsTime now);
    void follow_power();

    // Faults.
    [[nodiscard]] bool refuses_items(const UbxFrameView& frame) const;
    [[nodiscard]] bool stays_silent_to(UbxMessageId message) const;
    [[nodiscard]] std::vector<Bytes> answers_of(UbxMessageId polled, PortId port);
    void report(const NavigationState& state);
    void forget_configuration(GpsTime now);
    void force_baud(const ForceBaud& wanted, GpsTime now);
    void change_speeds_at_once(GpsTime now);
    [[nodiscard]] bool holds_forced_speed() const;
    [[nodiscard]] std::uint32_t wanted_baud(PortId port) const;

    // Output.
    // What messages of now are made from.
    ReportContext context(PortId port);
    [[nodiscard]] ReportContext context(PortId port, const NavigationState& state) const;
    [[nodiscard]] GpsTime answer_time(GpsTime now, Seconds work);
    void reply(PortUnit& unit, Reply reply, GpsTime now);
    [[nodiscard]] bool configured_speeds_hold() const;
    void plan_speed_changes(GpsTime at);
    void change_speed(PortId port, GpsTime at);
    void send(PortId port, const std::vector<Bytes>& messages, GpsTime now);
    void send_in_turn(PortId port, std::span<const ByteSpan> messages, GpsTime now);
    void send_text(int level, const std::string& text, GpsTime now);
    void send_epoch(const NavigationState& state, GpsTime now);
    void read_configured_messages(PortUnit& unit) const;
    [[nodiscard]] bool is_due(PortUnit& unit, UbxMessageId message, std::uint64_t every,
                              const NavigationState& state) const;
    [[nodiscard]] std::vector<ByteSpan> due_messages(PortUnit& unit, const NavigationState& state,
                                                     EpochMessages& made) const;
    [[nodiscard]] bool lets_out(PortId port, UbxMessageId message) const;
    [[nodiscard]] GpsTime burst_time(GpsTime epoch);
    void tell_overflow(PortUnit& unit, GpsTime now);
    void tell_antenna_status(const NavigationState& state, GpsTime now);

    // Settings and restarts.
    void begin_as_stored();
    void adopt_settings();
    [[nodiscard]] CorrectionState allowed(CorrectionState at_hand) const;
    void apply_changes(GpsTime now);
    void reset(std::uint16_t nav_bbr_mask, std::uint8_t mode, GpsTime now);
    void switch_navigating(bool on, GpsTime now);
    void stop_navigating(GpsTime now);
    void start_navigating(GpsTime now);
    void tell_of_navigating(const char* text, GpsTime now);
    /// How it starts anew.
    struct Boot {
        Seconds takes;  ///< until it hears
        bool banner = true;
        bool keeps_ram = false;
        BootCause cause = BootCause::power;
    };
    void boot(const Forgotten& forgotten, GpsTime now, const Boot& how);
    void reboot(const Forgotten& forgotten, GpsTime now, BootCause cause, bool banner = true);
    void restart_navigation(const Forgotten& forgotten, GpsTime now, Seconds silence);
    // @param woken it was off, not without power
    void send_banner(GpsTime now, bool woken);
    void look_at_ports();

    BoardProfile board_;
    ReceiverOptions options_;
    ConfigStore store_;
    ValueConfig values_;
    LegacyConfig legacy_;
    StateTracker tracker_;
    PowerSave power_;
    std::shared_ptr<const NavigationState> reported_;  ///< of the last epoch, edited; what polls are answered from
    CorrectionInput corrections_;
    std::vector<PortUnit> units_;
    std::vector<PortStatus> statuses_;
    Outbox outbox_;
    ReceiverSettings settings_;
    Nanoseconds configured_period_{0};  ///< of navigation; saving power has its own
    ReceiverCounters counters_;
    RandomStream latency_noise_;
    std::uint64_t revision_ = 0;          ///< of the store, as adopted
    GpsTime busy_until_{};                ///< commands are worked off one by one
    GpsTime deaf_until_{};                ///< the receiver boots: input is lost
    GpsTime silent_until_{};              ///< no epoch is reported
    GpsTime last_burst_{};                ///< since it started; later ones do not overtake it
    std::optional<GpsTime> report_time_;  ///< of the last epoch; nothing: it is not reported
    GpsTime last_answer_{};               ///< planned; later ones do not overtake it
    bool told_time_ = false;              ///< by assistance, and not forgotten since
    std::optional<AntennaStatus> told_antenna_;
    MavlinkSent mavlink_sent_;
    std::optional<Sleep> sleep_;           ///< it is off
    std::optional<Sleep> falling_asleep_;  ///< it will be, when all has left that is to be sent
    GpsTime lies_down_at_{};               ///< when that is looked at next
    FirmwareFaults faults_;
    /// The speed that ForceBaud gave, and the one before.
    struct ForcedSpeed {
        std::uint32_t forced = 0, before = 0;
        bool is_setting = true;  ///< the board can be set to it: else its settings keep the one before
    };
    std::optional<ForcedSpeed> forced_speed_;
    std::optional<SeptentrioConsole> console_;  ///< of a receiver that has a command line
    bool jamming_told_elsewhere_ = false;       ///< MonitorStatus::told_elsewhere
};

/// The id of a client's sentence, for PUBX and the standard polls; 00-00 of others.
UbxMessageId sentence_id(const SentenceView& sentence);

/// What the store says to measurement and solution. Items that are as the factory left them leave `base` as it is.
ReceiverSettings settings_of(const ConfigStore& store, const BoardProfile& board, const ReceiverSettings& base);

/// The factory configuration with what a run's options change of it.
ConfigValues initial_config(const BoardProfile& board, const ReceiverOptions& options);

}  // namespace skyloop::firmware
