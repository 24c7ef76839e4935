/// UBX messages in a stream of bytes with whatever else it carries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace skyloop {

/// One whole message; the payload lives as long as the log. Numbers are little-endian (u-blox M8 protocol
/// specification, section 32.3).
struct UbxFrame {
    std::uint8_t message_class = 0, id = 0;
    std::string_view payload;

    [[nodiscard]] std::uint8_t u1(std::size_t at) const { return static_cast<std::uint8_t>(payload[at]); }
    [[nodiscard]] std::int8_t i1(std::size_t at) const { return static_cast<std::int8_t>(payload[at]); }
    [[nodiscard]] std::uint16_t u2(std::size_t at) const {
        return static_cast<std::uint16_t>(u1(at) | u1(at + 1) << 8);
    }
    [[nodiscard]] std::int16_t i2(std::size_t at) const { return static_cast<std::int16_t>(u2(at)); }
    [[nodiscard]] std::uint32_t u4(std::size_t at) const {
        return u2(at) | static_cast<std::uint32_t>(u2(at + 2)) << 16;
    }
    [[nodiscard]] std::int32_t i4(std::size_t at) const { return static_cast<std::int32_t>(u4(at)); }
};

/// Walks over the messages of a log. State: the place of the next byte and running sums of all bytes, so that a
/// checksum costs the same for any length and a hostile log cannot make the walk slow.
class UbxFrames {
public:
    explicit UbxFrames(std::string_view log);
    /// The next message whose length and checksum hold, or nothing at the end.
    std::optional<UbxFrame> next();
    /// Places passed over that begin like a message and are none.
    [[nodiscard]] std::size_t damaged() const { return damaged_; }

private:
    [[nodiscard]] bool checksum_holds(std::size_t begin, std::size_t end) const;

    std::string_view log_;
    std::size_t at_ = 0;
    std::size_t damaged_ = 0;
    std::vector<std::uint8_t> sums_, sums_of_sums_;  // of the bytes before an index, modulo 256
};

}  // namespace skyloop
