// Profiles of known devices, and rules that let a person use them (udev(7); systemd's 73-seat-late.rules acts on the
// tag uaccess).
#include "wire/devices/device_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

namespace skyloop::inline wire {
namespace {

constexpr std::array<std::string_view, 7> kind_names{"autopilot", "receiver", "bridge",    "relay",
                                                     "gpio",      "hub",      "bootloader"};
constexpr std::array<std::string_view, 4> transport_names{"", "serial", "usb", "hid"};

// How much of a pattern stands for one character, and whether `c` is one that it stands for.
struct Step {
    std::size_t size;
    bool fits;
};
Step one_character(std::string_view pattern, char c) {
    if (pattern.front() == '?') return {1, true};
    const std::size_t end = pattern.front() == '[' ? pattern.find(']', 1) : std::string_view::npos;
    if (end == std::string_view::npos) return {1, pattern.front() == c};
    return {end + 1, pattern.substr(1, end - 1).find(c) != std::string_view::npos};
}

bool any_fits(std::string_view text, const std::vector<std::string>& patterns) {
    return std::any_of(patterns.begin(), patterns.end(),
                       [text](const std::string& pattern) { return matches_pattern(text, pattern); });
}

bool holds(const std::vector<UsbIds>& ids, UsbIds wanted) {
    return std::find(ids.begin(), ids.end(), wanted) != ids.end();
}

}  // namespace

std::string_view device_kind_name(DeviceKind kind) { return kind_names[static_cast<std::size_t>(kind)]; }

std::string_view device_transport_name(DeviceTransport transport) {
    return transport_names[static_cast<std::size_t>(transport)];
}

// Goes back to the last `*` alone, so that no pattern takes longer than the product of both lengths.
bool matches_pattern(std::string_view text, std::string_view pattern) {
    std::size_t at = 0, in_pattern = 0;
    std::size_t star = std::string_view::npos, tried = 0;
    while (at < text.size()) {
        if (in_pattern < pattern.size() && pattern[in_pattern] == '*') {
            star = in_pattern++;
            tried = at;
            continue;
        }
        const Step step = in_pattern < pattern.size() ? one_character(pattern.substr(in_pattern), text[at]) : Step{};
        if (step.fits) {
            in_pattern += step.size;
            ++at;
        } else if (star != std::string_view::npos) {
            in_pattern = star + 1;
            at = ++tried;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', in_pattern) == std::string_view::npos;
}

std::optional<DeviceMatch> match_device(std::span<const DeviceProfile> profiles, const UsbDeviceInfo& device) {
    const DeviceProfile *alone = nullptr, *bootloader = nullptr;
    for (const DeviceProfile& profile : profiles) {
        if (!bootloader && holds(profile.bootloader_ids, device.ids)) bootloader = &profile;
        if (!holds(profile.ids, device.ids)) continue;
        const bool boots = any_fits(device.product, profile.bootloader_products);
        if (any_fits(device.product, profile.products) || any_fits(device.manufacturer, profile.manufacturers))
            return DeviceMatch{&profile, boots};
        if (!alone && !profile.needs_strings()) alone = &profile;
    }
    if (alone) return DeviceMatch{alone, any_fits(device.product, alone->bootloader_products)};
    if (bootloader) return DeviceMatch{bootloader, true};
    return std::nullopt;
}

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

}  // namespace skyloop::inline wire
