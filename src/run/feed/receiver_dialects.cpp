// UBX and NMEA 0183 of another receiver or simulator, as truth of a receiver's quality (FEEDS.md 1.5, 1.6 and 3.13).
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "base/time/utc_time.hpp"
#include "detail/dialect_parts.hpp"
#include "detail/motion_filter.hpp"
#include "receiver/observed/nmea_epochs.hpp"
#include "receiver/observed/ubx_epochs.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "receiver/protocol/ubx_nav.hpp"

namespace skyloop::inline run {
namespace {

// A receiver's stream, of which messages of one kind are taken.
class StreamSource : public FeedDialect {
public:
    // @param bad_piece why one with a wrong checksum is refused
    StreamSource(const FeedContext& context, StreamKind kind, const char* bad_piece)
        : context_(context), kind_(kind), bad_piece_(bad_piece) {}

    FeedNews hear(ByteSpan bytes, std::int64_t received_ns) override {
        FeedNews news;
        const auto take_all = [&](ByteSpan some) {
            for (const StreamPiece& piece : splitter_.feed(some))
                if (piece.kind == kind_) take(piece.bytes, received_ns, news);
        };
        const bool by_sentences = context_.datagrams && kind_ == StreamKind::nmea;
        if (by_sentences && begins_sentence(bytes)) take_all(line_end);
        take_all(bytes);
        if (by_sentences && ends_sentence(bytes)) take_all(line_end);
        refuse_bad(news);
        return news;
    }
    void reconnected() override {
        splitter_ = StreamSplitter();
        bad_ = unchecked_ = 0;
        gate_ = {};
        filter_.forget();
    }

protected:
    virtual void take(ByteSpan message, std::int64_t received_ns, FeedNews& news) = 0;
    [[nodiscard]] const FeedContext& context() const { return context_; }
    // @param part of an epoch that has come, as bits. @return the epoch has become whole by it
    bool came(unsigned part, std::int64_t received_ns) {
        heard_ns_ = received_ns;
        return gate_.take(part);
    }
    // The next epoch begins. @return the one before has not been told
    bool next() { return gate_.next(); }
    void tell(const SourcePose& pose, Nanoseconds time, FeedNews& news) {
        SampleOr sample = sample_of(pose, context_);
        if (sample && context_.smooth) filter_.smooth(*sample, time.count());
        report_sample(news, std::move(sample), time, heard_ns_);
    }

private:
    // Sentences in datagrams need no line ends; and those of a stream that somebody sends on in pieces go over the
    // edges of datagrams.
    static bool begins_sentence(ByteSpan bytes) { return !bytes.empty() && (bytes[0] == '$' || bytes[0] == '!'); }
    static bool ends_sentence(ByteSpan bytes) {
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        const std::size_t begin = text.rfind('$');
        return begin != std::string_view::npos && !text.ends_with('\n') && parse_sentence(text.substr(begin));
    }

    void refuse_bad(FeedNews& news) {
        const StreamCounts& counts = splitter_.counts();
        const std::uint64_t bad = counts.bad[static_cast<std::size_t>(kind_)] - bad_;
        const std::uint64_t unchecked = kind_ == StreamKind::nmea ? counts.unchecked - unchecked_ : 0;
        for (std::uint64_t i = 0; i < bad; ++i)
            report_refusal(news, i < unchecked ? "a sentence without a checksum; expected *hh at its end" : bad_piece_);
        bad_ += bad;
        unchecked_ += unchecked;
    }

    FeedContext context_;
    StreamKind kind_;
    const char* bad_piece_;
    StreamSplitter splitter_;
    std::uint64_t bad_ = 0, unchecked_ = 0;  // told of
    EpochGate gate_;
    std::int64_t heard_ns_ = 0;  // when the last part of the epoch came
    MotionFilter filter_{receiver_noise};
};

class UbxDialect : public StreamSource {
public:
    explicit UbxDialect(const FeedContext& context)
        : StreamSource(context, StreamKind::ubx, "a UBX frame with a wrong checksum") {}

    void reconnected() override {
        StreamSource::reconnected();
        epochs_.end();
    }

private:
    void take(ByteSpan message, std::int64_t received_ns, FeedNews& news) override {
        const auto frame = parse_frame(message);
        if (!frame) return;
        const UbxEpochs::Taken taken = epochs_.take(*frame);
        if (taken.is_senseless) report_refusal(news, "a UBX message of a wrong length or time of week");
        if (taken.ended && next()) tell_epoch(*taken.ended, news);
        const unsigned of_motion = taken.part & ~static_cast<unsigned>(UbxEpochs::says_utc);
        if (of_motion != 0 && came(of_motion, received_ns)) tell_epoch(*epochs_.epoch(), news);
        if (frame->id != NavEoe::message_id) return;
        if (const auto ended = epochs_.end(); ended && next()) tell_epoch(*ended, news);
    }

    void tell_epoch(const ObservedEpoch& epoch, FeedNews& news) {
        if (!epoch.place || epoch.type == FixType::none || epoch.type == FixType::time_only)
            return report_refusal(news, "the receiver has no fix");
        SourcePose pose;
        pose.latitude_deg = epoch.place->latitude.deg();
        pose.longitude_deg = epoch.place->longitude.deg();
        pose.height_m = epoch.place->height.above_ellipsoid.value();
        pose.above_ellipsoid = true;
        if (epoch.velocity)
            pose.velocity_ned = Eigen::Vector3d(epoch.velocity->north, epoch.velocity->east, epoch.velocity->down);
        pose.attitude = epoch.attitude;
        tell(pose, epoch.time.time_since_epoch(), news);
    }

