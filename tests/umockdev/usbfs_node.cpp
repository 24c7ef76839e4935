#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <list>
#include <thread>

#include "nodes.hpp"

namespace skyloop::mock {
namespace {

constexpr std::size_t setup_size = 8;
constexpr std::uint8_t to_host = 0x80;

struct Urb {
    UMockdevIoctlClient* client = nullptr;  // whose it is: a forked process has its own at the same address
    UMockdevIoctlData* data = nullptr;      // of the struct, and by it the address in the caller
    UMockdevIoctlData* buffer = nullptr;

    [[nodiscard]] usbdevfs_urb& head() const { return *reinterpret_cast<usbdevfs_urb*>(data->data); }
    [[nodiscard]] ByteSpan bytes() const { return {buffer->data, static_cast<std::size_t>(head().buffer_length)}; }
};

Setup setup_of(const Urb& urb) {
    const std::uint8_t* const b = urb.buffer->data;
    const auto word = [b](int at) { return static_cast<std::uint16_t>(b[at] | b[at + 1] << 8); };
    return {b[0], b[1], word(2), word(4), word(6)};
}

class UsbfsNode : public HandlerNode {
public:
    UsbfsNode(DeviceSpec spec, std::shared_ptr<MockDevice> device)
        : spec_(std::move(spec)), device_(std::move(device)) {}
    ~UsbfsNode() override {
        for (std::list<Urb>* const list : {&waiting_, &done_})
            for (Urb& urb : *list)
                release(urb);
    }
    void control(UMockdevIoctlClient* client) override;

private:
    static void release(Urb& urb) {
        umockdev_ioctl_data_unref(urb.buffer);
        umockdev_ioctl_data_unref(urb.data);
        g_object_unref(urb.client);
    }
    static void answer(UMockdevIoctlClient* client, int error) {
        umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
    }
    void submit(UMockdevIoctlClient* client);
    void discard(UMockdevIoctlClient* client);
    void reap(UMockdevIoctlClient* client);
    void forget_the_gone();
    void finish_what_can();
    bool finish(Urb& urb);
    MockDevice::Answer control_answer(const Setup& setup, ByteSpan sent);
    void drivers(UMockdevIoctlClient* client, unsigned request);
    void claim_without_driver(UMockdevIoctlData* argument);
    int driver_call(UMockdevIoctlData* argument);
    int driver_name(UMockdevIoctlData* argument);

