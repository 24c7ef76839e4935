#include <fmt/format.h>
#include <libusb-1.0/libusb.h>

#include "wire/usb/cdc_acm.hpp"

namespace skyloop::inline wire {
namespace {

// USB-IF defined class codes; CDC 1.2, tables 13 and 15.
constexpr std::uint8_t communications_class = 0x02, abstract_control_model = 0x02, data_class = 0x0a;
constexpr std::uint8_t mass_storage_class = 0x08;
constexpr std::uint8_t class_specific_interface = 0x24, union_subtype = 0x06;

using Configuration = std::unique_ptr<libusb_config_descriptor, decltype(&libusb_free_config_descriptor)>;

Configuration active_configuration(const UsbDevice& device) {
    libusb_config_descriptor* configuration = nullptr;
    if (libusb_get_active_config_descriptor(device.get(), &configuration) != LIBUSB_SUCCESS) configuration = nullptr;
    return {configuration, libusb_free_config_descriptor};
}

// Of each interface the first setting: no abstract control model has others.
std::vector<const libusb_interface_descriptor*> interfaces(const libusb_config_descriptor& configuration) {
    std::vector<const libusb_interface_descriptor*> all;
    for (int i = 0; i < configuration.bNumInterfaces; ++i)
        if (configuration.interface[i].num_altsetting > 0) all.push_back(configuration.interface[i].altsetting);
    return all;
}

// Whether it has a bulk endpoint each way; then `shape` names them.
bool take_bulk_endpoints(const libusb_interface_descriptor& interface, CdcAcmShape& shape) {
    bool in = false, out = false;
    for (int i = 0; i < interface.bNumEndpoints; ++i) {
        const libusb_endpoint_descriptor& endpoint = interface.endpoint[i];
        if ((endpoint.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK) != LIBUSB_TRANSFER_TYPE_BULK) continue;
        const bool is_in = (endpoint.bEndpointAddress & LIBUSB_ENDPOINT_DIR_MASK) == LIBUSB_ENDPOINT_IN;
        if (is_in ? in : out) continue;
        (is_in ? in : out) = true;
        (is_in ? shape.bulk_in : shape.bulk_out) = endpoint.bEndpointAddress;
        constexpr unsigned size_bits = 0x7ff;  // USB 2.0, table 9-13
        if (!is_in) shape.out_packet = static_cast<std::uint16_t>(endpoint.wMaxPacketSize & size_bits);
    }
    shape.data_interface = interface.bInterfaceNumber;
    return in && out && shape.out_packet > 0;
}

bool is_abstract_control(const libusb_interface_descriptor& interface) {
    return interface.bInterfaceClass == communications_class && interface.bInterfaceSubClass == abstract_control_model;
}

// The data of a control interface: where its union says, else in the interface behind it, else in itself.
std::optional<CdcAcmShape> shape_of(const libusb_interface_descriptor& control,
                                    const std::vector<const libusb_interface_descriptor*>& all) {
    const auto joined = read_cdc_union({control.extra, static_cast<std::size_t>(control.extra_length)});
    const int behind = control.bInterfaceNumber + 1;
    for (const int wanted : {joined ? int{joined->data} : behind, behind, int{control.bInterfaceNumber}})
        for (const libusb_interface_descriptor* interface : all) {
            CdcAcmShape shape;
            shape.control_interface = control.bInterfaceNumber;
            if (interface->bInterfaceNumber == wanted && take_bulk_endpoints(*interface, shape)) return shape;
        }
    return std::nullopt;
}

}  // namespace

std::optional<CdcUnion> read_cdc_union(ByteSpan descriptors) {
    constexpr std::size_t union_size = 5;  // with one subordinate interface
    while (descriptors.size() >= 3) {
        const std::size_t size = descriptors[0];
        if (size < 3 || size > descriptors.size()) return std::nullopt;
        if (descriptors[1] == class_specific_interface && descriptors[2] == union_subtype && size >= union_size)
            return CdcUnion{descriptors[3], descriptors[4]};
        descriptors = descriptors.subspan(size);
    }
    return std::nullopt;
}

Result<CdcAcmShape> cdc_acm_shape(const UsbDevice& device) {
    const Configuration configuration = active_configuration(device);
    if (!configuration)
        return fail(ErrorCode::outside, fmt::format("USB device {} does not tell its interfaces: it is not configured",
                                                    to_string(describe(device).ids)));
    const auto all = interfaces(*configuration);
    for (const libusb_interface_descriptor* interface : all)
        if (is_abstract_control(*interface))
            if (const auto shape = shape_of(*interface, all)) return *shape;
    for (const bool data_only : {true, false})
        for (const libusb_interface_descriptor* interface : all) {
            const bool fits =
                data_only ? interface->bInterfaceClass == data_class : interface->bInterfaceClass != mass_storage_class;
            if (CdcAcmShape shape; fits && take_bulk_endpoints(*interface, shape)) return shape;
        }
    return fail(
        ErrorCode::outside,
        fmt::format("USB device {} is no serial device: expected a CDC-ACM interface, or one with bulk endpoints "
                    "both ways",
                    to_string(describe(device).ids)));
}

}  // namespace skyloop::inline wire