    UbxEpochs epochs_;
};

// The days that go with times of day: RMC's and ZDA's dates, counted on at midnight. Before the first date, days since
// the beginning.
class NmeaCalendar {
public:
    Nanoseconds time_of(const NmeaEpoch& epoch) {
        constexpr Nanoseconds day = std::chrono::hours(24);
        if (last_of_day_ && *last_of_day_ - *epoch.of_day > day / 2) ++days_;
        last_of_day_ = epoch.of_day;
        // Nothing for a day that no calendar has, or that is out of our time's range.
        if (epoch.date && is_calendar_time({epoch.date->year, epoch.date->month, epoch.date->day, 0, 0, 0, 0}))
            date_ = epoch.date, days_ = 0;
        if (!date_) return days_ * day + *epoch.of_day;
        const UtcTime midnight = midnight_of({date_->year, date_->month, date_->day}, days_);
        return (to_gps_time(midnight, LeapSeconds::announced()) + *epoch.of_day).time_since_epoch();
    }

private:
    std::optional<NmeaDate> date_;
    std::optional<Nanoseconds> last_of_day_;
    int days_ = 0;
};

// The heights of the epochs so far, whose change is the climb.
struct ClimbFilter {
    AxisFilter height{3};
    Nanoseconds time{0};
};

class NmeaDialect : public StreamSource {
public:
    explicit NmeaDialect(const FeedContext& context)
        : StreamSource(context, StreamKind::nmea, "a sentence with a wrong checksum") {}

    void reconnected() override {
        StreamSource::reconnected();
        epochs_.end();
        climb_.reset();
        told_.reset();
    }

private:
    struct Height {
        double metres;
        bool above_ellipsoid;
    };

    // Sentences that are not read here are no fault of theirs.
    void take(ByteSpan sentence, std::int64_t received_ns, FeedNews& news) override {
        const NmeaEpochs::Taken taken = epochs_.take(to_string(sentence));
        if (taken.ended && next()) tell_epoch(*taken.ended, news);
        if (taken.part == 0) return;
        const auto epoch = epochs_.epoch();
        if (epoch->of_day && came(taken.part, received_ns)) tell_epoch(*epoch, news);
    }

    // Altitude and the sentence's own separation undo what the receiver did; a separation of exactly 0 is that of one
    // that has none (FEEDS.md 1.5). RMC has no height: the last one counts.
    void tell_epoch(const NmeaEpoch& epoch, FeedNews& news) {
        if (!epoch.of_day) return;
        const ObservedMotion& motion = epoch.told.motion;
        const Nanoseconds time = calendar_.time_of(epoch);
        const bool fixed = epoch.told.type != FixType::none && epoch.told.claims_fix.value_or(true);
        const bool separated = motion.separation && motion.separation->value() != 0;
        if (epoch.told.type != FixType::none && motion.altitude)
            height_ = separated ? Height{(*motion.altitude + *motion.separation).value(), true}
                                : Height{motion.altitude->value(), false};
        if (!fixed || !motion.latitude) return report_refusal(news, "the receiver has no fix");
        if (!height_) return report_refusal(news, "positions without a height; expected GGA or GNS sentences");
        if (std::exchange(told_, time) == time) return;  // said twice
        SourcePose pose;
        pose.latitude_deg = motion.latitude->deg();
        pose.longitude_deg = motion.longitude->deg();
        pose.height_m = height_->metres;
        pose.above_ellipsoid = height_->above_ellipsoid;
        pose.velocity_ned = velocity(motion, time);
        if (motion.heading)
            pose.attitude = Attitude::roll_pitch_yaw(motion.roll.value_or(Angle{}), motion.pitch.value_or(Angle{}),
                                                     *motion.heading);
        tell(pose, time, news);
    }

    // Most sentences tell no climb: it comes from the heights, and is none in the first epoch, which would begin at
    // rest without a velocity and jump to the second. Courses of standing vehicles are left out by receivers.
    std::optional<Eigen::Vector3d> velocity(const ObservedMotion& motion, Nanoseconds time) {
        constexpr double standing_mps = 0.5;
        const double of_heights = climb_rate(time);
        const double climb = motion.climb ? motion.climb->value() : of_heights;
        if (!motion.ground_speed) return std::nullopt;
        const double speed = motion.ground_speed->value();
        if (!motion.course && speed > standing_mps) return std::nullopt;
        const double course = motion.course ? motion.course->rad() : 0;
        const double horizontal = motion.course ? speed : 0;
        return Eigen::Vector3d(horizontal * std::cos(course), horizontal * std::sin(course), -climb);
    }

    double climb_rate(Nanoseconds time) {
        constexpr double height_sigma = 0.3, longest_s = 5;
        const double step = climb_ ? to_seconds(time - climb_->time).value() : -1;
        if (step < 0 || step > longest_s) {
            climb_.emplace();
            climb_->height.start(height_->metres, height_sigma);
        } else {
            climb_->height.predict(step);
            climb_->height.see_position(height_->metres, height_sigma);
        }
        climb_->time = time;
        return climb_->height.velocity();
    }

    NmeaEpochs epochs_;
    NmeaCalendar calendar_;
    std::optional<Height> height_;     // the last one
    std::optional<Nanoseconds> told_;  // when the last epoch was
    std::optional<ClimbFilter> climb_;
};

}  // namespace

std::unique_ptr<FeedDialect> make_ubx_dialect(const FeedContext& context) {
    return std::make_unique<UbxDialect>(context);
}

std::unique_ptr<FeedDialect> make_nmea_dialect(const FeedContext& context) {
    return std::make_unique<NmeaDialect>(context);
}

}  // namespace skyloop::inline run
