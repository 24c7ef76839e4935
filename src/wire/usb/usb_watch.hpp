/// Which USB devices come and go.
#pragma once

#include <chrono>
#include <memory>
#include <vector>

#include "base/core/result.hpp"
#include "wire/usb/usb_device.hpp"

namespace skyloop::inline wire {

/// One device that was plugged in or taken out.
struct UsbChange {
    bool arrived;
    UsbDeviceInfo device;  ///< of one that left: what was known of it while it was there
};

/// How coming and going is noticed.
enum class UsbWatchMode {
    automatic,  ///< by hotplug where udevd runs (it has its socket in /run/udev), else by polling
    hotplug,    ///< told by libusb, at once
    polling,    ///< by looking every half second: what was there in between only is not seen
};

/// Tells of each device that comes or goes; not for several threads at once.
class UsbWatch {
public:
    /// Fails with `outside` where the system has no USB to offer.
    static Result<UsbWatch> start(UsbWatchMode mode = UsbWatchMode::automatic);
    UsbWatch(UsbWatch&&) noexcept;
    UsbWatch& operator=(UsbWatch&&) noexcept;
    ~UsbWatch();

    /// What has come and gone since the last call, in order; at the first call what is there has come. Waits for
    /// something to happen, `longest` at most. Fails with `outside`.
    Result<std::vector<UsbChange>> wait(std::chrono::milliseconds longest);
    [[nodiscard]] bool polls() const;

private:
    class Source;
    class Hotplug;
    class Polling;
    explicit UsbWatch(std::unique_ptr<Source> source);
    std::unique_ptr<Source> source_;
};

}  // namespace skyloop::inline wire
