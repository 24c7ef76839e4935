/// What a splitter finds in a stream that arrives in portions.
#pragma once

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "receiver/protocol/stream_splitter.hpp"

namespace skyloop::test {

/// @param portion bytes at a time, 1 or more
inline std::vector<StreamPiece> split_stream(StreamSplitter& splitter, ByteSpan stream, std::size_t portion) {
    std::vector<StreamPiece> pieces;
    const auto keep = [&](std::vector<StreamPiece> more) {
        std::move(more.begin(), more.end(), std::back_inserter(pieces));
    };
    for (std::size_t at = 0; at < stream.size(); at += portion)
        keep(splitter.feed(stream.subspan(at, std::min(portion, stream.size() - at))));
    keep(splitter.finish());
    return pieces;
}

inline std::vector<StreamPiece> split_stream(StreamProtocols protocols, ByteSpan stream, std::size_t portion) {
    StreamSplitter splitter(protocols);
    return split_stream(splitter, stream, portion);
}

}  // namespace skyloop::test
