/// Faults that hit whole messages on a wire.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/random.hpp"
#include "base/time/gps_time.hpp"
#include "correction_damage.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "run/fault/wire_damage.hpp"

namespace skyloop::inline run {

/// Bytes that go on together.
struct TimedBytes {
    GpsTime time;
    Bytes bytes;
    Seconds jitter{0};  ///< more of delay, either sign
};

/// Turns one bit of a message of that kind so that its frame stands and its checksum does not hold.
void spoil_checksum(Bytes& message, StreamKind kind, RandomStream& random);

/// Cuts a stream into messages and damages these: checksum errors, truncation, merging, duplication, reordering,
/// garbage between them, and the jitter of each; before all that, what is wrong with corrections. Everything is
/// appended to a list in the order of time. State: the bytes of the unfinished message, messages that are late, what is
/// due, the random numbers.
class MessageDamage {
public:
    MessageDamage(std::uint64_t seed, std::string_view stream);

    /// What is wrong from `now` on; what nothing holds any longer comes out.
    void set(const WireDirection& direction, GpsTime now, std::vector<TimedBytes>& out);
    /// Whether bytes must pass through here.
    [[nodiscard]] bool active() const { return active_; }
    /// Bytes that enter at `now`, to which advance() must have come.
    void put(ByteSpan bytes, GpsTime now, std::vector<TimedBytes>& out);
    /// What happens by `now` without new bytes.
    void advance(GpsTime now, std::vector<TimedBytes>& out);
    /// When something comes out at the latest that is held now, or garbage of its own.
    [[nodiscard]] std::optional<GpsTime> next_at() const;
    [[nodiscard]] std::size_t waiting() const { return undecided_ + late_.size() + delayed_bytes_; }
    /// Throws away what is held, as lost.
    void clear();
    [[nodiscard]] const WireDamageCounts& counts() const { return counts_; }

private:
    enum Draw : std::size_t {
        checksums,
        places,
        truncations,
        mergings,
        doublings,
        orders,
        garbages,
        contents,
        jitters,
        sources,
        losses
    };
    struct Arrival {
        GpsTime time;
        std::size_t count;
    };
    struct DelayedPiece {
        GpsTime due;
        StreamPiece piece;
    };
    [[nodiscard]] bool happens(double probability, Draw draw);
    std::size_t place_within(std::size_t size);
    void decide(StreamPiece piece, GpsTime now, std::vector<TimedBytes>& out);
    void correct(StreamPiece piece, GpsTime now, std::vector<TimedBytes>& out);
    void deliver_delayed(GpsTime now, std::vector<TimedBytes>& out);
    void damage(StreamPiece piece, GpsTime now, std::vector<TimedBytes>& out);
    void cut(Bytes& message);
    void emit(Bytes bytes, GpsTime now, std::vector<TimedBytes>& out);
    void emit_late(GpsTime now, std::vector<TimedBytes>& out);
    void emit_garbage(int bytes, GpsTime now, std::vector<TimedBytes>& out);
    int drawn_burst();
    void give_up_waiting(GpsTime now, std::vector<TimedBytes>& out);
    void flush(GpsTime now, std::vector<TimedBytes>& out);
    [[nodiscard]] std::optional<GpsTime> patience_ends() const;
    [[nodiscard]] std::optional<GpsTime> garbage_at() const;
    void forget_arrivals(std::size_t count);
    void garbage_happens(GpsTime at, std::vector<TimedBytes>& out);
    double next_threshold();

    WireDirection direction_;
    bool active_ = false;
    std::vector<RandomStream> random_;  // by Draw
    StreamSplitter splitter_;
    std::deque<Arrival> arrivals_;  // of the bytes that the splitter has not decided
    std::size_t undecided_ = 0;
    GpsTime last_byte_{};
    bool head_is_missing_ = false;  // of the next message
    Bytes late_;
    GpsTime late_since_{};
    CorrectionDamage corrections_;
    std::deque<DelayedPiece> delayed_;  // corrections, by their times
    std::size_t delayed_bytes_ = 0;
    // Garbage is a Poisson process: it comes when its rate, integrated over time, has reached a threshold.
    double integral_ = 0, threshold_ = 0;
    GpsTime integrated_to_{};
    std::vector<int> bursts_due_;  // bytes of each
    WireDamageCounts counts_;
};

}  // namespace skyloop::inline run
