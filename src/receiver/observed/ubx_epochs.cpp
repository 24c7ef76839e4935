#include "receiver/observed/ubx_epochs.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "base/time/utc_time.hpp"
#include "detail/observed_parts.hpp"
#include "receiver/protocol/nmea_satellites.hpp"
#include "receiver/protocol/ubx_inertial.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "receiver/protocol/ubx_time.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr std::uint32_t ubx_week_ms = 604'800'000;

// u-blox M8 protocol specification, "Satellite Numbering": gnssId and svId.
std::optional<SatelliteId> ubx_satellite(std::uint8_t gnss_id, std::uint8_t sv_id) {
    using enum Constellation;
    static constexpr std::array<std::optional<Constellation>, 8> systems{gps,          sbas, galileo, beidou,
                                                                         std::nullopt, qzss, glonass, navic};
    constexpr std::uint8_t not_identified = 255;  // a satellite of GLONASS
    if (gnss_id >= systems.size() || !systems[gnss_id]) return std::nullopt;
    const Constellation system = *systems[gnss_id];
    if (system == glonass && sv_id == not_identified) return std::nullopt;
    return SatelliteId{system, system == sbas ? sv_id - 100 : sv_id};
}

FixType ubx_fix_type(unsigned type, unsigned flags, unsigned carrier) {
    if ((flags & 1u) == 0 || type == 0 || type > 5) return FixType::none;
    if (type == 1) return FixType::dead_reckoning;
    if (type == 5) return FixType::time_only;
    if (carrier == 2) return FixType::rtk_fixed;
    if (carrier == 1) return FixType::rtk_float;
    if (type == 2) return FixType::fix_2d;
    return (flags & 2u) != 0 ? FixType::dgnss : FixType::fix_3d;
}

// Of NAV-PVT and NAV-PVAT.
template <class Message>
std::optional<std::int64_t> told_week(const Message& m) {
    constexpr unsigned date_and_time = 3;
    if ((m.valid & date_and_time) != date_and_time) return std::nullopt;
    return week_of_date({m.year, m.month, m.day, m.hour, m.minute, m.second, 0}, std::chrono::milliseconds(m.i_tow));
}

// Roll, pitch and heading; nothing for what are no such angles.
template <class Angles>
std::optional<Attitude> ubx_attitude(const Angles& angles) {
    for (std::size_t i = 0; i < angles.size(); ++i)
        if (std::abs(angles.value(i)) > 360) return std::nullopt;
    const auto degrees = [&](std::size_t i) { return Angle::degrees(angles.value(i)); };
    return Attitude::roll_pitch_yaw(degrees(0), degrees(1), degrees(2));
}

// Seconds since 1970 of NAV-PVT, NAV-PVAT and NAV-TIMEUTC, whose nanoseconds may be negative.
template <class Message>
std::optional<double> told_utc(const Message& m) {
    const auto day = std::chrono::year(m.year) / std::chrono::month(m.month) / std::chrono::day(m.day);
    if (!day.ok()) return std::nullopt;
    const auto midnight = std::chrono::seconds(std::chrono::sys_days(day).time_since_epoch());
    return static_cast<double>(midnight.count()) + m.hour * 3600.0 + m.minute * 60.0 + m.second + m.nano * 1e-9;
}

}  // namespace

void UbxEpochs::UnderWay::take_type(int rank, FixType type) {
    if (rank < type_rank) return;
    type_rank = rank;
    told.type = type;
}

void UbxEpochs::UnderWay::take_place(int rank, double latitude_deg, double longitude_deg, double height_m) {
    told.is_solution = true;
    if (rank < place_rank) return;
    const auto there = place_from_degrees(latitude_deg, longitude_deg, height_m);
    if (!there) return;
    place_rank = rank;
    told.place = *there;
}

