#include "skyloop/client/scripted_client.hpp"

namespace skyloop {

std::size_t ScriptedClient::write(ByteSpan bytes) {
    for (const StreamPiece& piece : splitter_.feed(bytes))
        hear(piece);
    return bytes.size();
}

void ScriptedClient::tell_time(GpsTime now) {
    now_ = now;
    if (!std::exchange(begun_, true)) {
        news_ = belief_;
        start();
    }
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

}  // namespace skyloop
