/// Devices as text and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "wire/devices/device_list.hpp"

namespace skyloop::host {

/// The table of `skyloop devices`, a device a line, under it what else there is to say.
std::string device_table(std::span<const DeviceEntry> devices);
/// One line: "+ 1-2 0403:6015 bridge /dev/ttyUSB0 FTDI ...", with its doubts under it.
std::string device_news_line(const DeviceNews& news);
/// docs/known_devices.md
std::string known_devices_page(std::span<const DeviceProfile> profiles);

/// The keys are written in docs/devices.md.
nlohmann::ordered_json device_json(const DeviceEntry& device);
nlohmann::ordered_json known_device_json(const DeviceProfile& profile);
/// On one line, whatever bytes its texts hold.
std::string json_line(const nlohmann::ordered_json& json);

}  // namespace skyloop::host
