/// What Galileo's satellites send of OSNMA (Galileo OSNMA SIS ICD 1.1, sections 3 to 5).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "base/time/utc_time.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/osnma/osnma_keys.hpp"

namespace skyloop::inline world {

/// Hands out the 40 bits of each odd page of E1-B. All satellites send; the tags of a subframe authenticate what was
/// sent in the one before, of the sender itself and of others, which change from subframe to subframe.
///
/// State: the navigation data of the last sixteen subframes as it was when first looked at, and the messages of this
/// one.
class OsnmaSender {
public:
    explicit OsnmaSender(std::shared_ptr<const OsnmaKeys> keys) : keys_(std::move(keys)) {}

    /// Starts come in ascending order, but for satellites of the same instant.
    /// @param sent what the satellites broadcast
    /// @param start of the pair of pages
    /// @return 8 bits of HKROOT, then 32 of MACK; 0 outside of the chain
    std::uint64_t field(SatelliteId sender, const NavigationSource& sent, const LeapSeconds& leap_seconds,
                        GpsTime start);

private:
    // What tags authenticate: words 1 to 5 of a satellite, or time (of satellite 255).
    struct Data {
        int of = 0;
        GpsTime subframe;
        auto operator<=>(const Data&) const = default;
    };
    struct Context;
    struct TagPlace {
        int number = 1;  // in its subframe
        int of = 0;      // PRN_D
        std::uint64_t adkd = 0;
    };
    struct Tag {
        std::uint64_t value = 0, info = 0;  // 40 bits; PRN_D, ADKD and cut-off point, 16
    };

    const BitWriter& data(const Context& context, const Data& which);
    int unchanged(const Context& context, int of);
    std::vector<int> others(const Context& context, int sender);
    Tag tag(const Context& context, int sender, const TagPlace& place, const TeslaKey& key);
    BitWriter tags(const Context& context, int sender);
    [[nodiscard]] BitWriter root_block(const Context& context, int sender) const;

    std::shared_ptr<const OsnmaKeys> keys_;
    std::map<Data, BitWriter> data_;
    std::optional<GpsTime> subframe_;
    std::map<int, BitWriter> messages_;  // of this subframe, by the sender: HKROOT, then MACK
};

}  // namespace skyloop::inline world
