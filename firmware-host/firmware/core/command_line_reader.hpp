/// Lines of text that a client writes to a receiver with a command line.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"

namespace skyloop::firmware {

/// What becomes of a line that is too long.
enum class LongLine {
    begins_anew,  ///< what has come of it is forgotten
    is_cut        ///< what follows is left out
};

/// Cuts what a client writes into lines. Frames of RTCM 3 and what else is no text are left out.
/// State: the line that has begun.
class CommandLineReader {
public:
    /// @param longest characters of a line (mosaic-X5 reference guide, section 3.1.1: 2000)
    explicit CommandLineReader(std::size_t longest = 2000, LongLine way = LongLine::begins_anew)
        : longest_(longest), way_(way) {}

    /// Lines that are whole now, without their ends; empty ones too.
    std::vector<std::string> feed(ByteSpan bytes);

private:
    void add(std::uint8_t byte);

    std::size_t longest_;
    LongLine way_;
    std::string line_;
    Bytes head_;            // of a frame of RTCM 3 that has begun
    std::size_t skip_ = 0;  // bytes of it that are still to come
    bool after_return_ = false;
};

}  // namespace skyloop::firmware
