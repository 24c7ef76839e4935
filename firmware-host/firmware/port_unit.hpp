/// One port of a receiver with everything that belongs to it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "firmware/board_profile.hpp"
#include "firmware/config/config_store.hpp"
#include "firmware/navigation_state.hpp"
#include "firmware/port.hpp"
#include "firmware/receiver.hpp"
#include "firmware/septentrio/command_line_reader.hpp"
#include "receiver/protocol/patient_splitter.hpp"

namespace skyloop::firmware {

/// The periodic messages that the configuration lets out of a port.
struct ConfiguredMessages {
    struct Message {
        UbxMessageId id;
        std::uint64_t every = 1;  ///< epochs
    };
    std::vector<Message> messages;
    std::optional<std::uint64_t> revision;  ///< of the configuration that was read; nothing: none yet
};

/// Both directions of one port, and what is counted of them.
struct PortUnit {
    PortUnit(PortId port, std::uint32_t baud, const BoardProfile& board)
        : id(port), transmit(baud, board.transmit_buffer_bytes, board.generated_ahead_bytes), configured_baud(baud) {
        status.id = port;
    }
    /// What came of something that is not yet whole.
    void forget_input() { splitter = {}; }
    PortId id;
    Port transmit;
    PatientSplitter splitter{};  ///< finds what clients send: UBX, sentences and RTCM 3
    CommandLineReader command_line{};
    PortStatus status;
    PortTotals totals{};
    GpsTime last_input{};
    std::uint32_t configured_baud = 0;  ///< to which it has been told to go
    ConfiguredMessages configured;
    std::optional<std::int64_t> told_pulse{};  ///< of the last TIM-TP
    bool overflowed = false;                   ///< messages were dropped since the last epoch was reported
};

/// The one of that name, or null.
/// @param units a vector of PortUnit, constant or not
template <class Units>
auto find_unit(Units& units, PortId port) -> decltype(units.data()) {
    for (auto& unit : units)
        if (unit.id == port) return &unit;
    return nullptr;
}

/// The speed of a port by the configuration; of USB, I2C and SPI that of their bus (USB full speed; I2C fast mode).
/// Commands cannot ask for one that no UART has, stored text may: the nearest that one has.
std::uint32_t configured_baud(const ConfigStore& store, PortId port);

/// What leaves the receiver, and what is going to happen to its ports, in the order of time.
///
/// State: the plan and the ports' queues.
class Outbox {
public:
    using Action = std::function<void(GpsTime)>;

    explicit Outbox(std::vector<PortUnit>& units) : units_(units) {}

    /// Something that happens at `at`, or now when that has passed; at the same instant in the order of planning.
    void plan(GpsTime at, Action action);
    /// Queues whole messages on a port: Port::queue() or Port::queue_in_turn().
    void queue(PortId port, std::span<const ByteSpan> messages, GpsTime now);
    void queue_in_turn(PortId port, std::span<const ByteSpan> messages, GpsTime now);
    /// Drops the messages of an earlier epoch that a port has not generated yet.
    void give_up_turns(PortUnit& unit, GpsTime now);
    /// Does what is planned until `now`, and gives what has left.
    std::vector<Receiver::Sent> run(GpsTime now);
    [[nodiscard]] std::optional<GpsTime> drained_at() const;
    /// When the port's next message will have left, or a plan is due that may come before it.
    [[nodiscard]] std::optional<GpsTime> next_at(PortId port) const;
    /// Forgets plans and queues, as when the power goes.
    void clear();

private:
    static void count(PortUnit& unit, bool queued);
    void collect(GpsTime now, std::vector<Receiver::Sent>& sent);

    std::vector<PortUnit>& units_;
    std::multimap<GpsTime, Action> plans_;
};

}  // namespace skyloop::firmware
