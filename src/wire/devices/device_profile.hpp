/// What is known of the boards and adapters of a bench, by their USB ids and the texts that they tell of themselves.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wire/usb/usb_device.hpp"

namespace skyloop::inline wire {

/// What a device is on a bench.
enum class DeviceKind { autopilot, receiver, bridge, relay, gpio, hub, bootloader };
/// "autopilot" and so on, as device files write it.
std::string_view device_kind_name(DeviceKind kind);

/// By which transport a device is reached, if by any.
enum class DeviceTransport { none, serial, usb, hid };
/// "serial" and so on; empty for none.
std::string_view device_transport_name(DeviceTransport transport);

/// One device of a device file (boards/README.md). Patterns are texts in which `*` stands for any text, `?` for one
/// character and `[abc]` for one of these.
struct DeviceProfile {
    std::string name;         ///< "ftdi-ft-x"
    std::string description;  ///< one line for people
    DeviceKind kind = DeviceKind::bridge;
    std::vector<UsbIds> ids;
    std::vector<std::string> products;       ///< patterns of its product string
    std::vector<std::string> manufacturers;  ///< patterns of its manufacturer string; one pattern of either fits it
    std::vector<UsbIds> bootloader_ids;      ///< while its bootloader runs
    std::vector<std::string> bootloader_products;  ///< patterns of its product string while its bootloader runs
    std::string good_for;                          ///< one line for people
    DeviceTransport transport = DeviceTransport::none;
    std::uint32_t baud = 0;              ///< bit/s that it is spoken to with unless told otherwise; 0: any
    std::uint32_t max_baud = 0;          ///< bit/s, its fastest; 0: not known
    std::uint32_t latency_timer_ms = 0;  ///< what its driver's latency_timer is to be; 0: it has none
    std::vector<std::string> hints;      ///< lines for people

    /// Whether its strings must fit, because others share its ids.
    [[nodiscard]] bool needs_strings() const { return !products.empty() || !manufacturers.empty(); }
};

/// Which profile a device has.
struct DeviceMatch {
    const DeviceProfile* profile;  ///< of the span that was searched
    bool bootloader;               ///< it is that device, but its bootloader runs
};

/// Whether all of `text` is what `pattern` describes.
bool matches_pattern(std::string_view text, std::string_view pattern);

/// The first profile of the device's ids whose strings fit; else the first of its ids that needs none; else the first
/// with its ids as those of a bootloader.
std::optional<DeviceMatch> match_device(std::span<const DeviceProfile> profiles, const UsbDeviceInfo& device);

/// A file for /etc/udev/rules.d that lets whoever sits at the machine, and the groups dialout and plugdev, use every
/// device of these profiles, keeps ModemManager away from them, and sets their latency timers (udev(7)).
std::string udev_rules(std::span<const DeviceProfile> profiles);
/// The lines of that file for one pair of ids.
std::string udev_rules_of(UsbIds ids);

}  // namespace skyloop::inline wire
