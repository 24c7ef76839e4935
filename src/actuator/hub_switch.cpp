#include <fmt/format.h>

#include <utility>

#include "skyloop/usb/hub_port_power.hpp"
#include "switch_parts.hpp"

namespace skyloop {
namespace {

class HubSwitch : public Actuator {
public:
    explicit HubSwitch(HubPort port) : port_(std::move(port)) {}

    Result<void> cut() override { return set(PowerState::cut); }
    Result<void> restore() override { return set(PowerState::on); }
    Result<std::optional<PowerState>> state() override {
        const auto powered = port_.powered();
        if (!powered) return fail(powered.error());
        return *powered ? PowerState::on : PowerState::cut;
    }
    [[nodiscard]] std::string description() const override { return port_.description(); }

private:
    Result<void> set(PowerState wanted) {
        if (auto done = port_.set_power(wanted == PowerState::on); !done) return done;
        const auto now = state();
        if (!now) return fail(now.error());
        if (**now != wanted)
            return fail(ErrorCode::outside, fmt::format("{} did not follow: the hub says its power is {}",
                                                        description(), wanted == PowerState::on ? "off" : "on"));
        return {};
    }
    HubPort port_;
};

}  // namespace

Result<std::unique_ptr<Actuator>> open_switch(const HubPortAddress& address) {
    auto port = HubPort::open(address.port_path);
    if (!port) return fail(port.error());
    return std::make_unique<HubSwitch>(std::move(*port));
}

}  // namespace skyloop
