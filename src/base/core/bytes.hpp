/// Raw bytes, as they travel on a wire.
/// A text as a number.
/// Bytes that wait until whoever they are for takes them.
/// Fields of any width in a row of bits, the most significant bit first, as navigation messages and RTCM 3 have them.
/// How a byte lies on an asynchronous serial line.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace skyloop::inline base {

using Bytes = std::vector<std::uint8_t>;
using ByteSpan = std::span<const std::uint8_t>;

/// The characters of `text` as bytes.
inline Bytes to_bytes(std::string_view text) { return {text.begin(), text.end()}; }

/// The bytes as characters, one for one.
inline std::string to_string(ByteSpan bytes) { return {bytes.begin(), bytes.end()}; }

/// FNV-1a, 64 bit (Fowler, Noll and Vo): quick and stable everywhere, not for secrets.
/// @param basis the digest of what came before, to go on with it
constexpr std::uint64_t fnv1a_64(std::string_view text, std::uint64_t basis = 0xcbf29ce484222325u) {
    std::uint64_t digest = basis;
    for (const char c : text)
        digest = (digest ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return digest;
}

/// A queue of bytes in one piece, from whose front any number leaves.
///
/// An other end that is always a little behind never empties it: what has left goes with the next bytes that come once
/// it is more than what waits, so that no byte is moved more than once and twice what waits is held.
class SendBuffer {
public:
    void add(ByteSpan bytes) {
        if (sent_ > size()) {
            bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(sent_));
            sent_ = 0;
        }
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    /// So many have left, at most size().
    void sent(std::size_t count) {
        sent_ += count;
        if (sent_ >= bytes_.size()) clear();
    }
    void clear() {
        bytes_.clear();
        sent_ = 0;
    }

    [[nodiscard]] ByteSpan waiting() const { return ByteSpan(bytes_).subspan(sent_); }
    [[nodiscard]] std::size_t size() const { return bytes_.size() - sent_; }
    [[nodiscard]] bool empty() const { return size() == 0; }
    /// With those that have left and are not given up yet.
    [[nodiscard]] std::size_t held() const { return bytes_.size(); }

private:
    Bytes bytes_;
    std::size_t sent_ = 0;  // of them
};

/// Writes fields one after the other.
class BitWriter {
public:
    /// The lowest `width` bits of `value`; of a negative number its two's complement. Beyond 64 bits they are 0.
    void put(std::uint64_t value, int width) {
        for (int bit = width - 1; bit >= 0; --bit)
            bits_.push_back(bit < 64 && (value >> bit & 1) != 0);
    }
    void put_signed(std::int64_t value, int width) { put(static_cast<std::uint64_t>(value), width); }
    [[nodiscard]] std::size_t size() const { return bits_.size(); }
    [[nodiscard]] bool bit(std::size_t index) const { return bits_[index]; }
    /// `width` (at most 64) bits from `offset` on as one number; 0 stands for what lies behind the end.
    [[nodiscard]] std::uint64_t field(std::size_t offset, int width) const {
        std::uint64_t value = 0;
        for (std::size_t i = offset; i < offset + static_cast<std::size_t>(width); ++i)
            value = value << 1 | static_cast<std::uint64_t>(i < bits_.size() && bits_[i]);
        return value;
    }
    /// Whole bytes, the last one filled up with 0.
    [[nodiscard]] Bytes bytes() const {
        Bytes result;
        for (std::size_t i = 0; i < bits_.size(); i += 8)
            result.push_back(static_cast<std::uint8_t>(field(i, 8)));
        return result;
    }
    /// Whole 32-bit words, the last one filled up with 0.
    [[nodiscard]] std::vector<std::uint32_t> words() const {
        std::vector<std::uint32_t> result;
        for (std::size_t i = 0; i < bits_.size(); i += 32)
            result.push_back(static_cast<std::uint32_t>(field(i, 32)));
        return result;
    }

private:
    std::vector<bool> bits_;
};

/// Reads fields one after the other. Behind the end it reads 0, and ok() turns false.
class BitReader {
public:
    explicit BitReader(ByteSpan bytes) : bytes_(bytes) {}
    /// @param width 0 … 64
    std::uint64_t get(int width) {
        std::uint64_t value = 0;
        for (int i = 0; i < width; ++i, ++at_) {
            const bool inside = at_ / 8 < bytes_.size();
            ok_ = ok_ && inside;
            value = value << 1 | (inside ? static_cast<unsigned>(bytes_[at_ / 8]) >> (7 - at_ % 8) & 1u : 0u);
        }
        return value;
    }
    /// A two's complement. @param width 1 … 64
    std::int64_t get_signed(int width) {
        const std::uint64_t raw = get(width);
        const int unused = 64 - width;
        return static_cast<std::int64_t>(raw << unused) >> unused;
    }
    void skip(std::size_t bits) {
        at_ += bits;
        ok_ = ok_ && at_ <= 8 * bytes_.size();
    }
    [[nodiscard]] bool ok() const { return ok_; }

private:
    ByteSpan bytes_;
    std::size_t at_ = 0;
    bool ok_ = true;
};

/// `value / step` rounded to the nearest whole number that `least … most` holds; 0 for what is no number.
inline std::int64_t quantised(double value, double step, std::int64_t least, std::int64_t most) {
    const double steps = std::round(value / step);
    if (std::isnan(steps)) return 0;
    if (steps <= static_cast<double>(least)) return least;
    if (steps >= static_cast<double>(most)) return most;
    return static_cast<std::int64_t>(steps);
}

enum class Parity { none, even, odd };

struct SerialFormat {
    int data_bits = 8;  ///< 7 or 8
    Parity parity = Parity::none;
    int stop_bits = 1;    ///< 1 or 2
    bool rtscts = false;  ///< each end sends only while the other lets it

    /// Bits of one byte on the line, with its start bit.
    [[nodiscard]] constexpr int bits_per_byte() const {
        return 1 + data_bits + (parity == Parity::none ? 0 : 1) + stop_bits;
    }
    /// How long one byte takes, ns, rounded up. @param baud bit/s
    [[nodiscard]] constexpr std::int64_t byte_ns(std::uint32_t baud) const {
        return bits_per_byte() * std::int64_t{1'000'000'000} / std::max<std::int64_t>(baud, 1) + 1;
    }
};

}  // namespace skyloop::inline base
