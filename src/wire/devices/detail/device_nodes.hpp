/// The files under /dev that belong to a device, by the paths of sysfs.
#pragma once

#include <string>
#include <vector>

#include "wire/devices/device_list.hpp"

namespace skyloop {

/// Where sysfs tells of the device at this port path.
std::filesystem::path sysfs_of_usb(const SystemFolders& folders, const std::string& port_path);
/// Of the device at the port of `usb`, serial lines first.
std::vector<DeviceNode> nodes_of_usb(const UsbDeviceInfo& usb, const SystemFolders& folders);
/// A serial line by its name, "ttyAMA0", without interface and driver.
DeviceNode serial_node(const std::string& name, const SystemFolders& folders);

}  // namespace skyloop
