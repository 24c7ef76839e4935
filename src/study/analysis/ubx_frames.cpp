#include "detail/ubx_frames.hpp"

namespace skyloop {
namespace {

constexpr std::string_view ubx_sync = "\xB5\x62";
constexpr std::size_t ubx_head = 6;  // sync, class, id, length
constexpr std::size_t ubx_tail = 2;  // checksum

}  // namespace

UbxFrames::UbxFrames(std::string_view log) : log_(log) {
    sums_.resize(log.size() + 1);
    sums_of_sums_.resize(log.size() + 1);
    for (std::size_t i = 0; i < log.size(); ++i) {
        sums_[i + 1] = static_cast<std::uint8_t>(sums_[i] + static_cast<std::uint8_t>(log[i]));
        sums_of_sums_[i + 1] = static_cast<std::uint8_t>(sums_of_sums_[i] + sums_[i + 1]);
    }
}

// Fletcher's checksum of RFC 1145 in eight bits: the sum of the bytes, and the sum of those sums.
bool UbxFrames::checksum_holds(std::size_t begin, std::size_t end) const {
    const auto sum = static_cast<std::uint8_t>(sums_[end] - sums_[begin]);
    const auto length = static_cast<std::uint8_t>(end - begin);
    const auto sum_of_sums =
        static_cast<std::uint8_t>(sums_of_sums_[end] - sums_of_sums_[begin] - length * sums_[begin]);
    return static_cast<std::uint8_t>(log_[end]) == sum && static_cast<std::uint8_t>(log_[end + 1]) == sum_of_sums;
}

std::optional<UbxFrame> UbxFrames::next() {
    for (;;) {
        const std::size_t begin = log_.find(ubx_sync, at_);
        if (begin == std::string_view::npos) return std::nullopt;
        at_ = begin + ubx_sync.size();
        if (log_.size() - begin < ubx_head + ubx_tail) {
            ++damaged_;
            continue;
        }
        const UbxFrame head{static_cast<std::uint8_t>(log_[begin + 2]), static_cast<std::uint8_t>(log_[begin + 3]),
                            log_.substr(begin + 4, 2)};
        const std::size_t length = head.u2(0);
        if (log_.size() - begin < ubx_head + length + ubx_tail ||
            !checksum_holds(begin + ubx_sync.size(), begin + ubx_head + length)) {
            ++damaged_;
            continue;
        }
        at_ = begin + ubx_head + length + ubx_tail;
        return UbxFrame{head.message_class, head.id, log_.substr(begin + ubx_head, length)};
    }
}

}  // namespace skyloop
