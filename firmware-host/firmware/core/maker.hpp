/// What receivers of one maker have of their own: how they are set up, what they understand, what they send.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "firmware/core/corrections.hpp"
#include "firmware/core/firmware_faults.hpp"
#include "firmware/core/port.hpp"
#include "firmware/core/receiver.hpp"
#include "firmware/core/receiver_config.hpp"
#include "firmware/core/state_tracker.hpp"
#include "firmware/messages/make_message.hpp"

namespace skyloop::firmware {

/// A start that a client asks for.
struct Reset {
    enum class Kind { navigation, software, hardware, stop_navigation, start_navigation };
    Kind kind = Kind::software;
    Forgotten forgotten{};
};

/// What wakes a receiver, by bits: those of UBX-RXM-PMREQ, and one of our own for USB.
inline constexpr std::uint32_t wake_by_uart_rx = 1u << 3, wake_by_spi_cs = 1u << 7, wake_by_usb = 1u << 31,
                               wake_by_every_pin = wake_by_uart_rx | 1u << 5 | 1u << 6 | wake_by_spi_cs;

/// A time of being off.
struct SleepRequest {
    std::optional<Nanoseconds> length{};  ///< nothing: until it is woken
    std::uint32_t wakes = 0;              ///< by what
};

/// What came of a piece that a client sent. Answers leave in this order, the verdict last.
struct CommandOutcome {
    std::vector<Bytes> answers{};         ///< whole frames, sentences or lines
    std::optional<Bytes> verdict{};       ///< ACK or NAK
    Seconds work{0};                      ///< before it answers, over its usual delay
    std::vector<std::string> warnings{};  ///< texts to all ports, before the answers
    std::optional<Reset> reset{};         ///< after the answers
    std::optional<bool> navigating{};     ///< it goes on tracking and solving, or stops; it answers all the same
    std::optional<SleepRequest> sleep{};  ///< after the answers
    bool resets_odometer = false;
    UbxMessageId to{};  ///< what it answers, as faults name it; 00-00 of what has no id
};

/// What is at hand while a client's piece is worked off.
struct Situation {
    PortId from;  ///< the port it came by
    GpsTime now;
    const FirmwareFaults& faults;
    const TimeKnowledge& time;  ///< of the receiver, whatever faults make of its reports
    ReportContext report;       ///< of its last epoch, by that port
};

/// Messages that leave a port with an epoch. `frames` are views into `own` and into the epoch's EpochMessages.
struct DueMessages {
    std::vector<ByteSpan> frames{};
    std::vector<Bytes> own{};
    void add(std::vector<Bytes> messages);  ///< of this one's own
};

/// A message to one port.
struct PortMessage {
    PortId port;
    Bytes bytes;
};

/// The maker's own part of a receiver; Receiver::Core has what all of them do.
///
/// State: the settings in force, and what the receiver's memories hold of them.
class Maker {
public:
    /// @param board it must outlive this
    explicit Maker(const BoardProfile& board) : board_(board) {}
    virtual ~Maker() = default;
    Maker(const Maker&) = delete;
    Maker& operator=(const Maker&) = delete;

    /// What the receiver does by the settings in force.
    [[nodiscard]] virtual const ReceiverConfig& config() const = 0;
    /// Grows with every change of config().
    [[nodiscard]] virtual std::uint64_t revision() const = 0;

    /// What its receivers' ports find in what they receive, beside UBX, sentences and RTCM 3.
    [[nodiscard]] virtual StreamProtocols hears() const { return {}; }
    /// Cuts what a port receives into whole pieces, command lines among them.
    virtual std::vector<StreamPiece> cut(PortUnit& unit, ByteSpan bytes, GpsTime now);
    /// Whether a port's frames may stand inside others that were never finished: not on a command line.
    [[nodiscard]] virtual bool has_frames() const { return true; }
    /// Works off a piece that the port's protocols let in, but corrections.
    virtual CommandOutcome receive(const StreamPiece& piece, const Situation& asked) = 0;
    /// Reports of a frame of corrections, where this maker's receivers report them.
    [[nodiscard]] virtual std::optional<std::vector<PortMessage>> correction_reports(
        const CorrectionAnswer& answer, const FirmwareFaults& faults) const;

