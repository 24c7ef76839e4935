#include "wire/actuator/modem_line.hpp"

#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <fmt/format.h>
#include <sys/ioctl.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/core/file_descriptor.hpp"
#include "detail/switch_parts.hpp"

namespace skyloop::inline wire {
namespace {

class ModemLineSwitch : public Actuator {
public:
    ModemLineSwitch(ModemLineAddress address, FileDescriptor device, std::shared_ptr<SerialSystem> system)
        : address_(std::move(address)), device_(std::move(device)), system_(std::move(system)) {}
    ~ModemLineSwitch() override {
        termios2 settings{};
        if (!waited_for_carrier_ || system_->control(device_.value(), TCGETS2, &settings) != 0) return;
        settings.c_cflag &= ~static_cast<tcflag_t>(CLOCAL);
        system_->control(device_.value(), TCSETS2, &settings);
    }

    // From whatever else moves it. False, and errno says why: the device does not allow it.
    [[nodiscard]] bool take_line() {
        termios2 settings{};
        if (system_->control(device_.value(), TCGETS2, &settings) != 0) return false;
        waited_for_carrier_ = (settings.c_cflag & CLOCAL) == 0;
        // Closing the device would drop both lines, and lost carrier close it. Given to flow control, RTS would follow
        // the driver's buffer instead of us. Neither comes back at the end: the level is to stay.
        settings.c_cflag &= ~static_cast<tcflag_t>(HUPCL);
        if (address_.line == ModemLineAddress::Line::rts) settings.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS);
        settings.c_cflag |= CLOCAL;
        return system_->control(device_.value(), TCSETS2, &settings) == 0;
    }

    Result<void> cut() override { return set(PowerState::cut); }
    Result<void> restore() override { return set(PowerState::on); }
    Result<std::optional<PowerState>> state() override {
        int lines = 0;
        if (system_->control(device_.value(), TIOCMGET, &lines) != 0) return fail(refused("be read"));
        return state_at((lines & bit()) != 0, address_.active);
    }
    [[nodiscard]] std::string description() const override {
        return fmt::format("{} of {}", address_.line == ModemLineAddress::Line::rts ? "RTS" : "DTR",
                           address_.device.string());
    }

private:
    [[nodiscard]] int bit() const { return address_.line == ModemLineAddress::Line::rts ? TIOCM_RTS : TIOCM_DTR; }
    [[nodiscard]] Error refused(const char* what) const {
        return {ErrorCode::outside, fmt::format("{} cannot {}: {}", description(), what, std::strerror(errno))};
    }
    Result<void> set(PowerState wanted) {
        int lines = bit();
        const bool assert = active_for(wanted, address_.active);
        if (system_->control(device_.value(), assert ? TIOCMBIS : TIOCMBIC, &lines) != 0)
            return fail(refused("be set"));
        return check_followed(*this, wanted,
                              assert ? "the driver says it is not asserted" : "the driver says it is asserted");
    }

    ModemLineAddress address_;
    FileDescriptor device_;
    std::shared_ptr<SerialSystem> system_;
    bool waited_for_carrier_ = false;  // before it was ours
};

Error line_error(const ModemLineAddress& address, std::string_view reason) {
    return {ErrorCode::outside, fmt::format("cannot use the modem lines of {}: {}", address.device.string(), reason)};
}

}  // namespace

Result<std::unique_ptr<Actuator>> open_modem_line(const ModemLineAddress& address,
                                                  std::shared_ptr<SerialSystem> system) {
    FileDescriptor device(system->open(address.device));
    if (!device.open()) return fail(line_error(address, std::strerror(errno)));
    if (system->lock(device.value()) != 0) return fail(line_error(address, "another program holds it (flock)"));
    int lines = 0;
    if (system->control(device.value(), TIOCMGET, &lines) != 0)
        return fail(line_error(address, errno == ENOTTY || errno == EINVAL ? "it has none" : std::strerror(errno)));
    auto line = std::make_unique<ModemLineSwitch>(address, std::move(device), std::move(system));
    if (!line->take_line()) return fail(line_error(address, std::strerror(errno)));
    return line;
}

Result<std::unique_ptr<Actuator>> open_switch(const ModemLineAddress& address) {
    return open_modem_line(address, std::make_shared<SerialSystem>());
}

}  // namespace skyloop::inline wire
