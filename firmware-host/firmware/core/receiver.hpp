/// The emulated receiver: epochs and bytes in, bytes out. It has no clock, no threads and no operating system.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "base/time/gps_time.hpp"
#include "firmware/core/board_profile.hpp"
#include "firmware/core/firmware_faults.hpp"
#include "firmware/core/navigation_state.hpp"
#include "world/flow/epoch.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop::firmware {

/// What a receiver counts about itself.
struct ReceiverCounters {
    std::uint64_t epochs = 0;
    std::uint64_t messages_sent = 0;
    std::uint64_t messages_dropped = 0;  ///< the transmit buffer was full
    std::uint64_t bytes_received = 0;
};

/// How a receiver begins.
struct ReceiverOptions {
    double rate_hz = 0;           ///< navigation rate from the factory on; 0: the board's own
    ReceiverSettings settings{};  ///< what else its user has set from the factory on
    std::uint64_t seed = 1;       ///< of the jitter of its latency, and of its monitors
    bool power_up = false;        ///< it is switched on at the start; otherwise it has been on for long
    std::size_t number = 0;       ///< among the receivers of the run: what each has of its own, whatever the seed
};

/// First settings that a receiver would refuse itself.
struct RefusedOptions {
    std::optional<std::uint32_t> item;  ///< that is out of range; nothing: its systems do not go together
    std::string reason;
};

/// What a u-blox receiver that begins so would refuse of its own settings: it judges all of them with every change, so
/// that no client could change any. Nothing when it takes them, and of receivers of other makers.
std::optional<RefusedOptions> refused_options(const BoardProfile& board, const ReceiverOptions& options);

struct MakerRow;

/// One receiver with all its ports.
///
/// What a client configures acts as on the real one: on the messages, the speeds, and through settings() on measurement
/// and solution. State: configuration, ports, what it knows of time and place.
class Receiver {
public:
    /// @param options rates are limited to the board's maximum, and stored in whole milliseconds as real receivers do
    explicit Receiver(BoardProfile board, const ReceiverOptions& options = {});
    /// Of another maker than those that boards name.
    Receiver(BoardProfile board, const ReceiverOptions& options, const MakerRow& row);
    ~Receiver();
    Receiver(Receiver&&) noexcept;
    Receiver& operator=(Receiver&&) noexcept;

    /// Begins. To be called once, before input, epochs and output; those before it find the receiver running.
    void start(GpsTime now);
    /// Bytes that reach a port. Times of input(), on_epoch() and output() never go back.
    void input(PortId port, ByteSpan bytes, GpsTime now);
    /// A new solution: its messages are queued and begin to leave one solution latency after `epoch.fix.time`.
    /// @param edit changes what is reported of it, now and to polls until the next; what the receiver itself goes on
    ///        with stays as it is
    void on_epoch(const Epoch& epoch, const ReportEdit& edit = {});
    /// How it is broken from now on; `{}`: not at all.
    void set_faults(const FirmwareFaults& faults);
    /// Something befalls it, at a time as of input().
    void happen(const ReceiverEvent& event, GpsTime now);
    /// Bytes of one port at one speed.
    struct Sent {
        PortId port = PortId::uart1;
        std::uint32_t baud = 0;
        Bytes bytes;
    };
    /// What has left the ports between the last call and `now`, each at its speed.
    std::vector<Sent> output(GpsTime now);
    /// When the last queued byte will have left, or nothing when nothing is queued or planned.
    [[nodiscard]] std::optional<GpsTime> drained_at() const;

    /// When the next message will have left the port, or something is due that may come before it; nothing when nothing
    /// is queued or planned.
    [[nodiscard]] std::optional<GpsTime> next_output(PortId port) const;

    /// When it goes on or off, or sends something, by itself, so that it is looked at then; nothing when it does not.
    [[nodiscard]] std::optional<GpsTime> next_change() const;

    /// Whether the board has the port.
    [[nodiscard]] bool has(PortId port) const;
    /// A port's speed, bit/s; of USB, I2C and SPI that of their bus. 0 for a port that the board does not have.
    [[nodiscard]] std::uint32_t baud(PortId port) const;
    /// What a port has done since the last restart; nothing for one that the board does not have.
    [[nodiscard]] PortStatus port_status(PortId port) const;
    /// What was counted of it over all restarts; nothing for one that the board does not have.
    [[nodiscard]] PortTotals port_totals(PortId port) const;
    [[nodiscard]] const ReceiverSettings& settings() const;
    /// Those that the solution of an epoch is made with: with the corrections that there are by then.
    const ReceiverSettings& settings_at(GpsTime epoch);
    [[nodiscard]] ReceiverCounters counters() const;
    [[nodiscard]] const BoardProfile& board() const;
    /// What it reported last, as edited.
    [[nodiscard]] const NavigationState& state() const;
    /// The same, for who looks at it after the next epoch.
    [[nodiscard]] std::shared_ptr<const NavigationState> kept_state() const;
    /// What its GGA sentence says of it, without the end of the line, whether or not it sends one: where it is, for who
    /// asks on its behalf. Empty while it has no valid position.
    [[nodiscard]] std::string position_sentence() const;
    /// When the messages of the last epoch begin to leave; nothing when none do: it starts, is mute or does not
    /// navigate.
    [[nodiscard]] std::optional<GpsTime> report_time() const;
    /// What outlives the process: battery-backed layer and flash.
    [[nodiscard]] std::string persistent_text() const;
    /// Its user has set these items, by id and raw as on the wire, and saved them: in flash, or where the board has
    /// none in battery-backed memory. To be called before start(). Fails with `usage` for a board of another maker, an
    /// item that the receiver does not have, a value that it would refuse, and values that it would refuse together.
    Result<void> configure(const std::map<std::uint32_t, std::uint64_t>& items);
    /// Takes a persistent_text(). Fails with `input` for a text that is none, an item that the receiver does not have
    /// and, of a u-blox receiver, values that it would refuse alone or together, and flash that it does not have;
    /// @param name for the message
    Result<void> restore(const std::string& text, const std::string& name);
    /// Where it was when it was last on, which a warm or hot start() knows. To be called before that.
    void remember(const Geodetic& position, Metres geoid_undulation);

private:
    class Core;
    std::unique_ptr<Core> core_;
};

}  // namespace skyloop::firmware
