/// The kernel's side of device nodes, as umockdev calls it.
#pragma once

#include <umockdev.h>

#include <memory>

#include "mock_device.hpp"
#include "testbed.hpp"

namespace skyloop::mock {

/// /dev/bus/usb/BBB/NNN: URBs of all kinds, claims, drivers (linux/usbdevice_fs.h). It answers for the texts itself.
std::unique_ptr<Node> make_usbfs_node(const DeviceSpec& spec, std::shared_ptr<MockDevice> device);
/// /dev/hidrawN (linux/hidraw.h): feature reports become the device's control transfers, output reports go to its
/// endpoint 0x01 and input reports come from 0x81.
std::unique_ptr<Node> make_hidraw_node(std::shared_ptr<MockDevice> device, const Bytes& report_descriptor);
/// What umockdev is to be given for either.
UMockdevIoctlBase* handler_of(Node& node);

/// Both kinds: one call of umockdev at a time, in its own thread.
class HandlerNode : public Node {
public:
    HandlerNode();
    ~HandlerNode() override;
    HandlerNode(const HandlerNode&) = delete;
    HandlerNode& operator=(const HandlerNode&) = delete;
    [[nodiscard]] UMockdevIoctlBase* handler() const { return handler_; }

    virtual void control(UMockdevIoctlClient* client) = 0;
    virtual void read(UMockdevIoctlClient* client);
    virtual void write(UMockdevIoctlClient* client);

protected:
    /// What the call's argument points to, `size` bytes of it from `offset` on; lives as long as the argument.
    static UMockdevIoctlData* resolve(UMockdevIoctlData* argument, std::size_t offset, std::size_t size);

private:
    UMockdevIoctlBase* handler_;
};

}  // namespace skyloop::mock