    /// What of the corrections at hand the settings allow.
    [[nodiscard]] virtual CorrectionState allowed(CorrectionState at_hand) const { return at_hand; }
    /// Takes from an epoch what the settings do not want reported.
    virtual void restrict(NavigationState& state) const;
    /// Takes an epoch in before its messages are made. @param now when they begin to leave
    virtual void follow(const NavigationState& state, GpsTime now);
    /// What is due on a port at the epoch of `made`.
    virtual DueMessages due(PortId port, EpochMessages& made, const FirmwareFaults& faults) = 0;
    /// The receiver listens from then on: it has started, or has been on for long.
    virtual void begin(GpsTime awake);
    /// When it sends something by itself, without an epoch and without being asked; nothing: never.
    [[nodiscard]] virtual std::optional<GpsTime> acts_at() const { return std::nullopt; }
    /// What that is; acts_at() is later than `now` after it.
    virtual std::vector<PortMessage> act(GpsTime now, const FirmwareFaults& faults);
    /// What its receivers say when navigation starts or stops; empty: nothing.
    [[nodiscard]] virtual std::string_view navigation_text(bool on) const;

    /// What a port says at a start, after the banner.
    [[nodiscard]] virtual std::vector<Bytes> greeting(PortId port) const;

    /// The receiver starts: the settings in force become the stored ones. @param keeps_ram it was off, with its RAM on
    virtual void restart(bool keeps_ram) = 0;
    virtual void navigation_restarts(const Forgotten& forgotten);
    /// The battery-backed memory was without supply.
    virtual void lose_battery() = 0;
    /// All settings, stored ones too, are as at the factory.
    virtual void forget_settings() = 0;
    /// Sets the speed of UART1, which is one of takes_speed().
    virtual void set_speed(std::uint32_t baud) = 0;
    [[nodiscard]] virtual bool takes_speed(std::uint32_t baud) const = 0;

    /// Receiver::configure(), Receiver::persistent_text() and Receiver::restore(). What is stored is in force then.
    virtual Result<void> configure(const std::map<std::uint32_t, std::uint64_t>& items);
    [[nodiscard]] virtual std::string stored_text() const = 0;
    virtual Result<void> restore(const std::string& text, const std::string& name) = 0;

protected:
    [[nodiscard]] const BoardProfile& board() const { return board_; }

private:
    const BoardProfile& board_;
};

/// What a receiver can do as its board is built, whatever a client may configure: what checks, faults and expectations
/// ask.
struct Abilities {
    /// What decides which messages an epoch has: the factory, a rate for each that is listed, or a command line.
    enum class MessageChoice { factory, rates, command_line };
    MessageChoice choice = MessageChoice::factory;
    bool ubx = false;  ///< takes the configuration and the polls of u-blox

    // Reports that are no sentences.
    bool version = false;           ///< MON-VER
    bool hardware_monitor = false;  ///< MON-HW, MON-RF
    bool jamming = false, spoofing = false, heading = false, accuracies = false, weeks = false;
    bool time = false, calendar = false;
    bool dead_reckoning = true;  ///< it has a word for it

    bool corrections = false;  ///< takes RTCM
    bool time_mode = false;    ///< can solve for time alone
    /// That it can be set to track; nothing: no document says.
    std::optional<std::vector<Constellation>> constellations{};
    std::optional<bool> second_band{};  ///< the same

    std::vector<UbxMessageId> answers{};   ///< what it sends when it is asked
    std::vector<std::string_view> more{};  ///< what else it sends, as dialogues call it
    std::string_view own_prefix{};         ///< of answers of which there are more than are listed anywhere

    [[nodiscard]] bool takes_commands() const { return choice != MessageChoice::factory; }
};

/// A kind of receiver: what it is called, how it is made, and what it can do.
struct MakerRow {
    std::string_view name;
    /// @param board it must outlive what is made
    std::unique_ptr<Maker> (*make)(const BoardProfile& board, const ReceiverOptions& options);
    Abilities (*abilities)(const BoardProfile& board);
    /// refused_options(); null: it takes all.
    std::optional<RefusedOptions> (*refuses)(const BoardProfile& board, const ReceiverOptions& options) = nullptr;
};

}  // namespace skyloop::firmware
