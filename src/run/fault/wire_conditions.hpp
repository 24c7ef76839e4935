/// What is wrong with a wire at one instant, as plain data.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop {

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

    [[nodiscard]] bool operator==(const WireDirection&) const = default;
};

/// What faults make of a wire.
struct WireConditions {
    WireDirection to_client, to_receiver;
    bool unplugged = false;   ///< neither end hears the other, as with the cable pulled
    bool line_break = false;  ///< the line is held at space: the client hears zero bytes with framing errors
    bool power_cut = false;   ///< the receiver has no power: what is behind its actuator is to have none either
    std::optional<std::uint32_t> receiver_baud;  ///< the line runs at this speed, whatever the receiver believes

    [[nodiscard]] bool operator==(const WireConditions&) const = default;
};

}  // namespace skyloop
