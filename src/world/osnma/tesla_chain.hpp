/// The chain of keys of OSNMA (Galileo OSNMA SIS ICD 1.1, sections 3.2.3 and 6.3).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline world {

/// A key of 128 bits.
using TeslaKey = std::array<std::uint8_t, 16>;

/// OSNMA counts by the subframes of I/NAV; those of E1-B begin a second later.
inline constexpr std::chrono::seconds osnma_subframe{30};

/// GST as OSNMA has it in what it hashes: 12 bits of the week and 20 of the time of week.
std::uint32_t osnma_time(GpsTime time);

/// Keys for four weeks, one for each subframe, all made from the last: SHA-256 of a key, the time of the one before and
/// α is, cut to 128 bits, the one before (6.3, one-way function).
class TeslaChain {
public:
    static constexpr int key_count = 4 * 20160;
    /// @param seed of the last key and of α
    /// @param first the subframe with the first key, GST_0; a whole hour
    TeslaChain(std::uint64_t seed, GpsTime first);

    /// The key that is disclosed in a subframe; nothing outside of the chain. The root is that of the subframe before
    /// the first.
    [[nodiscard]] std::optional<TeslaKey> key(GpsTime subframe) const;
    [[nodiscard]] const TeslaKey& root() const { return keys_.front(); }
    [[nodiscard]] GpsTime first() const { return first_; }
    /// 48 bits.
    [[nodiscard]] std::uint64_t alpha() const { return alpha_; }

private:
    GpsTime first_;
    std::uint64_t alpha_ = 0;
    std::vector<TeslaKey> keys_;  // the root, then by subframes
};

}  // namespace skyloop::inline world
