#include "detail/hub_port_claim.hpp"

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace skyloop {

std::unique_ptr<HubPortClaim> HubPortClaim::take(const std::string& node, int port) {
    const int file = ::open(node.c_str(), O_RDWR | O_CLOEXEC);
    if (file < 0) return nullptr;
    auto number = static_cast<unsigned>(port);
    if (::ioctl(file, USBDEVFS_CLAIM_PORT, &number) == 0)
        return std::unique_ptr<HubPortClaim>(new HubPortClaim(file, number));
    ::close(file);
    return nullptr;
}

HubPortClaim::~HubPortClaim() {
    ::ioctl(file_, USBDEVFS_RELEASE_PORT, &port_);
    ::close(file_);
}

}  // namespace skyloop
