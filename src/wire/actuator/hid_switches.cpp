#include "wire/actuator/hid_switches.hpp"

#include <algorithm>

namespace skyloop {
namespace {

constexpr std::size_t relay_report_size = 8;  // without its id
constexpr std::size_t relay_serial_size = 5;
constexpr int most_relays = 8;  // a state of one byte

}  // namespace

std::optional<RelayBoard> relay_board(std::string_view product) {
    // These have as many relays as they have; an order to one that is not there does nothing.
    if (product.starts_with("HIDRelay")) return RelayBoard{RelayBoard::Kind::ucreate, most_relays};
    constexpr std::string_view prefix = "USBRelay";
    if (!product.starts_with(prefix) || product.size() != prefix.size() + 1) return std::nullopt;
    const int relays = product.back() - '0';
    if (relays < 1 || relays > most_relays) return std::nullopt;
    return RelayBoard{RelayBoard::Kind::dcttech, relays};
}

Bytes relay_report(RelayBoard::Kind kind, int number, bool drawn) {
    Bytes report(1 + relay_report_size);
    const auto relay = static_cast<std::uint8_t>(number);
    if (kind == RelayBoard::Kind::dcttech) {
        report[1] = drawn ? 0xFF : 0xFD;
        report[2] = relay;
    } else {
        report[1] = static_cast<std::uint8_t>((drawn ? 0xF0 : 0x00) + relay);
    }
    return report;
}

std::optional<RelayStates> relay_states(ByteSpan report) {
    if (report.size() != relay_report_size && report.size() != relay_report_size + 1) return std::nullopt;
    const ByteSpan data = report.last(relay_report_size);
    const std::string serial = to_string(data.first(relay_serial_size));
    return RelayStates{serial.substr(0, serial.find('\0')), data.back()};
}

namespace mcp2221 {
namespace {

constexpr std::uint8_t set_gpio = 0x50, get_gpio = 0x51, set_sram = 0x60, get_sram = 0x61;
constexpr std::size_t gpio_step_set = 4, gpio_step_get = 2, first_pin = 2;      // both begin with command and status
constexpr std::size_t dac_setting = 6, adc_setting = 7, settings_of_pins = 22;  // of get_sram
constexpr std::size_t new_dac_reference = 3, new_adc_reference = 5, alter_pins = 7, new_settings = 8;  // of set_sram
constexpr std::uint8_t alter = 0x80, duty = 0x07, input = 0x08, high_output = 0x10;  // all zeros: a low output

// One byte more: the id that hidapi wants.
Bytes command(std::uint8_t code) {
    Bytes report(1 + report_size);
    report[1] = code;
    return report;
}

std::size_t at(int number) { return static_cast<std::size_t>(number); }

// Where the settings tell the voltage (two bits) and the source (one bit) of a reference from bit `lowest` on.
std::uint8_t reference(std::uint8_t setting, int lowest) { return static_cast<std::uint8_t>(setting >> lowest & 7); }

// How a pin is to be set so that it stays as it is. The settings do not show what set_gpio has made of it since.
std::uint8_t as_it_is(ByteSpan settings, ByteSpan pins_now, int number) {
    const std::uint8_t setting = settings[settings_of_pins + at(number)];
    const std::uint8_t value = pins_now[first_pin + gpio_step_get * at(number)];
    const std::uint8_t direction = pins_now[first_pin + gpio_step_get * at(number) + 1];
    if ((setting & duty) != 0 || value > 1) return setting;
    if (direction != 0) return static_cast<std::uint8_t>(setting | input);
    return value == 1 ? high_output : 0;
}

}  // namespace

Bytes set_pin(int number, bool high) {
    Bytes report = command(set_gpio);
    const std::size_t pin = 1 + first_pin + gpio_step_set * at(number);
    report[pin] = 1;  // its value changes
    report[pin + 1] = high ? 1 : 0;
    report[pin + 2] = 1;  // its direction changes
    report[pin + 3] = 0;  // to an output
    return report;
}

Bytes get_pins() { return command(get_gpio); }

Bytes get_settings() { return command(get_sram); }

Bytes give_to_gpio(ByteSpan settings, ByteSpan pins_now, int number, bool high) {
    Bytes report = command(set_sram);
    // Left out, both references would fall back to the supply with any change of the pins (DS20005565, section 1.8).
    report[1 + new_dac_reference] = alter | reference(settings[dac_setting], 5);
    report[1 + new_adc_reference] = alter | reference(settings[adc_setting], 2);
    report[1 + alter_pins] = alter;
    for (int pin = 0; pin < pins; ++pin)
        report[1 + new_settings + at(pin)] = as_it_is(settings, pins_now, pin);
    report[1 + new_settings + at(number)] = high ? high_output : 0;
    return report;
}

bool is_answer(ByteSpan report, std::uint8_t code) {
    return report.size() == report_size && report[0] == code && report[1] == 0;
}

std::optional<bool> output_level(ByteSpan answer, int number) {
    if (!is_answer(answer, get_gpio)) return std::nullopt;
    const std::uint8_t value = answer[first_pin + gpio_step_get * at(number)];
    const std::uint8_t direction = answer[first_pin + gpio_step_get * at(number) + 1];
    if (value > 1 || direction != 0) return std::nullopt;  // EE, EF: not given to its GPIO
    return value == 1;
}

}  // namespace mcp2221

}  // namespace skyloop
