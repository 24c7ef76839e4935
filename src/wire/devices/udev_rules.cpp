// Rules that let a person use the devices of a bench (udev(7); systemd's 73-seat-late.rules acts on the tag uaccess).
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "wire/devices/device_profile.hpp"

namespace skyloop {
namespace {

std::string udev_ids(UsbIds ids, std::string_view attribute) {
    return fmt::format("{0}{{idVendor}}==\"{1:04x}\", {0}{{idProduct}}==\"{2:04x}\"", attribute, ids.vendor,
                       ids.product);
}

std::string latency_rule(UsbIds ids, std::uint32_t milliseconds) {
    return fmt::format(
        "ACTION==\"add\", SUBSYSTEM==\"usb-serial\", DRIVER==\"ftdi_sio\", {}, ATTR{{latency_timer}}=\"{}\"\n",
        udev_ids(ids, "ATTRS"), milliseconds);
}

struct RulesOfIds {
    std::string names;
    std::uint32_t latency_timer_ms = 0;
};

void add_name(RulesOfIds& rules, const std::string& name) { rules.names += (rules.names.empty() ? "" : ", ") + name; }

}  // namespace

std::string udev_rules_of(UsbIds ids) {
    constexpr std::string_view allowed = "MODE=\"0660\", TAG+=\"uaccess\"";
    return fmt::format(
        "SUBSYSTEM==\"usb\", ENV{{DEVTYPE}}==\"usb_device\", {0}, ENV{{ID_MM_DEVICE_IGNORE}}=\"1\", "
        "GROUP=\"plugdev\", {2}\n"
        "SUBSYSTEM==\"tty\", {1}, ENV{{ID_MM_DEVICE_IGNORE}}=\"1\", GROUP=\"dialout\", {2}\n"
        "SUBSYSTEM==\"hidraw\", {1}, GROUP=\"plugdev\", {2}\n",
        udev_ids(ids, "ATTR"), udev_ids(ids, "ATTRS"), allowed);
}

std::string udev_rules(std::span<const DeviceProfile> profiles) {
    std::map<UsbIds, RulesOfIds> all;  // each pair of ids once, however many share it
    for (const DeviceProfile& profile : profiles) {
        for (const UsbIds ids : profile.ids) {
            add_name(all[ids], profile.name);
            all[ids].latency_timer_ms = std::max(all[ids].latency_timer_ms, profile.latency_timer_ms);
        }
        for (const UsbIds ids : profile.bootloader_ids)
            add_name(all[ids], profile.name + " (bootloader)");
    }
    std::string text =
        "# Boards, receivers and adapters that skyloop knows: for whoever sits at the machine, and for the groups "
        "dialout\n"
        "# and plugdev; ModemManager keeps away. Save as /etc/udev/rules.d/70-skyloop.rules, then\n"
        "#   sudo udevadm control --reload && sudo udevadm trigger\n";
    for (const auto& [ids, rules] : all) {
        text += fmt::format("\n# {}\n{}", rules.names, udev_rules_of(ids));
        if (rules.latency_timer_ms != 0) text += latency_rule(ids, rules.latency_timer_ms);
    }
    return text;
}

}  // namespace skyloop
