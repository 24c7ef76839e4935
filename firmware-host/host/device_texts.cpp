#include "device_texts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <vector>

namespace skyloop::host {
namespace {

using DeviceJson = nlohmann::ordered_json;

// What a device tells of itself may hold anything; on a terminal it is text.
std::string printable(std::string_view text) {
    std::string shown;
    for (const char c : text)
        shown += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    return shown;
}

// The node that a person would type.
std::string node_column(const DeviceEntry& device) {
    if (device.nodes.empty()) return "-";
    std::vector<std::string> paths;
    for (const DeviceNode& node : device.nodes)
        if (node.kind != NodeKind::usb) paths.push_back(node.path);
    return paths.empty() ? device.nodes.back().path : fmt::format("{}", fmt::join(paths, " "));
}

using DeviceColumns = std::array<std::string, 4>;

DeviceColumns columns_of(const DeviceEntry& device) {
    return {device.usb ? device.usb->port_path : "-", device.usb ? to_string(device.usb->ids) : "-",
            std::string(device.kind_name()), node_column(device)};
}

// What it tells of itself, where that says more than its profile.
std::string own_words(const DeviceEntry& device) {
    if (!device.usb) return {};
    std::vector<std::string> words;
    if (device.known && !device.usb->product.empty()) words.push_back(printable(device.usb->product));
    if (!device.usb->serial.empty()) words.push_back("serial " + printable(device.usb->serial));
    return words.empty() ? std::string() : fmt::format(" ({})", fmt::join(words, ", "));
}

std::string remarks(const DeviceEntry& device) {
    std::string text;
    const auto add = [&](std::string_view what, std::string_view remark) {
        if (!remark.empty()) text += fmt::format("    {}: {}\n", what, remark);
    };
    if (device.known) add("good for", device.known->profile->good_for);
    add("use", device.port().empty() ? std::string() : "--port " + device.port());
    if (device.known)
        for (const std::string& hint : device.known->profile->hints)
            add("note", hint);
    for (const std::string& doubt : device_doubts(device))
        add("WARNING", doubt);
    return text;
}

std::string speeds(const DeviceProfile& profile) {
    if (profile.max_baud != 0) return fmt::format("up to {}", profile.max_baud);
    return profile.baud != 0 ? std::to_string(profile.baud) : "";
}

std::string ids_cell(const std::vector<UsbIds>& ids) {
    std::vector<std::string> texts;
    for (const UsbIds pair : ids)
        texts.push_back('`' + to_string(pair) + '`');
    return fmt::format("{}", fmt::join(texts, " "));
}

std::string strings_cell(const DeviceProfile& profile) {
    std::vector<std::string> texts;
    for (const std::string& pattern : profile.products)
        texts.push_back("product `" + pattern + '`');
    for (const std::string& pattern : profile.manufacturers)
        texts.push_back("manufacturer `" + pattern + '`');
    return fmt::format("{}", fmt::join(texts, " or "));
}

std::string notes_cell(const DeviceProfile& profile) {
    std::vector<std::string> notes = profile.hints;
    if (profile.latency_timer_ms != 0) notes.push_back(fmt::format("latency_timer {} ms", profile.latency_timer_ms));
    if (!profile.bootloader_ids.empty()) notes.push_back("bootloader " + ids_cell(profile.bootloader_ids));
    return fmt::format("{}", fmt::join(notes, "; "));
}

DeviceJson texts_of_ids(const std::vector<UsbIds>& ids) {
    DeviceJson list = DeviceJson::array();
    for (const UsbIds pair : ids)
        list.push_back(to_string(pair));
    return list;
}

DeviceJson or_null(std::uint32_t number) { return number == 0 ? DeviceJson() : DeviceJson(number); }

DeviceJson node_json(const DeviceNode& node) {
    return {{"kind", node_kind_name(node.kind)},
            {"path", node.path},
            {"stable_path", node.stable_path},
            {"interface", node.interface},
            {"driver", node.driver},
            {"exists", node.exists},
            {"usable", node.usable},
            {"owner", node.owner},
            {"group", node.group},
            {"mode", fmt::format("{:03o}", node.mode)}};
}

}  // namespace

std::string device_table(std::span<const DeviceEntry> devices) {
    std::vector<DeviceColumns> rows{{"PORT", "USB", "KIND", "NODES"}};
    for (const DeviceEntry& device : devices)
        rows.push_back(columns_of(device));
    std::array<std::size_t, 4> widths{};
    for (const DeviceColumns& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const DeviceColumns& row = rows[i];
        text += fmt::format("{:<{}}  {:<{}}  {:<{}}  {:<{}}  {}\n", row[0], widths[0], row[1], widths[1], row[2],
                            widths[2], row[3], widths[3],
                            i == 0 ? "DEVICE" : printable(devices[i - 1].title()) + own_words(devices[i - 1]));
        if (i != 0) text += remarks(devices[i - 1]);
    }
    return text;
}

std::string device_news_line(const DeviceNews& news) {
    const DeviceColumns columns = columns_of(news.device);
    std::string text = fmt::format("{} {}  {}{}\n", news.arrived ? '+' : '-', fmt::join(columns, "  "),
                                   printable(news.device.title()), own_words(news.device));
    if (news.arrived)
        for (const std::string& doubt : device_doubts(news.device))
            text += fmt::format("    WARNING: {}\n", doubt);
    return text;
}

std::string known_devices_page(std::span<const DeviceProfile> profiles) {
    std::string page =
        "# Known devices\n\nWritten by `skyloop devices --known` from the files in `boards/autopilots` and "
        "`boards/adapters`; how they are used stands in [devices.md](devices.md).\n\n"
        "| name | ids | told apart by | kind | what it is | good for | transport | bit/s | notes |\n"
        "|---|---|---|---|---|---|---|---|---|\n";
    for (const DeviceProfile& profile : profiles)
        page +=
            fmt::format("| `{}` | {} | {} | {} | {} | {} | {} | {} | {} |\n", profile.name, ids_cell(profile.ids),
                        strings_cell(profile), device_kind_name(profile.kind), profile.description, profile.good_for,
                        device_transport_name(profile.transport), speeds(profile), notes_cell(profile));
    return page;
}

DeviceJson device_json(const DeviceEntry& device) {
    DeviceJson json{{"port_path", nullptr},
                    {"usb", nullptr},
                    {"manufacturer", ""},
                    {"product", ""},
                    {"serial", ""},
                    {"kind", device.kind_name()},
                    {"profile", nullptr},
                    {"title", device.title()},
                    {"bootloader", false},
                    {"port", device.port()},
                    {"nodes", DeviceJson::array()},
                    {"hints", DeviceJson::array()},
                    {"warnings", device_doubts(device)}};
    if (device.usb) {
        json["port_path"] = device.usb->port_path;
        json["usb"] = to_string(device.usb->ids);
        json["manufacturer"] = device.usb->manufacturer;
        json["product"] = device.usb->product;
        json["serial"] = device.usb->serial;
    }
    if (device.known) {
        json["profile"] = device.known->profile->name;
        json["bootloader"] = device.known->bootloader || device.known->profile->kind == DeviceKind::bootloader;
        json["hints"] = device.known->profile->hints;
    }
    for (const DeviceNode& node : device.nodes)
        json["nodes"].push_back(node_json(node));
    return json;
}

DeviceJson known_device_json(const DeviceProfile& profile) {
    return {{"name", profile.name},
            {"title", profile.description},
            {"kind", device_kind_name(profile.kind)},
            {"usb", texts_of_ids(profile.ids)},
            {"product", profile.products},
            {"manufacturer", profile.manufacturers},
            {"bootloader_usb", texts_of_ids(profile.bootloader_ids)},
            {"bootloader_product", profile.bootloader_products},
            {"good_for", profile.good_for},
            {"transport", device_transport_name(profile.transport)},
            {"baud", or_null(profile.baud)},
            {"max_baud", or_null(profile.max_baud)},
            {"latency_timer_ms", or_null(profile.latency_timer_ms)},
            {"hints", profile.hints}};
}

std::string json_line(const DeviceJson& json) {
    return json.dump(-1, ' ', false, DeviceJson::error_handler_t::replace);
}

}  // namespace skyloop::host
