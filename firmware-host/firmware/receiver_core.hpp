/// The receiver's parts in a row.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/config/config_handler.hpp"
#include "firmware/correction_input.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/nmea_commands.hpp"
#include "firmware/port_unit.hpp"
#include "firmware/receiver.hpp"
#include "firmware/state_tracker.hpp"
#include "skyloop/base/random.hpp"

namespace skyloop::firmware {

/// What Receiver documents. It does not move: its parts refer to each other.
class Receiver::Core {
public:
    Core(BoardProfile board, const ReceiverOptions& options);
    Core(const Core&) = delete;
    Core& operator=(const Core&) = delete;

    void start(GpsTime now);
    void input(PortId port, ByteSpan bytes, GpsTime now);
    void on_epoch(const Epoch& epoch);
    std::vector<Sent> output(GpsTime now);
    [[nodiscard]] const PortUnit* unit(PortId port) const { return find_unit(units_, port); }
    Result<void> restore(const std::string& text, const std::string& name);

    [[nodiscard]] const Outbox& outbox() const { return outbox_; }
    [[nodiscard]] const ConfigStore& store() const { return store_; }
    [[nodiscard]] const BoardProfile& board() const { return board_; }
    [[nodiscard]] const ReceiverSettings& settings() const { return settings_; }
    [[nodiscard]] const ReceiverCounters& counters() const { return counters_; }
    [[nodiscard]] const NavigationState& state() const { return tracker_.state(); }

private:
    // What a client's message has led to, on its way out.
    struct Reply {
        std::vector<Bytes> answers;
        std::optional<Bytes> verdict;  ///< ACK or NAK
        Seconds work{0};
    };

    // Input.
    void give_up_unfinished(PortUnit& unit, GpsTime now);
    void work_off(PortUnit& unit, const std::vector<StreamPiece>& pieces, GpsTime now);
    void dispatch(PortUnit& unit, const StreamPiece& piece, GpsTime now);
    void dispatch_ubx(PortUnit& unit, ByteSpan frame, GpsTime now);
    void dispatch_sentence(PortUnit& unit, ByteSpan line, GpsTime now);
    void dispatch_corrections(ByteSpan frame, GpsTime now);
    [[nodiscard]] bool accepts(const PortUnit& unit, StreamKind kind) const;
    void configure(PortUnit& unit, const UbxFrameView& frame, GpsTime now);
    [[nodiscard]] ConfigOutcome configured(const UbxFrameView& frame, PortId from);
    void command(PortUnit& unit, const UbxFrameView& frame, GpsTime now);
    void assist(PortUnit& unit, const UbxFrameView& frame, GpsTime now);

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
    void send_text(int level, const std::string& text, GpsTime now);
    void send_epoch(const NavigationState& state, GpsTime now);
    [[nodiscard]] std::vector<Bytes> due_messages(PortId port, const NavigationState& state, EpochMessages& made) const;
    [[nodiscard]] bool lets_out(PortId port, UbxMessageId message) const;
    [[nodiscard]] GpsTime burst_time(GpsTime epoch);
    void tell_antenna_status(const NavigationState& state, GpsTime now);

    // Settings and restarts.
    void adopt_settings();
    void apply_changes(GpsTime now);
    void reset(std::uint16_t nav_bbr_mask, std::uint8_t mode, GpsTime now);
    void reboot(const Forgotten& forgotten, GpsTime now);
    void restart_navigation(const Forgotten& forgotten, GpsTime now, Seconds silence);
    void send_banner(GpsTime now);
    void look_at_ports();

    BoardProfile board_;
    ReceiverOptions options_;
    ConfigStore store_;
    ValueConfig values_;
    LegacyConfig legacy_;
    StateTracker tracker_;
    CorrectionInput corrections_;
    std::vector<PortUnit> units_;
    std::vector<PortStatus> statuses_;
    Outbox outbox_;
    ReceiverSettings settings_;
    ReceiverCounters counters_;
    RandomStream latency_noise_;
    std::uint64_t revision_ = 0;  ///< of the store, as adopted
    GpsTime busy_until_{};        ///< commands are worked off one by one
    GpsTime deaf_until_{};        ///< the receiver boots: input is lost
    GpsTime silent_until_{};      ///< no epoch is reported
    GpsTime last_burst_{};
    std::optional<AntennaStatus> told_antenna_;
};

/// What the store says to measurement and solution. Items that are as the factory left them leave `base` as it is.
ReceiverSettings settings_of(const ConfigStore& store, const BoardProfile& board, const ReceiverSettings& base);

/// The factory configuration with what a run's options change of it.
ConfigValues initial_config(const BoardProfile& board, const ReceiverOptions& options);

}  // namespace skyloop::firmware
