/// One receiver of a run with everything that belongs to it, and the only place that calls the firmware.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "firmware/core/receiver.hpp"
#include "run/emulator/corrections_wire.hpp"
#include "run/emulator/dialogue.hpp"
#include "run/emulator/link.hpp"
#include "run/emulator/moving_base.hpp"
#include "run/emulator/read_recording.hpp"
#include "run/emulator/recorder.hpp"
#include "run/emulator/run_files.hpp"
#include "run/emulator/simulation.hpp"
#include "run/emulator/timing.hpp"
#include "run/fault/active_faults.hpp"
#include "wire/actuator/power_switch.hpp"

namespace skyloop::inline run {

/// The line speed of a receiver's port, bit/s; nothing for a port that has none.
PortSpeed port_speed(const firmware::Receiver& receiver, firmware::PortId port);

/// The speed of the port that a wire is plugged into unless it names one, bit/s; of a board without UARTs the one that
/// its profile names.
std::uint32_t first_baud(const firmware::Receiver& receiver);

/// A wire and the port that it is plugged into.
struct Wire {
    firmware::PortId port = firmware::PortId::uart1;
    Link link;
    /// It brings the port corrections, beside what other wires bring: nothing leaves by it, nobody is to be waited for
    /// at its end, and what it has comes when no client of the port is amid something.
    bool one_way = false;
    CorrectionsWire* corrections = nullptr;  ///< its other end, where that is a caster; lives in `link`
};

/// What a run counted of one receiver.
struct RunCounts {
    std::uint64_t epochs = 0;
    std::uint64_t epochs_with_fix = 0;
    LatenessHistogram lateness;
};

/// A receiver on its antenna's path, with its wires and its recording. The loop tells it when.
///
/// State: when its next epoch is.
class Station {
public:
    struct Parts {
        Simulation simulation;
        firmware::Receiver receiver;
        std::vector<Wire> wires;
        std::optional<Recorder> recorder;
        std::string name = "receiver0";
        std::optional<StateFile> state{};
        std::optional<std::size_t> base{};  ///< the station that carries the base antenna of the pair
        std::optional<MovingBase> moving_base{};
        std::optional<std::size_t> corrections_from{};  ///< the receiver whose bytes this one takes as corrections
        bool overheard = false;                         ///< there is one that takes those of this receiver
        std::uint64_t seed = 1;                         ///< of its own random numbers
        std::vector<HeardBytes> repeated{};             ///< input of an earlier run, to be heard again
        std::set<std::size_t> mute_wires{};             ///< whose clients listen only: what they write is in `repeated`
        std::unique_ptr<PowerSwitch> power{};           ///< of a real device, switched by power_cut; null: none
    };
    explicit Station(Parts parts);

    /// Shows what leaves a port to one more, who may not wait, by a wire of its own that faults hit like the others.
    using Tap = std::function<void(ByteSpan bytes, GpsTime now)>;
    void add_tap(firmware::PortId port, Tap tap);

    /// The receiver starts; before anything else.
    void start(GpsTime now);
    /// Takes from the wires what clients have written, and carries to them all that has left the receiver by now: to be
    /// called before anything happens to it, so that it never matters when it was looked at last.
    /// @param dialogue is shown the messages of the receiver; null: nobody wants them
    void carry_out(const LoopTime& time, Dialogue* dialogue = nullptr);
    /// Lets the receiver hear what its clients have written, carries out what that brings about at once, and follows
    /// faults and what a client has configured.
    /// @param dialogue is shown the messages of both
    void take_in(const LoopTime& time, Dialogue* dialogue = nullptr);
    /// What has come since the last call from the port that others take corrections from.
    [[nodiscard]] Bytes take_overheard() { return overheard_ ? std::exchange(*overheard_, {}) : Bytes(); }
    /// Corrections of another receiver enter the wire by which they come.
    void hear_corrections(Bytes bytes, GpsTime now);
    /// What is true, measured and solved at the epoch that is due.
    Trace observe();
    /// Adds the vector from the base antenna, and the type of fix that it makes.
    /// @param base of the same instant; null: the base has no epoch then, and the type of fix of its last one stays
    void relate(Trace& trace, const Trace* base);
    /// Hands the epoch to receiver and recording.
    /// @param safe flushes the recording, so that a killed run keeps it
    void report(const Trace& trace, Nanoseconds lateness, bool safe);
    /// Looks whether the receiver's memory has changed, at most once a second.
    void keep_state(GpsTime now);
    /// Writes what is left to write.
    void finish(GpsTime now);

