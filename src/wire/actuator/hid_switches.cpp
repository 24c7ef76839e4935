#include "wire/actuator/hid_switches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "detail/switch_parts.hpp"
#include "wire/hid/hid_device.hpp"

namespace skyloop::inline wire {
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
    const std::string serial = base::to_string(data.first(relay_serial_size));
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

namespace {

Result<RelayStates> ask_relays(HidDevice& device) {
    constexpr std::size_t answer_size = 9;
    // Boards of different age answer to one of both.
    Error refused;
    for (const std::uint8_t id : {std::uint8_t{0}, std::uint8_t{1}}) {
        const auto answer = device.get_feature(id, answer_size);
        if (!answer) {
            if (refused.message.empty()) refused = answer.error();
            continue;
        }
        if (auto states = relay_states(*answer)) return std::move(*states);
        refused = {ErrorCode::outside, fmt::format("HID device {} answered {} bytes; expected 8 or 9 of a relay board",
                                                   to_string(device.info().ids), answer->size())};
    }
    return fail(refused);
}

class RelaySwitch : public Actuator {
public:
    RelaySwitch(HidDevice device, RelayBoard board, RelayAddress address)
        : device_(std::move(device)), board_(board), address_(std::move(address)) {}

    Result<void> cut() override { return set(PowerState::cut); }
    Result<void> restore() override { return set(PowerState::on); }
    Result<std::optional<PowerState>> state() override {
        if (board_.kind == RelayBoard::Kind::ucreate) return std::optional<PowerState>();
        const auto states = ask_relays(device_);
        if (!states) return fail(states.error());
        const bool drawn = (states->drawn >> (address_.number - 1) & 1) != 0;
        return state_at(drawn, address_.active);
    }
    [[nodiscard]] std::string description() const override {
        const UsbDeviceInfo& info = device_.info();
        return fmt::format("relay {} of {} ({} at {})", address_.number, info.product, to_string(info.ids),
                           info.port_path);
    }
    [[nodiscard]] std::string lock_name() const override { return description(); }

private:
    Result<void> set(PowerState wanted) {
        const bool drawn = active_for(wanted, address_.active);
        const Bytes report = relay_report(board_.kind, address_.number, drawn);
        auto sent = board_.kind == RelayBoard::Kind::dcttech ? device_.send_feature(report) : device_.write(report);
        if (!sent && board_.kind == RelayBoard::Kind::dcttech) sent = device_.write(report);
        if (!sent) return sent;
        return check_followed(*this, wanted, drawn ? "the board says it is not drawn" : "the board says it is drawn");
    }

    HidDevice device_;
    RelayBoard board_;
    RelayAddress address_;
};

// Looks through what has the ids; keeps what to say when none of it is the board.
class RelaySearch {
public:
    explicit RelaySearch(const RelayAddress& address) : address_(address) {}

    std::unique_ptr<Actuator> through(HidBackend backend) {
        const auto devices = HidDevice::list(address_.board.ids, backend);
        if (!devices) {
            refuse(devices.error().message);
            return nullptr;
        }
        for (const UsbDeviceInfo& info : *devices)
            if (auto found = look_at(info, backend)) return found;
        return nullptr;
    }
    [[nodiscard]] Error error() const {
        return {ErrorCode::outside,
                refusal_.empty() ? fmt::format("no HID device {} is plugged in", to_string(address_.board)) : refusal_};
    }

private:
    std::unique_ptr<Actuator> look_at(const UsbDeviceInfo& info, HidBackend backend) {
        if (!address_.board.port_path.empty() && info.port_path != address_.board.port_path) return nullptr;
        const auto board = relay_board(info.product);
        if (!board) {
            refuse(fmt::format("{} at {} is '{}', no relay board; expected the product USBRelay1 to 8 or HIDRelay",
                               to_string(info.ids), info.port_path, info.product));
            return nullptr;
        }
        if (address_.number > board->relays) {
            refuse(fmt::format("{} at {} is '{}': it has no relay {}", to_string(info.ids), info.port_path,
                               info.product, address_.number));
            return nullptr;
        }
        auto device = HidDevice::open({info.ids, {}, info.port_path}, backend);
        if (!device) {
            refuse(device.error().message);
            return nullptr;
        }
        if (!has_serial(*device)) return nullptr;
        return std::make_unique<RelaySwitch>(std::move(*device), *board, address_);
    }
    // These boards keep theirs in the report, and leave that of USB empty.
    bool has_serial(HidDevice& device) {
        const std::string& wanted = address_.board.serial;
        if (wanted.empty() || device.info().serial == wanted) return true;
        const auto states = ask_relays(device);
        if (states && states->serial == wanted) return true;
        refuse(fmt::format("the relay board at {} has the serial number '{}'; expected '{}'", device.info().port_path,
                           states ? states->serial : device.info().serial, wanted));
        return false;
    }
    // The first refusal tells most: libusb is asked only because hidraw did not do.
    void refuse(const std::string& why) {
        if (refusal_.empty()) refusal_ = why;
    }

