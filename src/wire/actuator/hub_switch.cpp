// A port of a hub that the kernel leaves alone.

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "detail/switch_parts.hpp"
#include "wire/usb/hub_port_power.hpp"

namespace skyloop::inline wire {

/// While it lives the kernel's hub driver neither switches the port's power on again, as it otherwise does where what
/// was plugged in has gone, nor gives a driver to what appears there (USBDEVFS_CLAIM_PORT). The kernel takes it back
/// from a process that ends. libusb has no call for it, so that it has a file of its own.
class HubPortClaim {
public:
    /// @param node of the hub, "/dev/bus/usb/001/004". Null: the kernel does not allow it, or somebody else has it.
    static std::unique_ptr<HubPortClaim> take(const std::string& node, int port);
    ~HubPortClaim();
    HubPortClaim(const HubPortClaim&) = delete;
    HubPortClaim& operator=(const HubPortClaim&) = delete;

private:
    HubPortClaim(int file, unsigned port) : file_(file), port_(port) {}
    int file_;
    unsigned port_;
};

std::unique_ptr<HubPortClaim> HubPortClaim::take(const std::string& node, int port) {
    const int file = ::open(node.c_str(), O_RDWR | O_CLOEXEC);
    if (file < 0) return nullptr;
    auto number = static_cast<unsigned>(port);
    if (::ioctl(file, USBDEVFS_CLAIM_PORT, &number) == 0)
        return std::unique_ptr<HubPortClaim>(new HubPortClaim(file, number));
    ::close(file);
    return nullptr;
}

HubPortClaim::~HubPortClaim() {
    ::ioctl(file_, USBDEVFS_RELEASE_PORT, &port_);
    ::close(file_);
}

namespace {

using HubClock = std::chrono::steady_clock;  // the kernel's hub driver lives by the host's time
// A hub tells within a quarter of a second that something has gone (its interrupt endpoint is asked that often), and
// only then would the kernel switch the port on again.
constexpr std::chrono::seconds until_kernel_has_looked{1};

class HubSwitch : public Actuator {
public:
    explicit HubSwitch(HubPort port) : port_(std::move(port)) {}
    // A cut outlives its switch only where the kernel has been kept off until it has looked.
    ~HubSwitch() override {
        if (cut_since_ && claim_) std::this_thread::sleep_until(*cut_since_ + until_kernel_has_looked);
    }

    Result<void> cut() override {
        // Before what is plugged in goes. Without it, on old kernels or where another program has it, the port may come
        // back by itself, which is seen when the cut ends.
        if (!claim_) claim_ = HubPortClaim::take(port_.hub().node, port_.number());
        auto done = set(PowerState::cut);
        if (done) cut_since_ = HubClock::now();
        return done;
    }
    Result<void> restore() override {
        cut_since_.reset();
        claim_.reset();  // what comes back wants its driver
        return set(PowerState::on);
    }
    Result<std::optional<PowerState>> state() override {
        const auto powered = port_.powered();
        if (!powered) return fail(powered.error());
        return *powered ? PowerState::on : PowerState::cut;
    }
    [[nodiscard]] std::string description() const override { return port_.description(); }
    [[nodiscard]] std::string lock_name() const override { return description(); }

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
    std::unique_ptr<HubPortClaim> claim_;  // while the power is off
    std::optional<HubClock::time_point> cut_since_;
};

}  // namespace

Result<std::unique_ptr<Actuator>> open_switch(const HubPortAddress& address) {
    auto port = HubPort::open(address.port_path);
    if (!port) return fail(port.error());
    return std::make_unique<HubSwitch>(std::move(*port));
}

}  // namespace skyloop::inline wire
