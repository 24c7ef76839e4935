// Any bytes as a feed of JSON lines, whole or in pieces, and what it says put on a path: finite states, one line of
// refusal each, the same samples whatever the pieces.
#include <algorithm>
#include <cstdint>
#include <string>

#include "motion/trajectory/live_path.hpp"
#include "motion/trajectory/source_clock.hpp"
#include "require.hpp"
#include "run/feed/feed_dialect.hpp"

namespace {

using namespace skyloop;

// @return samples that were heard
std::size_t hear_in_pieces(ByteSpan bytes, std::size_t piece) {
    const auto dialect = make_dialect("json", FeedContext());
    SourceClock clock(piece % 2 == 0 ? ClockMode::realtime : ClockMode::follow, GpsTime(), 0);
    LivePath path{LivePathSettings()};
    std::size_t samples = 0;
    std::int64_t now_ns = 0;
    while (!bytes.empty()) {
        const std::size_t size = std::min(piece, bytes.size());
        const FeedNews news = dialect->hear(bytes.first(size), now_ns += 10'000'000);
        bytes = bytes.subspan(size);
        require(news.refusal.find('\n') == std::string::npos && (news.refused > 0) == !news.refusal.empty());
        for (const Bytes& answer : news.answers)
            require(!answer.empty() && answer.back() == '\n');
        samples += news.samples.size();
        for (const TruthSample& sample : news.samples) {
            const GpsTime time = clock.stamp(sample.source_time, sample.received_ns).time;
            path.add(time, sample);
            const TruthState state = path.at(time + Nanoseconds(30'000'000));
            require(state.position.vector().allFinite() && state.velocity.vector().allFinite());
        }
    }
    return samples;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const ByteSpan bytes(data, size);
    require(hear_in_pieces(bytes, 7) == hear_in_pieces(bytes, size + 1));
    return 0;
}
