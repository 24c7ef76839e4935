#include <fmt/format.h>

#include <utility>

#include "detail/switch_parts.hpp"
#include "wire/actuator/hid_switches.hpp"
#include "wire/hid/hid_device.hpp"

namespace skyloop {
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

}  // namespace skyloop
