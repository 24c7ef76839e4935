#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "base/core/bytes.hpp"
#include "detail/fault_catalogue.hpp"
#include "detail/wire_fault.hpp"
#include "firmware/core/firmware_faults.hpp"

namespace skyloop::inline run {

Fault worsened(const Parameters& parameters, WireWorsening worsen) {
    const std::string direction = parameters.text("direction");
    return fault_of<&Fault::wire>([to_client = direction != "to_receiver", to_receiver = direction != "to_client",
                                   worsen = std::move(worsen)](WireConditions& wire, const FaultMoment& moment) {
        if (moment.strength <= 0) return;
        if (to_client) worsen(wire.to_client, moment);
        if (to_receiver) worsen(wire.to_receiver, moment);
    });
}

namespace {

// What a receiver without commands does not read may be lost.
std::string why_unread(const UsedReceiver& receiver, std::string_view direction) {
    return direction == "to_receiver" && !takes_commands(receiver) ? std::string(command_input.lack) : std::string();
}

constexpr ParameterSpec wire_direction =
    word_parameter("direction", "to_client", wire_directions,
                   "which bytes: those of the receiver to its client, those of the client, or both")
        .judged_by(why_unread);

// Raises one probability of a direction.
template <double WireDirection::*which>
Result<Fault> raise_probability(const Parameters& parameters, const FaultContext&) {
    return worsened(parameters,
                    [p = parameters.number("probability")](WireDirection& direction, const FaultMoment& moment) {
                        combine(direction.*which, p * moment.strength);
                    });
}

Result<Fault> make_garbage(const Parameters& parameters, const FaultContext&) {
    const double rate = parameters.number("bursts_per_s");
    const int bytes = static_cast<int>(parameters.number("burst_bytes"));
    return worsened(parameters, [rate, bytes](WireDirection& direction, const FaultMoment& moment) {
        direction.garbage.push_back({rate * moment.strength, bytes});
    });
}

Result<Fault> make_delay(const Parameters& parameters, const FaultContext&) {
    return worsened(parameters,
                    [delay = parameters.number("delay_s")](WireDirection& direction, const FaultMoment& moment) {
                        direction.delay += Seconds(delay * moment.strength);
                    });
}

// Independent jitters add as their squares do.
Result<Fault> make_jitter(const Parameters& parameters, const FaultContext&) {
    return worsened(parameters,
                    [sigma = parameters.number("sigma_s")](WireDirection& direction, const FaultMoment& moment) {
                        direction.jitter = Seconds(std::hypot(direction.jitter.value(), sigma * moment.strength));
                    });
}

Result<Fault> make_stall(const Parameters& parameters, const FaultContext&) {
    const double hold = parameters.number("hold_s"), every = parameters.number("period_s");
    if (hold >= every)
        return fail(ErrorCode::usage,
                    "stall: hold_s is not shorter than period_s; expected time for the bytes to come through");
    return worsened(parameters, [hold, every](WireDirection& direction, const FaultMoment& moment) {
        if (std::fmod(moment.since_start.value(), every) < hold * moment.strength) direction.stalled = true;
    });
}

Result<Fault> make_saturation(const Parameters& parameters, const FaultContext&) {
    const auto bytes_per_s = parameters.optional_number("bytes_per_s"), baud = parameters.optional_number("baud");
    if (bytes_per_s && baud)
        return fail(ErrorCode::usage, "saturated_uart: bytes_per_s and baud are given; expected one of them");
    const double rate = bytes_per_s.value_or(baud.value_or(9600) / SerialFormat{}.bits_per_byte());
    return worsened(parameters, [rate](WireDirection& direction, const FaultMoment& moment) {
        const double limit = rate / moment.strength;
        direction.bytes_per_s = std::min(direction.bytes_per_s.value_or(limit), limit);
    });
}

Result<Fault> make_dead(const Parameters& parameters, const FaultContext&) {
    return worsened(parameters, [](WireDirection& direction, const FaultMoment&) { direction.dead = true; });
}

template <bool WireConditions::*which>
Result<Fault> whole_wire(const Parameters&, const FaultContext&) {
    return fault_of<&Fault::wire>([](WireConditions& wire, const FaultMoment& moment) {
        if (moment.strength > 0) wire.*which = true;
    });
}

Result<Fault> make_power_cut(const Parameters& parameters, const FaultContext&) {
    Fault fault;
    fault.wire = [](WireConditions& wire, const FaultMoment& moment) {
        if (moment.strength > 0) wire.to_client.dead = wire.to_receiver.dead = wire.power_cut = true;
    };
    fault.firmware = [](firmware::FirmwareFaults& faults, const FaultMoment& moment) {
        if (moment.strength > 0) faults.deaf = faults.mute = true;
    };
    firmware::Reboot reboot;
    reboot.kind = firmware::start_kind(parameters.text("start")).value_or(StartKind::cold);
    // Whoever has kept clock or ephemerides has a backup supply, and with it the settings kept there.
    reboot.loses_battery = reboot.kind == StartKind::cold;
    fault.at_end.emplace_back(reboot);
    return fault;
}

Result<Fault> make_speed_mismatch(const Parameters& parameters, const FaultContext&) {
    return fault_of<&Fault::wire>([baud = static_cast<std::uint32_t>(parameters.number("baud"))](
                                      WireConditions& wire, const FaultMoment& moment) {
        if (moment.strength > 0) wire.receiver_baud = baud;
    });
}

constexpr ParameterList chance(double standard, std::string_view meaning) {
    return {number_parameter("probability", standard, 0, 1, meaning), wire_direction};
}

constexpr auto gradual_wire_kinds = std::to_array<FaultKind>({
    {"byte_loss", "Single bytes are missing.",
     "A host that serves its UART's interrupt or DMA too late overruns the FIFO and loses bytes.",
     chance(0.01, "of each byte to be lost"), raise_probability<&WireDirection::byte_loss>},
    {"bit_flips", "Single bits arrive inverted.",
     "Motor currents and speed controllers couple noise into long unshielded leads without a good ground.",
     chance(0.001, "of each bit to be inverted"), raise_probability<&WireDirection::bit_errors>},
    {"checksum_errors", "One bit of a message is inverted: the message stands, and its checksum fails.",
     "A baud rate at the edge, a slow level shifter or rare interference spoils single bits.",
     chance(0.1, "of each message to be spoilt"), raise_probability<&WireDirection::checksum_errors>},
    {"truncated_messages", "The end of a message is missing.",
     "A transmit buffer that is full drops the rest of what was to be sent.", chance(0.1, "of each message to be cut"),
     raise_probability<&WireDirection::truncation>},
    {"merged_messages", "The end of a message is missing, and so is the beginning of the next one.",
     "A DMA ring buffer that is read too late is overwritten across the border of two messages.",
     chance(0.1, "of each message to run into the next one"), raise_probability<&WireDirection::merging>},
    {"inserted_garbage",
     "Bursts of random bytes stand between messages.",
     "A floating or noisy line makes start bits of its own; so does a second sender on it.",
     {number_parameter("bursts_per_s", 1, 0, 1000, "how often, on average"),
      whole_number_parameter("burst_bytes", 16, 1, 4096, "length of each burst, bytes"), wire_direction},
     make_garbage},
    {"wire_delay",
     "Every byte comes late by the same time.",
     "Radio links, CAN and network bridges buffer what they carry.",
     {number_parameter("delay_s", 0.5, 0, 60, "by which bytes are late, s"), wire_direction},
     make_delay},
    {"wire_jitter",
     "Messages come late by times that vary; none overtakes another.",
     "Latency timers of USB bridges and a busy host's scheduler hold bytes for varying times.",
     {number_parameter("sigma_s", 0.05, 0, 10,
                       "standard deviation of each message's delay before it is cut at zero, s"),
      wire_direction},
     make_jitter},
    {"stall",
     "Again and again nothing comes for a while, and then all of it in one burst.",
     "A host blocked by flash writes or logging, or a USB bus that sleeps, drains its buffer late.",
     {number_parameter("hold_s", 1, 0, 600, "how long nothing comes, s"),
      number_parameter("period_s", 5, 0.001, 3600, "from the start of a stall to the next one, s"), wire_direction},
     make_stall},
    {"duplicate_messages", "A message comes twice.",
     "A telemetry radio or a network bridge repeats a packet whose acknowledgement was lost.",
     chance(0.1, "of each message to come twice"), raise_probability<&WireDirection::duplication>},
    {"reordered_messages", "A message comes after the one that followed it.",
     "A bridge over UDP, or a driver with several queues, does not keep the order of its packets.",
     chance(0.1, "of each message to change places with the next one"), raise_probability<&WireDirection::reordering>},
    {"saturated_uart",
     "Fewer bytes come through than are sent: the rest waits, the lag grows, and at last bytes are lost.",
     "More messages are enabled, or at a higher rate, than the speed of the line can carry.",
     {number_parameter("bytes_per_s", no_standard, 1, 1e7, "that come through; or give baud"),
      number_parameter("baud", no_standard, 10, 1e8,
                       "of a line that carries as much, ten bits a byte; 9600 when neither is given"),
      wire_direction},
     make_saturation},
});

constexpr auto switched_wire_kinds = without_strength(std::to_array<FaultKind>({
    {"line_break",
     "The line is held at space: its listener hears zero bytes with framing errors.",
     "A short to ground, or a sender whose output stays low without power.",
     {},
     whole_wire<&WireConditions::line_break>},
    {"unplugged",
     "Neither end hears the other, as with the cable pulled. What the receiver sends leaves it, and is in "
     "`port0.out` of a recording.",
     "Vibration works a connector loose, or a USB hub resets and its devices vanish for a while.",
     {},
     whole_wire<&WireConditions::unplugged>},
    {"power_cut",
     "The receiver is without power, and starts anew when it returns. In a live run its actuator, "
     "`power` of its [[receiver]], is switched too.",
     "A brown-out of the supply rail, a tripped fuse or a bad crimp of the supply lead.",
     {word_parameter("start", "cold", firmware::start_kind_names,
                     "how it starts afterwards: cold without a backup battery, and "
                     "settings saved in battery-backed memory are lost then, those in flash are not")},
     make_power_cut},
    FaultKind{"speed_mismatch",
              "The receiver's line runs at another speed than the one it was set to: a client that listens at that one "
              "hears garble. `port0.out` of a recording has the bytes as they were sent.",
              "A receiver that restarted unnoticed speaks at its default speed while its client does not.",
              {whole_number_parameter("baud", 9600, 300, 4e6, "at which the receiver's line runs, bit/s")},
              make_speed_mismatch}
        .that_needs(wired_uart1),
    {"one_direction_dead",
     "One end hears nothing of the other, which still hears it.",
     "A bad crimp, a pin never wired or a level shifter of the wrong voltage cuts one lead.",
     {word_parameter("direction", "to_client", std::span(wire_directions).first(2), "which bytes do not arrive")
          .judged_by(why_unread)},
     make_dead},
}));

}  // namespace

std::vector<FaultKind> wire_fault_kinds() {
    return all_kinds_of(FaultLayer::wire, {gradual_wire_kinds, switched_wire_kinds});
}

}  // namespace skyloop::inline run
