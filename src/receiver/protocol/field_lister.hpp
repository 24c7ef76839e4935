/// Field lists as named values: the third use of their declarations, beside writing and reading.
///
/// The fields of one message of each protocol; decode_piece() puts them together.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/core/bytes.hpp"
#include "receiver/protocol/decoded_message.hpp"
#include "receiver/protocol/field_list.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop::inline receiver {

/// A number in the declared unit.
DecodedValue scaled_value(std::uint64_t raw, const FieldFormat& format);
DecodedValue scaled_value(std::int64_t raw, const FieldFormat& format);
DecodedValue scaled_value(double raw, const FieldFormat& format);
/// The shortest decimal number that is this one in single precision.
double shortest(float value);
/// Text up to its first zero.
DecodedValue text_value(std::string_view characters);

/// Walks a field list and names what it meets.
class FieldLister {
public:
    template <class... T>
    void operator()(const T&... field) {
        (list(field), ...);
    }
    template <class T>
    void count(const T&) {}
    template <class T>
    void items(const T& list) {
        add(T::format, list_value(list, T::format));
    }
    template <class T>
    void rest(const T& list, std::size_t, std::size_t) {
        items(list);
    }
    template <class T>
    void if_present(const std::optional<T>& field) {
        if (field) list(*field);
    }
    template <class T>
    void sized(const T& field, std::size_t) {
        list(field);
    }

    [[nodiscard]] std::vector<DecodedField> take() { return std::move(fields_); }

private:
    void add(const FieldFormat& format, DecodedValue value) {
        fields_.push_back({std::string(format.name), std::move(value)});
    }
    template <class T>
    void list(const T& field) {
        if constexpr (!DeclaredField<T>)
            list_members(field);
        else if constexpr (requires { field.size(); })
            add(T::format, list_value(field, T::format));
        else
            add(T::format, item_value(field.raw, T::format));
    }
    // Of a group in place; members that are no fields have no name.
    template <class T>
    void list_members(const T& member) {
        if constexpr (!field_list::Number<T> && !requires { member.size(); }) walk_fields(member, *this);
    }

    template <class Items>
    static DecodedValue list_value(const Items& items, const FieldFormat& format) {
        if constexpr (std::is_same_v<typename Items::value_type, char>) {
            return text_value({items.data(), items.size()});
        } else {
            std::vector<DecodedValue> values;
            for (const auto& item : items)
                values.push_back(item_value(item, format));
            return {std::move(values)};
        }
    }
    template <class T>
    static DecodedValue item_value(const T& item, const FieldFormat& format) {
        if constexpr (std::is_same_v<T, float>) {
            return scaled_value(shortest(item), format);
        } else if constexpr (std::is_floating_point_v<T>) {
            return scaled_value(static_cast<double>(item), format);
        } else if constexpr (std::is_signed_v<T>) {
            return scaled_value(static_cast<std::int64_t>(item), format);
        } else if constexpr (field_list::Number<T>) {
            return scaled_value(static_cast<std::uint64_t>(item), format);
        } else if constexpr (requires { item.size(); }) {
            return list_value(item, format);
        } else {
            FieldLister group;
            walk_fields(item, group);
            return {group.take()};
        }
    }

    std::vector<DecodedField> fields_;
};

/// Fills fields or payload of a message whose protocol and size are set.
void list_ubx(const UbxFrameView& frame, DecodedMessage& message);
void list_nmea(const SentenceView& sentence, DecodedMessage& message);
/// @param payload between length and CRC
void list_rtcm3(ByteSpan payload, DecodedMessage& message);

}  // namespace skyloop::inline receiver
