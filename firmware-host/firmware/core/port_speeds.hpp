/// The speeds of a receiver's ports: as they are set, or as somebody else has forced that of UART1.
#pragma once

#include <optional>

#include "firmware/core/parts.hpp"

namespace skyloop::firmware {

/// State: the speed that was forced.
class PortSpeeds {
public:
    explicit PortSpeeds(ReceiverParts& parts) : parts_(parts) {}

    /// Whether the port has been told to go to its speed.
    [[nodiscard]] bool is_set(PortId port) const;
    [[nodiscard]] bool are_set() const;
    /// Ports go to their speeds between two bytes, or where the maker has it so after what is queued.
    void plan_changes(GpsTime at);
    /// The same as soon as no byte is on its way.
    void change_now(GpsTime now);
    /// Forces the speed of UART1, or gives back that of before. Settings are changed where the board can be set to it.
    void force(const ForceBaud& wanted);
    void release() { forced_.reset(); }

private:
    struct Forced {
        std::uint32_t speed = 0, before = 0;
        bool is_setting = true;  ///< else the settings keep the one before
    };
    [[nodiscard]] std::uint32_t wanted(PortId port) const;
    [[nodiscard]] bool holds_forced() const;
    void change(PortId port, GpsTime at);

    ReceiverParts& parts_;
    std::optional<Forced> forced_;
};

}  // namespace skyloop::firmware
