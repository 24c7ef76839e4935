#include "firmware/core/command_line_reader.hpp"

#include <cstdint>
#include <utility>

namespace skyloop::firmware {
namespace {

constexpr std::uint8_t corrections_begin = 0xD3;  // of RTCM 3

}  // namespace

void CommandLineReader::add(std::uint8_t byte) {
    const bool text = byte >= 0x20 && byte < 0x7F;
    if (text && line_.size() < longest_)
        line_ += static_cast<char>(byte);
    else if (!text || way_ == LongLine::begins_anew)
        line_.clear();
}

std::vector<std::string> CommandLineReader::feed(ByteSpan bytes) {
    std::vector<std::string> lines;
    for (const std::uint8_t byte : bytes) {
        if (skip_ > 0) {
            --skip_;
            continue;
        }
        if (!head_.empty() || byte == corrections_begin) {
            head_.push_back(byte);
            if (head_.size() < 3) continue;
            constexpr std::size_t crc_bytes = 3;
            skip_ = (std::size_t{head_[1]} & 3u) * 256 + head_[2] + crc_bytes;
            head_.clear();
            line_.clear();
            continue;
        }
        const bool line_end = byte == '\r' || byte == '\n';
        if (line_end && !(byte == '\n' && after_return_)) lines.push_back(std::exchange(line_, {}));
        after_return_ = byte == '\r';
        if (!line_end) add(byte);
    }
    return lines;
}

}  // namespace skyloop::firmware
