/// Quectel's receivers for RTK: LG290P and the LC29H series. Sentences, PQTM commands, RTCM 3; the LC29H, which has a
/// chip of Airoha's, understands PAIR, too.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/core/maker.hpp"
#include "firmware/quectel/settings.hpp"
#include "firmware/sentences/sentence_maker.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop::firmware {

/// Works off PQTM and PAIR commands. State: settings; those that wait for a restart; topics that are kept alone.
class QuectelMaker : public SentenceMaker {
public:
    QuectelMaker(const BoardProfile& board, const ReceiverOptions& options);

    CommandOutcome receive(const StreamPiece& piece, const Situation& asked) override;
    void restrict(NavigationState& state) const override { tell_given_place(state); }
    DueMessages due(PortId port, EpochMessages& made, const FirmwareFaults& faults) override;
    void restart(bool keeps_ram) override;
    void forget_settings() override;

protected:
    void adjust(ReceiverConfig& config) const override;

private:
    /// A command while it is worked off.
    struct Command {
        const SentenceView& sentence;
        const Situation& asked;
        CommandOutcome& outcome;

        [[nodiscard]] std::string_view field(std::size_t i) const { return sentence.field(i); }
        [[nodiscard]] bool reads() const { return field(0) == "R"; }
        [[nodiscard]] bool writes() const { return field(0) == "W"; }
    };
    /// What is said of a command, as PQTM numbers it.
    enum class Verdict { ok = 0, wrong_parameter = 1, failed = 2, unsupported = 3, said_already = 4 };
    using Execute = Verdict (QuectelMaker::*)(const Command& command);
    struct Row {
        std::string_view name;
        Execute execute;
    };
    static const Row rows[];

    void execute(const Command& command);
    void answer(const Command& command, const std::string& fields) const;
    Verdict version(const Command& command);
    Verdict port_speed(const Command& command);
    Verdict fix_rate(const Command& command);
    Verdict message_rate(const Command& command);
    Verdict set_message_rate(const Command& command, std::size_t name_at, PortId port);
    Verdict systems(const Command& command);
    Verdict mode(const Command& command);
    Verdict survey(const Command& command);
    Verdict elevation(const Command& command);
    Verdict topic(const Command& command);
    Verdict save(const Command& command);
    Verdict restore_all(const Command& command);
    Verdict restart_all(const Command& command);
    Verdict start_navigation(const Command& command);
    Verdict stop_navigation(const Command& command);
    bool correction_output(const SentenceView& sentence, CommandOutcome& outcome);

    /// What will be in force after SAVEPAR and a restart.
    [[nodiscard]] std::uint64_t coming(std::uint32_t key) const;
    void set_coming(std::uint32_t key, std::uint64_t value) { coming_[key] = value; }
    [[nodiscard]] bool has_pair() const { return board().identity.hardware.starts_with("LC29H"); }
    [[nodiscard]] bool is_base() const { return settings().value(QuectelKeys::mode) == quectel_base; }

    std::map<std::uint32_t, std::uint64_t> coming_;
    std::map<std::string, std::string, std::less<>> topics_;
};

std::unique_ptr<Maker> make_quectel(const BoardProfile& board, const ReceiverOptions& options);
Abilities quectel_abilities(const BoardProfile& board);

}  // namespace skyloop::firmware
