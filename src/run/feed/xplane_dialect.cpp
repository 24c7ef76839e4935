// X-Plane 9 to 12 by UDP: RPOS for the pose, RREF for the time, DATA rows as they come (X-Plane's "Exchanging Data with
// X-Plane"; offsets and traps: FEEDS.md 3.5).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "detail/dialect_parts.hpp"
#include "detail/motion_filter.hpp"
#include "receiver/protocol/field_list.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::size_t xplane_head_size = 5;

// What follows the head of RPOS. Axes of the velocity: east, up, south.
struct XplanePose {
    double longitude = 0, latitude = 0;      // deg
    double elevation = 0;                    // m above the sea
    float above_ground = 0;                  // m
    float pitch = 0, heading = 0, roll = 0;  // deg
    float east = 0, up = 0, south = 0;       // m/s
    float p = 0, q = 0, r = 0;               // rad/s

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.longitude, m.latitude, m.elevation, m.above_ground, m.pitch, m.heading, m.roll, m.east, m.up, m.south, m.p,
          m.q, m.r);
    }
};

// One value of RREF.
struct XplaneReference {
    std::int32_t index = 0;
    float value = 0;
    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.index, m.value);
    }
};

// What asks for one; the name of a dataref, filled up with zeros.
struct XplaneReferenceRequest {
    std::int32_t rate = 0, index = 0;
    std::array<char, 400> name{};
    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.rate, m.index, m.name);
    }
};

// One row of DATA; −999: nothing.
struct XplaneRow {
    std::int32_t index = 0;
    std::array<float, 8> values{};
    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.index, m.values);
    }
};
// Rows that are read: their indices are X-Plane 10's to 12's. 9 has the attitude one row behind, among the angles that
// the others have there; nothing in a row tells which it is.
struct XplaneRowIndex {
    enum : std::int32_t { attitude = 17, place = 20, motion = 21 };
};

constexpr std::int32_t time_reference = 1, paused_reference = 2;  // numbers of ours, which X-Plane repeats

Bytes xplane_reference_request(std::int32_t rate_hz, std::int32_t index, std::string_view name) {
    XplaneReferenceRequest request;
    request.rate = rate_hz;
    request.index = index;
    std::copy(name.begin(), name.end(), request.name.begin());
    Bytes bytes{'R', 'R', 'E', 'F', 0};
    const Bytes rest = encode_payload(request);
    bytes.insert(bytes.end(), rest.begin(), rest.end());
    return bytes;
}

class XplaneDialect : public FeedDialect {
public:
    explicit XplaneDialect(const FeedContext& context) : context_(context) {}

    FeedNews hear(ByteSpan bytes, std::int64_t received_ns) override {
        FeedNews news;
        const std::string_view head(reinterpret_cast<const char*>(bytes.data()),
                                    std::min<std::size_t>(bytes.size(), 4));
        if (bytes.size() >= xplane_head_size && head == "RPOS")
            take_pose(bytes.subspan(xplane_head_size), received_ns, news);
        else if (bytes.size() >= xplane_head_size && head == "RREF")
            take_references(bytes.subspan(xplane_head_size), received_ns, news);
        else if (bytes.size() >= xplane_head_size && head == "DATA")
            take_rows(bytes.subspan(xplane_head_size), received_ns, news);
        else if (head != "BECN")
            report_refusal(news, fmt::format("{} bytes that begin with none of RPOS, RREF and DATA", bytes.size()));
        return news;
    }

    // X-Plane 11 and 12 want the rate in letters, 9 and 10 as an integer: both until poses come, then now and then. The
    // letters last: 11 and 12 take the integer for letters too, of another rate or of none, and 9 and 10 take the
    // letters for a rate above that of their frames.
    std::vector<Bytes> say() override {
        constexpr int renewal = 10;
        const bool renew = said_++ % renewal == 0;
        const bool heard = std::exchange(heard_, false);
        if (heard && !renew) return {};
        const auto rate = static_cast<std::int32_t>(std::clamp(std::lround(context_.rate_hz), 1L, 1000L));
        std::vector<Bytes> words{xplane_reference_request(rate, time_reference, "sim/time/total_running_time_sec"),
                                 xplane_reference_request(rate, paused_reference, "sim/time/paused")};
        if (!heard) {
            Bytes integer{'R', 'P', 'O', 'S', 0};
            for (int shift = 0; shift < 32; shift += 8)
                integer.push_back(static_cast<std::uint8_t>(static_cast<std::uint32_t>(rate) >> shift & 0xFF));
            words.push_back(std::move(integer));
        }
        words.push_back(to_bytes(fmt::format("RPOS{:c}{}{:c}", '\0', rate, '\0')));
        return words;
    }

    void reconnected() override {
        time_.reset();
        heard_ = false;
        said_ = 0;
        filter_.forget();
        attitude_.reset();
        velocity_.reset();
    }

private:
    void take_pose(ByteSpan body, std::int64_t received_ns, FeedNews& news) {
        const auto said = decode_payload<XplanePose>(body);
        if (!said)
            return report_refusal(news,
                                  fmt::format("an RPOS of {} bytes; expected 69", body.size() + xplane_head_size));
        heard_ = true;
        SourcePose pose;
        pose.latitude_deg = said->latitude;
        pose.longitude_deg = said->longitude;
        pose.height_m = said->elevation;
        pose.velocity_ned = Eigen::Vector3d(-said->south, said->east, -said->up);
        pose.attitude = attitude_of_degrees(said->roll, said->pitch, said->heading);
        pose.turn_rate = Eigen::Vector3d(said->p, said->q, said->r);
        exact_at_ns_ = received_ns;
        report_sample(news, sample_of(pose, context_), time_at(received_ns), received_ns);
    }

