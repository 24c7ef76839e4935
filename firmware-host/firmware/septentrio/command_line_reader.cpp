#include "firmware/septentrio/command_line_reader.hpp"

#include <cstdint>
#include <utility>

namespace skyloop::firmware {
namespace {

constexpr std::uint8_t rtcm3_begins = 0xD3;
constexpr std::size_t longest_command = 2000;  // characters (mosaic-X5 reference guide, section 3.1.1)

}  // namespace

std::vector<std::string> CommandLineReader::feed(ByteSpan bytes) {
    std::vector<std::string> lines;
    for (const std::uint8_t byte : bytes) {
        if (skip_ > 0) {
            --skip_;
            continue;
        }
        if (!head_.empty() || byte == rtcm3_begins) {
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
        if (line_end) continue;
        const bool text = byte >= 0x20 && byte < 0x7F;
        if (text && line_.size() < longest_command)
            line_ += static_cast<char>(byte);
        else
            line_.clear();
    }
    return lines;
}

}  // namespace skyloop::firmware
