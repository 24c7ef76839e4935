#include "wire/hid/hid_device.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <hidapi/hidapi.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/core/files.hpp"
#include "base/core/result.hpp"

namespace skyloop::inline wire {

/// The functions of one backend of hidapi, found in its library when first asked for.
struct HidApi {
    HidBackend backend;
    decltype(&hid_init) initialize;
    decltype(&hid_exit) finish;
    decltype(&hid_enumerate) enumerate;
    decltype(&hid_free_enumeration) free_enumeration;
    decltype(&hid_open_path) open_path;
    decltype(&hid_close) close;
    decltype(&hid_write) write;
    decltype(&hid_read_timeout) read_timeout;
    decltype(&hid_send_feature_report) send_feature_report;
    decltype(&hid_get_feature_report) get_feature_report;
    decltype(&hid_error) error;
};

namespace {

struct Library {
    const char* file;
    const char* package;
};

Library library_of(HidBackend backend) {
    if (backend == HidBackend::hidraw) return {"libhidapi-hidraw.so.0", "libhidapi-hidraw0"};
    return {"libhidapi-libusb.so.0", "libhidapi-libusb0"};
}

template <class Function>
bool find(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    return function != nullptr;
}

Result<HidApi> load(HidBackend backend) {
    const Library library = library_of(backend);
    // Local and bound to itself: the other backend has the same names.
    void* loaded = dlopen(library.file, RTLD_NOW | RTLD_LOCAL);
    if (loaded == nullptr)
        return fail(ErrorCode::outside, fmt::format("cannot use HID devices: {} is not on this machine (package {})",
                                                    library.file, library.package));
    HidApi api{};
    api.backend = backend;
    const bool whole =
        find(loaded, "hid_init", api.initialize) && find(loaded, "hid_exit", api.finish) &&
        find(loaded, "hid_enumerate", api.enumerate) && find(loaded, "hid_free_enumeration", api.free_enumeration) &&
        find(loaded, "hid_open_path", api.open_path) && find(loaded, "hid_close", api.close) &&
        find(loaded, "hid_write", api.write) && find(loaded, "hid_read_timeout", api.read_timeout) &&
        find(loaded, "hid_send_feature_report", api.send_feature_report) &&
        find(loaded, "hid_get_feature_report", api.get_feature_report) && find(loaded, "hid_error", api.error);
    if (!whole || api.initialize() != 0)
        return fail(ErrorCode::outside, fmt::format("cannot use HID devices: {} {}", library.file,
                                                    whole ? "does not start" : "is no hidapi"));
    return api;
}

// Stays loaded until the program ends. Fails with `outside`: the library is not there, and which package has it.
Result<const HidApi*> hid_api(HidBackend backend) {
    static const Result<HidApi> hidraw = load(HidBackend::hidraw);
    static const Result<HidApi> libusb = load(HidBackend::libusb);
    const Result<HidApi>& api = backend == HidBackend::hidraw ? hidraw : libusb;
    if (!api) return fail(api.error());
    return &*api;
}

constexpr std::size_t longest_report = 4096;  // bytes; those of the devices here have 64

// hidapi speaks in wide characters; a USB device's texts are UTF-16 and in practice ASCII.
std::string narrow(const wchar_t* text) {
    std::string result;
    for (; text != nullptr && *text != L'\0'; ++text)
        result += *text > 0 && *text < 0x80 ? static_cast<char>(*text) : '?';
    return result;
}

// The bus and ports of a hidraw node, by its place in sysfs: …/1-1.2/1-1.2:1.0/0003:16C0:05DF.0001/hidraw/hidraw0.
std::string port_path_of_node(const std::string& node) {
    const auto name = std::filesystem::path(node).filename();
    std::error_code none;
    auto place = std::filesystem::canonical(std::filesystem::path("/sys/class/hidraw") / name / "device", none);
    for (; !none && place.has_relative_path(); place = place.parent_path())
        if (const std::string folder = place.filename();
            folder.find(':') != std::string::npos && folder.find('-') < folder.find(':'))
            return folder.substr(0, folder.find(':'));
    return {};
}

// hidapi's libusb backend calls a device "1-1.2:1.0", by its interface.
std::string port_path_of(HidBackend backend, const std::string& path) {
    return backend == HidBackend::hidraw ? port_path_of_node(path) : path.substr(0, path.find(':'));
}

std::filesystem::path sysfs_of_port(const std::string& port_path) {
    return std::filesystem::path("/sys/bus/usb/devices") / port_path;
}

// The node that a device is opened by; empty when sysfs does not tell.
std::string node_of(HidBackend backend, const std::string& path) {
    if (backend == HidBackend::hidraw) return path;
    const auto device = sysfs_of_port(port_path_of(backend, path));
    int bus = 0, number = 0;
    if (!(std::ifstream(device / "busnum") >> bus) || !(std::ifstream(device / "devnum") >> number)) return {};
    return fmt::format("/dev/bus/usb/{:03}/{:03}", bus, number);
}

// hidapi's libusb backend opens a device for its texts, which needs permission. sysfs tells them to everybody.
void complete_texts(UsbDeviceInfo& info) {
    if (!info.manufacturer.empty() || !info.product.empty() || !info.serial.empty()) return;
    const auto device = sysfs_of_port(info.port_path);
    info.manufacturer = first_line_of(device / "manufacturer");
    info.product = first_line_of(device / "product");
    info.serial = first_line_of(device / "serial");
}

// hidapi opens, closes and lists devices of one backend in one thread at a time only, and keeps the words for its last
// mistake in one place for all of them.
struct Usage {
    std::mutex mutex{};
    int open = 0;  // devices
};

Usage& usage(HidBackend backend) {
    static Usage hidraw, libusb;
    return backend == HidBackend::hidraw ? hidraw : libusb;
}

struct Found {
    std::string path;
    UsbDeviceInfo info;
};

std::vector<Found> enumerate(const HidApi& api, UsbIds ids, const Usage& used) {
    std::vector<Found> found;
    // Where no udevd runs, a session of libusb sees what was plugged in when it began. It can begin anew while nothing
    // of it is open.
    if (used.open == 0 && api.finish() == 0) (void)api.initialize();
    hid_device_info* list = api.enumerate(ids.vendor, ids.product);
    for (const hid_device_info* device = list; device != nullptr; device = device->next) {
        found.push_back({device->path,
                         {ids, narrow(device->manufacturer_string), narrow(device->product_string),
                          narrow(device->serial_number), port_path_of(api.backend, device->path)}});
        complete_texts(found.back().info);
    }
    api.free_enumeration(list);
    return found;
}

}  // namespace

Result<std::vector<UsbDeviceInfo>> HidDevice::list(UsbIds ids, HidBackend backend) {
    const auto api = hid_api(backend);
    if (!api) return fail(api.error());
    Usage& used = usage(backend);
    const std::lock_guard lock(used.mutex);
    std::vector<UsbDeviceInfo> devices;
    for (Found& found : enumerate(**api, ids, used))
        devices.push_back(std::move(found.info));
    return devices;
}

Result<HidDevice> HidDevice::open(const UsbAddress& address, HidBackend backend) {
    auto device = open_if_there(address, backend);
    if (!device) return fail(std::move(device.error()));
    if (!*device) return fail(ErrorCode::outside, fmt::format("no HID device {} is plugged in", to_string(address)));
    return std::move(**device);
}

Result<std::optional<HidDevice>> HidDevice::open_if_there(const UsbAddress& address, HidBackend backend) {
    const auto api = hid_api(backend);
    if (!api) return fail(api.error());
    Usage& used = usage(backend);
    const std::lock_guard lock(used.mutex);
    const std::vector<Found> devices = enumerate(**api, address.ids, used);
    const auto found =
        std::find_if(devices.begin(), devices.end(), [&](const Found& device) { return address.matches(device.info); });
    if (found == devices.end()) return std::nullopt;
    hid_device* device = (*api)->open_path(found->path.c_str());
    if (device != nullptr) {
        ++used.open;
        return HidDevice(**api, device, found->info);
    }
    const std::string node = node_of(backend, found->path);
    const bool denied = !node.empty() && ::access(node.c_str(), R_OK | W_OK) != 0 && errno == EACCES;
    // The libusb backend has no words for it.
    const std::string reason =
        backend == HidBackend::hidraw ? narrow((*api)->error(nullptr)) : "it is gone, or another program holds it";
    return fail(ErrorCode::outside,
                fmt::format("cannot open HID device {} ({}): {}", to_string(address), node.empty() ? found->path : node,
                            denied ? "no permission; a udev rule gives it: skyloop devices shows the line" : reason));
}

Result<HidDevice> HidDevice::open(const UsbAddress& address) {
    auto through_kernel = open_if_there(address, HidBackend::hidraw);
    if (through_kernel && *through_kernel) return std::move(**through_kernel);
    // The kernel has the device: its refusal tells more, since libusb is asked only because of it.
    const bool kernel_has_it = !through_kernel && hid_api(HidBackend::hidraw);
    // Without libusb's library hidraw has the last word: a device that is not plugged in is the likely reason.
    if (const auto past = hid_api(HidBackend::libusb); through_kernel && !past)
        return fail(ErrorCode::outside, fmt::format("no HID device {} is plugged in, or it has no hidraw node, and {}",
                                                    to_string(address), past.error().message));
    auto past_it = open(address, HidBackend::libusb);
    if (!past_it && kernel_has_it) return fail(std::move(through_kernel.error()));
    return past_it;
}

HidDevice::HidDevice(HidDevice&& other) noexcept
    : api_(other.api_), device_(std::exchange(other.device_, nullptr)), info_(std::move(other.info_)) {}

HidDevice& HidDevice::operator=(HidDevice&& other) noexcept {
    std::swap(api_, other.api_);
    std::swap(device_, other.device_);
    std::swap(info_, other.info_);
    return *this;
}

HidDevice::~HidDevice() {
    if (device_ == nullptr) return;
    Usage& used = usage(api_->backend);
    const std::lock_guard lock(used.mutex);
    api_->close(static_cast<hid_device*>(device_));
    --used.open;
}

HidBackend HidDevice::backend() const { return api_->backend; }

Error HidDevice::last_error(const char* what) const {
    // The libusb backend has no words for it.
    const std::string reason = api_->backend == HidBackend::hidraw
                                   ? narrow(api_->error(static_cast<hid_device*>(device_)))
                                   : "it refused, or is gone";
    return {ErrorCode::outside,
            fmt::format("HID device {} at {}: cannot {}: {}", to_string(info_.ids), info_.port_path, what, reason)};
}

Result<void> HidDevice::write(ByteSpan report) {
    if (api_->write(static_cast<hid_device*>(device_), report.data(), report.size()) < 0)
        return fail(last_error("send a report"));
    return {};
}

Result<void> HidDevice::send_feature(ByteSpan report) {
    if (api_->send_feature_report(static_cast<hid_device*>(device_), report.data(), report.size()) < 0)
        return fail(last_error("send a feature report"));
    return {};
}

Result<Bytes> HidDevice::get_feature(std::uint8_t id, std::size_t size) {
    Bytes report(std::max<std::size_t>(size, 1));
    report.front() = id;
    const int got = api_->get_feature_report(static_cast<hid_device*>(device_), report.data(), report.size());
    if (got < 0) return fail(last_error("read a feature report"));
    report.resize(static_cast<std::size_t>(got));
    return report;
}

Result<Bytes> HidDevice::read(std::chrono::milliseconds wait) {
    Bytes report(longest_report);
    const int got = api_->read_timeout(static_cast<hid_device*>(device_), report.data(), report.size(),
                                       static_cast<int>(wait.count()));
    if (got < 0) return fail(last_error("read a report"));
    report.resize(static_cast<std::size_t>(got));
    return report;
}

}  // namespace skyloop::inline wire
