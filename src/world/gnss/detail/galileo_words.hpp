/// Words of Galileo's I/NAV that tell more than the ephemeris (OS SIS ICD 2.1, section 4.3.5), behind their type.
#pragma once

#include <array>
#include <cstdint>

#include "broadcast_fields.hpp"
#include "world/gnss/broadcast_galileo.hpp"

namespace skyloop::inline world {

/// Words 7 to 10: almanacs of three satellites in a minute, 36 in twelve (tables 49 to 52).
void put_inav_almanac(BitWriter& bits, int word, const InavData& data, GpsTime start);

/// Word 16: a short orbit and clock of the satellite (section 4.3.5, word type 16).
void put_reduced_record(BitWriter& bits, const KeplerEphemeris& record, GpsTime start);

/// Words 17 to 20: 60 octets by which the words 1 to 4 can be mended (section 4.3.5, word types 17 to 20, and 5.1.13).
void put_mending_octets(BitWriter& bits, int word, const InavData& data, GpsTime start);

/// The first bits of F/NAV's pages 5 and 6 likewise (tables 35 and 36), up to their checksum.
void put_fnav_almanac(BitWriter& bits, int page, const InavData& data, GpsTime start);

/// CRC-24Q (OS SIS ICD 2.1, 5.1.9.4; IS-GPS-200, 20.3.5), bit by bit, since messages are no whole bytes.
class MessageChecksum {
public:
    void add(const BitWriter& bits) {
        for (std::size_t i = 0; i < bits.size(); ++i)
            add(bits.bit(i));
    }
    [[nodiscard]] std::uint64_t value() const { return value_; }

private:
    void add(bool bit) {
        const bool carry = (value_ >> 23 & 1) != 0;
        value_ = value_ << 1 & 0xFFFFFF;
        if (carry != bit) value_ ^= 0x864CFB;
    }
    std::uint32_t value_ = 0;
};

}  // namespace skyloop::inline world
