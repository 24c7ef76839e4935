/// libusb, owned: its session, its devices, their handles, and its words for what went wrong.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "wire/usb/usb_address.hpp"

struct libusb_context;
struct libusb_device;
struct libusb_device_handle;

namespace skyloop {

/// A session of libusb. Devices and handles keep it alive.
using UsbContext = std::shared_ptr<libusb_context>;
/// A device that was plugged in when it was listed; held by count.
using UsbDevice = std::shared_ptr<libusb_device>;
/// An opened device; closed with the last owner.
using UsbHandle = std::shared_ptr<libusb_device_handle>;

/// Fails with `outside` where the system has no USB to offer.
Result<UsbContext> open_usb();
/// What is plugged in, in the order of libusb. Fails with `outside`.
Result<std::vector<UsbDevice>> list_usb_devices(const UsbContext& context);
/// Ids and port path of a device; the texts as sysfs has them, which needs no permission, or else, where the device may
/// be opened, as it tells them itself.
UsbDeviceInfo describe(const UsbDevice& device);
/// The first device of that address. Fails with `outside`: no such device, and what is there of the same ids.
Result<UsbDevice> find_usb_device(const UsbContext& context, const UsbAddress& address);
/// Fails with `outside`; without permission the sentence names the node and what would give it.
Result<UsbHandle> open_usb_device(const UsbContext& context, const UsbDevice& device);

/// "no such device (it may have been disconnected)" and the like, of a negative result of libusb.
std::string usb_error_text(int result);

}  // namespace skyloop