// NAV-PVT and NAV-PVAT.
template <class Message>
void UbxEpochs::UnderWay::take_solution(const Message& m, const VelocityNed& velocity) {
    constexpr unsigned resolved = 7;  // date, time, and both fully
    told.is_solution = true;
    if (place_rank == 3) place_rank = 0, told.place.reset();  // a second message says it anew
    take_type(3, ubx_fix_type(m.fix_type, m.flags, m.flags >> 6 & 3u));
    if (const auto of_date = told_week(m)) take_week(*of_date);
    if ((m.valid & resolved) == resolved) told.utc_s = told_utc(m);
    told.velocity = velocity;
    told.satellites_used = m.num_sv;
    told.horizontal_accuracy = Metres(m.h_acc.value());
    told.vertical_accuracy = Metres(m.v_acc.value());
    told.speed_accuracy = MetresPerSecond(m.s_acc.value());
}

void UbxEpochs::UnderWay::take_week(std::int64_t number) {
    if (number >= 0 && number <= last_gps_week) week = number;
}

void UbxEpochs::UnderWay::list_satellites(std::size_t used) {
    told.lists_satellites = true;
    listed_used = static_cast<int>(used);
}

template <class Message, class Taker>
void UbxEpochs::with(const UbxFrameView& frame, unsigned part, Taker&& taker) {
    if (frame.id != Message::message_id) return;
    const auto message = decode_payload<Message>(frame.payload);
    taken_.is_senseless = !message || message->i_tow >= ubx_week_ms;
    if (taken_.is_senseless) return;
    if (!under_way_ || under_way_->itow_ms != message->i_tow) {
        taken_.ended = end();
        under_way_ = UnderWay{};
        under_way_->itow_ms = message->i_tow;
    }
    taken_.part = part;
    taker(*message, *under_way_);
}

UbxEpochs::Taken UbxEpochs::take(const UbxFrameView& frame) {
    with<NavPvt>(frame, says_solution, [](const NavPvt& m, UnderWay& e) {
        e.take_solution(m, {m.vel_n.value(), m.vel_e.value(), m.vel_d.value()});
        if ((m.flags3 & 1u) == 0) e.take_place(3, m.lat.value(), m.lon.value(), m.height.value());
    });
    with<NavPvat>(frame, says_solution, [](const NavPvat& m, UnderWay& e) {
        constexpr unsigned whole_attitude = 0x1C;
        e.take_solution(m, {m.vel_ned.value(0), m.vel_ned.value(1), m.vel_ned.value(2)});
        e.take_place(3, m.lat.value(), m.lon.value(), m.height.value());
        if ((m.flags & whole_attitude) == whole_attitude) e.told.attitude = ubx_attitude(m.angle);
    });
    take_positions(frame);
    take_times(frame);
    take_satellites(frame);
    return std::exchange(taken_, {});
}

void UbxEpochs::take_positions(const UbxFrameView& frame) {
    with<NavSol>(frame, says_old_solution, [](const NavSol& m, UnderWay& e) {
        constexpr double deepest_m = 6.3e6;  // from the Earth's centre: below any place
        e.told.is_solution = true;
        e.take_type(2, ubx_fix_type(m.gps_fix, m.flags, 0));
        if ((m.flags & 4u) != 0 && !e.week) e.take_week(m.week);
        if (!e.told.satellites_used) e.told.satellites_used = m.num_sv;
        const Position<Ecef> point(m.ecef.value(0), m.ecef.value(1), m.ecef.value(2));
        if (point.vector().norm() <= deepest_m) return;
        const Geodetic there = to_geodetic(point);
        e.take_place(1, there.latitude.deg(), there.longitude.deg(), there.height.above_ellipsoid.value());
    });
    with<NavPosllh>(frame, says_place, [](const NavPosllh& m, UnderWay& e) {
        e.take_place(2, m.lat.value(), m.lon.value(), m.height.value());
        if (e.told.horizontal_accuracy) return;
        e.told.horizontal_accuracy = Metres(m.h_acc.value());
        e.told.vertical_accuracy = Metres(m.v_acc.value());
    });
    with<NavHpposllh>(frame, says_precise_place, [](const NavHpposllh& m, UnderWay& e) {
        e.told.is_solution = true;
        if ((m.flags & 1u) == 0)
            e.take_place(4, m.lat.value() + m.lat_hp.value(), m.lon.value() + m.lon_hp.value(),
                         m.height.value() + m.height_hp.value());
    });
    with<NavVelned>(frame, says_velocity, [](const NavVelned& m, UnderWay& e) {
        if (e.told.velocity) return;
        e.told.velocity = VelocityNed{m.vel_n.value(), m.vel_e.value(), m.vel_d.value()};
        e.told.speed_accuracy = MetresPerSecond(m.s_acc.value());
    });
    // An accuracy of zero comes before the fusion has begun.
    with<NavAtt>(frame, 0, [](const NavAtt& m, UnderWay& e) {
        if (m.acc[0] > 0 || m.acc[2] > 0) e.told.attitude = ubx_attitude(m.angle);
    });
}

