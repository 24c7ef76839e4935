/// Fields of DroneCAN messages and the bits they have: the numbers of field.hpp with any count of bits.
///
///     Unsigned<"sats_used", 6> sats_used;          // uint6
///     Signed<"latitude_deg*1e-8", 37> latitude;    // int37
///     Half<"pdop"> pdop;                           // float16
///     Void<13> reserved;                           // void13
///     BitList<"covariance", HalfBits, 36> covariance;   // float16[<=36], with its length before it
///     TailList<"name", CharacterBits, 92> name;    // uint8[<=92], the last of a message: no length
///
/// DSDL serialises a number from its lowest byte to its highest, each byte (and what is left above the last whole one)
/// from its highest bit to its lowest; a message ends with zero bits up to a whole byte (dronecan.github.io,
/// specification 3.5; dronecan/pydronecan, transport.py). The last array of a message whose items have eight bits or
/// more has no length, in frames of classic CAN.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "base/core/bytes.hpp"
#include "receiver/protocol/field.hpp"
#include "receiver/protocol/members.hpp"

namespace skyloop::inline receiver {

/// A number of `Width` bits, or an array of them. @tparam Raw that it is in C++; float of 16 bits is half precision
template <FieldText Declared, unsigned Width, class Raw, std::size_t Count = 1>
struct BitField : Field<Declared, Raw, Count> {
    static constexpr unsigned width = Width;
    using Field<Declared, Raw, Count>::Field;
    using Field<Declared, Raw, Count>::operator=;
    /// The nearest number that has so many bits to a value in the declared unit.
    void set(double value) requires(Count == 1 && std::is_integral_v<Raw>) {
        constexpr int bits = static_cast<int>(Width) - (std::is_signed_v<Raw> ? 1 : 0);
        constexpr double beyond = field_text::power(2, bits), least = std::is_signed_v<Raw> ? -beyond : 0;
        const double number = std::round(value * this->format.divisor / this->format.factor);
        this->raw = nearest<Raw>(std::isnan(number) ? 0 : std::min(std::max(number, least), beyond - 1));
    }
    void set(double value) requires(Count == 1 && std::is_floating_point_v<Raw>) {
        this->raw = static_cast<Raw>(value * this->format.divisor / this->format.factor);
    }
};

// clang-format off
template <FieldText Declared, unsigned Width> using Unsigned = BitField<Declared, Width, std::uint64_t>;
template <FieldText Declared, unsigned Width, std::size_t Count = 1> using Signed = BitField<Declared, Width, std::int64_t, Count>;
template <FieldText Declared> using Half = BitField<Declared, 16, float>;
template <FieldText Declared, std::size_t Count = 1> using Single = BitField<Declared, 32, float, Count>;
template <FieldText Declared> using Flag = BitField<Declared, 1, std::uint64_t>;
// clang-format on

/// Bits that mean nothing: zeros.
template <unsigned Width>
struct Void {
    static void fields(auto& m, auto& v) {
        if constexpr (requires { v.skip(Width); })
            v.skip(Width);
        else
            static_cast<void>(m);
    }
};

// Items of lists.
struct HalfBits {
    using type = float;
    static constexpr unsigned width = 16;
};
struct ByteBits {
    using type = std::uint8_t;
    static constexpr unsigned width = 8;
};
struct CharacterBits {
    using type = char;
    static constexpr unsigned width = 8;
};

/// At most so many items; their count stands before them.
template <FieldText Declared, class Item, std::size_t Most>
struct BitList : List<Declared, typename Item::type> {
    using List<Declared, typename Item::type>::List;
    static constexpr std::size_t most = Most;
    static constexpr unsigned item_width = Item::width, length_width = std::bit_width(Most);
    static constexpr bool counted = true;
};
/// The same at the end of a message, without a count.
template <FieldText Declared, class Item, std::size_t Most>
struct TailList : List<Declared, typename Item::type> {
    using List<Declared, typename Item::type>::List;
    static constexpr std::size_t most = Most;
    static constexpr unsigned item_width = Item::width;
    static constexpr bool counted = false;
};

/// A number in half precision (IEEE 754 binary16), the nearest one, beyond its range infinite; and back.
std::uint16_t half_bits(float value);
float half_value(std::uint16_t bits);

namespace bit_list {

template <class Raw>
std::uint64_t raw_bits(Raw value, unsigned width) {
    if constexpr (std::is_same_v<Raw, float>)
        return width == 16 ? half_bits(value) : std::bit_cast<std::uint32_t>(value);
    else
        return static_cast<std::uint64_t>(value);
}

template <class Raw>
Raw raw_value(std::uint64_t bits, unsigned width) {
    if constexpr (std::is_same_v<Raw, float>) {
        return width == 16 ? half_value(static_cast<std::uint16_t>(bits))
                           : std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    } else if constexpr (std::is_signed_v<Raw> && !std::is_same_v<Raw, char>) {
        const unsigned above = 64 - width;
        return static_cast<Raw>(static_cast<std::int64_t>(bits << above) >> above);
    } else {
        return static_cast<Raw>(bits);
    }
}

/// Walks a message's fields and writes them.
class Writer {
public:
    template <class... T>
    void operator()(const T&... field) {
        (put(field), ...);
    }
    void skip(unsigned width) { put_number(0, width); }
    [[nodiscard]] Bytes take() { return bits_.bytes(); }

private:
    template <class T>
    void put(const T& field) {
        if constexpr (requires { T::counted; }) {
            const std::size_t count = std::min(field.size(), T::most);
            if constexpr (T::counted) put_number(count, T::length_width);
            for (std::size_t i = 0; i < count; ++i)
                put_number(raw_bits(field[i], T::item_width), T::item_width);
        } else if constexpr (requires { T::width; }) {
            if constexpr (requires { field.raw; })
                put_number(raw_bits(field.raw, T::width), T::width);
            else
                for (const auto& number : field)
                    put_number(raw_bits(number, T::width), T::width);
        } else {
            walk_bits(field, *this);
        }
    }
    template <class M>
    static void walk_bits(const M& m, Writer& v) {
        if constexpr (requires { M::fields(m, v); })
            M::fields(m, v);
        else
            with_members(m, v);
    }
    // Byte after byte of the number, of each the highest bit first.
    void put_number(std::uint64_t value, unsigned width) {
        for (unsigned offset = 0; offset < width; offset += 8)
            bits_.put(value >> offset, static_cast<int>(std::min(width - offset, 8U)));
    }
    BitWriter bits_;
};

/// Walks a message's fields and reads them.
class Reader {
public:
    explicit Reader(ByteSpan bytes) : bits_(bytes), left_(8 * bytes.size()) {}
    template <class... T>
    void operator()(T&... field) {
        (pick(field), ...);
    }
    void skip(unsigned width) { take(width); }
    /// Everything was there, and nothing more than bits up to a whole byte.
    [[nodiscard]] bool complete() const { return good_ && left_ < 8; }

private:
    template <class T>
    void pick(T& field) {
        if constexpr (requires { T::counted; }) {
            pick_list(field);
        } else if constexpr (requires { T::width; }) {
            if constexpr (requires { field.raw; })
                field.raw = number<std::remove_cvref_t<decltype(field.raw)>>(T::width);
            else
                for (auto& one : field)
                    one = number<std::remove_cvref_t<decltype(one)>>(T::width);
        } else if constexpr (requires { T::fields(field, *this); }) {
            T::fields(field, *this);
        } else {
            with_members(field, *this);
        }
    }
    template <class T>
    void pick_list(T& field) {
        std::size_t count = left_ / T::item_width;
        if constexpr (T::counted) count = take(T::length_width);
        if (count > T::most || count * T::item_width > left_) {
            good_ = false;
            return;
        }
        field.clear();
        for (std::size_t i = 0; i < count; ++i)
            field.push_back(number<typename T::value_type>(T::item_width));
    }
    template <class Raw>
    Raw number(unsigned width) {
        return raw_value<Raw>(take(width), width);
    }
    std::uint64_t take(unsigned width) {
        good_ = good_ && width <= left_;
        if (!good_) return 0;
        left_ -= width;
        std::uint64_t value = 0;
        for (unsigned offset = 0; offset < width; offset += 8)
            value |= bits_.get(static_cast<int>(std::min(width - offset, 8U))) << offset;
        return value;
    }
    BitReader bits_;
    std::size_t left_;  ///< bits
    bool good_ = true;
};

}  // namespace bit_list

/// The payload of a transfer.
template <class Message>
Bytes encode_bits(const Message& message) {
    bit_list::Writer writer;
    writer(message);
    return writer.take();
}

/// The message, or nothing when the payload is shorter or longer than its fields and counts say.
template <class Message>
std::optional<Message> decode_bits(ByteSpan payload) {
    bit_list::Reader reader(payload);
    Message message;
    reader(message);
    if (!reader.complete()) return std::nullopt;
    return message;
}

}  // namespace skyloop::inline receiver