    [[nodiscard]] GpsTime next_epoch() const { return grid_.next(); }
    /// When a fault, a held byte, or a receiver that goes on or off by itself, wants to be looked at next.
    /// @param now of the last look
    [[nodiscard]] std::optional<GpsTime> next_change(GpsTime now) const;
    /// When the next message will have left by a wire, or is made.
    [[nodiscard]] std::optional<GpsTime> next_output() const;
    /// When a byte of a client will have arrived, or a client in simulated time acts. @param now of the last look
    [[nodiscard]] std::optional<GpsTime> next_input(GpsTime now) const;
    /// The other end of a wire lives in simulated time: it must not matter how often it is looked at.
    [[nodiscard]] bool has_scripted_client() const;
    /// Lets what is wrong now act on receiver and wires; take_in() does so, too.
    void follow_faults(GpsTime now);
    /// Faults of this receiver.
    [[nodiscard]] ActiveFaults& faults() { return faults_; }
    [[nodiscard]] const ActiveFaults& faults() const { return faults_; }
    /// Something happens to the receiver.
    void happen(const firmware::ReceiverEvent& event, GpsTime now);
    /// From now on the antenna goes this way.
    void lead_along(std::unique_ptr<Trajectory> path);
    /// Moves the vehicle: the path goes on from there.
    void move_to(const Geodetic& place, GpsTime now);
    [[nodiscard]] std::uint64_t seed() const { return parts_.seed; }
    /// Bytes are on their way or a client listens: the wires want to be looked at often.
    [[nodiscard]] bool busy() const;
    [[nodiscard]] std::optional<std::size_t> base() const { return parts_.base; }
    [[nodiscard]] std::optional<std::size_t> corrections_from() const { return parts_.corrections_from; }
    /// Name of the receiver that a fault has in the place of that one.
    [[nodiscard]] const std::optional<std::string>& wrong_corrections_from() const { return wrong_corrections_from_; }
    [[nodiscard]] bool is_overheard() const { return parts_.overheard; }
    [[nodiscard]] const std::string& name() const { return parts_.name; }
    [[nodiscard]] const firmware::Receiver& receiver() const { return parts_.receiver; }
    [[nodiscard]] PortSpeed speed(firmware::PortId port) const { return port_speed(parts_.receiver, port); }
    [[nodiscard]] const std::vector<Wire>& wires() const { return parts_.wires; }
    [[nodiscard]] Transport& transport(std::size_t wire) { return parts_.wires.at(wire).link.transport(); }
    /// Messages on the ports that have a wire; without any wire on the port of an unnamed one.
    [[nodiscard]] std::uint64_t messages_sent() const { return total(&firmware::PortTotals::messages_out); }
    /// Those among them that did not fit into the transmit buffer.
    [[nodiscard]] std::uint64_t messages_dropped() const { return total(&firmware::PortTotals::messages_dropped); }
    [[nodiscard]] const Simulation& simulation() const { return parts_.simulation; }
    [[nodiscard]] const Recorder* recorder() const { return parts_.recorder ? &*parts_.recorder : nullptr; }
    [[nodiscard]] Recorder* recorder() { return parts_.recorder ? &*parts_.recorder : nullptr; }
    /// Of a real device; null: none.
    [[nodiscard]] PowerSwitch* power() { return parts_.power.get(); }
    [[nodiscard]] const PowerSwitch* power() const { return parts_.power.get(); }
    [[nodiscard]] const std::optional<StateFile>& state() const { return parts_.state; }
    [[nodiscard]] const RunCounts& counts() const { return counts_; }

private:
    [[nodiscard]] std::uint64_t total(std::uint64_t firmware::PortTotals::*of) const;
    bool hear(std::size_t wire, GpsTime now, Dialogue* dialogue);
    bool hand_over(std::size_t wire, const Bytes& heard, GpsTime now, Dialogue* dialogue);
    void input(firmware::PortId port, ByteSpan bytes, GpsTime now);
    bool hear_again(GpsTime now, Dialogue* dialogue);
    void speak(const LoopTime& time, Dialogue* dialogue);
    void show(const std::vector<firmware::Receiver::Sent>& pieces, GpsTime now);
    void send_on_wire(std::size_t wire, const std::vector<firmware::Receiver::Sent>& pieces, bool at_rest);
    [[nodiscard]] firmware::PortId port_of(std::size_t wire) const;
    [[nodiscard]] PortSpeed line_speed(std::size_t wire) const;
    [[nodiscard]] bool has_to_wait(std::size_t wire) const;
    void tell_position();
    void follow_faults_of_corrections(WireConditions conditions, GpsTime now);
    void follow_settings(GpsTime now);

    struct Listener {
        firmware::PortId port;
        FaultyWire wire;
        Tap tap;
    };

    Parts parts_;
    std::vector<Listener> listeners_;
    ActiveFaults faults_;
    bool faults_act_ = false;               // on receiver or wires, at the last look
    std::vector<FaultyWire> faulty_wires_;  // one more than none: what has no wire is recorded as if it had
    FaultyWire corrections_wire_;           // from another receiver of the run
    std::optional<std::string> wrong_corrections_from_;
    std::size_t heard_again_ = 0;  // of parts_.repeated
    EpochGrid grid_;
    std::shared_ptr<Bytes> overheard_;  // null: nobody wants it
    RunCounts counts_;
};

}  // namespace skyloop::inline run
