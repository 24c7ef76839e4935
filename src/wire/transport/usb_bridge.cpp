#include "wire/transport/usb_bridge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/core/threads.hpp"
#include "detail/line_settings.hpp"
#include "wire/usb/usb_device.hpp"

namespace skyloop::inline wire {
namespace {

constexpr std::uint32_t bridge_speed_of_no_speed = 115200;  // for a receiver's port that has none

std::vector<UsbDeviceInfo> listed_by_libusb() {
    std::vector<UsbDeviceInfo> all;
    const auto context = open_usb();
    const auto devices = context ? list_usb_devices(*context) : Result<std::vector<UsbDevice>>{};
    for (const UsbDevice& device : devices ? *devices : std::vector<UsbDevice>{})
        all.push_back(describe(device));
    return all;
}

bool is_among(const std::vector<std::string>& ports, const std::string& port) {
    return std::find(ports.begin(), ports.end(), port) != ports.end();
}

// Where a lost device may be: at its port, or, while none of its kind is there, at the only other `ports` that was free
// when it was lost. Cheap devices share one serial number: what was `beside` it is another one.
std::vector<UsbAddress> addresses_to_try(const UsbDeviceInfo& known, const std::vector<std::string>& ports,
                                         const std::vector<std::string>& beside) {
    std::vector<UsbAddress> all{{known.ids, known.serial, known.port_path}};
    std::vector<std::string> elsewhere;
    std::copy_if(ports.begin(), ports.end(), std::back_inserter(elsewhere),
                 [&](const std::string& port) { return !is_among(beside, port); });
    if (!is_among(ports, known.port_path) && elsewhere.size() == 1)
        all.push_back({known.ids, known.serial, elsewhere.front()});
    return all;
}

}  // namespace

Result<UsbBridgeAddress> parse_usb_bridge_address(std::string_view text) {
    const auto refused = [&](const std::string& what) {
        return fail(
            ErrorCode::usage,
            fmt::format("device '{}': {}; expected VID:PID[:SERIAL|@PORT][,BAUD][,8N1][,rtscts], BAUD {} to {}, "
                        "the format 7 or 8, N, E or O, 1 or 2",
                        text, what, lowest_baud, highest_baud));
    };
    const std::size_t comma = std::min(text.find(','), text.size());
    auto device = parse_usb_address(text.substr(0, comma));
    if (!device) return fail(std::move(device.error()));
    UsbBridgeAddress address{std::move(*device), std::nullopt, {}};
    if (comma == text.size()) return address;
    std::string_view options = text.substr(comma + 1);
    const std::string_view first = options.substr(0, options.find(','));
    const bool is_number =
        !first.empty() && std::all_of(first.begin(), first.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (is_number) {
        address.baud = read_baud(first);
        if (!address.baud) return refused(fmt::format("the speed '{}' is not understood", first));
        if (first.size() == options.size()) return address;
        options.remove_prefix(first.size() + 1);
    }
    if (const std::string wrong = read_line_options(options, address.format); !wrong.empty()) return refused(wrong);
    return address;
}

UsbBridgeTransport::UsbBridgeTransport(UsbBridgeAddress address, Opener opener, std::string_view kind, Lister lister)
    : address_(std::move(address)),
      opener_(std::move(opener)),
      kind_(kind),
      lister_(lister ? std::move(lister) : listed_by_libusb),
      baud_(address_.baud.value_or(bridge_speed_of_no_speed)) {}

Result<std::unique_ptr<UsbBridgeTransport>> UsbBridgeTransport::open(const UsbBridgeAddress& address, Opener opener,
                                                                     std::string_view kind, Lister lister) {
    std::unique_ptr<UsbBridgeTransport> wire(
        new UsbBridgeTransport(address, std::move(opener), kind, std::move(lister)));
    auto bridge = wire->opener_(address.device, {wire->baud_, address.format});
    if (!bridge) return fail(std::move(bridge.error()));
    wire->bridge_ = std::move(*bridge);
    wire->known_ = wire->bridge_->info();
    return wire;
}

void UsbBridgeTransport::follow() {
    if (!bridge_) return search();
    if (bridge_->gone()) lose();
}

// To close it may take its time, and so is none of the loop's.
void UsbBridgeTransport::lose() {
    for (std::string& news : bridge_->take_news())
        news_.push_back(std::move(news));
    news_.push_back(fmt::format("{} is gone; it is looked for every 0.5 s", description()));
    search_.begin(std::move(bridge_), steady_clock_ns(), ports_of_its_kind());
}

// Gives where devices of its ids and serial number are. Without a number, or asked for by its port, it is where it was.
std::function<UsbBridgeTransport::Search::Ports()> UsbBridgeTransport::ports_of_its_kind() const {
    if (known_.serial.empty() || !address_.device.port_path.empty()) return [] { return Search::Ports{}; };
    return [lister = lister_, alike = UsbAddress{known_.ids, known_.serial, {}}] {
        Search::Ports ports;
        for (const UsbDeviceInfo& device : lister())
            if (alike.matches(device)) ports.push_back(device.port_path);
        return ports;
    };
}

void UsbBridgeTransport::search() {
    auto found = search_.look(steady_clock_ns(), [this](const Search::Ports& beside) {
        return [opener = opener_, known = known_, ports = ports_of_its_kind(), beside,
                line = BridgeLine{baud_, address_.format}] {
            return attempt(opener, addresses_to_try(known, ports(), beside), line);
        };
    });
    if (!found) return;
    if (!found->end) return news_.push_back(std::move(found->trouble));
    bridge_ = std::move(found->end);
    known_ = bridge_->info();
    news_.push_back(fmt::format("{} is back, at {}", description(), known_.port_path));
    // The receiver's speed may have changed while it was opened.
    if (found->baud != baud_) bridge_->set_baud(baud_);
}

UsbBridgeTransport::Search::Attempt UsbBridgeTransport::attempt(const Opener& opener,
                                                                const std::vector<UsbAddress>& places,
                                                                const BridgeLine& line) {
    Search::Attempt attempt;
    for (const UsbAddress& place : places) {
        auto bridge = opener(place, line);
        if (bridge) return {std::move(*bridge), line.baud, {}};
        const auto context = open_usb();
        if (context && find_usb_device(*context, place)) attempt.trouble = bridge.error().message;
    }
    return attempt;
}

void UsbBridgeTransport::set_receiver_baud(std::uint32_t baud) {
    const std::optional<std::uint32_t> before = std::exchange(told_baud_, baud);
    // Until the receiver's speed changes the line has the one that was asked for.
    if (address_.baud && (!before || *before == baud)) return;
    baud_ = baud;
    if (bridge_) bridge_->set_baud(baud);
}

std::size_t UsbBridgeTransport::write(ByteSpan bytes) {
    follow();
    return bridge_ ? bridge_->write(bytes) : bytes.size();
}

Bytes UsbBridgeTransport::read() {
    follow();
    return bridge_ ? bridge_->read() : Bytes{};
}

LineState UsbBridgeTransport::line() {
    follow();
    return {bridge_ != nullptr, std::nullopt};
}

std::vector<std::string> UsbBridgeTransport::take_news() {
    if (bridge_)
        for (std::string& news : bridge_->take_news())
            news_.push_back(std::move(news));
    return std::exchange(news_, {});
}

std::string UsbBridgeTransport::description() const {
    return fmt::format("{} ({})", to_string(address_.device), kind_);
}

}  // namespace skyloop::inline wire
