#include "run/client/port_hunt.hpp"

namespace skyloop {

std::vector<std::uint32_t> usual_speeds() { return {9600, 38400, 115200, 57600, 230400, 19200, 460800, 4800}; }

void PortHunt::start(GpsTime now) {
    hunting_ = true;
    first_ = true;
    next_ = 0;
    since_ = now;
}

bool PortHunt::advance(GpsTime now) {
    if (!hunting_ || (!first_ && now - since_ < dwell_)) return false;
    since_ = now;
    if (first_ && known_) {
        first_ = false;
        speed_ = *known_;
        return true;
    }
    first_ = false;
    speed_ = speeds_[next_];
    next_ = (next_ + 1) % speeds_.size();
    return true;
}

void PortHunt::found() {
    hunting_ = false;
    known_ = speed_;
}

}  // namespace skyloop
