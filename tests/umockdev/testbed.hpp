/// A bus of virtual devices that every program and library of this process sees in place of the machine's own.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "descriptors.hpp"
#include "mock_device.hpp"

namespace skyloop::mock {

/// What plays a node: the kernel's side of its system calls.
class Node {
public:
    virtual ~Node() = default;
};

/// Needs umockdev-wrapper. Devices are plugged in and taken out at any time; libusb, udev and hidapi hear of it as of
/// real ones. Failures of umockdev end the test.
class Testbed {
public:
    Testbed();
    ~Testbed();
    Testbed(const Testbed&) = delete;
    Testbed& operator=(const Testbed&) = delete;

    /// The device appears in sysfs and under node_of(spec), where `device` answers, with a uevent.
    void plug_in(const DeviceSpec& spec, std::shared_ptr<MockDevice> device);
    /// Every call to it fails from now on, then it goes, with a uevent.
    void unplug(const DeviceSpec& spec);
    /// The same of a device that another thread may be opening at this moment. Its node's socket stays until the end:
    /// umockdev ends a program whose call it closes it under. To be plugged in again it needs another address.
    void unplug_in_use(const DeviceSpec& spec);
    /// The kernel's HID driver makes /dev/hidrawN of a HID device that has been plugged in. umockdev takes each N once.
    void add_hidraw(const DeviceSpec& spec, int number, std::shared_ptr<MockDevice> device, const Bytes& report);
    /// The kernel's driver makes the line `name`, "ttyACM0", of its interface; nothing answers there. Each name once.
    void add_tty(const DeviceSpec& spec, int interface, const std::string& name, const std::string& driver);
    /// From now on only the superuser may open its nodes.
    void forbid(const DeviceSpec& spec);
    /// Where sysfs is while the testbed lives, and where device nodes are: paths such as /sys and /dev are led there.
    [[nodiscard]] std::string root() const;

private:
    void add(const std::string& description);
    void attach(const std::string& node, std::unique_ptr<Node> answers);
    std::vector<std::string> take_away(const DeviceSpec& spec);

    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace skyloop::mock
