/// Lines in what a client writes.
#pragma once

#include <string>
#include <vector>

#include "base/core/bytes.hpp"

namespace skyloop::firmware {

/// Cuts what a client writes into lines. Frames of RTCM 3 and what else is no text are left out.
/// State: the line that has begun.
class CommandLineReader {
public:
    /// Lines that are whole now, without their ends; empty ones too.
    std::vector<std::string> feed(ByteSpan bytes);

private:
    std::string line_;
    Bytes head_;            // of a frame of RTCM 3 that has begun
    std::size_t skip_ = 0;  // bytes of it that are still to come
    bool after_return_ = false;
};

}  // namespace skyloop::firmware