    void take_references(ByteSpan body, std::int64_t received_ns, FeedNews& news) {
        constexpr std::size_t size = 8;
        if (body.empty() || body.size() % size != 0)
            return report_refusal(news, fmt::format("an RREF of {} bytes", body.size() + xplane_head_size));
        for (; !body.empty(); body = body.subspan(size)) {
            const auto reference = decode_payload<XplaneReference>(body.first(size));
            if (reference->index == time_reference) take_time(reference->value, received_ns);
            if (reference->index == paused_reference) take_paused(reference->value != 0, received_ns, news);
        }
    }

    void take_time(double seconds, std::int64_t received_ns) {
        const auto time = source_nanoseconds(seconds);
        if (!time) return;
        // Held still between two statements that say the same, it would creep on and fall back.
        if (time_ && time_->said == *time) return;
        Nanoseconds even = *time;
        if (time_) {
            const Nanoseconds half = half_grid(seconds);
            even = std::clamp(time_->time + Nanoseconds(received_ns - time_->received_ns), *time - half, *time + half);
        }
        time_ = Stated{*time, even, received_ns};
    }

    // It is a float: after a day its grid is 8 ms, and whoever took its steps for the source's would have it fly by
    // jerks. Within the grid time goes on as it passes here.
    static Nanoseconds half_grid(double seconds) {
        const auto said = static_cast<float>(std::abs(seconds));
        const double grid_s = double{std::nextafter(said, std::numeric_limits<float>::max())} - double{said};
        return to_nanoseconds(Seconds(grid_s / 2));
    }

    void take_paused(bool paused, std::int64_t received_ns, FeedNews& news) {
        if (paused != paused_) news.add_aside(FeedPause{paused});
        // The time that was said held until now.
        if (paused_ && !paused && time_) time_->received_ns = received_ns;
        paused_ = paused;
    }

    // Time and pose come in packets of their own, in any order: the time that was said, and how long ago.
    std::optional<Nanoseconds> time_at(std::int64_t received_ns) const {
        constexpr std::int64_t longest_ns = 100'000'000;
        if (!time_) return std::nullopt;
        const std::int64_t ago =
            paused_ ? 0 : std::clamp<std::int64_t>(received_ns - time_->received_ns, 0, longest_ns);
        return time_->time + Nanoseconds(ago);
    }

    void take_rows(ByteSpan body, std::int64_t received_ns, FeedNews& news) {
        constexpr std::size_t size = 36;
        if (body.empty() || body.size() % size != 0)
            return report_refusal(news,
                                  fmt::format("DATA of {} bytes; expected rows of 36", body.size() + xplane_head_size));
        std::optional<XplaneRow> place;
        for (; !body.empty(); body = body.subspan(size)) {
            const auto row = decode_payload<XplaneRow>(body.first(size));
            const auto& values = row->values;
            if (std::find(values.begin(), values.begin() + 3, -999.0F) != values.begin() + 3) continue;
            if (row->index == XplaneRowIndex::attitude)
                attitude_ = attitude_of_degrees(values[1], values[0], values[2]);
            if (row->index == XplaneRowIndex::motion) velocity_ = Eigen::Vector3d(-values[5], values[3], -values[4]);
            if (row->index == XplaneRowIndex::place) place = row;
        }
        if (place) take_place(*place, received_ns, news);
    }

    // Its latitude and longitude are floats, on a grid of up to 1.7 m: smoothed, and left out while RPOS comes.
    void take_place(const XplaneRow& row, std::int64_t received_ns, FeedNews& news) {
        constexpr std::int64_t patience_ns = 2'000'000'000;
        if (exact_at_ns_ && received_ns - *exact_at_ns_ <= patience_ns) return;
        SourcePose pose;
        pose.latitude_deg = row.values[0];
        pose.longitude_deg = row.values[1];
        pose.height_m = row.values[2] * metres_per_foot;
        pose.attitude = attitude_;
        pose.velocity_ned = velocity_;
        SampleOr sample = sample_of(pose, context_);
        const auto time = time_at(received_ns);
        if (sample) filter_.smooth(*sample, time ? time->count() : received_ns);
        report_sample(news, std::move(sample), time, received_ns);
    }

    struct Stated {
        Nanoseconds said, time;
        std::int64_t received_ns;
    };
    FeedContext context_;
    std::optional<Stated> time_;
    bool paused_ = false, heard_ = false;
    int said_ = 0;
    std::optional<std::int64_t> exact_at_ns_;
    MotionFilter filter_{{0.5, 0.05}};
    std::optional<Attitude> attitude_;
    std::optional<Eigen::Vector3d> velocity_;
};

}  // namespace

std::unique_ptr<FeedDialect> make_xplane_dialect(const FeedContext& context) {
    return std::make_unique<XplaneDialect>(context);
}

}  // namespace skyloop::inline run
