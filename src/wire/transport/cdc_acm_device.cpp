#include "wire/transport/cdc_acm_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace skyloop::inline wire {
namespace {

// USB 2.0, table 9-4.
constexpr std::uint8_t get_status = 0, clear_feature = 1, set_feature = 3, set_address = 5, get_descriptor = 6,
                       get_configuration = 8, set_configuration = 9, get_interface = 10, set_interface = 11;
// USB 2.0, table 9-5.
constexpr std::uint8_t device_type = 1, configuration_type = 2, string_type = 3;
constexpr std::uint16_t endpoint_halt = 0;  // USB 2.0, table 9-6
// PSTN 1.2, table 13.
constexpr std::uint8_t set_line_coding = 0x20, get_line_coding = 0x21, set_control_line_state = 0x22, send_break = 0x23;
constexpr std::size_t line_coding_bytes = 7;
constexpr std::uint16_t us_english = 0x0409;
constexpr std::uint8_t interfaces = 2, to_host_bit = 0x80;
constexpr std::size_t longest_text = 126;  // UTF-16 units in a string descriptor of 254 bytes

std::uint8_t low(std::uint16_t value) { return static_cast<std::uint8_t>(value & 0xFF); }
std::uint8_t high(std::uint16_t value) { return static_cast<std::uint8_t>(value >> 8); }

// Text beyond ASCII is left out: no receiver's has any.
Bytes string_descriptor(std::string_view text) {
    Bytes bytes{0, string_type};
    for (const char c : text.substr(0, longest_text))
        if (static_cast<unsigned char>(c) < 0x80) bytes.insert(bytes.end(), {static_cast<std::uint8_t>(c), 0});
    bytes[0] = static_cast<std::uint8_t>(bytes.size());
    return bytes;
}

// USB 2.0, table 9-13.
void put_endpoint(Bytes& bytes, std::uint8_t address, std::uint8_t attributes, std::uint8_t interval) {
    bytes.insert(bytes.end(),
                 {7, 5, address, attributes, static_cast<std::uint8_t>(CdcAcmDevice::packet_bytes), 0, interval});
}

Bytes configuration_bytes() {
    constexpr std::uint8_t interrupt = 3, bulk = 2, poll_every_ms = 255;
    Bytes bytes{9, configuration_type, 0, 0, interfaces, 1, 0, 0xC0, 0};  // powered by itself
    bytes.insert(bytes.end(), {9, 4, 0, 0, 1, 2, 2, 1, 0});               // communication, ACM, AT commands
    bytes.insert(bytes.end(), {5, 0x24, 0, 0x10, 0x01});                  // header: CDC 1.10
    bytes.insert(bytes.end(), {5, 0x24, 1, 0, 1});                        // call management: none
    bytes.insert(bytes.end(), {4, 0x24, 2, 0x06});                        // ACM: line coding and state; break
    bytes.insert(bytes.end(), {5, 0x24, 6, 0, 1});                        // union of interfaces 0 and 1
    put_endpoint(bytes, to_host_bit | CdcAcmDevice::notify_in, interrupt, poll_every_ms);
    bytes.insert(bytes.end(), {9, 4, 1, 0, 2, 10, 0, 0, 0});  // data
    put_endpoint(bytes, CdcAcmDevice::data_out, bulk, 0);
    put_endpoint(bytes, to_host_bit | CdcAcmDevice::data_in, bulk, 0);
    bytes[2] = static_cast<std::uint8_t>(bytes.size());
    return bytes;
}

// The number of an endpoint that the device has, from its address in wIndex.
std::optional<std::uint8_t> endpoint_of(std::uint16_t index) {
    if (index == CdcAcmDevice::data_out) return CdcAcmDevice::data_out;
    for (const std::uint8_t in : {CdcAcmDevice::data_in, CdcAcmDevice::notify_in})
        if (index == (to_host_bit | in)) return in;
    return std::nullopt;
}

std::optional<UsbLineCoding> read_coding(ByteSpan data) {
    constexpr std::uint8_t most_stop_bits = 2, most_parity = 4;
    if (data.size() != line_coding_bytes) return std::nullopt;
    UsbLineCoding coding;
    coding.baud = 0;
    for (std::size_t i = 0; i < 4; ++i)
        coding.baud |= std::uint32_t{data[i]} << 8 * i;
    coding.stop_bits = data[4];
    coding.parity = data[5];
    coding.data_bits = data[6];
    const bool known_bits = (coding.data_bits >= 5 && coding.data_bits <= 8) || coding.data_bits == 16;
    if (coding.stop_bits > most_stop_bits || coding.parity > most_parity || !known_bits) return std::nullopt;
    return coding;
}

Bytes coding_bytes(const UsbLineCoding& c) {
    const auto byte = [&](int shift) { return static_cast<std::uint8_t>(c.baud >> shift & 0xFF); };
    return {byte(0), byte(8), byte(16), byte(24), c.stop_bits, c.parity, c.data_bits};
}

// An answer without data, or a stall.
std::optional<Bytes> done(bool taken) { return taken ? std::optional<Bytes>(Bytes{}) : std::nullopt; }

}  // namespace