    const RelayAddress& address_;
    std::string refusal_;
};

}  // namespace

Result<std::unique_ptr<Actuator>> open_switch(const RelayAddress& address) {
    RelaySearch search(address);
    for (const HidBackend backend : {HidBackend::hidraw, HidBackend::libusb})
        if (auto found = search.through(backend)) return found;
    return fail(search.error());
}

namespace {

class GpioSwitch : public Actuator {
public:
    GpioSwitch(HidDevice device, GpioAddress address) : device_(std::move(device)), address_(std::move(address)) {}

    Result<void> cut() override { return set(PowerState::cut); }
    Result<void> restore() override { return set(PowerState::on); }
    Result<std::optional<PowerState>> state() override {
        const auto level = read_level();
        if (!level) return fail(level.error());
        if (!*level) return std::optional<PowerState>();
        return state_at(**level, address_.active);
    }
    [[nodiscard]] std::string description() const override {
        const UsbDeviceInfo& info = device_.info();
        return fmt::format("pin GP{} of {} ({} at {})", address_.number,
                           info.product.empty() ? "an MCP2221A" : info.product, to_string(info.ids), info.port_path);
    }
    [[nodiscard]] std::string lock_name() const override { return description(); }

private:
    // What has come for somebody else, another program or another pin of the chip, would be taken for an answer.
    Result<void> forget_old_answers() {
        constexpr int most_waiting = 64;  // reports that the kernel keeps
        for (int i = 0; i < most_waiting; ++i) {
            const auto old = device_.read(std::chrono::milliseconds(0));
            if (!old) return fail(old.error());
            if (old->empty()) break;
        }
        return {};
    }
    // The answer to a command.
    Result<Bytes> ask(const Bytes& command) {
        constexpr std::chrono::milliseconds patience{500};
        constexpr int most_strangers = 4;
        if (const auto forgotten = forget_old_answers(); !forgotten) return fail(forgotten.error());
        if (const auto sent = device_.write(command); !sent) return fail(sent.error());
        for (int i = 0; i <= most_strangers; ++i) {
            auto answer = device_.read(patience);
            if (!answer) return answer;
            if (mcp2221::is_answer(*answer, command[1])) return answer;
            if (!answer->empty() && answer->front() == command[1]) break;  // with an error
        }
        return fail(ErrorCode::outside, fmt::format("{} does not carry out command {:02x}", description(), command[1]));
    }
    // Nothing: the pin is no output, or not given to its GPIO.
    Result<std::optional<bool>> read_level() {
        const auto answer = ask(mcp2221::get_pins());
        if (!answer) return fail(answer.error());
        return mcp2221::output_level(*answer, address_.number);
    }
    Result<void> set(PowerState wanted) {
        const bool high = active_for(wanted, address_.active);
        if (const auto answer = ask(mcp2221::set_pin(address_.number, high)); !answer) return fail(answer.error());
        auto level = read_level();
        if (!level) return fail(level.error());
        if (!*level) {
            // From the factory on the pins are clocks, lamps and the like.
            const auto settings = ask(mcp2221::get_settings());
            if (!settings) return fail(settings.error());
            const auto pins_now = ask(mcp2221::get_pins());
            if (!pins_now) return fail(pins_now.error());
            const auto given = ask(mcp2221::give_to_gpio(*settings, *pins_now, address_.number, high));
            if (!given) return fail(given.error());
            level = read_level();
            if (!level) return fail(level.error());
        }
        if (*level != high)
            return fail(ErrorCode::outside,
                        fmt::format("{} did not follow: it is not {}", description(), high ? "high" : "low"));
        return {};
    }

    HidDevice device_;
    GpioAddress address_;
};

}  // namespace

Result<std::unique_ptr<Actuator>> open_switch(const GpioAddress& address) {
    auto device = HidDevice::open(address.board);
    if (!device) return fail(device.error());
    return std::make_unique<GpioSwitch>(std::move(*device), address);
}

}  // namespace skyloop::inline wire
