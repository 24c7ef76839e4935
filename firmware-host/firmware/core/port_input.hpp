/// From the bytes that a port receives to whole pieces.
#pragma once

#include <functional>

#include "firmware/core/parts.hpp"

namespace skyloop::firmware {

class PortInput {
public:
    /// What a piece leads to; false: the receiver does not listen any longer.
    using Handler = std::function<bool(PortUnit& unit, const StreamPiece& piece, GpsTime now)>;
    /// What a frame of corrections without a right checksum leads to.
    using Damaged = std::function<void(PortUnit& unit, GpsTime now)>;

    PortInput(ReceiverParts& parts, Handler handle, Damaged damaged)
        : parts_(parts), handle_(std::move(handle)), damaged_(std::move(damaged)) {}

    void receive(PortUnit& unit, ByteSpan bytes, GpsTime now);
    /// Decides what was begun long ago, as if nothing followed.
    void give_up_unfinished(PortUnit& unit, GpsTime now);

private:
    void plan_to_give_way(const PortUnit& unit);
    void give_way(PortUnit& unit, GpsTime now);
    void work_off(PortUnit& unit, const std::vector<StreamPiece>& pieces, GpsTime now);

    ReceiverParts& parts_;
    Handler handle_;
    Damaged damaged_;
};

}  // namespace skyloop::firmware
