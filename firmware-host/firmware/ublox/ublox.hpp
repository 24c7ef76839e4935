/// u-blox's receivers: UBX, PUBX, RTCM 3 in and out, configuration items.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "firmware/core/maker.hpp"
#include "firmware/ublox/config/config_handler.hpp"

namespace skyloop::firmware {

/// State: the configuration in its layers, an open transaction, what each port has sent by its time pulses.
class UbloxMaker : public Maker {
public:
    UbloxMaker(const BoardProfile& board, const ReceiverOptions& options);

    [[nodiscard]] const ReceiverConfig& config() const override;
    [[nodiscard]] std::uint64_t revision() const override { return store_.revision(); }
    CommandOutcome receive(const StreamPiece& piece, const Situation& asked) override;
    [[nodiscard]] std::optional<std::vector<PortMessage>> correction_reports(
        const CorrectionAnswer& answer, const FirmwareFaults& faults) const override;
    DueMessages due(PortId port, EpochMessages& made, const FirmwareFaults& faults) override;
    [[nodiscard]] std::string_view navigation_text(bool on) const override;
    void restart(bool keeps_ram) override;
    void navigation_restarts(const Forgotten& forgotten) override;
    void lose_battery() override { store_.clear(in_battery); }
    void forget_settings() override;
    void set_speed(std::uint32_t baud) override { store_.set(in_ram, key::uart1_baudrate, baud); }
    [[nodiscard]] bool takes_speed(std::uint32_t baud) const override;
    Result<void> configure(const std::map<std::uint32_t, std::uint64_t>& items) override;
    [[nodiscard]] std::string stored_text() const override { return store_.persistent_text(); }
    Result<void> restore(const std::string& text, const std::string& name) override;

private:
    CommandOutcome receive_frame(const UbxFrameView& frame, const Situation& asked);
    CommandOutcome receive_sentence(ByteSpan line, const Situation& asked);
    CommandOutcome configure(const UbxFrameView& frame, const Situation& asked);
    [[nodiscard]] ConfigOutcome configured(const UbxFrameView& frame, const Situation& asked);
    CommandOutcome reset(const UbxFrameView& frame);
    CommandOutcome command(const UbxFrameView& frame, const Situation& asked);
    CommandOutcome assist(const UbxFrameView& frame, const Situation& asked);
    Result<void> keep(ConfigStore after, ErrorCode code, const std::string& prefix);
    /// The periodic messages that the configuration lets out of a port.
    struct Periodic {
        UbxMessageId id;
        std::uint64_t every = 1;  ///< epochs
    };
    [[nodiscard]] const std::vector<Periodic>& periodic_messages(PortId port);
    [[nodiscard]] bool is_due(const Periodic& message, PortId port, const EpochMessages& made);

    ReceiverSettings base_;  ///< of the run, where items are as the factory left them
    ConfigStore store_;
    ValueConfig values_;
    LegacyConfig legacy_;
    bool knows_time_by_assistance_ = false;  ///< and has not forgotten it since
    std::map<PortId, std::int64_t> sent_pulses_;
    std::map<PortId, std::vector<Periodic>> periodic_;
    std::optional<std::uint64_t> periodic_revision_;
    mutable ReceiverConfig config_;
    mutable std::optional<std::uint64_t> config_revision_;
};

std::unique_ptr<Maker> make_ublox(const BoardProfile& board, const ReceiverOptions& options);
std::optional<RefusedOptions> ublox_refuses(const BoardProfile& board, const ReceiverOptions& options);
Abilities ublox_abilities(const BoardProfile& board);

/// The id of a client's sentence, for PUBX and the standard polls; 00-00 of others.
UbxMessageId sentence_id(const SentenceView& sentence);

/// What a sentence does: PUBX 00, 03, 04, 40, 41, and the standard polls (u-blox M8 interface description, PUBX).
struct SentenceOutcome {
    std::vector<UbxMessageId> polled;  ///< messages to be sent once
    bool unknown = false;              ///< a maker's sentence that it does not know
};
SentenceOutcome execute_ublox(const SentenceView& sentence, const BoardProfile& board, ConfigStore& store);

/// UBX-RXM-PMREQ: nothing for a request that puts the receiver not off, or is none.
std::optional<SleepRequest> requested_backup(const UbxFrameView& frame, PortId from, const PowerAbility& ability);
/// UBX-CFG-PWR.
CommandOutcome change_power_state(const UbxFrameView& frame);
/// UBX-UPD-SOS.
CommandOutcome save_on_shutdown(const UbxFrameView& frame);
Bytes acknowledgement(UbxMessageId of, bool positive);

}  // namespace skyloop::firmware
