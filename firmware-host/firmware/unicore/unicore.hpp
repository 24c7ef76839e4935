/// Unicore's N4 receivers (UM980, UM982): text commands, logs as text and bytes, sentences, RTCM 3.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/core/random.hpp"
#include "firmware/core/command_line_reader.hpp"
#include "firmware/core/maker.hpp"
#include "firmware/unicore/settings.hpp"

namespace skyloop::firmware {

/// Executes commands, and sends what they ask for. State: the settings in force and the saved ones.
class UnicoreMaker : public Maker {
public:
    UnicoreMaker(const BoardProfile& board, const ReceiverOptions& options);

    [[nodiscard]] const ReceiverConfig& config() const override { return config_; }
    [[nodiscard]] std::uint64_t revision() const override { return revision_; }
    std::vector<StreamPiece> cut(PortUnit& unit, ByteSpan bytes, GpsTime) override;
    [[nodiscard]] bool has_frames() const override { return false; }
    CommandOutcome receive(const StreamPiece& piece, const Situation& asked) override;
    void restrict(NavigationState& state) const override;
    void follow(const NavigationState& state, GpsTime) override;
    DueMessages due(PortId port, EpochMessages& made, const FirmwareFaults& faults) override;
    [[nodiscard]] std::vector<Bytes> greeting(PortId port) const override;
    void restart(bool keeps_ram) override;
    void lose_battery() override {}
    void forget_settings() override;
    void set_speed(std::uint32_t baud) override;
    [[nodiscard]] bool takes_speed(std::uint32_t baud) const override { return takes_baud(board(), baud); }
    [[nodiscard]] std::string stored_text() const override { return saved_.text(factory_); }
    Result<void> restore(const std::string& text, const std::string& name) override;

private:
    /// A command while it is worked off.
    struct Command {
        std::string line;                ///< as typed, without the dollar and the checksum
        std::vector<std::string> words;  ///< in capitals
        const Situation& asked;
        CommandOutcome& outcome;
    };
    using Execute = bool (UnicoreMaker::*)(const Command& command);
    struct Row {
        std::string_view name;
        Execute execute;
    };
    static const Row rows[];

    void execute(const std::string& line, const Situation& asked, CommandOutcome& outcome);
    bool carry_out(const Command& command);
    /// Settings alone, of a text that was saved.
    bool take_setting(const std::vector<std::string>& words, PortId port);
    bool mode(const Command& command);
    bool configure_topic(const Command& command);
    bool mask(const Command& command);
    bool unmask(const Command& command);
    bool log(const Command& command);
    bool named_log(const Command& command);
    bool remove_log(const Command& command);
    bool remove_all_logs(const Command& command);
    bool list_logs(const Command& command);
    bool save(const Command& command);
    bool forget_all(const Command& command);
    bool reset(const Command& command);

    bool set_mode(std::span<const std::string> words);
    bool set_port(PortId port, std::span<const std::string> words);
    bool set_mask(std::span<const std::string> words);
    /// @param words a name, perhaps a port, a period in seconds
    bool set_log(std::span<const std::string> words, PortId port);
    bool send_once(const Command& command, std::string_view name);
    [[nodiscard]] std::optional<std::uint64_t> period_of(std::string_view seconds) const;
    void adopt();
    void adopt_systems();

    ReceiverConfig start_, config_;
    UnicoreSettings factory_, saved_, now_;
    std::map<PortId, CommandLineReader> lines_;
    std::map<PortId, GpsTime> quiet_until_;  // ports whose speed has just been changed
    RandomStream pauses_;
    std::uint64_t revision_ = 1;
    bool has_started_ = true;  ///< so long ago that it answers VERSIONB in full
};

std::unique_ptr<Maker> make_unicore(const BoardProfile& board, const ReceiverOptions& options);
Abilities unicore_abilities(const BoardProfile& board);

}  // namespace skyloop::firmware
