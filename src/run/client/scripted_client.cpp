#include "run/client/scripted_client.hpp"

namespace skyloop::inline run {
namespace {

constexpr Nanoseconds acts_every = std::chrono::milliseconds(10);

}  // namespace

std::size_t ScriptedClient::write(ByteSpan bytes) {
    inbox_.insert(inbox_.end(), bytes.begin(), bytes.end());
    return bytes.size();
}

std::optional<GpsTime> ScriptedClient::acts_at(GpsTime now) const {
    return now + (acts_every - now.time_since_epoch() % acts_every);
}

void ScriptedClient::tell_time(GpsTime now) {
    if (now.time_since_epoch() % acts_every != Nanoseconds(0)) return;
    now_ = now;
    if (!std::exchange(begun_, true)) {
        news_ = belief_;
        start();
    }
    for (const StreamPiece& piece : splitter_.feed(std::exchange(inbox_, {})))
        hear(piece);
    pass_time();
}

void ScriptedClient::set_speed(std::uint32_t speed) {
    speed_ = speed;
    splitter_ = StreamSplitter(StreamProtocols{.rtcm3 = false, .impatient = true});
}

void ScriptedClient::believe(bool trusts, std::string reason) {
    if (trusts == belief_.trusts) {
        belief_.reason = std::move(reason);
        return;
    }
    belief_ = {trusts, std::move(reason)};
    news_ = belief_;
}

}  // namespace skyloop::inline run
