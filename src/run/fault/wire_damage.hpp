/// One direction of a wire with its faults.
/// What is wrong with a wire at one instant, as plain data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/random.hpp"
#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "run/fault/correction_conditions.hpp"

namespace skyloop::inline run {

/// Bursts of random bytes between two messages.
struct GarbageBursts {
    double per_s = 0;  ///< on average
    int bytes = 0;     ///< of each

    [[nodiscard]] bool operator==(const GarbageBursts&) const = default;
};

/// One direction of a wire. Probabilities lie within 0 … 1; several faults together are combined by whoever sets them.
struct WireDirection {
    bool dead = false;                     ///< nothing comes through
    double byte_loss = 0;                  ///< of each byte
    double message_loss = 0;               ///< of each message: it is missing as a whole
    double bit_errors = 0;                 ///< of each bit
    double checksum_errors = 0;            ///< of each message: one bit of it is turned, so that its checksum is wrong
    double truncation = 0;                 ///< of each message: its end is missing
    double merging = 0;                    ///< of each message: its end is missing, and so is the beginning of the next
    double duplication = 0;                ///< of each message: it comes twice
    double reordering = 0;                 ///< of each message: it comes after the next one
    std::vector<GarbageBursts> garbage{};  ///< of each source
    Seconds delay{0};                      ///< of every byte
    Seconds jitter{0};                     ///< 1 σ that is added to the delay of each message; never overtaking
    bool stalled = false;                  ///< all is kept, and comes at once when this ends
    std::optional<double> bytes_per_s{};   ///< no more come through; the rest waits, and the lag grows
    CorrectionConditions corrections{};    ///< that come this way

    [[nodiscard]] bool operator==(const WireDirection&) const = default;
};

/// What faults make of a wire.
struct WireConditions {
    WireDirection to_client, to_receiver;
    bool unplugged = false;   ///< neither end hears the other, as with the cable pulled
    bool line_break = false;  ///< the line is held at space: the client hears zero bytes with framing errors
    bool power_cut = false;   ///< the receiver has no power: what is behind its actuator is to have none either
    std::optional<std::uint32_t> receiver_baud;  ///< the line runs at this speed, whatever the receiver believes
    /// Name of a receiver of the run whose corrections come in place of those that should.
    std::optional<std::string> corrections_from;

    [[nodiscard]] bool operator==(const WireConditions&) const = default;
};

/// What faults have made of one direction so far. Bytes put in and `bytes_inserted` are the bytes taken out, those that
/// wait, `bytes_lost` and `bytes_overrun`.
struct WireDamageCounts {
    std::uint64_t bytes_lost = 0;        ///< by loss, cut messages and a dead wire
    std::uint64_t bytes_overrun = 0;     ///< lost because too many waited
    std::uint64_t bytes_inserted = 0;    ///< garbage, and second copies of messages
    std::uint64_t bits_turned = 0;       ///< by bit errors and checksum errors
    std::uint64_t messages_changed = 0;  ///< cut, with a wrong checksum, doubled or late; corrections that tell else
    std::uint64_t garbage_bursts = 0;

    [[nodiscard]] bool operator==(const WireDamageCounts&) const = default;
};

/// Bytes of one direction on their way through what is wrong with it.
///
/// A sound direction hands on what it is given, at once and unchanged. What is drawn depends on the bytes and their
/// times, not on how they were cut into pieces, nor on when what came out was taken. In this order bytes meet: a dead
/// wire, faults of corrections, faults of messages, loss and bit errors, delay and jitter, a stall, the limit of
/// throughput.
///
/// Messages are UBX, NMEA, RTCM 3 and SBF with right checksums, and frames of a CAN bus; everything else passes the
/// faults of messages, but waits for its turn. While one of these faults is on (jitter and garbage among them) bytes
/// are kept until their message is whole, no longer than 0.1 s after the last byte and 1 s after the first, and then
/// come as they are; a message that is to come after the next one waits 2 s for it at most. Garbage that is due during
/// a message comes after it.
///
/// With more than `capacity` bytes on their way the newest are lost. When faults end, what they held comes out in its
/// order at that instant; all that a dead wire holds is lost. Probabilities, times and rates that make no sense (not
/// finite, negative) count as none; a throughput of zero is a stall; a jitter never makes a delay negative.
///
/// State: what is held back, and the random numbers, of which each kind of damage has its own.
class WireDamage {
public:
    /// The most bytes that wait for their time, a stall or the throughput. A whole message of each protocol may wait
    /// besides.
    static constexpr std::size_t capacity = 1'000'000;

    /// @param stream a name for the random numbers, different for each direction of each wire
    WireDamage(std::uint64_t seed, std::string_view stream);
    ~WireDamage();
    WireDamage(WireDamage&&) noexcept;
    WireDamage& operator=(WireDamage&&) noexcept;

    /// What is wrong from now on.
    void set(const WireDirection& direction, GpsTime now);
    /// Bytes that enter at `now`. Times never go back.
    void put(ByteSpan bytes, GpsTime now);
    /// What comes out by `now`.
    Bytes take(GpsTime now);
    /// When the next byte comes out that is held back now, or garbage; nothing: neither is to come, or nobody knows. It
    /// stays at the past until it is taken.
    [[nodiscard]] std::optional<GpsTime> next_at() const;
    /// Bytes that are held back, and those that are ready and not yet taken.
    [[nodiscard]] std::size_t waiting() const;
    [[nodiscard]] WireDamageCounts counts() const;

private:
    class State;
    std::unique_ptr<State> state_;
};

}  // namespace skyloop::inline run
