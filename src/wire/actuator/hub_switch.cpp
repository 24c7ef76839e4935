#include <fcntl.h>
#include <fmt/format.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "base/core/file_descriptor.hpp"
#include "detail/switch_parts.hpp"
#include "wire/usb/hub_port_power.hpp"

namespace skyloop::inline wire {
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
        if (cut_since_ && claim_.open()) std::this_thread::sleep_until(*cut_since_ + until_kernel_has_looked);
        release_port();
    }

    Result<void> cut() override {
        // Before what is plugged in goes. Without it, on old kernels or where another program has it, the port may come
        // back by itself, which is seen when the cut ends.
        if (!claim_.open()) claim_port();
        auto done = set(PowerState::cut);
        if (done) cut_since_ = HubClock::now();
        return done;
    }
    Result<void> restore() override {
        cut_since_.reset();
        release_port();  // what comes back wants its driver
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
        return check_followed(
            *this, wanted, wanted == PowerState::on ? "the hub says its power is off" : "the hub says its power is on");
    }
    // From now on the kernel's hub driver neither switches the port's power on again, as it otherwise does where what
    // was plugged in has gone, nor gives a driver to what appears there (libusb has no call for it). The kernel takes
    // the claim back from a process that ends; it may not allow it, or somebody else has it.
    void claim_port() {
        auto number = static_cast<unsigned>(port_.number());
        claim_ = FileDescriptor(::open(port_.hub().node.c_str(), O_RDWR | O_CLOEXEC));
        if (::ioctl(claim_.value(), USBDEVFS_CLAIM_PORT, &number) != 0) claim_ = FileDescriptor();
    }
    void release_port() {
        auto number = static_cast<unsigned>(port_.number());
        if (claim_.open()) ::ioctl(claim_.value(), USBDEVFS_RELEASE_PORT, &number);
        claim_ = FileDescriptor();
    }

    HubPort port_;
    FileDescriptor claim_;  // of the port, by the node of its hub, while the power is off
    std::optional<HubClock::time_point> cut_since_;
};

}  // namespace

Result<std::unique_ptr<Actuator>> open_switch(const HubPortAddress& address) {
    auto port = HubPort::open(address.port_path);
    if (!port) return fail(port.error());
    return std::make_unique<HubSwitch>(std::move(*port));
}

}  // namespace skyloop::inline wire
