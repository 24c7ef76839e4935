// Any bytes, cuts, times and conditions: nothing crashes, every byte is accounted for, what waits is bounded, cuts and
// looks change nothing, and a wire that is sound again carries what it is given and nothing else.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "fuzz_input.hpp"
#include "require.hpp"
#include "run/fault/wire_damage.hpp"

namespace {

using namespace skyloop;

// Besides its capacity: an unfinished message of each stage, and a late one that is doubled.
constexpr std::size_t most_waiting = WireDamage::capacity + 64 * 1024;

// Only what the mask names, so that short inputs reach each kind of damage alone.
WireDirection read_direction(FuzzInput& input) {
    WireDirection direction;
    const unsigned mask = input.byte() | static_cast<unsigned>(input.byte()) << 8;
    const auto named = [&](unsigned bit) { return (mask >> bit & 1U) != 0; };
    double* const probabilities[] = {&direction.byte_loss,  &direction.bit_errors, &direction.checksum_errors,
                                     &direction.truncation, &direction.merging,    &direction.duplication,
                                     &direction.reordering};
    for (unsigned i = 0; i < std::size(probabilities); ++i)
        if (named(i)) *probabilities[i] = input.number(1);
    if (named(7)) {
        const double bursts_per_s = input.number(50);
        direction.garbage = {{bursts_per_s, input.byte() - 2}};
    }
    if (named(8)) direction.delay = Seconds(input.number(3));
    if (named(9)) direction.jitter = Seconds(input.number(1));
    if (named(10)) direction.bytes_per_s = input.number(2000);
    direction.stalled = named(11);
    direction.dead = named(12);
    return direction;
}

struct Totals {
    std::uint64_t put = 0, taken = 0;
};

void take_all(WireDamage& wire, GpsTime now, Totals& totals, Bytes& heard) {
    const Bytes bytes = wire.take(now);
    totals.taken += bytes.size();
    heard.insert(heard.end(), bytes.begin(), bytes.end());
    const WireDamageCounts counts = wire.counts();
    require(wire.waiting() <= most_waiting);
    require(totals.put + counts.bytes_inserted ==
            totals.taken + wire.waiting() + counts.bytes_lost + counts.bytes_overrun);
    const auto next = wire.next_at();
    require(!next || *next > now);  // what is due has been taken; garbage is due without a byte that waits
}

void require_soundness(WireDamage& wire, GpsTime now, Totals& totals, Bytes& heard) {
    wire.set({}, now);
    take_all(wire, now, totals, heard);
    require(wire.waiting() == 0);
    const WireDamageCounts before = wire.counts();
    for (const Bytes& probe : {Bytes{0xB5, 0x62, 1}, Bytes{'$', 'G'}, Bytes{0}}) {
        wire.put(probe, now);
        require(wire.take(now) == probe);
    }
    require(wire.counts() == before);
}

// Runs the script; with `in_parts` bytes go in one by one, and one looks after each.
Bytes play(FuzzInput input, bool in_parts) {
    WireDamage wire(input.byte(), "fuzz");
    GpsTime now{std::chrono::seconds(1'000'000'000)};
    Totals totals;
    Bytes heard;
    while (!input.empty()) {
        const std::uint8_t step = input.byte();
        now += std::chrono::milliseconds(step >> 2);
        if (in_parts) take_all(wire, now, totals, heard);
        switch (step & 3U) {
            case 0:
                wire.set(read_direction(input), now);
                break;
            case 1: {
                const ByteSpan bytes = input.part(input.byte());
                totals.put += bytes.size();
                if (!in_parts) wire.put(bytes, now);
                for (std::size_t i = 0; in_parts && i < bytes.size(); ++i)
                    wire.put(bytes.subspan(i, 1), now);
                break;
            }
            case 2:
                now += std::chrono::milliseconds(8 * input.byte());
                take_all(wire, now, totals, heard);
                break;
            default: {  // a flood
                const Bytes flood(std::size_t{64} * input.byte(), input.byte());
                totals.put += flood.size();
                wire.put(flood, now);
                break;
            }
        }
    }
    take_all(wire, now, totals, heard);
    require_soundness(wire, now, totals, heard);
    return heard;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 4096) return 0;
    const FuzzInput input({data, size});
    require(play(input, false) == play(input, true));
    return 0;
}
