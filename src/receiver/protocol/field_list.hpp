/// Payloads from field lists: a message declares its fields once (field.hpp), and encoding, decoding, size and listing
/// follow.
///
/// The fields are the members of the struct, in their order: declared fields, plain numbers (little-endian),
/// std::arrays and structs of them. A message with lists, a tail or odd sizes says itself how its bytes follow each
/// other, in a `static void fields(auto& m, auto& v)` that calls, in the order of the bytes, `v(m.a, m.b, …)` for such
/// members, `v.count(m.items)` for a U1 that counts what `v.items(m.items)` later writes, `v.rest(m.items, least,
/// most)` for what fills the payload, `v.if_present(m.optional)` for a tail that older firmware leaves out and
/// `v.sized(m.value, bytes)` for an integer of three bytes, or whose size another field gives. UBX, MSP, MAVLink and
/// SBF use it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/core/bytes.hpp"
#include "receiver/protocol/field.hpp"
#include "receiver/protocol/members.hpp"

namespace skyloop::inline receiver {

/// The most that a U1 counts; longer lists are written up to here.
inline constexpr std::size_t most_items = 255;

/// Shows all fields of m to v: in the order that `fields` tells, else in that of the members.
template <class M, class V>
void walk_fields(M& m, V& v) {
    if constexpr (requires { std::remove_const_t<M>::fields(m, v); })
        std::remove_const_t<M>::fields(m, v);
    else
        with_members(m, v);
}

namespace field_list {

template <std::size_t Size>
using Unsigned = std::conditional_t<
    Size == 1, std::uint8_t,
    std::conditional_t<Size == 2, std::uint16_t, std::conditional_t<Size == 4, std::uint32_t, std::uint64_t>>>;

template <class T>
concept Number = std::is_arithmetic_v<T>;
/// A struct of members.
template <class T>
concept Group = !Number<T> && !DeclaredField<T>;

class Writer {
public:
    template <class... T>
    void operator()(const T&... field) {
        (put(field), ...);
    }
    template <class T>
    void count(const std::vector<T>& list) {
        put(static_cast<std::uint8_t>(std::min(list.size(), most_items)));
    }
    template <class T>
    void items(const std::vector<T>& list) {
        const std::size_t written = std::min(list.size(), most_items);
        for (std::size_t i = 0; i < written; ++i)
            put(list[i]);
    }
    template <class T>
    void rest(const std::vector<T>& list, std::size_t, std::size_t) {
        for (const T& item : list)
            put(item);
    }
    template <class T>
    void if_present(const std::optional<T>& field) {
        if (field) put(*field);
    }
    void sized(std::uint64_t value, std::size_t bytes) {
        for (std::size_t i = 0; i < bytes; ++i)
            bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i) & 0xFF));
    }
    [[nodiscard]] Bytes take() { return std::move(bytes_); }

private:
    template <Number T>
    void put(T value) {
        sized(std::bit_cast<Unsigned<sizeof(T)>>(value), sizeof(T));
    }
    template <class Raw>
    void put(const RawNumber<Raw>& number) {
        put(number.raw);
    }
    template <class T, std::size_t N>
    void put(const std::array<T, N>& fields) {
        for (const T& field : fields)
            put(field);
    }
    template <Group T>
    void put(const T& group) {
        walk_fields(group, *this);
    }

    Bytes bytes_;
};

class Reader {
public:
    explicit Reader(ByteSpan bytes) : left_(bytes) {}

    template <class... T>
    void operator()(T&... field) {
        (pick(field), ...);
    }
    template <class T>
    void count(std::vector<T>& list) {
        std::uint8_t number = 0;
        pick(number);
        list.resize(number);
    }
    template <class T>
    void items(std::vector<T>& list) {
        for (T& item : list)
            pick(item);
    }
    template <class T>
    void rest(std::vector<T>& list, std::size_t least, std::size_t most) {
        list.clear();
        while (good_ && !left_.empty()) {
            T item{};
            pick(item);
            list.push_back(std::move(item));
        }
        if (list.size() < least || list.size() > most) good_ = false;
    }
    template <class T>
    void if_present(std::optional<T>& field) {
        field.reset();
        if (!left_.empty()) pick(field.emplace());
    }
    void sized(std::uint64_t& value, std::size_t bytes) {
        value = 0;
        if (bytes == 0 || bytes > left_.size()) good_ = false;
        if (!good_) return;
        for (std::size_t i = 0; i < bytes; ++i)
            value |= std::uint64_t{left_[i]} << (8 * i);
        left_ = left_.subspan(bytes);
    }
    /// Everything was there, and nothing more.
    [[nodiscard]] bool complete() const { return good_ && left_.empty(); }
    /// Everything was there.
    [[nodiscard]] bool enough() const { return good_; }

private:
    template <Number T>
    void pick(T& value) {
        std::uint64_t raw = 0;
        sized(raw, sizeof(T));
        value = std::bit_cast<T>(static_cast<Unsigned<sizeof(T)>>(raw));
    }
    template <class Raw>
    void pick(RawNumber<Raw>& number) {
        pick(number.raw);
    }
    template <class T, std::size_t N>
    void pick(std::array<T, N>& fields) {
        for (T& field : fields)
            pick(field);
    }
    template <Group T>
    void pick(T& group) {
        walk_fields(group, *this);
    }

    ByteSpan left_;
    bool good_ = true;
};

}  // namespace field_list

/// The payload's bytes.
template <class Message>
Bytes encode_payload(const Message& message) {
    field_list::Writer writer;
    walk_fields(message, writer);
    return writer.take();
}

/// Bytes of the payload.
template <class Message>
std::size_t wire_size(const Message& message) {
    return encode_payload(message).size();
}

/// The message, or nothing when the payload is shorter or longer than its fields and counts say.
template <class Message>
std::optional<Message> decode_payload(ByteSpan payload) {
    field_list::Reader reader(payload);
    Message message;
    walk_fields(message, reader);
    if (!reader.complete()) return std::nullopt;
    return message;
}

/// The message, whatever follows it: padding, or what a later revision added. Nothing when the payload is too short.
template <class Message>
std::optional<Message> decode_front(ByteSpan payload) {
    field_list::Reader reader(payload);
    Message message;
    walk_fields(message, reader);
    if (!reader.enough()) return std::nullopt;
    return message;
}

/// A list of message types.
template <class... Message>
struct MessageTypes {
    /// Calls `f.template operator()<Message>()` for one after the other, until one says true; whether one did.
    template <class F>
    static bool any(F&& f) {
        return (f.template operator()<Message>() || ...);
    }
};

}  // namespace skyloop::inline receiver
