#include "detail/client_inbox.hpp"

#include <algorithm>
#include <utility>

#include "base/core/threads.hpp"

namespace skyloop::inline wire {
namespace {

constexpr std::size_t most_waiting = 65536, most_news = 100;

}  // namespace

ClientInbox::ClientInbox() : last_bytes_ns_(steady_clock_ns()) {}

void ClientInbox::connect(int version, const std::string& uri) {
    const std::lock_guard lock(mutex_);
    connected_ = true;
    counts_.version = version;
    ++counts_.connections;
    if (!problem_.empty() && news_.size() < most_news) news_.push_back(uri + ": corrections come again");
    problem_.clear();
}

void ClientInbox::disconnect() { connected_ = false; }

void ClientInbox::put(const Bytes& bytes) {
    const std::lock_guard lock(mutex_);
    last_bytes_ns_ = steady_clock_ns();
    counts_.bytes += bytes.size();
    waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
    if (waiting_.size() <= most_waiting) return;
    const std::size_t lost = waiting_.size() - most_waiting;
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(lost));
    counts_.bytes_lost += lost;
}

std::string ClientInbox::position() const {
    const std::lock_guard lock(mutex_);
    return position_;
}

void ClientInbox::tell_problem(const std::string& uri, const std::string& problem) {
    const std::lock_guard lock(mutex_);
    if (problem == problem_ || news_.size() >= most_news) return;
    problem_ = problem;
    news_.push_back(uri + ": " + problem + "; trying again");
}

Bytes ClientInbox::take() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock ? std::exchange(waiting_, {}) : Bytes();
}

void ClientInbox::set_position(std::string gga) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (lock) position_ = std::move(gga);
}

NtripClientCounts ClientInbox::counts() const {
    const std::lock_guard lock(mutex_);
    NtripClientCounts counts = counts_;
    counts.connected = connected_;
    counts.age_s = static_cast<double>(steady_clock_ns() - last_bytes_ns_) * 1e-9;
    return counts;
}

std::vector<std::string> ClientInbox::take_news() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock ? std::exchange(news_, {}) : std::vector<std::string>();
}

}  // namespace skyloop::inline wire
