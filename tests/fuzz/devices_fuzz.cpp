// Any bytes as a device file: mistakes of one line each, or devices that rules and matches can be made of.
#include <cstdint>
#include <sstream>
#include <string>
#include <string_view>

#include "require.hpp"
#include "run/scenario/board_files.hpp"

namespace {

using namespace skyloop;

// A device of its ids is known by it or by one that its strings fit.
void check_device(const std::vector<DeviceProfile>& devices, const DeviceProfile& device) {
    require(!device.name.empty() && !device.ids.empty());
    require(device.max_baud == 0 || device.baud <= device.max_baud);
    for (const UsbIds ids : device.ids) {
        const auto match = match_device(devices, {ids, device.name, device.description, "", "1-1"});
        require(match.has_value() || device.needs_strings());
        require(!match || !match->profile->name.empty());
    }
    for (const UsbIds ids : device.bootloader_ids)
        require(match_device(devices, {ids, "", "", "", "1-1"}).has_value() || device.needs_strings());
}

// Rules are lines that udevd reads: nothing of a file may break out of them.
void check_rules(const std::string& rules) {
    std::istringstream lines(rules);
    for (std::string line; std::getline(lines, line);)
        require(line.empty() || line.starts_with("#") || line.starts_with("SUBSYSTEM==\"") ||
                line.starts_with("ACTION==\""));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto devices = read_devices({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    if (!devices) {
        require(devices.error().code == ErrorCode::input && !devices.error().message.empty());
        std::istringstream lines(devices.error().message);
        for (std::string line; std::getline(lines, line);)
            require(line.starts_with("fuzz.toml:") && line.size() < 2000);
        return 0;
    }
    require(!devices->empty());
    for (const DeviceProfile& device : *devices)
        check_device(*devices, device);
    check_rules(udev_rules(*devices));
    return 0;
}