UsbSetup parse_usb_setup(const std::array<std::uint8_t, 8>& bytes) {
    const auto two = [&](std::size_t at) { return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8); };
    return {bytes[0], bytes[1], two(2), two(4), two(6)};
}

std::string to_string(const UsbLineCoding& coding) {
    constexpr std::string_view parities = "NOEMS";
    constexpr std::array<std::string_view, 3> stops{"1", "1.5", "2"};
    return fmt::format("{} {}{}{}", coding.baud, coding.data_bits, parities[coding.parity % parities.size()],
                       stops[coding.stop_bits % stops.size()]);
}

// USB 2.0, table 9-8: USB 1.1, class "communication", one configuration.
CdcAcmDevice::CdcAcmDevice(const UsbFace& face) : configuration_(configuration_bytes()) {
    strings_ = {Bytes{4, string_type, low(us_english), high(us_english)}, string_descriptor(face.manufacturer),
                string_descriptor(face.product)};
    if (!face.serial.empty()) strings_.push_back(string_descriptor(face.serial));
    device_ = {18, device_type, 0x10, 0x01, 2, 0, 0, static_cast<std::uint8_t>(packet_bytes)};
    for (const std::uint16_t number : {face.ids.vendor, face.ids.product, face.release})
        device_.insert(device_.end(), {low(number), high(number)});
    device_.insert(device_.end(), {1, 2, static_cast<std::uint8_t>(face.serial.empty() ? 0 : 3), 1});
}

std::optional<Bytes> CdcAcmDevice::control(const UsbSetup& setup, ByteSpan data) {
    constexpr std::uint8_t kind_bits = 0x60, standard_kind = 0, class_kind = 0x20;
    std::optional<Bytes> answer;
    if ((setup.type & kind_bits) == standard_kind) answer = standard(setup);
    if ((setup.type & kind_bits) == class_kind) answer = of_class(setup, data);
    if (answer && answer->size() > setup.length) answer->resize(setup.length);
    return answer;
}

std::optional<Bytes> CdcAcmDevice::standard(const UsbSetup& setup) {
    constexpr std::uint8_t device = 0, interface = 1, endpoint = 2;
    const std::uint8_t to = setup.type & 0x1F;
    const bool known_interface = configured_ && setup.index < interfaces;
    if (setup.to_host()) {
        if (setup.request == get_status) return status(setup);
        if (setup.request == get_descriptor && to == device) return descriptor(setup);
        if (setup.request == get_configuration && to == device) return Bytes{static_cast<std::uint8_t>(configured_)};
        if (setup.request == get_interface && to == interface && known_interface) return Bytes{0};
        return std::nullopt;
    }
    switch (setup.request) {
        case set_address:  // the host's controller has given it one
            return done(to == device);
        case set_configuration:
            return done(to == device && configure(setup.value));
        case set_interface:
            return done(to == interface && known_interface && setup.value == 0 && begin_anew(setup.index));
        case set_feature:
        case clear_feature:
            return done(to == endpoint && set_halt(setup, setup.request == set_feature));
        default:
            return std::nullopt;
    }
}

