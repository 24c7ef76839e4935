/// What a virtual device does; how its answers reach libusb or hidapi is the business of its nodes.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "base/core/bytes.hpp"

namespace skyloop::mock {

/// The first eight bytes of a control transfer (USB 2.0, table 9-2).
struct Setup {
    std::uint8_t type = 0;
    std::uint8_t request = 0;
    std::uint16_t value = 0;
    std::uint16_t index = 0;
    std::uint16_t length = 0;
};

/// Called in umockdev's own thread, one call at a time; what a test reads meanwhile is the device's to guard. A device
/// that is not asked something else stalls, as a real one.
class MockDevice {
public:
    virtual ~MockDevice() = default;

    enum class Status { done, stall, busy };  ///< busy: not yet (NAK); it is asked again
    /// How much of what came was taken, or what is given.
    struct Answer {
        Status status = Status::done;
        Bytes data{};
    };
    static Answer stall() { return {Status::stall, {}}; }
    static Answer busy() { return {Status::busy, {}}; }

    /// `data` came with a transfer to the device. Never busy.
    virtual Answer control(const Setup&, ByteSpan /*data*/) { return stall(); }
    /// A bulk or interrupt transfer to the device, without the packet of no length that may end it. All is taken.
    virtual Answer out(std::uint8_t /*endpoint*/, ByteSpan /*data*/) { return stall(); }
    /// Up to `most` bytes for such a transfer from the device.
    virtual Answer in(std::uint8_t /*endpoint*/, std::size_t /*most*/) { return busy(); }
    /// The kernel was asked to end a stall.
    virtual void halt_cleared(std::uint8_t /*endpoint*/) {}
    /// A transfer to the device asked for a packet of no length at its end, where its length needs one.
    virtual void zero_packet_asked(std::uint8_t /*endpoint*/) {}

    /// The kernel's driver of interface N; empty: none.
    virtual std::string driver(unsigned /*interface*/) { return {}; }
    virtual void detach_driver(unsigned /*interface*/) {}
    virtual void attach_driver(unsigned /*interface*/) {}
    virtual void claimed(unsigned /*interface*/, bool /*now*/) {}
    /// The kernel's hub driver is kept off port N.
    virtual void port_claimed(unsigned /*port*/, bool /*now*/) {}

    std::atomic<bool> present{true};  ///< false: pulled out
};

}  // namespace skyloop::mock
