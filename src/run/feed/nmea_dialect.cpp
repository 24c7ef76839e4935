// NMEA 0183 of another receiver or simulator, as truth of a receiver's quality (FEEDS.md 1.5 and 3.13).
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/core/overloaded.hpp"
#include "base/time/utc_time.hpp"
#include "detail/dialects.hpp"
#include "detail/epoch_gate.hpp"
#include "detail/heard_pieces.hpp"
#include "detail/motion_filter.hpp"
#include "receiver/protocol/nmea_decode.hpp"

namespace skyloop {
namespace {

constexpr std::int64_t nmea_second_ns = 1'000'000'000;

std::int64_t nanoseconds_of_day(const NmeaTime& time) {
    return (time.hour * 3600 + time.minute * 60 + time.second) * nmea_second_ns + time.nanosecond;
}

NmeaDate next_day(const NmeaDate& date) {
    using namespace std::chrono;
    const year_month_day next(sys_days(year(date.year) / month(date.month) / day(date.day)) + days(1));
    return {int{next.year()}, unsigned{next.month()}, unsigned{next.day()}};
}

// Nothing for a day that no calendar has, or that is out of our time's range.
std::optional<NmeaDate> usable_date(const std::optional<NmeaDate>& date) {
    if (!date || !is_calendar_time({date->year, date->month, date->day, 0, 0, 0, 0})) return std::nullopt;
    return date;
}

// Kinds of sentences, for EpochGate.
struct NmeaKind {
    enum : unsigned { rmc = 1, gga = 2, gns = 4, vtg = 8, heading = 16 };
};

// The days that go with times of day: RMC's and ZDA's dates, counted on at midnight. Before the first date, days since
// the beginning.
class NmeaCalendar {
public:
    Nanoseconds time_of(const NmeaTime& time, std::optional<NmeaDate> said) {
        constexpr std::int64_t day_ns = 86400 * nmea_second_ns;
        const std::int64_t of_day = nanoseconds_of_day(time);
        const bool midnight = last_of_day_ && *last_of_day_ - of_day > day_ns / 2;
        last_of_day_ = of_day;
        if (midnight) ++days_;
        if (midnight && date_ && !said) date_ = usable_date(next_day(*date_));
        if (said) date_ = said;
        if (!date_) return Nanoseconds(days_ * day_ns + of_day);
        const UtcTime utc{date_->year, date_->month, date_->day, time.hour, time.minute, time.second, time.nanosecond};
        return to_gps_time(utc, LeapSeconds::announced()).time_since_epoch();
    }

private:
    std::optional<NmeaDate> date_;
    std::optional<std::int64_t> last_of_day_;
    std::int64_t days_ = 0;
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
        epoch_ = {};
        gate_ = {};
        filter_.forget();
        climb_.reset();
    }

private:
    struct Epoch {
        std::optional<NmeaTime> time;
        std::optional<NmeaDate> date;
        std::optional<NmeaPosition> position;
        std::optional<bool> fixed;
        std::optional<MetresPerSecond> speed;
        std::optional<Angle> course, heading;
        std::int64_t received_ns = 0;
    };
    struct Height {
        double metres;
        bool above_ellipsoid;
    };

    void take(ByteSpan sentence, std::int64_t received_ns, FeedNews& news) override {
        const auto message = decode_nmea(to_string(sentence));
        // Sentences that are not read here are no fault of theirs.
        if (!message) return;
        std::visit(Overloaded{[&](const Rmc& m) { take_rmc(m, received_ns, news); },
                              [&](const Gga& m) { take_fix(m, m.quality > 0, NmeaKind::gga, received_ns, news); },
                              [&](const Gns& m) { take_fix(m, has_fix(m), NmeaKind::gns, received_ns, news); },
                              [&](const Zda& m) {
                                  if (m.time && is_of_epoch(*m.time)) epoch_.date = usable_date(m.date);
                              },
                              [&](const Vtg& m) {
                                  take_motion(m.speed, m.course);
                                  came(NmeaKind::vtg, received_ns, news);
                              },
                              [&](const Hdt& m) { take_heading(m.heading, received_ns, news); },
                              [&](const Ths& m) { take_heading(m.heading, received_ns, news); }, [](const auto&) {}},
                   *message);
    }