    DeviceSpec spec_;
    std::shared_ptr<MockDevice> device_;
    std::list<Urb> waiting_;
    std::list<Urb> done_;
};

void UsbfsNode::control(UMockdevIoctlClient* client) {
    const auto request = static_cast<unsigned>(umockdev_ioctl_client_get_request(client));
    UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
    const auto number = [&] { return *reinterpret_cast<unsigned*>(resolve(argument, 0, sizeof(unsigned))->data); };
    if (request == static_cast<unsigned>(USBDEVFS_REAPURBNDELAY) || request == static_cast<unsigned>(USBDEVFS_REAPURB))
        return reap(client);
    if (!device_->present) return answer(client, ENODEV);
    switch (request) {
        case static_cast<unsigned>(USBDEVFS_GET_CAPABILITIES):
            *reinterpret_cast<std::uint32_t*>(resolve(argument, 0, sizeof(std::uint32_t))->data) =
                USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION | USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
                USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
            return answer(client, 0);
        case static_cast<unsigned>(USBDEVFS_SUBMITURB):
            return submit(client);
        case static_cast<unsigned>(USBDEVFS_DISCARDURB):
            return discard(client);
        case static_cast<unsigned>(USBDEVFS_CLEAR_HALT):
            device_->halt_cleared(static_cast<std::uint8_t>(number()));
            return answer(client, 0);
        case static_cast<unsigned>(USBDEVFS_RESET):
            return answer(client, 0);
        default:
            return drivers(client, request);
    }
}

void UsbfsNode::drivers(UMockdevIoctlClient* client, unsigned request) {
    UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
    const auto number = [&] { return *reinterpret_cast<unsigned*>(resolve(argument, 0, sizeof(unsigned))->data); };
    switch (request) {
        case static_cast<unsigned>(USBDEVFS_CLAIMINTERFACE): {
            const bool held = !device_->driver(number()).empty();
            if (!held) device_->claimed(number(), true);
            return answer(client, held ? EBUSY : 0);
        }
        case static_cast<unsigned>(USBDEVFS_RELEASEINTERFACE):
            device_->claimed(number(), false);
            return answer(client, 0);
        case static_cast<unsigned>(USBDEVFS_DISCONNECT_CLAIM):
            claim_without_driver(argument);
            return answer(client, 0);
        case static_cast<unsigned>(USBDEVFS_CLAIM_PORT):
        case static_cast<unsigned>(USBDEVFS_RELEASE_PORT):
            device_->port_claimed(number(), request == static_cast<unsigned>(USBDEVFS_CLAIM_PORT));
            return answer(client, 0);
        case static_cast<unsigned>(USBDEVFS_IOCTL):
            return answer(client, driver_call(argument));
        case static_cast<unsigned>(USBDEVFS_GETDRIVER):
            return answer(client, driver_name(argument));
        default:
            return answer(client, ENOTTY);
    }
}

void UsbfsNode::claim_without_driver(UMockdevIoctlData* argument) {
    const auto& claim =
        *reinterpret_cast<usbdevfs_disconnect_claim*>(resolve(argument, 0, sizeof(usbdevfs_disconnect_claim))->data);
    if (!device_->driver(claim.interface).empty()) device_->detach_driver(claim.interface);
    device_->claimed(claim.interface, true);
}

int UsbfsNode::driver_call(UMockdevIoctlData* argument) {
    const auto& call = *reinterpret_cast<usbdevfs_ioctl*>(resolve(argument, 0, sizeof(usbdevfs_ioctl))->data);
    const auto interface = static_cast<unsigned>(call.ifno);
    if (static_cast<unsigned>(call.ioctl_code) == static_cast<unsigned>(USBDEVFS_CONNECT)) {
        device_->attach_driver(interface);
        return 0;
    }
    if (static_cast<unsigned>(call.ioctl_code) != static_cast<unsigned>(USBDEVFS_DISCONNECT)) return ENOTTY;
    if (device_->driver(interface).empty()) return ENODATA;
    device_->detach_driver(interface);
    return 0;
}

int UsbfsNode::driver_name(UMockdevIoctlData* argument) {
    auto& driver = *reinterpret_cast<usbdevfs_getdriver*>(resolve(argument, 0, sizeof(usbdevfs_getdriver))->data);
    const std::string name = device_->driver(driver.interface);
    if (name.empty()) return ENODATA;
    std::strncpy(driver.driver, name.c_str(), sizeof driver.driver - 1);
    return 0;
}

void UsbfsNode::submit(UMockdevIoctlClient* client) {
    UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
    Urb urb;
    urb.client = UMOCKDEV_IOCTL_CLIENT(g_object_ref(client));
    urb.data = umockdev_ioctl_data_ref(resolve(argument, 0, sizeof(usbdevfs_urb)));
    urb.buffer = umockdev_ioctl_data_ref(
        resolve(urb.data, offsetof(usbdevfs_urb, buffer), static_cast<std::size_t>(urb.head().buffer_length)));
    urb.head().status = 0;
    urb.head().actual_length = 0;
    if ((urb.head().flags & USBDEVFS_URB_ZERO_PACKET) != 0) device_->zero_packet_asked(urb.head().endpoint);
    waiting_.push_back(urb);
    answer(client, 0);
}

void UsbfsNode::discard(UMockdevIoctlClient* client) {
    const UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
    unsigned long address = 0;
    std::memcpy(&address, argument->data, sizeof address);
    const auto urb = std::find_if(waiting_.begin(), waiting_.end(), [&](const Urb& one) {
        return one.client == client && one.data->client_addr == address;
    });
    if (urb == waiting_.end()) return answer(client, EINVAL);
    urb->head().status = -ENOENT;
    done_.splice(done_.end(), waiting_, urb);
    answer(client, 0);
}

// Texts are answered for every device: those of its description (USB 2.0, section 9.6.7), in US English.
MockDevice::Answer UsbfsNode::control_answer(const Setup& setup, ByteSpan sent) {
    constexpr std::uint8_t get_descriptor = 6, text = 3;
    if (setup.type != to_host || setup.request != get_descriptor || setup.value >> 8 != text)
        return device_->control(setup, sent);
    const std::size_t index = setup.value & 0xff;
    if (index == 0) return {MockDevice::Status::done, {4, text, 0x09, 0x04}};
    const std::array<std::string, 3> texts{spec_.manufacturer, spec_.product, spec_.serial};
    if (index > texts.size() || texts[index - 1].empty()) return MockDevice::stall();
    Bytes answer{static_cast<std::uint8_t>(2 + 2 * texts[index - 1].size()), text};
    for (const char c : texts[index - 1])
        answer.insert(answer.end(), {static_cast<std::uint8_t>(c), 0});
    return {MockDevice::Status::done, answer};
}

// Whether the device has dealt with it.
bool UsbfsNode::finish(Urb& urb) {
    usbdevfs_urb& head = urb.head();
    if (!device_->present) {
        head.status = -ESHUTDOWN;
        return true;
    }
    const bool control = head.type == USBDEVFS_URB_TYPE_CONTROL;
    const bool in = control ? (urb.buffer->data[0] & to_host) != 0 : (head.endpoint & to_host) != 0;
    const std::size_t room = urb.bytes().size() - (control ? setup_size : 0);
    std::uint8_t* const place = urb.buffer->data + (control ? setup_size : 0);
    const ByteSpan sent = in ? ByteSpan() : ByteSpan(place, room);
    const MockDevice::Answer answer = control ? control_answer(setup_of(urb), sent)
                                      : in    ? device_->in(head.endpoint, room)
                                              : device_->out(head.endpoint, sent);
    if (answer.status == MockDevice::Status::busy) return false;
    if (answer.status == MockDevice::Status::stall) head.status = -EPIPE;
    const std::size_t given = std::min(answer.data.size(), room);
    if (in) std::copy_n(answer.data.begin(), given, place);
    head.actual_length = static_cast<int>(in ? given : answer.status == MockDevice::Status::done ? room : 0);
    return true;
}

// As the kernel does at close(2), also of a process that has been killed.
void UsbfsNode::forget_the_gone() {
    for (std::list<Urb>* const list : {&waiting_, &done_})
        list->remove_if([](Urb& urb) {
            const bool gone = umockdev_ioctl_client_get_connected(urb.client) == FALSE;
            if (gone) release(urb);
            return gone;
        });
}

// The transfers of an endpoint are dealt with in their order: one that waits holds up the others.
void UsbfsNode::finish_what_can() {
    std::list<unsigned char> held;
    for (auto urb = waiting_.begin(); urb != waiting_.end();) {
        const auto next = std::next(urb);
        const unsigned char endpoint = urb->head().endpoint;
        if (std::find(held.begin(), held.end(), endpoint) == held.end()) {
            if (finish(*urb))
                done_.splice(done_.end(), waiting_, urb);
            else
                held.push_back(endpoint);
        }
        urb = next;
    }
}

void UsbfsNode::reap(UMockdevIoctlClient* client) {
    forget_the_gone();
    finish_what_can();
    const auto own = std::find_if(done_.begin(), done_.end(), [&](const Urb& one) { return one.client == client; });
    if (own == done_.end()) {
        // umockdev's nodes are always ready to poll(2): libusb would ask without pause.
        std::this_thread::sleep_for(std::chrono::microseconds(300));
        return answer(client, device_->present ? EAGAIN : ENODEV);
    }
    Urb urb = *own;
    done_.erase(own);
    UMockdevIoctlData* const place = resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(void*));
    umockdev_ioctl_data_set_ptr(place, 0, urb.data);
    answer(client, 0);
    release(urb);
}

}  // namespace

std::unique_ptr<Node> make_usbfs_node(const DeviceSpec& spec, std::shared_ptr<MockDevice> device) {
    return std::make_unique<UsbfsNode>(spec, std::move(device));
}

}  // namespace skyloop::mock
