#include "world/osnma/tesla_chain.hpp"

#include <algorithm>

#include "detail/cryptography.hpp"
#include "detail/secrets.hpp"

namespace skyloop::inline world {

std::uint32_t osnma_time(GpsTime time) {
    const WeekAndTow at = gst_week_and_tow(time);
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(at.tow).count();
    return static_cast<std::uint32_t>(at.week) << 20 | static_cast<std::uint32_t>(seconds);
}

TeslaChain::TeslaChain(std::uint64_t seed, GpsTime first) : first_(first), keys_(key_count + 1) {
    const Sha256Digest last = osnma_secret(seed, "chain"), salt = osnma_secret(seed, "alpha");
    for (std::size_t i = 0; i < 6; ++i)
        alpha_ = alpha_ << 8 | salt[i];
    std::copy_n(last.begin(), keys_.back().size(), keys_.back().begin());
    // Key, time and α; plain bytes, since there are many of them.
    std::array<std::uint8_t, 16 + 4 + 6> message{};
    const auto put = [&message](std::size_t at, std::size_t count, std::uint64_t value) {
        for (std::size_t i = count; i-- > 0; value >>= 8)
            message[at + i] = static_cast<std::uint8_t>(value);
    };
    put(20, 6, alpha_);
    for (std::size_t i = keys_.size() - 1; i > 0; --i) {
        std::copy(keys_[i].begin(), keys_[i].end(), message.begin());
        put(16, 4, osnma_time(first + (static_cast<std::int64_t>(i) - 2) * osnma_subframe));
        const Sha256Digest digest = sha256_of(message);
        std::copy_n(digest.begin(), keys_[i - 1].size(), keys_[i - 1].begin());
    }
}

std::optional<TeslaKey> TeslaChain::key(GpsTime subframe) const {
    const std::int64_t index = (subframe - first_) / osnma_subframe + 1;
    if (subframe < first_ - osnma_subframe || index > key_count) return std::nullopt;
    return keys_[static_cast<std::size_t>(index)];
}

}  // namespace skyloop::inline world
