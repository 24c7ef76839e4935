/// One direction of a wire with its faults.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "skyloop/base/bytes.hpp"
#include "skyloop/base/random.hpp"
#include "skyloop/fault/wire_conditions.hpp"
#include "skyloop/time/gps_time.hpp"

namespace skyloop {

/// Bytes of one direction on their way through what is wrong with it.
///
/// A sound direction hands on what it is given, at once and unchanged. What is drawn depends on the bytes and their
/// times, not on how they were cut into pieces. State: what is held back, and the random numbers.
class WireDamage {
public:
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
    /// When the next byte comes out that is held back now; nothing: none is, or nobody knows.
    [[nodiscard]] std::optional<GpsTime> next_at() const;
    /// Bytes that are held back.
    [[nodiscard]] std::size_t waiting() const;

private:
    class State;
    std::unique_ptr<State> state_;
};

}  // namespace skyloop
