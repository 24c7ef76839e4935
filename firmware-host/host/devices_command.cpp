#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "data_folders.hpp"
#include "device_texts.hpp"
#include "messages.hpp"
#include "run/scenario/device_file.hpp"
#include "run_options.hpp"

namespace skyloop::host {
namespace {

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
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const DeviceProfile& profile : profiles)
        list.push_back(known_device_json(profile));
    fmt::print("{}\n", json_line({{"known", list}}));
}

int print_devices(std::span<const DeviceProfile> profiles, const DevicesOptions& options, const Messages& messages) {
    auto devices = list_devices(profiles);
    if (!devices) return messages.error(devices.error());
    std::erase_if(*devices, is_root_hub);
    if (options.json) {
        nlohmann::ordered_json list = nlohmann::ordered_json::array();
        for (const DeviceEntry& device : *devices)
            list.push_back(device_json(device));
        fmt::print("{}\n", json_line({{"devices", list}}));
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
                   json_line({{"event", news.arrived ? "arrived" : "left"}, {"device", device_json(news.device)}}));
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
