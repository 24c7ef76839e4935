#include <linux/hidraw.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "nodes.hpp"

namespace skyloop::mock {
namespace {

// umockdev keeps what it resolved for as long as the argument it belongs to.
UMockdevIoctlData* checked(UMockdevIoctlData* data, GError* error) {
    if (data != nullptr) return data;
    const std::string text = error == nullptr ? "umockdev gave no memory" : error->message;
    g_clear_error(&error);
    throw std::runtime_error(text);
}

gboolean on_control(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer node) {
    static_cast<HandlerNode*>(node)->control(client);
    return TRUE;
}

gboolean on_read(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer node) {
    static_cast<HandlerNode*>(node)->read(client);
    return TRUE;
}

gboolean on_write(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer node) {
    static_cast<HandlerNode*>(node)->write(client);
    return TRUE;
}

class HidrawNode : public HandlerNode {
public:
    HidrawNode(std::shared_ptr<MockDevice> device, Bytes descriptor)
        : device_(std::move(device)), descriptor_(std::move(descriptor)) {}
    void control(UMockdevIoctlClient* client) override;
    void read(UMockdevIoctlClient* client) override;
    void write(UMockdevIoctlClient* client) override;

private:
    static constexpr std::uint8_t set_report = 9, get_report = 1;  // HID 1.11, section 7.2
    static constexpr std::uint16_t feature = 3 << 8;
    void feature_report(UMockdevIoctlClient* client, unsigned request);
    static void answer(UMockdevIoctlClient* client, long result, int error = 0) {
        umockdev_ioctl_client_complete(client, error == 0 ? result : -1, error);
    }

    std::shared_ptr<MockDevice> device_;
    Bytes descriptor_;
};

void HidrawNode::control(UMockdevIoctlClient* client) {
    const auto request = static_cast<unsigned>(umockdev_ioctl_client_get_request(client));
    UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
    if (!device_->present) return answer(client, 0, ENODEV);
    if (request == static_cast<unsigned>(HIDIOCGRDESCSIZE)) {
        *reinterpret_cast<int*>(resolve(argument, 0, sizeof(int))->data) = static_cast<int>(descriptor_.size());
        return answer(client, 0);
    }
    if (request == static_cast<unsigned>(HIDIOCGRDESC)) {
        auto& place =
            *reinterpret_cast<hidraw_report_descriptor*>(resolve(argument, 0, sizeof(hidraw_report_descriptor))->data);
        std::copy(descriptor_.begin(), descriptor_.end(), place.value);
        return answer(client, 0);
    }
    if (_IOC_TYPE(request) == 'H' && (_IOC_NR(request) == 0x06 || _IOC_NR(request) == 0x07))
        return feature_report(client, request);
    answer(client, 0, ENOTTY);
}

// The first byte is the report's number; a device whose reports have none does not see it.
void HidrawNode::feature_report(UMockdevIoctlClient* client, unsigned request) {
    const std::size_t size = _IOC_SIZE(request);
    std::uint8_t* const bytes = resolve(umockdev_ioctl_client_get_arg(client), 0, size)->data;
    const std::size_t skipped = bytes[0] == 0 ? 1 : 0;
    const auto length = static_cast<std::uint16_t>(size - skipped);
    const auto value = static_cast<std::uint16_t>(feature | bytes[0]);
    const bool sends = _IOC_NR(request) == 0x06;
    const MockDevice::Answer done =
        sends ? device_->control({0x21, set_report, value, 0, length}, ByteSpan(bytes + skipped, length))
              : device_->control({0xa1, get_report, value, 0, length}, {});
    if (done.status != MockDevice::Status::done) return answer(client, 0, EPIPE);
    if (sends) return answer(client, static_cast<long>(size));
    const std::size_t given = std::min<std::size_t>(done.data.size(), length);
    std::copy_n(done.data.begin(), given, bytes + skipped);
    answer(client, static_cast<long>(given + skipped));
}

void HidrawNode::read(UMockdevIoctlClient* client) {
    if (!device_->present) return answer(client, 0, EIO);
    UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
    const auto room = static_cast<std::size_t>(argument->data_len);
    const MockDevice::Answer report = device_->in(0x81, room);
    if (report.status != MockDevice::Status::done) {
        std::this_thread::sleep_for(std::chrono::microseconds(300));  // the node is always ready to poll(2)
        return answer(client, 0, EAGAIN);
    }
    const std::size_t given = std::min(report.data.size(), room);
    std::copy_n(report.data.begin(), given, argument->data);
    answer(client, static_cast<long>(given));
}

void HidrawNode::write(UMockdevIoctlClient* client) {
    if (!device_->present) return answer(client, 0, EIO);
    const UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
    const auto size = static_cast<std::size_t>(argument->data_len);
    const std::size_t skipped = size > 0 && argument->data[0] == 0 ? 1 : 0;
    const MockDevice::Answer done = device_->out(0x01, ByteSpan(argument->data + skipped, size - skipped));
    answer(client, static_cast<long>(size), done.status == MockDevice::Status::done ? 0 : EPIPE);
}

}  // namespace

HandlerNode::HandlerNode() : handler_(umockdev_ioctl_base_new()) {
    g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(on_control), static_cast<HandlerNode*>(this));
    g_signal_connect(handler_, "handle-read", G_CALLBACK(on_read), static_cast<HandlerNode*>(this));
    g_signal_connect(handler_, "handle-write", G_CALLBACK(on_write), static_cast<HandlerNode*>(this));
}

HandlerNode::~HandlerNode() { g_object_unref(handler_); }

void HandlerNode::read(UMockdevIoctlClient* client) { umockdev_ioctl_client_complete(client, -1, EINVAL); }

void HandlerNode::write(UMockdevIoctlClient* client) { umockdev_ioctl_client_complete(client, -1, EINVAL); }

UMockdevIoctlData* HandlerNode::resolve(UMockdevIoctlData* argument, std::size_t offset, std::size_t size) {
    GError* error = nullptr;
    UMockdevIoctlData* const data = umockdev_ioctl_data_resolve(argument, offset, size, &error);
    checked(data, error);
    umockdev_ioctl_data_unref(data);  // the argument holds it, too
    return data;
}

UMockdevIoctlBase* handler_of(Node& node) { return static_cast<HandlerNode&>(node).handler(); }

std::unique_ptr<Node> make_hidraw_node(std::shared_ptr<MockDevice> device, const Bytes& report_descriptor) {
    return std::make_unique<HidrawNode>(std::move(device), report_descriptor);
}

}  // namespace skyloop::mock
