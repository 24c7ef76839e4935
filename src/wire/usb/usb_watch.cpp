#include "wire/usb/usb_watch.hpp"

#include <fmt/format.h>
#include <libusb-1.0/libusb.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <thread>
#include <tuple>
#include <utility>

#include "wire/usb/usb_device.hpp"

namespace skyloop::inline wire {
namespace {

using WatchClock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds poll_period{500};

// What tells a device from the next one at the same port without asking it anything.
using Presence = std::tuple<int, int, UsbIds>;

Presence presence_of(libusb_device* device) {
    libusb_device_descriptor descriptor{};
    libusb_get_device_descriptor(device, &descriptor);  // cached by libusb: never fails
    return {
        libusb_get_bus_number(device), libusb_get_device_address(device), {descriptor.idVendor, descriptor.idProduct}};
}

}  // namespace

class UsbWatch::Source {
public:
    virtual ~Source() = default;
    virtual Result<std::vector<UsbChange>> wait(std::chrono::milliseconds longest) = 0;
    [[nodiscard]] virtual bool polls() const = 0;
};

// A callback of libusb may not ask a device anything, so that it only notes what happened.
class UsbWatch::Hotplug final : public UsbWatch::Source {
public:
    explicit Hotplug(UsbContext context) : context_(std::move(context)) {}
    ~Hotplug() override {
        if (registered_) libusb_hotplug_deregister_callback(context_.get(), callback_);
    }

    Result<void> listen() {
        const int result = libusb_hotplug_register_callback(
            context_.get(), LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT,
            LIBUSB_HOTPLUG_ENUMERATE, LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY,
            &Hotplug::notice, this, &callback_);
        registered_ = result == LIBUSB_SUCCESS;
        if (!registered_)
            return fail(ErrorCode::outside, fmt::format("cannot watch USB devices: {}", usb_error_text(result)));
        return {};
    }

    Result<std::vector<UsbChange>> wait(std::chrono::milliseconds longest) override {
        const auto deadline = WatchClock::now() + longest;
        while (noticed_.empty()) {
            const auto left = std::chrono::ceil<std::chrono::microseconds>(deadline - WatchClock::now());
            timeval rest{};
            if (left.count() > 0) {
                rest.tv_sec = left.count() / 1'000'000;
                rest.tv_usec = left.count() % 1'000'000;
            }
            const int result = libusb_handle_events_timeout_completed(context_.get(), &rest, nullptr);
            if (result != LIBUSB_SUCCESS && result != LIBUSB_ERROR_INTERRUPTED)
                return fail(ErrorCode::outside, fmt::format("cannot watch USB devices: {}", usb_error_text(result)));
            if (left.count() <= 0) break;
        }
        std::vector<UsbChange> changes;
        for (const Noticed& noticed : std::exchange(noticed_, {}))
            changes.push_back(change_of(noticed));
        return changes;
    }

    [[nodiscard]] bool polls() const override { return false; }

private:
    struct Noticed {
        bool arrived;
        UsbDevice device;
    };

    static int LIBUSB_CALL notice(libusb_context* /*context*/, libusb_device* device, libusb_hotplug_event event,
                                  void* self) {
        auto* watch = static_cast<Hotplug*>(self);
        watch->noticed_.push_back(
            {event == LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED,
             {libusb_ref_device(device), [context = watch->context_](libusb_device* d) { libusb_unref_device(d); }}});
        return 0;  // stays registered
    }

    UsbChange change_of(const Noticed& noticed) {
        libusb_device* const key = noticed.device.get();
        if (noticed.arrived) return {true, known_[key] = describe(noticed.device)};
        const auto known = known_.extract(key);
        return {false, known.empty() ? describe(noticed.device) : known.mapped()};
    }

    UsbContext context_;
    libusb_hotplug_callback_handle callback_ = 0;
    bool registered_ = false;
    std::vector<Noticed> noticed_;
    std::map<libusb_device*, UsbDeviceInfo> known_;
};

// libusb looks at the bus once for each session and then waits for udevd; without udevd each look is a session of its
// own.
class UsbWatch::Polling final : public UsbWatch::Source {
public:
    Result<std::vector<UsbChange>> wait(std::chrono::milliseconds longest) override {
        const auto deadline = WatchClock::now() + longest;
        for (;;) {
            // A call that may not wait looks all the same.
            std::this_thread::sleep_until(std::min(next_, deadline));
            next_ = WatchClock::now() + poll_period;
            auto changes = look();
            if (!changes || !changes->empty() || WatchClock::now() >= deadline) return changes;
        }
    }

    [[nodiscard]] bool polls() const override { return true; }

private:
    Result<std::vector<UsbChange>> look() {
        const auto context = open_usb();
        if (!context) return fail(context.error());
        const auto devices = list_usb_devices(*context);
        if (!devices) return fail(devices.error());
        std::map<Presence, UsbDeviceInfo> now;
        std::vector<UsbChange> came;
        for (const UsbDevice& device : *devices) {
            const Presence presence = presence_of(device.get());
            const auto known = known_.find(presence);
            const UsbDeviceInfo info = known == known_.end() ? describe(device) : known->second;
            if (known == known_.end()) came.push_back({true, info});
            now.emplace(presence, info);
        }
        std::vector<UsbChange> changes;
        for (const auto& [presence, info] : known_)
            if (!now.contains(presence)) changes.push_back({false, info});
        changes.insert(changes.end(), came.begin(), came.end());
        known_ = std::move(now);
        return changes;
    }

    WatchClock::time_point next_ = WatchClock::now();
    std::map<Presence, UsbDeviceInfo> known_;
};

UsbWatch::UsbWatch(std::unique_ptr<Source> source) : source_(std::move(source)) {}
UsbWatch::UsbWatch(UsbWatch&&) noexcept = default;
UsbWatch& UsbWatch::operator=(UsbWatch&&) noexcept = default;
UsbWatch::~UsbWatch() = default;

Result<UsbWatch> UsbWatch::start(UsbWatchMode mode) {
    auto context = open_usb();
    if (!context) return fail(context.error());
    std::error_code error;
    const bool hotplug = mode == UsbWatchMode::hotplug ||
                         (mode == UsbWatchMode::automatic && libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) != 0 &&
                          std::filesystem::exists("/run/udev/control", error));
    if (!hotplug) return UsbWatch(std::make_unique<Polling>());
    auto source = std::make_unique<Hotplug>(std::move(*context));
    if (const auto listening = source->listen(); !listening) return fail(listening.error());
    return UsbWatch(std::move(source));
}

Result<std::vector<UsbChange>> UsbWatch::wait(std::chrono::milliseconds longest) { return source_->wait(longest); }
bool UsbWatch::polls() const { return source_->polls(); }

}  // namespace skyloop::inline wire