    void take_rmc(const Rmc& rmc, std::int64_t received_ns, FeedNews& news) {
        if (!rmc.time) return;
        begin(*rmc.time, news);
        if (rmc.date) epoch_.date = usable_date(rmc.date);
        if (!epoch_.position) epoch_.position = rmc.position;
        epoch_.fixed = epoch_.fixed.value_or(true) && rmc.valid;
        take_motion(rmc.speed, rmc.course);
        came(NmeaKind::rmc, received_ns, news);
    }

    // Altitude and the sentence's own separation undo what the receiver did; a separation of exactly 0 is that of one
    // that has none (FEEDS.md 1.5).
    template <class Fix>
    void take_fix(const Fix& fix, bool fixed, unsigned kind, std::int64_t received_ns, FeedNews& news) {
        if (!fix.time) return;
        begin(*fix.time, news);
        if (fix.position) epoch_.position = fix.position;
        epoch_.fixed = epoch_.fixed.value_or(true) && fixed;
        const bool separated = fix.geoid_separation && fix.geoid_separation->value() != 0;
        if (fixed && fix.altitude)
            height_ = separated ? Height{(*fix.altitude + *fix.geoid_separation).value(), true}
                                : Height{fix.altitude->value(), false};
        came(kind, received_ns, news);
    }

    static bool has_fix(const Gns& gns) {
        return std::any_of(gns.modes.begin(), gns.modes.end(), [](NmeaMode mode) { return mode != NmeaMode::none; });
    }

    void take_motion(std::optional<MetresPerSecond> speed, std::optional<Angle> course) {
        if (speed) epoch_.speed = speed;
        if (course) epoch_.course = course;
    }

    void take_heading(std::optional<Angle> heading, std::int64_t received_ns, FeedNews& news) {
        epoch_.heading = heading;
        came(NmeaKind::heading, received_ns, news);
    }

    // 1 ms: sentences of one epoch may show different numbers of digits.
    bool is_of_epoch(const NmeaTime& time) const {
        constexpr std::int64_t same_ns = 1'000'000;
        return epoch_.time && std::abs(nanoseconds_of_day(*epoch_.time) - nanoseconds_of_day(time)) < same_ns;
    }

    void begin(const NmeaTime& time, FeedNews& news) {
        if (is_of_epoch(time)) return;
        if (gate_.next() && epoch_.time) tell(news);
        epoch_ = {};
        epoch_.time = time;
    }

    void came(unsigned kind, std::int64_t received_ns, FeedNews& news) {
        if (!epoch_.time) return;
        epoch_.received_ns = received_ns;
        if (gate_.take(kind)) tell(news);
    }

    void tell(FeedNews& news) {
        const Nanoseconds time = calendar_.time_of(*epoch_.time, epoch_.date);
        if (!epoch_.fixed.value_or(false) || !epoch_.position) return report_refusal(news, "the receiver has no fix");
        if (!height_) return report_refusal(news, "positions without a height; expected GGA or GNS sentences");
        SourcePose pose;
        pose.latitude_deg = epoch_.position->latitude.deg();
        pose.longitude_deg = epoch_.position->longitude.deg();
        pose.height_m = height_->metres;
        pose.above_ellipsoid = height_->above_ellipsoid;
        pose.velocity_ned = velocity(time);
        if (epoch_.heading) pose.attitude = Attitude::roll_pitch_yaw({}, {}, *epoch_.heading);
        SampleOr sample = sample_of(pose, context());
        if (sample && context().smooth) filter_.smooth(*sample, time.count());
        report_sample(news, std::move(sample), time, epoch_.received_ns);
    }

    // Sentences tell no climb: it comes from the heights, and is none in the first epoch, which would begin at rest
    // without a velocity and jump to the second. Courses of standing vehicles are left out by receivers.
    std::optional<Eigen::Vector3d> velocity(Nanoseconds time) {
        constexpr double standing_mps = 0.5;
        const double climb = climb_rate(time);
        if (!epoch_.speed) return std::nullopt;
        const double speed = epoch_.speed->value();
        if (!epoch_.course && speed > standing_mps) return std::nullopt;
        const double course = epoch_.course ? epoch_.course->rad() : 0;
        const double horizontal = epoch_.course ? speed : 0;
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

    NmeaCalendar calendar_;
    EpochGate gate_;
    Epoch epoch_;
    std::optional<Height> height_;  // the last one: RMC has none
    std::optional<ClimbFilter> climb_;
    MotionFilter filter_{receiver_noise};
};

}  // namespace

std::unique_ptr<FeedDialect> make_nmea_dialect(const FeedContext& context) {
    return std::make_unique<NmeaDialect>(context);
}

}  // namespace skyloop
