/// What a client's thread and the loop hand each other.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "wire/ntrip/ntrip_client.hpp"

namespace skyloop::inline wire {

/// By any thread. The loop takes what comes by try_lock: it never waits.
class ClientInbox {
public:
    ClientInbox();

    // Of the client's thread.
    /// Corrections come. @param version of NTRIP
    void connect(int version, const std::string& uri);
    void disconnect();
    void put(const Bytes& bytes);
    [[nodiscard]] std::string position() const;
    /// Tells one that is not the last one.
    void tell_problem(const std::string& uri, const std::string& problem);

    // Of the loop.
    Bytes take();
    [[nodiscard]] bool connected() const { return connected_; }
    void set_position(std::string gga);
    [[nodiscard]] NtripClientCounts counts() const;
    std::vector<std::string> take_news();

private:
    std::atomic<bool> connected_{false};
    mutable std::mutex mutex_;
    Bytes waiting_;
    std::string position_, problem_;
    std::vector<std::string> news_;
    NtripClientCounts counts_;
    std::int64_t last_bytes_ns_;
};

}  // namespace skyloop::inline wire
