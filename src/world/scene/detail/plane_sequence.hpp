/// Which planes a ray met, and sets of such sequences.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "base/core/inplace_vector.hpp"
#include "world/gnss/satellite.hpp"
#include "world/scene/scene_path.hpp"

namespace skyloop {

/// Planes from the antenna to the satellite.
using PlaneSequence = InplaceVector<std::uint32_t, most_reflections>;

inline std::span<const std::uint32_t> planes_of(const PlaneSequence& sequence) {
    return {sequence.begin(), sequence.size()};
}

inline PlaneSequence to_sequence(std::span<const std::uint32_t> planes) {
    PlaneSequence sequence;
    for (const std::uint32_t plane : planes)
        sequence.push_back(plane);
    return sequence;
}

/// A sequence that is to be tried, or was found, for a satellite.
struct SatelliteSequence {
    SatelliteId id;
    PlaneSequence planes;
};

/// 64 well-mixed bits of a satellite and a sequence, never 0. Two of a million different ones are equal once in 10⁷
/// runs; a path would then be overlooked for an epoch.
inline std::uint64_t sequence_key(SatelliteId id, std::span<const std::uint32_t> planes) {
    constexpr std::uint64_t golden = 0x9E3779B97F4A7C15;
    std::uint64_t key = golden * (static_cast<std::uint64_t>(id.constellation) * 4096 +
                                  static_cast<std::uint64_t>(static_cast<std::uint32_t>(id.number)) + 1);
    for (const std::uint32_t plane : planes) {
        key = (key ^ (plane + 1ULL)) * 0xFF51AFD7ED558CCD;
        key ^= key >> 32;
    }
    return key | 1;
}

/// A set of keys in one flat table: quick to clear and to copy, no allocation once it has grown.
class KeySet {
public:
    KeySet() : table_(1024, 0) {}
    void clear() {
        if (size_ > 0) std::fill(table_.begin(), table_.end(), 0);
        size_ = 0;
    }
    /// @returns true when the key is new
    bool insert(std::uint64_t key) {
        if (2 * (size_ + 1) > table_.size()) grow();
        std::uint64_t& place = table_[slot(key)];
        if (place == key) return false;
        place = key;
        ++size_;
        return true;
    }
    [[nodiscard]] bool contains(std::uint64_t key) const { return table_[slot(key)] == key; }

private:
    [[nodiscard]] std::size_t slot(std::uint64_t key) const {
        const std::size_t mask = table_.size() - 1;
        std::size_t at = (key >> 20) & mask;
        while (table_[at] != 0 && table_[at] != key)
            at = (at + 1) & mask;
        return at;
    }
    void grow() {
        std::vector<std::uint64_t> old(table_.size() * 2, 0);
        old.swap(table_);
        for (const std::uint64_t key : old)
            if (key != 0) table_[slot(key)] = key;
    }

    std::vector<std::uint64_t> table_;
    std::size_t size_ = 0;
};

}  // namespace skyloop
