#include "run/emulator/corrections_wire.hpp"

#include <fmt/format.h>

namespace skyloop::inline run {

Bytes CorrectionsWire::read() {
    const Bytes come = client_.take();
    if (come.empty()) return {};
    Bytes whole;
    for (const StreamPiece& piece : splitter_.feed(come)) {
        if (piece.kind == StreamKind::rtcm3) ++messages_;
        whole.insert(whole.end(), piece.bytes.begin(), piece.bytes.end());
    }
    return whole;
}

std::string CorrectionsWire::other_end() const {
    const NtripClientCounts counts = client_.counts();
    if (counts.version == 0) return "not connected yet";
    return fmt::format("NTRIP {}.0, {}, last bytes {:.0f} s ago, {} connections", counts.version,
                       counts.connected ? "connected" : "not connected", counts.age_s, counts.connections);
}

}  // namespace skyloop::inline run