// USB 2.0, 9.4.5: of the device that it is powered by itself, of an endpoint that it is halted.
std::optional<Bytes> CdcAcmDevice::status(const UsbSetup& setup) const {
    switch (setup.type & 0x1F) {
        case 0:
            return Bytes{1, 0};
        case 1:
            if (configured_ && setup.index < interfaces) return Bytes{0, 0};
            return std::nullopt;
        case 2:
            if ((setup.index & 0x7F) == 0) return Bytes{0, 0};
            if (const auto endpoint = endpoint_of(setup.index); endpoint && configured_)
                return Bytes{static_cast<std::uint8_t>(halted_[*endpoint]), 0};
            return std::nullopt;
        default:
            return std::nullopt;
    }
}

// A device of full speed alone has no qualifier, and one of USB 1.1 no capabilities: these stall.
std::optional<Bytes> CdcAcmDevice::descriptor(const UsbSetup& setup) const {
    const std::uint8_t index = low(setup.value);
    switch (high(setup.value)) {
        case device_type:
            return device_;
        case configuration_type:
            return index == 0 ? std::optional<Bytes>(configuration_) : std::nullopt;
        case string_type:
            return index < strings_.size() ? std::optional<Bytes>(strings_[index]) : std::nullopt;
        default:
            return std::nullopt;
    }
}

bool CdcAcmDevice::set_halt(const UsbSetup& setup, bool halted) {
    const auto endpoint = endpoint_of(setup.index);
    if (!configured_ || !endpoint || setup.value != endpoint_halt) return false;
    halted_[*endpoint] = halted;
    return true;
}

// An interface that is set begins with its endpoints (USB 2.0, 9.1.1.5).
bool CdcAcmDevice::begin_anew(std::uint16_t interface) {
    if (interface == 0) halted_[notify_in] = false;
    if (interface == 1) halted_[data_out] = halted_[data_in] = false;
    return true;
}

bool CdcAcmDevice::configure(std::uint16_t value) {
    if (value > 1) return false;
    configured_ = value == 1;
    halted_ = {};
    notify_ = configured_;
    overrun_ = false;
    lines_ = 0;
    coding_.reset();
    break_.reset();
    return true;
}

std::optional<Bytes> CdcAcmDevice::of_class(const UsbSetup& setup, ByteSpan data) {
    constexpr std::uint8_t from_interface = 0xA1, to_interface = 0x21;
    if (!configured_ || setup.index != 0) return std::nullopt;
    if (setup.type == from_interface && setup.request == get_line_coding)
        return coding_bytes(coding_.value_or(UsbLineCoding{}));
    if (setup.type != to_interface) return std::nullopt;
    switch (setup.request) {
        case set_line_coding: {
            const auto coding = read_coding(data);
            if (coding) coding_ = coding;
            return done(coding.has_value());
        }
        case set_control_line_state:
            lines_ = setup.value;
            return Bytes{};
        case send_break:
            break_ = setup.value;
            return Bytes{};
        default:
            return std::nullopt;
    }
}

std::optional<std::uint16_t> CdcAcmDevice::take_break() { return std::exchange(break_, std::nullopt); }

std::optional<Bytes> CdcAcmDevice::take_notification() {
    constexpr std::uint8_t carrier = 1, dsr = 2, overrun = 0x40;
    if (!configured_ || !std::exchange(notify_, false)) return std::nullopt;
    const bool lost = std::exchange(overrun_, false);
    return Bytes{0xA1, 0x20, 0, 0, 0, 0, 2, 0, static_cast<std::uint8_t>(carrier | dsr | (lost ? overrun : 0)), 0};
}

}  // namespace skyloop::inline wire
