#include "mock_cdc_acm.hpp"

#include <algorithm>

namespace skyloop::mock {
namespace {

constexpr std::uint8_t to_interface = 0x21;  // class request to an interface (USB 2.0, table 9-2)
constexpr std::uint8_t set_line_coding = 0x20, set_control_line_state = 0x22;  // PSTN 1.2, table 13
constexpr std::uint8_t data_out = 0x01, data_in = 0x82;

}  // namespace

std::uint32_t MockCdcAcm::Coding::baud() const {
    return coding.size() < 4
               ? 0
               : coding[0] | static_cast<std::uint32_t>(coding[1]) << 8 | static_cast<std::uint32_t>(coding[2]) << 16 |
                     static_cast<std::uint32_t>(coding[3]) << 24;
}

MockDevice::Answer MockCdcAcm::control(const Setup& setup, ByteSpan data) {
    const std::lock_guard lock(mutex_);
    if (setup.type != to_interface || setup.index != 0 || refuses_coding_) return stall();
    if (setup.request == set_line_coding && data.size() == 7) {
        codings_.push_back({heard_.size(), Bytes(data.begin(), data.end())});
        return {};
    }
    if (setup.request != set_control_line_state) return stall();
    lines_ = setup.value;
    return {};
}

MockDevice::Answer MockCdcAcm::out(std::uint8_t endpoint, ByteSpan data) {
    const std::lock_guard lock(mutex_);
    if (endpoint != data_out || halted_.count(endpoint) != 0) return stall();
    if (!takes_data_) return busy();
    heard_.insert(heard_.end(), data.begin(), data.end());
    return {};
}

MockDevice::Answer MockCdcAcm::in(std::uint8_t endpoint, std::size_t most) {
    const std::lock_guard lock(mutex_);
    if (halted_.count(endpoint) != 0) return stall();
    if (endpoint != data_in) return busy();
    largest_in_ = std::max(largest_in_, most);
    if (to_say_.empty()) return busy();
    const auto size = static_cast<std::ptrdiff_t>(std::min(most, to_say_.size()));
    Answer answer{Status::done, Bytes(to_say_.begin(), to_say_.begin() + size)};
    to_say_.erase(to_say_.begin(), to_say_.begin() + size);
    return answer;
}

void MockCdcAcm::halt_cleared(std::uint8_t endpoint) {
    const std::lock_guard lock(mutex_);
    halted_.erase(endpoint);
    ++halts_cleared_;
}

void MockCdcAcm::zero_packet_asked(std::uint8_t endpoint) {
    const std::lock_guard lock(mutex_);
    if (endpoint == data_out) ++zero_packets_;
}

std::string MockCdcAcm::driver(unsigned interface) {
    const std::lock_guard lock(mutex_);
    const auto found = drivers_.find(interface);
    return found == drivers_.end() ? std::string() : found->second;
}

void MockCdcAcm::detach_driver(unsigned interface) {
    const std::lock_guard lock(mutex_);
    if (auto node = drivers_.extract(interface)) detached_.insert(std::move(node));
}

void MockCdcAcm::attach_driver(unsigned interface) {
    const std::lock_guard lock(mutex_);
    if (auto node = detached_.extract(interface)) drivers_.insert(std::move(node));
}

void MockCdcAcm::claimed(unsigned interface, bool now) {
    const std::lock_guard lock(mutex_);
    if (now)
        claims_.insert(interface);
    else
        claims_.erase(interface);
}

void MockCdcAcm::say(const Bytes& bytes) {
    const std::lock_guard lock(mutex_);
    to_say_.insert(to_say_.end(), bytes.begin(), bytes.end());
}

Bytes MockCdcAcm::heard() {
    const std::lock_guard lock(mutex_);
    return heard_;
}

std::vector<MockCdcAcm::Coding> MockCdcAcm::codings() {
    const std::lock_guard lock(mutex_);
    return codings_;
}

std::optional<unsigned> MockCdcAcm::lines() {
    const std::lock_guard lock(mutex_);
    return lines_;
}

void MockCdcAcm::stall_endpoint(std::uint8_t endpoint) {
    const std::lock_guard lock(mutex_);
    halted_.insert(endpoint);
}

void MockCdcAcm::take_data(bool yes) {
    const std::lock_guard lock(mutex_);
    takes_data_ = yes;
}

void MockCdcAcm::refuse_line_coding() {
    const std::lock_guard lock(mutex_);
    refuses_coding_ = true;
}

int MockCdcAcm::halts_cleared() {
    const std::lock_guard lock(mutex_);
    return halts_cleared_;
}

int MockCdcAcm::zero_packets() {
    const std::lock_guard lock(mutex_);
    return zero_packets_;
}

std::set<unsigned> MockCdcAcm::claims() {
    const std::lock_guard lock(mutex_);
    return claims_;
}

std::size_t MockCdcAcm::largest_in() {
    const std::lock_guard lock(mutex_);
    return largest_in_;
}

}  // namespace skyloop::mock
