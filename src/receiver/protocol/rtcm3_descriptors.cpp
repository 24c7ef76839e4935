#include "receiver/protocol/rtcm3_descriptors.hpp"

#include <algorithm>
#include <string_view>

namespace skyloop::inline receiver {
namespace {

constexpr int antenna_1007 = 1007, antenna_1008 = 1008, receiver_1033 = 1033;
constexpr std::size_t longest_descriptor = 31;  // DF029 and its like

bool is_descriptors(int number) { return number == antenna_1007 || number == antenna_1008 || number == receiver_1033; }

void put_counted(BitWriter& bits, std::string_view text) {
    const std::string_view told = text.substr(0, longest_descriptor);
    bits.put(told.size(), 8);
    for (const char c : told)
        bits.put(static_cast<unsigned char>(c), 8);
}

std::string get_counted(BitReader& bits) {
    std::string text;
    for (std::uint64_t left = bits.get(8); left > 0 && bits.ok(); --left)
        text += static_cast<char>(bits.get(8));
    return text;
}

}  // namespace

std::optional<Rtcm3Descriptors> decode_descriptors(const Rtcm3Message& message) {
    if (!is_descriptors(message.number)) return std::nullopt;
    BitReader bits(message.payload);
    Rtcm3Descriptors result;
    result.number = static_cast<int>(bits.get(12));
    result.station = static_cast<int>(bits.get(12));
    result.antenna = get_counted(bits);
    result.antenna_setup = static_cast<int>(bits.get(8));
    if (message.number != antenna_1007) result.antenna_serial = get_counted(bits);
    if (message.number == receiver_1033) {
        result.receiver = get_counted(bits);
        result.firmware = get_counted(bits);
        result.receiver_serial = get_counted(bits);
    }
    if (!bits.ok()) return std::nullopt;
    return result;
}

Bytes encode(const Rtcm3Descriptors& descriptors) {
    if (!is_descriptors(descriptors.number)) return {};
    BitWriter bits;
    bits.put_signed(descriptors.number, 12);
    bits.put_signed(descriptors.station, 12);
    put_counted(bits, descriptors.antenna);
    bits.put_signed(descriptors.antenna_setup, 8);
    if (descriptors.number != antenna_1007) put_counted(bits, descriptors.antenna_serial);
    if (descriptors.number == receiver_1033)
        for (const std::string* text : {&descriptors.receiver, &descriptors.firmware, &descriptors.receiver_serial})
            put_counted(bits, *text);
    return encode_rtcm3(bits.bytes());
}

}  // namespace skyloop::inline receiver
