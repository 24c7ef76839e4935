// Messages of DroneCAN against their DSDL: layouts that were written down here from it, and bytes that pydronecan
// wrote.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "base/core/crc16.hpp"
#include "receiver/protocol/dronecan_listing.hpp"
#include "receiver/protocol/dronecan_messages.hpp"
#include "receiver/protocol/dronecan_transfer.hpp"

namespace skyloop {
namespace {

using testing::ElementsAre;

// One field of a layout: u unsigned, i signed, f float, v void; '[' a list with its count, '(' one without.
struct Part {
    char kind = 'u';
    unsigned width = 0;
    unsigned repeated = 1, most = 0;
};

// "u56 i37 f32*3 f16[36 u8(128": DSDL in a line.
std::vector<Part> layout_of(const std::string& text) {
    std::vector<Part> parts;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t used = 0;
        Part part{text[at], static_cast<unsigned>(std::stoul(text.substr(at + 1), &used))};
        at += 1 + used;
        if (at < text.size() && text[at] == '*') part.repeated = static_cast<unsigned>(std::stoul(text.substr(at + 1)));
        if (at < text.size() && (text[at] == '[' || text[at] == '(')) {
            part.kind = text[at];
            part.most = static_cast<unsigned>(std::stoul(text.substr(at + 1)));
        }
        parts.push_back(part);
        at = text.find(' ', at);
        if (at == std::string::npos) break;
        ++at;
    }
    return parts;
}

// Bits as the specification draws them: a text of ones and zeros.
std::string drawn(std::uint64_t value, unsigned width) {
    std::string bits;
    unsigned left = width;
    while (left > 0) {
        const unsigned chunk = left < 8 ? left : 8;
        std::string byte;
        for (unsigned i = 0; i < chunk; ++i)
            byte.insert(byte.begin(), (value >> (width - left + i) & 1) != 0 ? '1' : '0');
        bits += byte;
        left -= chunk;
    }
    return bits;
}

Bytes packed_bits(std::string bits) {
    while (bits.size() % 8 != 0)
        bits += '0';
    Bytes bytes;
    for (std::size_t at = 0; at < bits.size(); at += 8)
        bytes.push_back(static_cast<std::uint8_t>(std::stoul(bits.substr(at, 8), nullptr, 2)));
    return bytes;
}

// The numbers of a message's fields, as the product holds them.
class Collector {
public:
    std::vector<std::uint64_t> numbers;
    template <class... T>
    void operator()(const T&... field) {
        (add(field), ...);
    }
    void skip(unsigned) {}

private:
    template <class T>
    void add(const T& field) {
        if constexpr (requires { T::counted; }) {
            numbers.push_back(field.size());
            for (const auto& item : field)
                keep(bit_list::raw_bits(item, T::item_width), T::item_width);
        } else if constexpr (requires { T::width; }) {
            if constexpr (requires { field.raw; })
                keep(bit_list::raw_bits(field.raw, T::width), T::width);
            else
                for (const auto& number : field)
                    keep(bit_list::raw_bits(number, T::width), T::width);
        } else if constexpr (requires { T::fields(field, *this); }) {
            T::fields(field, *this);
        } else {
            with_members(field, *this);
        }
    }
    void keep(std::uint64_t bits, unsigned width) {
        numbers.push_back(width == 64 ? bits : bits & ((std::uint64_t{1} << width) - 1));
    }
};

class Drawn {
public:
    std::string bits;
    std::vector<std::uint64_t> numbers;