void UbxEpochs::take_times(const UbxFrameView& frame) {
    with<NavStatus>(frame, 0, [](const NavStatus& m, UnderWay& e) {
        e.take_type(1, ubx_fix_type(m.gps_fix, m.flags, m.flags2 >> 6 & 3u));
    });
    with<NavTimegps>(frame, 0, [](const NavTimegps& m, UnderWay& e) {
        if ((m.valid & 2u) != 0) e.take_week(m.week);
    });
    with<NavTimeutc>(frame, says_utc, [](const NavTimeutc& m, UnderWay& e) {
        if ((m.valid & 7u) == 7) e.told.utc_s = told_utc(m);
    });
}

// NAV-SVINFO counts where neither NAV-SAT nor NAV-SIG comes in its epoch.
void UbxEpochs::take_satellites(const UbxFrameView& frame) {
    const auto anew = [](UnderWay& e) {
        if (std::exchange(e.single_numbers, false)) e.told.signals.clear();
    };
    with<NavSat>(frame, 0, [&](const NavSat& m, UnderWay& e) {
        anew(e);
        std::size_t used = 0;
        for (const NavSatItem& item : m.satellites) {
            if ((item.flags & 8u) != 0) ++used;
            if (const auto id = ubx_satellite(item.gnss_id, item.sv_id))
                add_signal(e.told.signals, {*id, static_cast<double>(item.cno), item.elev});
        }
        e.list_satellites(used);
    });
    with<NavSig>(frame, 0, [&](const NavSig& m, UnderWay& e) {
        anew(e);
        e.told.lists_satellites = true;
        for (const NavSigItem& item : m.signals)
            if (const auto id = ubx_satellite(item.gnss_id, item.sv_id))
                add_signal(e.told.signals,
                           {*id, static_cast<double>(item.cno), {}, every_signal_ ? 1 + item.sig_id : 0});
    });
    with<NavSvinfo>(frame, 0, [](const NavSvinfo& m, UnderWay& e) {
        if (e.told.lists_satellites && !e.single_numbers) return;
        e.single_numbers = true;
        std::size_t used = 0;
        for (const NavSvinfoItem& item : m.channels) {
            if ((item.flags & 1u) != 0) ++used;
            if (const auto id = single_byte_satellite(item.sv_id))
                add_signal(e.told.signals, {*id, static_cast<double>(item.cno), item.elev});
        }
        e.list_satellites(used);
    });
}

// Receivers that do not know the week say 0.
std::int64_t UbxEpochs::week_under_way() const {
    if (under_way_->week) return *under_way_->week;
    return week_ + (under_way_->itow_ms + ubx_week_ms / 2 < last_itow_ms_ ? 1 : 0);
}

std::optional<ObservedEpoch> UbxEpochs::epoch() const {
    if (!under_way_) return std::nullopt;
    ObservedEpoch told = under_way_->told;
    told.time = to_gps_time({week_under_way(), std::chrono::milliseconds(under_way_->itow_ms)});
    told.dated = under_way_->week ? *under_way_->week > 0 : week_told_;
    if (under_way_->type_rank == 0 && told.place) told.type = FixType::fix_3d;
    if (!told.satellites_used) told.satellites_used = under_way_->listed_used;
    return told;
}

std::optional<ObservedEpoch> UbxEpochs::end() {
    std::optional<ObservedEpoch> ended = epoch();
    if (!ended) return std::nullopt;
    if (ended->place && under_way_->type_rank == 0) ++untyped_;
    week_ = week_under_way();
    week_told_ = ended->dated;
    last_itow_ms_ = under_way_->itow_ms;
    under_way_.reset();
    return ended;
}

}  // namespace skyloop::inline receiver
