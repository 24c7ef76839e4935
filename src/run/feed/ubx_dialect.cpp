// UBX of another receiver, as truth of a receiver's quality (u-blox M8 protocol specification; FEEDS.md 1.6 and 3.13).
#include <fmt/format.h>

#include <chrono>

#include "base/time/week_of_date.hpp"
#include "detail/dialects.hpp"
#include "detail/epoch_gate.hpp"
#include "detail/heard_pieces.hpp"
#include "detail/motion_filter.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "receiver/protocol/ubx_nav.hpp"

namespace skyloop {
namespace {

constexpr std::uint32_t ubx_ms_per_week = 604'800'000;

// Kinds of messages, for EpochGate.
struct UbxKind {
    enum : unsigned { pvt = 1, position = 2, velocity = 4, precise = 8, solution = 16 };
};

class UbxDialect : public StreamSource {
public:
    explicit UbxDialect(const FeedContext& context)
        : StreamSource(context, StreamKind::ubx, "a UBX frame with a wrong checksum") {}

    void reconnected() override {
        StreamSource::reconnected();
        epoch_ = {};
        gate_ = {};
        filter_.forget();
    }

private:
    struct Place {
        double latitude_deg, longitude_deg, height_m;
    };
    struct Epoch {
        std::optional<std::uint32_t> itow_ms;
        std::optional<bool> fixed;
        std::optional<Place> place, precise;
        std::optional<Eigen::Vector3d> velocity_ned;
        std::int64_t received_ns = 0;
    };

    void take(ByteSpan message, std::int64_t received_ns, FeedNews& news) override {
        if (const auto frame = parse_frame(message)) take(*frame, received_ns, news);
    }

    void take(const UbxFrameView& frame, std::int64_t received_ns, FeedNews& news) {
        received_ns_ = received_ns;
        with<NavPvt>(frame, news, UbxKind::pvt, [this](const NavPvt& m) {
            epoch_.fixed = (m.flags & 1u) != 0 && m.fix_type >= 1 && m.fix_type <= 4;
            if ((m.flags3 & 1u) == 0) epoch_.place = Place{m.lat * 1e-7, m.lon * 1e-7, m.height * 1e-3};
            epoch_.velocity_ned = Eigen::Vector3d(m.vel_n, m.vel_e, m.vel_d) * 1e-3;
            take_week(m);
        });
        with<NavPosllh>(frame, news, UbxKind::position, [this](const NavPosllh& m) {
            if (!epoch_.place) epoch_.place = Place{m.lat * 1e-7, m.lon * 1e-7, m.height * 1e-3};
        });
        with<NavHpposllh>(frame, news, UbxKind::precise, [this](const NavHpposllh& m) {
            if ((m.flags & 1u) == 0)
                epoch_.precise = Place{m.lat * 1e-7 + m.lat_hp * 1e-9, m.lon * 1e-7 + m.lon_hp * 1e-9,
                                       m.height * 1e-3 + m.height_hp * 1e-4};
        });
        with<NavVelned>(frame, news, UbxKind::velocity, [this](const NavVelned& m) {
            if (!epoch_.velocity_ned) epoch_.velocity_ned = Eigen::Vector3d(m.vel_n, m.vel_e, m.vel_d) * 1e-2;
        });
        with<NavSol>(frame, news, UbxKind::solution, [this](const NavSol& m) {
            if (!epoch_.fixed) epoch_.fixed = (m.flags & 1u) != 0 && m.gps_fix >= 1 && m.gps_fix <= 4;
            if ((m.flags & 4u) != 0 && m.week > 0) week_ = m.week;
        });
        if (frame.id == NavEoe::message_id) end(news);
    }

    template <class Message, class Taker>
    void with(const UbxFrameView& frame, FeedNews& news, unsigned kind, Taker&& taker) {
        if (frame.id != Message::message_id) return;
        const auto message = decode_payload<Message>(frame.payload);
        if (!message || message->i_tow >= ubx_ms_per_week)
            return report_refusal(news, "a UBX message of a wrong length or time of week");
        if (!epoch_.itow_ms || *epoch_.itow_ms != message->i_tow) {
            end(news);
            epoch_.itow_ms = message->i_tow;
        }
        taker(*message);
        epoch_.received_ns = received_ns_;
        if (gate_.take(kind)) tell(news);
    }

    void end(FeedNews& news) {
        if (gate_.next() && epoch_.itow_ms) tell(news);
        epoch_ = {};
    }

    void take_week(const NavPvt& pvt) {
        constexpr unsigned date_and_time = 3;
        if ((pvt.valid & date_and_time) != date_and_time) return;
        const UtcTime utc{pvt.year, pvt.month, pvt.day, pvt.hour, pvt.minute, pvt.second, 0};
        week_ = week_of_date(utc, std::chrono::milliseconds(pvt.i_tow)).value_or(week_);
    }

    // Without a week it counts from the first one.
    Nanoseconds time_of_epoch() {
        const std::uint32_t itow = *epoch_.itow_ms;
        if (last_itow_ms_ && last_week_ == week_ && itow + ubx_ms_per_week / 2 < *last_itow_ms_) ++week_;
        last_itow_ms_ = itow;
        last_week_ = week_;
        return to_gps_time({week_, std::chrono::milliseconds(itow)}).time_since_epoch();
    }

    void tell(FeedNews& news) {
        const Nanoseconds time = time_of_epoch();
        const auto& place = epoch_.precise ? epoch_.precise : epoch_.place;
        if (!place || !epoch_.fixed.value_or(true)) return report_refusal(news, "the receiver has no fix");
        SourcePose pose;
        pose.latitude_deg = place->latitude_deg;
        pose.longitude_deg = place->longitude_deg;
        pose.height_m = place->height_m;
        pose.above_ellipsoid = true;
        pose.velocity_ned = epoch_.velocity_ned;
        SampleOr sample = sample_of(pose, context());
        if (sample && context().smooth) filter_.smooth(*sample, time.count());
        report_sample(news, std::move(sample), time, epoch_.received_ns);
    }

    std::int64_t received_ns_ = 0;
    EpochGate gate_;
    Epoch epoch_;
    std::int64_t week_ = 0, last_week_ = 0;
    std::optional<std::uint32_t> last_itow_ms_;
    MotionFilter filter_{receiver_noise};
};

}  // namespace

std::unique_ptr<FeedDialect> make_ubx_dialect(const FeedContext& context) {
    return std::make_unique<UbxDialect>(context);
}

}  // namespace skyloop
