#include "wire/usb/serial_bridge.hpp"

#include <algorithm>
#include <utility>

namespace skyloop::inline wire {

std::size_t BridgeBuffers::offer(ByteSpan bytes) {
    const std::lock_guard lock(mutex_);
    const std::size_t taken = std::min(bytes.size(), most_output - output_size_);
    const ByteSpan accepted = bytes.first(taken);
    Bytes& last = pieces_.back().bytes;
    last.insert(last.end(), accepted.begin(), accepted.end());
    output_size_ += taken;
    return taken;
}

void BridgeBuffers::ask_speed(std::uint32_t baud) {
    const std::lock_guard lock(mutex_);
    if (pieces_.back().bytes.empty())
        pieces_.back().baud = baud;
    else if (pieces_.back().baud != baud)
        pieces_.push_back({baud, {}});
}

Bytes BridgeBuffers::take_input() {
    const std::lock_guard lock(mutex_);
    return std::exchange(input_, {});
}

std::vector<std::string> BridgeBuffers::take_news() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, {});
}

bool BridgeBuffers::gone() const {
    const std::lock_guard lock(mutex_);
    return gone_;
}

std::optional<BridgeBuffers::Piece> BridgeBuffers::next_output(std::size_t most) {
    const std::lock_guard lock(mutex_);
    if (pieces_.size() > 1 && pieces_.front().bytes.empty()) pieces_.pop_front();
    Piece& front = pieces_.front();
    if (front.bytes.empty() && front.baud == given_baud_) return std::nullopt;
    const auto size = static_cast<std::ptrdiff_t>(std::min(most, front.bytes.size()));
    Piece piece{front.baud, Bytes(front.bytes.begin(), front.bytes.begin() + size)};
    front.bytes.erase(front.bytes.begin(), front.bytes.begin() + size);
    output_size_ -= piece.bytes.size();
    given_baud_ = piece.baud;
    return piece;
}

bool BridgeBuffers::output_waits() const {
    const std::lock_guard lock(mutex_);
    return output_size_ > 0;
}

void BridgeBuffers::put_input(ByteSpan bytes) {
    const std::lock_guard lock(mutex_);
    input_.insert(input_.end(), bytes.begin(), bytes.end());
}

bool BridgeBuffers::input_full() const {
    const std::lock_guard lock(mutex_);
    return input_.size() >= most_input;
}

void BridgeBuffers::tell(std::string news) {
    const std::lock_guard lock(mutex_);
    news_.push_back(std::move(news));
}

void BridgeBuffers::set_gone() {
    const std::lock_guard lock(mutex_);
    gone_ = true;
}

}  // namespace skyloop::inline wire
