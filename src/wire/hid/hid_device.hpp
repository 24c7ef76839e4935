/// A HID device through hidapi, by either of its backends.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "wire/usb/usb_device.hpp"

namespace skyloop::inline wire {

/// The two libraries of hidapi. They export the same names, so that each is loaded when it is first asked for.
enum class HidBackend {
    hidraw,  ///< through the kernel's driver; needs a /dev/hidrawN
    libusb,  ///< past it, which it detaches; for containers, and where another driver holds the device (MCP2221A)
};

struct HidApi;  // the functions of one backend

/// One opened HID device. Reports begin with their id, 0 for a device that numbers none. Calls of one device must not
/// overlap in time.
class HidDevice {
public:
    /// What has these ids, as one backend sees it: without permission the texts are those of sysfs. Fails with
    /// `outside`: no hidapi on this machine.
    static Result<std::vector<UsbDeviceInfo>> list(UsbIds ids, HidBackend backend);
    /// The first device of that address, through hidraw, else through libusb. Fails with `outside`: there is none, no
    /// permission (the sentence names the node and what gives it), or no hidapi on this machine. The sentence is that
    /// of the backend which has the device.
    static Result<HidDevice> open(const UsbAddress& address);
    /// Through one backend only.
    static Result<HidDevice> open(const UsbAddress& address, HidBackend backend);

    HidDevice(HidDevice&&) noexcept;
    HidDevice& operator=(HidDevice&&) noexcept;
    ~HidDevice();

    [[nodiscard]] const UsbDeviceInfo& info() const { return info_; }
    [[nodiscard]] HidBackend backend() const;
    /// Sends an output report. Fails with `outside`.
    Result<void> write(ByteSpan report);
    /// Sends a feature report. Fails with `outside`.
    Result<void> send_feature(ByteSpan report);
    /// Asks for feature report `id`, of `size` bytes with its id. What the device gave may be shorter. Fails with
    /// `outside`.
    Result<Bytes> get_feature(std::uint8_t id, std::size_t size);
    /// The next input report, its id first where the device numbers them; empty when none came within `wait` (0: none
    /// is there now). Fails with `outside` when the device is gone.
    Result<Bytes> read(std::chrono::milliseconds wait);

private:
    /// Nothing: no device of that address is there.
    static Result<std::optional<HidDevice>> open_if_there(const UsbAddress& address, HidBackend backend);
    HidDevice(const HidApi& api, void* device, UsbDeviceInfo info)
        : api_(&api), device_(device), info_(std::move(info)) {}
    Error last_error(const char* what) const;

    const HidApi* api_;
    void* device_;
    UsbDeviceInfo info_;
};

}  // namespace skyloop::inline wire
