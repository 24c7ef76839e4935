/// A caster's corrections as bytes that reach a receiver's port.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "receiver/protocol/stream_splitter.hpp"
#include "wire/ntrip/ntrip_client.hpp"
#include "wire/transport/transport.hpp"

namespace skyloop::inline run {

/// A wire that only brings something. Frames of RTCM 3 arrive whole, whatever pieces the network makes of them; what is
/// none (SPARTN, RTCM 2) arrives as it comes, up to 256 bytes late.
///
/// State: the frame that is not yet whole, and the counts.
class CorrectionsWire : public Transport {
public:
    explicit CorrectionsWire(const NtripClientSettings& settings)
        : client_(settings), name_(shown_uri(settings.address)), splitter_({false, false, true}) {}

    void begin() override { client_.start(); }
    std::size_t write(ByteSpan bytes) override { return bytes.size(); }
    Bytes read() override;
    LineState line() override { return {client_.connected(), std::nullopt}; }
    std::vector<std::string> take_news() override { return client_.take_news(); }
    [[nodiscard]] std::string other_end() const override;
    /// "ntrip://127.0.0.1:2101/BASE (ntrip)": neither user nor password.
    [[nodiscard]] std::string description() const override { return name_ + " (ntrip)"; }

    [[nodiscard]] bool wants_position() const { return client_.wants_position(); }
    void tell_position(std::string gga) { client_.tell_position(std::move(gga)); }
    [[nodiscard]] NtripClientCounts counts() const { return client_.counts(); }
    /// Whole frames of RTCM 3 that have arrived.
    [[nodiscard]] std::uint64_t messages() const { return messages_; }

private:
    NtripClient client_;
    std::string name_;
    StreamSplitter splitter_;
    std::uint64_t messages_ = 0;
};

}  // namespace skyloop::inline run
