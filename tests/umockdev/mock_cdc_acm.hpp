/// A USB serial device that a test looks into: a u-blox receiver's shape, or any bridge with an abstract control model.
#pragma once

#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <vector>

#include "mock_device.hpp"

namespace skyloop::mock {

/// What the host did to it, in its order; and what it says. All functions may be called from the test at any time.
class MockCdcAcm : public MockDevice {
public:
    explicit MockCdcAcm(std::string driver = "cdc_acm") { drivers_ = {{0, driver}, {1, driver}}; }

    Answer control(const Setup& setup, ByteSpan data) override;
    Answer out(std::uint8_t endpoint, ByteSpan data) override;
    Answer in(std::uint8_t endpoint, std::size_t most) override;
    void halt_cleared(std::uint8_t endpoint) override;
    void zero_packet_asked(std::uint8_t endpoint) override;
    std::string driver(unsigned interface) override;
    void detach_driver(unsigned interface) override;
    void attach_driver(unsigned interface) override;
    void claimed(unsigned interface, bool now) override;

    /// What it sends next.
    void say(const Bytes& bytes);
    /// Every byte that it was sent.
    Bytes heard();
    /// With how many bytes it had heard by then: each line coding as it was set (PSTN 1.2, table 17).
    struct Coding {
        std::size_t after_bytes = 0;
        Bytes coding;
        [[nodiscard]] std::uint32_t baud() const;
    };
    std::vector<Coding> codings();
    /// DTR in bit 0, RTS in bit 1 (PSTN 1.2, table 18); nothing before it was set.
    std::optional<unsigned> lines();
    /// The endpoint answers with stalls until its halt is cleared.
    void stall_endpoint(std::uint8_t endpoint);
    /// It takes no data, as a UART whose other end holds it up.
    void take_data(bool yes);
    /// Requests of its class stall, as of a device that does without.
    void refuse_line_coding();
    [[nodiscard]] int halts_cleared();
    [[nodiscard]] int zero_packets();
    std::set<unsigned> claims();
    /// The largest number of bytes that one transfer could have brought.
    std::size_t largest_in();

private:
    std::mutex mutex_;
    std::map<unsigned, std::string> drivers_;
    std::map<unsigned, std::string> detached_;
    std::set<unsigned> claims_;
    std::deque<std::uint8_t> to_say_;
    Bytes heard_;
    std::vector<Coding> codings_;
    std::optional<unsigned> lines_;
    std::set<std::uint8_t> halted_;
    bool takes_data_ = true;
    bool refuses_coding_ = false;
    int halts_cleared_ = 0;
    int zero_packets_ = 0;
    std::size_t largest_in_ = 0;
};

}  // namespace skyloop::mock