    void draw(const std::vector<Part>& layout) {
        for (const Part& part : layout) {
            if (part.kind == 'v') {
                bits += std::string(part.width, '0');
                continue;
            }
            unsigned count = part.repeated;
            if (part.most != 0) {
                count = static_cast<unsigned>(random_() % (part.most + 1));
                numbers.push_back(count);
                unsigned length = 1;
                while ((1U << length) <= part.most)
                    ++length;
                if (part.kind == '[') bits += drawn(count, length);
            }
            for (unsigned i = 0; i < count; ++i)
                put(part.width, part.width == 16 || part.kind == 'f');
        }
    }

private:
    void put(unsigned width, bool is_float) {
        std::uint64_t value = random_();
        if (width < 64) value &= (std::uint64_t{1} << width) - 1;
        // Of floating point a bit of the exponent stays 0: what is not a number has many forms.
        if (is_float && width == 16) value &= ~(std::uint64_t{1} << 13);
        if (is_float && width == 32) value &= ~(std::uint64_t{1} << 27);
        numbers.push_back(value);
        bits += drawn(value, width);
    }
    std::mt19937_64 random_{7};
};

template <class Message>
void expect_layout(const std::string& layout) {
    SCOPED_TRACE(std::string(Message::type.name));
    Drawn drawn;
    for (int round = 0; round < 20; ++round) {
        drawn.bits.clear();
        drawn.numbers.clear();
        drawn.draw(layout_of(layout));
        const Bytes payload = packed_bits(drawn.bits);
        const auto message = decode_bits<Message>(payload);
        ASSERT_TRUE(message) << round;
        Collector seen;
        seen(*message);
        EXPECT_EQ(seen.numbers, drawn.numbers) << round;
        EXPECT_EQ(encode_bits(*message), payload) << round;
    }
}

TEST(DronecanMessages, HaveTheLayoutsOfTheirDsdl) {
    expect_layout<DronecanFix2>("u56 u56 u3 v13 u8 i37 i37 i27 i27 f32*3 u6 u2 u4 u6 f16[36 f16 u8(99");
    expect_layout<DronecanAuxiliary>("f16 f16 f16 f16 f16 f16 f16 u7 u6");
    expect_layout<DronecanRtcmStream>("u8 u8(128");
    expect_layout<DronecanHeading>("u1 u1 f16 f16");
    expect_layout<DronecanGnssStatus>("u32 u1 u23");
    expect_layout<DronecanMovingBaselineData>("u8(300");
    expect_layout<DronecanRelPosHeading>("u56 u1 f32 f32 f16 f16");
    expect_layout<DronecanNodeStatus>("u32 u2 u3 u3 u16");
    expect_layout<DronecanAllocation>("u7 u1 u8(16");
    expect_layout<DronecanGetNodeInfoResponse>("u32 u2 u3 u3 u16 u8 u8 u8 u32 u64 u8 u8 u8*16 u8[255 u8(80");
    expect_layout<DronecanRestartNodeRequest>("u40");
    expect_layout<DronecanRestartNodeResponse>("u1");
    expect_layout<DronecanExecuteOpcodeRequest>("u8 i48");
    expect_layout<DronecanExecuteOpcodeResponse>("i48 u1");
    expect_layout<DronecanBeginFirmwareUpdateRequest>("u8 u8(200");
    expect_layout<DronecanBeginFirmwareUpdateResponse>("u8 u8(127");
}

std::string hex(ByteSpan bytes) {
    std::string text;
    for (const std::uint8_t byte : bytes) {
        constexpr char digits[] = "0123456789abcdef";
        text += {digits[byte >> 4], digits[byte & 15]};
    }
    return text;
}

// The bytes are what pydronecan 1.0.27 writes for these values with the DSDL of dronecan/DSDL.
TEST(DronecanMessages, AreTheBytesThatPydronecanWrites) {
    DronecanFix2 fix;
    fix.timestamp = 1700000000123456;
    fix.gnss_timestamp = 1700000000000000;
    fix.time_standard = 2;
    fix.leap_seconds = 18;
    fix.longitude.set(-123.45678901);
    fix.latitude.set(47.397742);
    fix.height.set(488.123);
    fix.msl_height.set(-441);
    fix.velocity[0] = 1.5F;
    fix.velocity[1] = -2.25F;
    fix.velocity[2] = 0.125F;
    fix.satellites = 31;
    fix.status = 3;
    fix.mode = 2;
    fix.sub_mode = 1;
    fix.covariance = {1.0F, 1.0F, 2.5F, 0.01F, 0.01F, 0.01F};
    fix.pdop = 1.25F;
    EXPECT_EQ(
        hex(encode_bits(fix)),
        "40222018240a0600401e18240a06400012cbe32320efc1b418d06edc81c2c22fcf0000c03f000010c00000003e7f2046003c003c0041"
        "1f211f211f21003d");

    DronecanGetSetResponse parameter;
    parameter.value.tag = DronecanValue::integer_value;
    parameter.value.integer = -2;
    parameter.name = {'G', 'P', 'S', '_', 'T', 'Y', 'P', 'E'};
    EXPECT_EQ(hex(encode_bits(parameter)), "01feffffffffffffff0000004750535f54595045");

    DronecanAllocation allocation;
    allocation.node_id = 5;
    allocation.first_part = 1;
    allocation.unique_id = {1, 2};
    EXPECT_EQ(hex(encode_bits(allocation)), "0b0102");
}

TEST(DronecanMessages, TakeEachKindOfValue) {
    DronecanGetSetRequest request;
    request.index = 4711;
    request.name = {'N'};
    for (const auto tag : {DronecanValue::empty, DronecanValue::integer_value, DronecanValue::real_value,
                           DronecanValue::boolean_value, DronecanValue::string_value}) {
        request.value.tag = tag;
        request.value.integer = tag == DronecanValue::integer_value ? -5 : 0;
        request.value.real = tag == DronecanValue::real_value ? 0.5F : 0.0F;
        request.value.boolean = tag == DronecanValue::boolean_value ? 1 : 0;
        request.value.text = {};
        if (tag == DronecanValue::string_value) request.value.text = {'a', 'b'};
        const auto again = decode_bits<DronecanGetSetRequest>(encode_bits(request));
        ASSERT_TRUE(again);
        EXPECT_EQ(again->index, 4711U);
        EXPECT_EQ(again->value.tag, static_cast<std::uint64_t>(tag));
        EXPECT_EQ(again->value.integer, request.value.integer);
        EXPECT_EQ(again->value.real, request.value.real);
        EXPECT_EQ(again->value.boolean, request.value.boolean);
        EXPECT_EQ(again->value.text, request.value.text);
        EXPECT_THAT(again->name, ElementsAre('N'));
    }
}

TEST(DronecanMessages, OfAWrongLengthAreNone) {
    const Bytes status = encode_bits(DronecanNodeStatus{});
    EXPECT_EQ(status.size(), 7U);
    EXPECT_FALSE(decode_bits<DronecanNodeStatus>(ByteSpan(status).first(6)));
    Bytes longer = status;
    longer.push_back(0);
    EXPECT_FALSE(decode_bits<DronecanNodeStatus>(longer));
    EXPECT_FALSE(decode_bits<DronecanRtcmStream>(Bytes(130))) << "129 bytes of data";
    EXPECT_FALSE(decode_bits<DronecanRtcmStream>(Bytes()));
}

// IEEE 754, binary16: largest, smallest normal, smallest, ties to even.
TEST(DronecanFields, HaveHalfPrecision) {
    EXPECT_EQ(half_bits(1.0F), 0x3C00);
    EXPECT_EQ(half_bits(-2.0F), 0xC000);
    EXPECT_EQ(half_bits(65504.0F), 0x7BFF);
    EXPECT_EQ(half_bits(65519.0F), 0x7BFF);
    EXPECT_EQ(half_bits(65520.0F), 0x7C00) << "infinite";
    EXPECT_EQ(half_bits(6.103515625e-5F), 0x0400);
    EXPECT_EQ(half_bits(5.960464477539063e-8F), 0x0001);
    EXPECT_EQ(half_bits(1.00048828125F), 0x3C00) << "between two: the even one";
    EXPECT_EQ(half_bits(1.00146484375F), 0x3C02);
    EXPECT_EQ(half_bits(0.0F), 0);
    EXPECT_TRUE(std::isnan(half_value(half_bits(std::nanf("")))));
    for (unsigned bits = 0; bits < 0x7C00; ++bits)
        ASSERT_EQ(half_bits(half_value(static_cast<std::uint16_t>(bits))), bits);
}

TEST(DronecanFields, StayWithinTheirBits) {
    DronecanFix2 fix;
    fix.longitude.set(1e6);
    EXPECT_EQ(fix.longitude, (std::int64_t{1} << 36) - 1);
    fix.height.set(-1e9);
    EXPECT_EQ(fix.height, -(std::int64_t{1} << 26));
    fix.satellites.set(70);
    EXPECT_EQ(fix.satellites, 63U);
    fix.satellites.set(-1);
    EXPECT_EQ(fix.satellites, 0U);
}

// Facts of the transport layer: the check value of CRC-16-CCITT-FALSE, and the seed that a signature makes.
TEST(DronecanTypes, HaveTheSignaturesOfTheirDsdl) {
    EXPECT_EQ(crc16_ccitt(to_bytes("123456789"), 0xFFFF), 0x29B1);
    const std::uint64_t signature = DronecanFix2::type.signature;
    Bytes low_first;
    for (unsigned shift = 0; shift < 64; shift += 8)
        low_first.push_back(static_cast<std::uint8_t>(signature >> shift));
    EXPECT_EQ(crc16_ccitt(low_first, 0xFFFF), 0xC798);
    EXPECT_EQ(find_dronecan_type(DronecanKind::message, 1063)->name, "Fix2");
    EXPECT_EQ(find_dronecan_type(DronecanKind::message, 1063)->signature, 0xCA41E7000F37435FU);
    EXPECT_EQ(find_dronecan_type(DronecanKind::response, 1)->signature, 0xEE468A8121C46A9EU);
    EXPECT_EQ(find_dronecan_type(DronecanKind::request, 40)->signature, 0xB7D725DF72724126U);
    EXPECT_EQ(find_dronecan_type(DronecanKind::request, 1063), nullptr);
}

TEST(DronecanListing, NamesWhatATransferSays) {
    DronecanNodeStatus status;
    status.uptime = 12;
    const DronecanTransfer transfer{DronecanKind::message, 341, 24, 42, 0, 3, encode_bits(status)};
    const CanFrame frame = dronecan_frames(transfer, DronecanNodeStatus::type.signature).at(0);
    EXPECT_EQ(text_line(decode_piece({StreamKind::can, to_bytes(slcan_line(frame))})),
              "CAN NodeStatus source=42 transfer_id=3 uptime_s=12 health=0 mode=0 sub_mode=0 vendor_code=0");
}

}  // namespace
}  // namespace skyloop
