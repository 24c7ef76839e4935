/// Navigation messages that real receivers have handed out.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/core/files.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "receiver/protocol/ubx_raw.hpp"
#include "receiver/protocol/ubx_satellites.hpp"

namespace skyloop::test {

/// One RXM-SFRBX.
struct RealFrame {
    int gnss = 0, sv = 0, signal = 0;
    std::vector<std::uint32_t> words;
};

inline std::vector<RealFrame> real_frames(const std::filesystem::path& path) {
    const auto log = read_text_file(path);
    EXPECT_TRUE(log.has_value()) << path;
    std::vector<RealFrame> result;
    if (!log) return result;
    StreamSplitter splitter;
    for (const StreamPiece& piece : splitter.feed(to_bytes(*log))) {
        const auto frame = piece.kind == StreamKind::ubx ? parse_frame(piece.bytes) : std::nullopt;
        const auto page =
            frame && frame->id == RxmSfrbx::message_id ? decode_payload<RxmSfrbx>(frame->payload) : std::nullopt;
        if (page) result.push_back({page->gnss_id, page->sv_id, page->sig_id, page->words});
    }
    return result;
}

}  // namespace skyloop::test
