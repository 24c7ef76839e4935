/// Field lists with names: the third use of `fields`, beside writing and reading.
///
/// Names stand in one text, separated by spaces, one for each call's argument in the order of the field list:
/// `name` as it is; `name*1e-7`, `name*4e-2` or `name*2^-32` scaled; `name!65535` missing when the raw number is 65535;
/// `-name` not shown; `name[a b c]` a list of groups with those names. A group inside a message takes its names in
/// place.
///
/// The fields of one message of each protocol; decode_piece() puts them together.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
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

/// One name of the text.
struct FieldName {
    std::string_view name;
    int decimal_digits = 0;        ///< of the scale: 7 for 1e-7
    int factor = 1;                ///< of the scale: 4 for 4e-2
    int binary_digits = 0;         ///< 32 for 2^-32
    std::optional<double> absent;  ///< the raw number that means nothing
    bool hidden = false;
    std::string_view items;  ///< the names of a list's groups
};

/// Takes the next name off the front of the text; an empty one when there is none left.
FieldName next_field_name(std::string_view& names);

/// A number with its scale.
DecodedValue scaled_value(std::uint64_t raw, const FieldName& name);
DecodedValue scaled_value(std::int64_t raw, const FieldName& name);
DecodedValue scaled_value(double raw, const FieldName& name);
/// The shortest decimal number that is this one in single precision.
double shortest(float value);
/// Text up to its first zero.
DecodedValue text_value(std::string_view characters);

/// Walks a field list and names what it meets.
class FieldLister {
public:
    explicit FieldLister(std::string_view names) : names_(names) {}

    template <class... T>
    void operator()(const T&... field) {
        (list(field), ...);
    }
    template <class T>
    void count(const std::vector<T>&) {}
    template <class T>
    void items(const std::vector<T>& list) {
        const FieldName name = next();
        add(name, list_value(list, name));
    }
    template <class T>
    void rest(const std::vector<T>& list, std::size_t, std::size_t) {
        items(list);
    }
    template <class T>
    void if_present(const std::optional<T>& field) {
        if (field) list(*field);
    }
    void sized(std::uint64_t value, std::size_t) { list(value); }

    [[nodiscard]] std::vector<DecodedField> take() { return std::move(fields_); }
    /// Every name was used, and none was missing.
    [[nodiscard]] bool names_fit() const { return fit_ && names_.empty(); }

private:
    FieldName next() {
        const FieldName name = next_field_name(names_);
        if (name.name.empty()) fit_ = false;
        return name;
    }
    void add(const FieldName& name, DecodedValue value) {
        if (!name.hidden) fields_.push_back({std::string(name.name), std::move(value)});
    }
    template <class T>
    static DecodedValue number_value(T value, const FieldName& name) {
        if constexpr (std::is_same_v<T, float>)
            return scaled_value(shortest(value), name);
        else if constexpr (std::is_floating_point_v<T>)
            return scaled_value(static_cast<double>(value), name);
        else if constexpr (std::is_signed_v<T>)
            return scaled_value(static_cast<std::int64_t>(value), name);
        else
            return scaled_value(static_cast<std::uint64_t>(value), name);
    }
    template <field_list::Number T>
    void list(T value) {
        const FieldName name = next();
        add(name, number_value(value, name));
    }
    template <class T, std::size_t N>
    void list(const std::array<T, N>& fields) {
        const FieldName name = next();
        add(name, list_value(fields, name));
    }
    template <class T>
    requires(!field_list::Number<T>) void list(const T& group) { walk_fields(group, *this); }

    template <class List>
    DecodedValue list_value(const List& list, const FieldName& name) {
        using T = typename List::value_type;
        if constexpr (std::is_same_v<T, char>) {
            return text_value({list.data(), list.size()});
        } else {
            std::vector<DecodedValue> values;
            for (const T& item : list)
                values.push_back(item_value(item, name));
            return {std::move(values)};
        }
    }
    template <class T>
    DecodedValue item_value(const T& item, const FieldName& name) {
        if constexpr (field_list::Number<T>) {
            return number_value(item, name);
        } else {
            FieldLister group(name.items.empty() ? std::string_view("value") : name.items);
            walk_fields(item, group);
            fit_ = fit_ && group.names_fit();
            std::vector<DecodedField> fields = group.take();
            if (name.items.empty() && !fields.empty()) return std::move(fields.front().value);
            return {std::move(fields)};
        }
    }

    std::string_view names_;
    std::vector<DecodedField> fields_;
    bool fit_ = true;
};

/// How a UBX message with a known layout is listed.
struct UbxListing {
    UbxMessageId id;
    /// The message's fields; nothing when the payload is not of this layout.
    std::optional<std::vector<DecodedField>> (*list)(ByteSpan payload);
    bool (*names_fit)();  ///< as many names as fields
};

/// All of them. A message with several layouts stands there several times; the first that fits holds.
std::span<const UbxListing> ubx_listings();

/// Fills fields or payload of a message whose protocol and size are set.
void list_ubx(const UbxFrameView& frame, DecodedMessage& message);
void list_nmea(const SentenceView& sentence, DecodedMessage& message);
/// @param payload between length and CRC
void list_rtcm3(ByteSpan payload, DecodedMessage& message);

}  // namespace skyloop::inline receiver
