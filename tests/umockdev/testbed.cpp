#include "testbed.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <umockdev.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

#include "nodes.hpp"

namespace skyloop::mock {
namespace {

constexpr const char* bus = "/devices/pci0000:00/0000:00:14.0/usb1";

std::string hexadecimal(const Bytes& bytes) {
    std::string text;
    for (const std::uint8_t byte : bytes)
        text += fmt::format("{:02X}", byte);
    return text;
}

std::string device_path(const DeviceSpec& spec) { return fmt::format("{}/1-{}", bus, spec.port); }

std::string attribute(const char* name, const std::string& value) {
    return value.empty() ? std::string() : fmt::format("A: {}={}\\n\n", name, value);
}

// umockdev(7), "device description": path, node, properties, attributes.
std::string describe_device(const DeviceSpec& spec) {
    std::string text = fmt::format("P: {}\nN: bus/usb/001/{:03}\n", device_path(spec), spec.address);
    text += fmt::format("E: DEVNAME=/dev/bus/usb/001/{:03}\nE: DEVTYPE=usb_device\nE: SUBSYSTEM=usb\n", spec.address);
    text +=
        fmt::format("E: BUSNUM=001\nE: DEVNUM={0:03}\nE: MAJOR=189\nE: MINOR={1}\n", spec.address, spec.address - 1);
    text += fmt::format("E: PRODUCT={:x}/{:x}/100\n", spec.ids.vendor, spec.ids.product);
    text += attribute("busnum", "1") + attribute("devnum", std::to_string(spec.address));
    text += attribute("devpath", spec.port) + attribute("speed", "12") + attribute("bConfigurationValue", "1");
    text += attribute("idVendor", fmt::format("{:04x}", spec.ids.vendor));
    text += attribute("idProduct", fmt::format("{:04x}", spec.ids.product));
    text += attribute("manufacturer", spec.manufacturer) + attribute("product", spec.product);
    text += attribute("serial", spec.serial);
    return text + fmt::format("H: descriptors={}\n\n", hexadecimal(descriptors(spec)));
}

std::string path_of(const DeviceSpec& spec, int interface) {
    return fmt::format("{}/1-{}:1.{}", device_path(spec), spec.port, interface);
}

std::string describe_interface(const DeviceSpec& spec, int number) {
    return fmt::format("P: {}\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\nA: bInterfaceNumber={:02}\\n\n\n",
                       path_of(spec, number), number);
}

void expect(bool done, GError* error) {
    if (done) return;
    const std::string text = error == nullptr ? "umockdev failed" : error->message;
    g_clear_error(&error);
    throw std::runtime_error(text);
}

}  // namespace

struct Testbed::State {
    UMockdevTestbed* bed = umockdev_testbed_new();
    std::map<std::string, std::unique_ptr<Node>> nodes{};
    std::vector<std::unique_ptr<Node>> pulled_nodes{};        // somebody may have them open still
    std::map<std::string, std::vector<std::string>> paths{};  // of a device: those below it, and its own last
    std::map<std::string, std::vector<std::string>> nodes_of{};
    std::map<std::string, std::vector<std::string>> lines_of{};  // nodes where nothing answers
    std::map<std::string, std::shared_ptr<MockDevice>> devices{};
};

Testbed::Testbed() : state_(std::make_unique<State>()) {
    // Without it the test would meet the machine's own devices.
    if (!umockdev_in_mock_environment()) throw std::runtime_error("expected to be started by umockdev-wrapper");
}

Testbed::~Testbed() {
    for (const auto& [node, answers] : state_->nodes)
        umockdev_testbed_detach_ioctl(state_->bed, node.c_str(), nullptr);
    g_object_unref(state_->bed);
}

void Testbed::add(const std::string& description) {
    GError* error = nullptr;
    expect(umockdev_testbed_add_from_string(state_->bed, description.c_str(), &error), error);
}

void Testbed::attach(const std::string& node, std::unique_ptr<Node> answers) {
    GError* error = nullptr;
    expect(umockdev_testbed_attach_ioctl(state_->bed, node.c_str(), handler_of(*answers), &error), error);
    state_->nodes[node] = std::move(answers);
}

void Testbed::plug_in(const DeviceSpec& spec, std::shared_ptr<MockDevice> device) {
    add(describe_device(spec));  // which tells of it, too
    attach(node_of(spec), make_usbfs_node(spec, device));
    const std::string path = device_path(spec);
    state_->paths[path] = {path};
    state_->nodes_of[path] = {node_of(spec)};
    state_->devices[path] = std::move(device);
}

// Gives the nodes where the device was answered for.
std::vector<std::string> Testbed::take_away(const DeviceSpec& spec) {
    const std::string path = device_path(spec);
    for (const std::string& line : std::exchange(state_->lines_of[path], {}))
        (void)::unlink((root() + line).c_str());
    state_->devices.at(path)->present = false;
    for (const std::string& one : state_->paths.at(path)) {
        const std::string whole = "/sys" + one;
        umockdev_testbed_uevent(state_->bed, whole.c_str(), "remove");
    }
    for (const std::string& one : state_->paths.at(path))
        umockdev_testbed_remove_device(state_->bed, ("/sys" + one).c_str());
    state_->paths.erase(path);
    state_->devices.erase(path);
    return state_->nodes_of.extract(path).mapped();
}

void Testbed::unplug(const DeviceSpec& spec) {
    for (const std::string& node : take_away(spec)) {
        umockdev_testbed_detach_ioctl(state_->bed, node.c_str(), nullptr);
        state_->pulled_nodes.push_back(std::move(state_->nodes.extract(node).mapped()));
    }
}

void Testbed::unplug_in_use(const DeviceSpec& spec) { take_away(spec); }

void Testbed::add_hidraw(const DeviceSpec& spec, int number, std::shared_ptr<MockDevice> device, const Bytes& report) {
    const std::string path = device_path(spec);
    const std::string hid = fmt::format("0003:{:04X}:{:04X}.{:04X}", spec.ids.vendor, spec.ids.product, number + 1);
    const std::string below = path_of(spec, 0) + '/' + hid;
    const std::string name = fmt::format("{} {}", spec.manufacturer, spec.product);
    const std::string id = fmt::format("HID_ID=0003:{:08X}:{:08X}", spec.ids.vendor, spec.ids.product);
    const std::string physical = fmt::format("HID_PHYS=usb-0000:00:14.0-{}/input0", spec.port);
    std::string text = describe_interface(spec, 0);
    text += fmt::format("P: {}\nE: SUBSYSTEM=hid\nE: {}\nE: HID_NAME={}\nE: {}\nE: HID_UNIQ={}\n", below, id, name,
                        physical, spec.serial);
    text += fmt::format("A: uevent={}\\nHID_NAME={}\\n{}\\nHID_UNIQ={}\\n\n", id, name, physical, spec.serial);
    text += fmt::format("H: report_descriptor={}\n\n", hexadecimal(report));
    text += fmt::format("P: {0}/hidraw/hidraw{1}\nN: hidraw{1}\nL: device=../../../{2}\n", below, number, hid);
    text += fmt::format("E: DEVNAME=/dev/hidraw{0}\nE: SUBSYSTEM=hidraw\nE: MAJOR=240\nE: MINOR={0}\n\n", number);
    add(text);
    const std::string node = fmt::format("/dev/hidraw{}", number);
    attach(node, make_hidraw_node(std::move(device), report));
    // The node is a terminal, which poll(2) finds ready once something lies in it; reads are answered by the device.
    expect(::write(umockdev_testbed_get_dev_fd(state_->bed, node.c_str()), "\n", 1) == 1, nullptr);
    std::vector<std::string>& paths = state_->paths.at(path);
    paths.insert(paths.begin(), {fmt::format("{}/hidraw/hidraw{}", below, number), below, path_of(spec, 0)});
    state_->nodes_of.at(path).push_back(node);
}

void Testbed::add_tty(const DeviceSpec& spec, int interface, const std::string& name, const std::string& driver) {
    const std::string path = device_path(spec);
    const std::string below = path_of(spec, interface);
    const bool serial = driver == "cdc_acm";  // a USB-serial driver puts a device of its own between
    const std::string tty =
        serial ? fmt::format("{}/tty/{}", below, name) : fmt::format("{0}/{1}/tty/{1}", below, name);
    add(describe_interface(spec, interface) +
        fmt::format("P: {0}\nN: {1}\nL: device=../../../1-{2}:1.{3}\nE: DEVNAME=/dev/{1}\nE: SUBSYSTEM=tty\n"
                    "E: MAJOR={4}\nE: MINOR=0\n\n",
                    tty, name, spec.port, interface, serial ? 166 : 188));
    std::vector<std::string>& paths = state_->paths.at(path);
    paths.insert(paths.begin(), {tty, below});
    state_->lines_of[path].push_back("/dev/" + name);
}

void Testbed::forbid(const DeviceSpec& spec) {
    bool done = ::chmod(root().c_str(), 0777) == 0;  // whoever listens to udev makes a socket there
    for (const std::string& node : state_->nodes_of.at(device_path(spec)))
        done = done && ::chmod((root() + node).c_str(), 0) == 0 &&
               // umockdev's own socket is no part of the play: it asks there whatever open(2) said.
               ::chmod((root() + "/ioctl/" + node).c_str(), 0777) == 0;
    expect(done, nullptr);
}

std::string Testbed::root() const {
    gchar* const root = umockdev_testbed_get_root_dir(state_->bed);
    const std::string text = root;
    g_free(root);
    return text;
}

}  // namespace skyloop::mock
