/// A splitter for what a client sends, which tells payloads from false beginnings by the time.
#pragma once

#include <optional>

#include "base/time/gps_time.hpp"
#include "receiver/protocol/stream_splitter.hpp"

namespace skyloop {

/// Cuts a stream into pieces. A whole frame inside something that is not yet whole is its payload, or what follows a
/// false beginning: the latter after 100 ms without another byte, at the latest after 1 s.
///
/// State: that of its StreamSplitter, and when something inside was whole first.
class PatientSplitter {
public:
    PatientSplitter() = default;
    explicit PatientSplitter(StreamProtocols protocols) : splitter_(protocols) {}

    /// The pieces that `bytes` completes. Where the time of give_way() has come it is called first.
    std::vector<StreamPiece> feed(ByteSpan bytes, GpsTime now);
    /// When a beginning counts as false unless more bytes come; nothing while there is none.
    [[nodiscard]] std::optional<GpsTime> gives_way_at() const { return gives_way_at_; }
    /// The pieces that come out then.
    std::vector<StreamPiece> give_way();
    /// Decides what is left as if nothing followed.
    std::vector<StreamPiece> finish();
    [[nodiscard]] const StreamCounts& counts() const { return splitter_.counts(); }

private:
    StreamSplitter splitter_;
    std::optional<GpsTime> held_since_, gives_way_at_;
};

}  // namespace skyloop
