// The readers of single formats: one function each, listed in read_track.cpp.
#pragma once

#include "skyloop/tracks/read_track.hpp"

namespace skyloop {

// The whole file, and what its reader needs to know.
struct TrackFile {
    ByteSpan bytes;
    std::string_view text;  // the same
    const std::string& name;
    const TrackReading& reading;
};

}  // namespace skyloop
