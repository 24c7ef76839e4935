// `skyloop devices`, as text and as JSON.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/json.hpp"
#include "commands.hpp"
#include "data_folders.hpp"
#include "messages.hpp"
#include "run/scenario/board_files.hpp"
#include "run_options.hpp"
#include "wire/devices/device_list.hpp"

namespace skyloop::host {

namespace {

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

Json texts_of_ids(const std::vector<UsbIds>& ids) {
    Json list = Json::array();
    for (const UsbIds pair : ids)
        list.push_back(to_string(pair));
    return list;
}

Json or_null(std::uint32_t number) { return number == 0 ? Json() : Json(number); }

Json node_json(const DeviceNode& node) {
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

// The table of `skyloop devices`, a device a line, under it what else there is to say.
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

// One line: "+ 1-2 0403:6015 bridge /dev/ttyUSB0 FTDI ...", with its doubts under it.
std::string device_news_line(const DeviceNews& news) {
    const DeviceColumns columns = columns_of(news.device);
    std::string text = fmt::format("{} {}  {}{}\n", news.arrived ? '+' : '-', fmt::join(columns, "  "),
                                   printable(news.device.title()), own_words(news.device));
    if (news.arrived)
        for (const std::string& doubt : device_doubts(news.device))
            text += fmt::format("    WARNING: {}\n", doubt);
    return text;
}

// docs/known_devices.md
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

// The keys are written in docs/devices.md.
Json device_json(const DeviceEntry& device) {
    Json json{{"port_path", nullptr},
              {"usb", nullptr},
              {"manufacturer", ""},
              {"product", ""},
              {"serial", ""},
              {"kind", device.kind_name()},
              {"profile", nullptr},
              {"title", device.title()},
              {"bootloader", false},
              {"port", device.port()},
              {"nodes", Json::array()},
              {"hints", Json::array()},
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

Json known_device_json(const DeviceProfile& profile) {
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

struct DevicesOptions {
    bool json = false;
    bool watch = false;
    double duration_s = 0;  // 0: until it is stopped
    bool udev_rules = false;
    bool known = false;
    Verbosity verbosity;
};

// USB is there in every machine: a list without its own ports would be no answer.
bool is_root_hub(const DeviceEntry& device) { return device.usb && device.usb->port_path.starts_with("usb"); }

void print_known(std::span<const DeviceProfile> profiles, bool json) {
    if (!json) return fmt::print("{}", known_devices_page(profiles));
    Json list = Json::array();
    for (const DeviceProfile& profile : profiles)
        list.push_back(known_device_json(profile));
    fmt::print("{}\n", json_text({{"known", list}}));
}

int print_devices(std::span<const DeviceProfile> profiles, const DevicesOptions& options, const Messages& messages) {
    auto devices = list_devices(profiles);
    if (!devices) return messages.error(devices.error());
    std::erase_if(*devices, is_root_hub);
    if (options.json) {
        Json list = Json::array();
        for (const DeviceEntry& device : *devices)
            list.push_back(device_json(device));
        fmt::print("{}\n", json_text({{"devices", list}}));
        return 0;
    }
    if (devices->empty())
        messages.info("no USB device is plugged in, and this machine has no serial line of its own");
    else
        fmt::print("{}", device_table(*devices));
    return 0;
}

void print_news(const DeviceNews& news, bool json) {
    if (is_root_hub(news.device)) return;
    if (json)
        fmt::print("{}\n",
                   json_text({{"event", news.arrived ? "arrived" : "left"}, {"device", device_json(news.device)}}));
    else
        fmt::print("{}", device_news_line(news));
    std::fflush(stdout);  // a line is there when its device is
}

// A reader that has gone away ends the program by SIGPIPE, Ctrl-C by SIGINT: nothing is held that must be given back.
int watch_devices(std::span<const DeviceProfile> profiles, const DevicesOptions& options, const Messages& messages) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds longest_wait{1000};
    auto usb = UsbWatch::start();
    if (!usb) return messages.error(usb.error());
    if (usb->polls()) messages.detail("udevd does not run: devices are looked for every 500 ms");
    const auto there = list_devices(profiles);
    if (!there) return messages.error(there.error());
    for (const DeviceEntry& device : *there)
        if (!device.usb)
            print_news({true, device}, options.json);  // a line of the machine, which neither comes nor goes
    DeviceWatch watch(std::move(*usb), profiles);
    const auto end =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.duration_s));
    for (;;) {
        auto left = longest_wait;
        if (options.duration_s > 0)
            left = std::min(left, std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()));
        if (left.count() <= 0) return 0;
        const auto news = watch.wait(left);
        if (!news) return messages.error(news.error());
        for (const DeviceNews& one : *news)
            print_news(one, options.json);
    }
}

int show_devices(const DevicesOptions& options) {
    const Messages messages(options.verbosity);
    const auto folders = board_folders(data_folders());
    const auto profiles = load_devices(folders);
    if (!profiles) return messages.error(profiles.error());
    if (profiles->empty())
        messages.warning(fmt::format("no device files in {}; SKYLOOP_DATA_DIR may name the folder that holds boards/",
                                     folders.front().string()));
    if (options.udev_rules) {
        fmt::print("{}", udev_rules(*profiles));
        return 0;
    }
    if (options.known) {
        print_known(*profiles, options.json);
        return 0;
    }
    return options.watch ? watch_devices(*profiles, options, messages) : print_devices(*profiles, options, messages);
}

}  // namespace

Action add_devices_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("devices", "What is plugged in: boards, receivers, bridges, relays");
    auto options = std::make_shared<DevicesOptions>();
    command->add_flag("--json", options->json, "JSON; with --watch a line per device");
    auto* watch = command->add_flag("--watch", options->watch, "A line for each device that comes or goes");
    constexpr double longest_s = 1e7;
    command->add_option("--duration", options->duration_s, "How long to watch, s; until it is stopped")
        ->check(CLI::Range(0.0, longest_s))
        ->needs(watch);
    auto* rules = command->add_flag("--udev-rules", options->udev_rules, "A udev rules file for all known devices");
    auto* known = command->add_flag("--known", options->known, "The devices that are known, as Markdown or JSON");
    rules->excludes(watch)->excludes(known);
    known->excludes(watch);
    add_verbosity_options(*command, options->verbosity);
    return [options] { return show_devices(*options); };
}

}  // namespace skyloop::host
