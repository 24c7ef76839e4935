/// A port of a hub that the kernel leaves alone.
#pragma once

#include <memory>
#include <string>

namespace skyloop {

/// While it lives the kernel's hub driver neither switches the port's power on again, as it otherwise does where what
/// was plugged in has gone, nor gives a driver to what appears there (USBDEVFS_CLAIM_PORT). The kernel takes it back
/// from a process that ends. libusb has no call for it, so that it has a file of its own.
class HubPortClaim {
public:
    /// @param node of the hub, "/dev/bus/usb/001/004". Null: the kernel does not allow it, or somebody else has it.
    static std::unique_ptr<HubPortClaim> take(const std::string& node, int port);
    ~HubPortClaim();
    HubPortClaim(const HubPortClaim&) = delete;
    HubPortClaim& operator=(const HubPortClaim&) = delete;

private:
    HubPortClaim(int file, unsigned port) : file_(file), port_(port) {}
    int file_;
    unsigned port_;
};

}  // namespace skyloop
