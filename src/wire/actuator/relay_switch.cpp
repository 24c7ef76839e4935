#include <fmt/format.h>

#include <utility>
#include <vector>

#include "detail/switch_parts.hpp"
#include "wire/actuator/hid_switches.hpp"
#include "wire/hid/hid_device.hpp"

namespace skyloop {
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
        const auto now = state();
        if (!now) return fail(now.error());
        if (*now && **now != wanted)
            return fail(ErrorCode::outside, fmt::format("{} did not follow: the board says it is {}", description(),
                                                        drawn ? "not drawn" : "drawn"));
        return {};
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

}  // namespace skyloop
