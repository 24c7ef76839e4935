#include "detail/ubx_epochs.hpp"

#include <cmath>
#include <utility>

#include "base/time/week_of_date.hpp"
#include "receiver/protocol/nmea_satellites.hpp"
#include "receiver/protocol/ubx_inertial.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "receiver/protocol/ubx_time.hpp"

namespace skyloop {
namespace {

constexpr std::uint32_t ubx_week_ms = 604'800'000;

// u-blox M8 protocol specification, "Satellite Numbering": gnssId and svId.
std::optional<SatelliteId> ubx_satellite(std::uint8_t gnss_id, std::uint8_t sv_id) {
    switch (gnss_id) {
        case 0:
            return SatelliteId{Constellation::gps, sv_id};
        case 1:
            return SatelliteId{Constellation::sbas, sv_id - 100};
        case 2:
            return SatelliteId{Constellation::galileo, sv_id};
        case 3:
            return SatelliteId{Constellation::beidou, sv_id};
        case 5:
            return SatelliteId{Constellation::qzss, sv_id};
        case 6:
            if (sv_id == 255) return std::nullopt;  // not identified yet
            return SatelliteId{Constellation::glonass, sv_id};
        default:
            return std::nullopt;
    }
}

// The single numbering of NAV-SVINFO (same section, column "svId").
std::optional<SatelliteId> single_number_satellite(std::uint8_t number) {
    if (number >= 1 && number <= 32) return SatelliteId{Constellation::gps, number};
    if (number >= 33 && number <= 64) return SatelliteId{Constellation::beidou, number - 27};
    if (number >= 65 && number <= 96) return SatelliteId{Constellation::glonass, number - 64};
    if (number >= 120 && number <= 158) return SatelliteId{Constellation::sbas, number - 100};
    if (number >= 159 && number <= 163) return SatelliteId{Constellation::beidou, number - 158};
    if (number >= 193 && number <= 202) return SatelliteId{Constellation::qzss, number - 192};
    if (number >= 211 && number <= 246) return SatelliteId{Constellation::galileo, number - 210};
    return std::nullopt;
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

// Roll, pitch and heading in 1e-5 degrees; nothing for what are no such angles.
std::optional<Attitude> ubx_attitude(const std::array<std::int32_t, 3>& angle) {
    constexpr std::int32_t whole_turn = 36'000'000;
    for (const std::int32_t one : angle)
        if (one < -whole_turn || one > whole_turn) return std::nullopt;
    const auto degrees = [](std::int32_t value) { return Angle::degrees(value * 1e-5); };
    return Attitude::roll_pitch_yaw(degrees(angle[0]), degrees(angle[1]), degrees(angle[2]));
}

template <std::size_t N>
std::string text_of(const std::array<char, N>& characters) {
    return {characters.begin(), std::find(characters.begin(), characters.end(), '\0')};
}

// The profile whose chip, and module where that is told, MON-VER names (boards/receivers, [identity]).
std::string board_of_version(const std::string& hardware, const std::string& texts) {
    if (texts.find("MOD=ZED-F9") != std::string::npos) return "ublox-f9p";
    if (texts.find("MOD=NEO-M9") != std::string::npos) return "ublox-m9";
    if (hardware == "000A0000") return texts.find("SPGL1L5") != std::string::npos ? "ublox-f10" : "ublox-m10";
    if (hardware == "00190000") return texts.find("HPG") != std::string::npos ? "ublox-f9p" : "ublox-m9";
    if (hardware == "00080000") return "ublox-m8";
    if (hardware == "00040007" || hardware == "00070000") return "ublox-6";
    return {};
}

}  // namespace

template <class Message, class Taker>
bool UbxEpochs::with(const UbxFrameView& frame, Taker&& taker) {
    if (frame.id != Message::message_id) return false;
    const auto message = decode_payload<Message>(frame.payload);
    if (!message || message->i_tow >= ubx_week_ms)
        ++senseless_;
    else
        taker(*message, epoch_at(message->i_tow));
    return true;
}

UbxEpochs::Epoch& UbxEpochs::epoch_at(std::uint32_t itow_ms) {
    if (!epoch_ || epoch_->itow_ms != itow_ms) {
        finish_epoch();
        epoch_ = Epoch{};
        epoch_->itow_ms = itow_ms;
    }
    return *epoch_;
}

void UbxEpochs::take(const UbxFrameView& frame) {
    const bool taken =
        with<NavPvt>(frame,
                     [](const NavPvt& m, Epoch& e) {
                         e.solution = true;
                         e.of_pvt = ubx_fix_type(m.fix_type, m.flags, m.flags >> 6 & 3u);
                         if (const auto week = told_week(m)) e.week = week;
                         if ((m.flags3 & 1u) == 0) e.pvt = logged_place(m.lat * 1e-7, m.lon * 1e-7, m.height * 1e-3);
                         e.velocity = VelocityNed{m.vel_n * 1e-3, m.vel_e * 1e-3, m.vel_d * 1e-3};
                         e.used = m.num_sv;
                         e.h_acc = Metres(m.h_acc * 1e-3);
                         e.v_acc = Metres(m.v_acc * 1e-3);
                     }) ||
        with<NavSol>(frame,
                     [](const NavSol& m, Epoch& e) {
                         e.solution = true;
                         e.of_sol = ubx_fix_type(m.gps_fix, m.flags, 0);
                         if ((m.flags & 4u) != 0 && !e.week) e.week = m.week;
                         const Position<Ecef> point(m.ecef[0] * 1e-2, m.ecef[1] * 1e-2, m.ecef[2] * 1e-2);
                         if (point.vector().norm() > 6e6) {
                             const Geodetic place = to_geodetic(point);
                             e.sol = logged_place(place.latitude.deg(), place.longitude.deg(),
                                                  place.height.above_ellipsoid.value());
                         }
                         if (!e.used) e.used = m.num_sv;
                     }) ||
        with<NavStatus>(frame, [](const NavStatus& m,
                                  Epoch& e) { e.of_status = ubx_fix_type(m.gps_fix, m.flags, m.flags2 >> 6 & 3u); }) ||
        with<NavTimegps>(frame, [](const NavTimegps& m, Epoch& e) {
            if ((m.valid & 2u) != 0) e.week = m.week;
        });
    if (taken) return;
    take_positions(frame);
    take_attitudes(frame);
    take_satellites(frame);
    take_version(frame);
}

void UbxEpochs::take_positions(const UbxFrameView& frame) {
    with<NavPosllh>(frame, [](const NavPosllh& m, Epoch& e) {
        e.llh = logged_place(m.lat * 1e-7, m.lon * 1e-7, m.height * 1e-3);
        if (!e.h_acc) e.h_acc = Metres(m.h_acc * 1e-3), e.v_acc = Metres(m.v_acc * 1e-3);
    });
    with<NavHpposllh>(frame, [](const NavHpposllh& m, Epoch& e) {
        if ((m.flags & 1u) == 0)
            e.precise = logged_place(m.lat * 1e-7 + m.lat_hp * 1e-9, m.lon * 1e-7 + m.lon_hp * 1e-9,
                                     m.height * 1e-3 + m.height_hp * 1e-4);
    });
    with<NavVelned>(frame, [](const NavVelned& m, Epoch& e) {
        if (!e.velocity) e.velocity = VelocityNed{m.vel_n * 1e-2, m.vel_e * 1e-2, m.vel_d * 1e-2};
    });
}

// NAV-PVAT tells all of an epoch; of NAV-ATT an accuracy of zero comes before the fusion has begun.
void UbxEpochs::take_attitudes(const UbxFrameView& frame) {
    with<NavPvat>(frame, [](const NavPvat& m, Epoch& e) {
        constexpr unsigned whole_attitude = 0x1C;
        e.solution = true;
        e.of_pvt = ubx_fix_type(m.fix_type, m.flags, m.flags >> 6 & 3u);
        if (const auto week = told_week(m)) e.week = week;
        e.pvt = logged_place(m.lat * 1e-7, m.lon * 1e-7, m.height * 1e-3);
        e.velocity = VelocityNed{m.vel_ned[0] * 1e-3, m.vel_ned[1] * 1e-3, m.vel_ned[2] * 1e-3};
        e.used = m.num_sv;
        e.h_acc = Metres(m.h_acc * 1e-3);
        e.v_acc = Metres(m.v_acc * 1e-3);
        if ((m.flags & whole_attitude) == whole_attitude) e.attitude = ubx_attitude(m.angle);
    });
    with<NavAtt>(frame, [](const NavAtt& m, Epoch& e) {
        if (m.acc[0] > 0 || m.acc[2] > 0) e.attitude = ubx_attitude(m.angle);
    });
}

void UbxEpochs::take_satellites(const UbxFrameView& frame) {
    with<NavSat>(frame, [](const NavSat& m, Epoch& e) {
        e.lists = true;
        for (const NavSatItem& item : m.satellites)
            if (const auto id = ubx_satellite(item.gnss_id, item.sv_id))
                add_satellite(e.satellites, {*id, static_cast<double>(item.cno), item.elev});
    });
    with<NavSig>(frame, [](const NavSig& m, Epoch& e) {
        e.lists = true;
        for (const NavSigItem& item : m.signals)
            if (const auto id = ubx_satellite(item.gnss_id, item.sv_id))
                add_satellite(e.satellites, {*id, static_cast<double>(item.cno)});
    });
    with<NavSvinfo>(frame, [](const NavSvinfo& m, Epoch& e) {
        if (e.lists) return;
        e.lists = true;
        for (const NavSvinfoItem& item : m.channels)
            if (const auto id = single_number_satellite(item.sv_id))
                add_satellite(e.satellites, {*id, static_cast<double>(item.cno), item.elev});
    });
}

void UbxEpochs::take_version(const UbxFrameView& frame) {
    if (frame.id != MonVer::message_id || !log_.receiver.empty()) return;
    const auto version = decode_payload<MonVer>(frame.payload);
    if (!version) return;
    std::string texts = text_of(version->sw_version);
    for (const auto& extension : version->extensions)
        texts += ", " + text_of(extension.characters);
    log_.receiver = "MON-VER " + text_of(version->hw_version) + ", " + texts;
    log_.board = board_of_version(text_of(version->hw_version), texts);
}

// Receivers that do not know the week say 0.
void UbxEpochs::count_week() {
    if (epoch_->week) {
        week_told_ = *epoch_->week > 0;
        week_ = week_told_ ? *epoch_->week : 0;
    } else if (epoch_->itow_ms + ubx_week_ms / 2 < last_itow_ms_) {
        ++week_;
    }
    last_itow_ms_ = epoch_->itow_ms;
}

void UbxEpochs::finish_epoch() {
    if (!epoch_) return;
    count_week();
    const bool with_place = epoch_->precise || epoch_->pvt || epoch_->llh || epoch_->sol;
    const bool told = epoch_->of_pvt || epoch_->of_sol || epoch_->of_status;
    if (epoch_->solution || with_place || told) {
        ++solutions_;
        LogEpoch done;
        done.time = to_gps_time({week_, std::chrono::milliseconds(epoch_->itow_ms)});
        done.place = epoch_->precise ? epoch_->precise
                     : epoch_->pvt   ? epoch_->pvt
                     : epoch_->llh   ? epoch_->llh
                                     : epoch_->sol;
        done.type = epoch_->of_pvt   ? *epoch_->of_pvt
                    : epoch_->of_sol ? *epoch_->of_sol
                                     : epoch_->of_status.value_or(with_place ? FixType::fix_3d : FixType::none);
        done.satellites_used = epoch_->used;
        done.horizontal_accuracy = epoch_->h_acc;
        done.vertical_accuracy = epoch_->v_acc;
        done.lists_satellites = epoch_->lists;
        done.satellites = std::move(epoch_->satellites);
        if (!done.is_lost() && !done.place) ++placeless_;
        if (done.type == FixType::none || done.type == FixType::time_only) done.place.reset();
        if (done.place) done.velocity = epoch_->velocity, done.attitude = epoch_->attitude;
        (week_told_ ? log_.epochs : weekless_).push_back(std::move(done));
    }
    epoch_.reset();
}

ReceiverLog UbxEpochs::finish() {
    finish_epoch();
    log_.format = "UBX";
    log_.dated = !for_track_ || !log_.epochs.empty();
    if (!log_.dated) log_.epochs = std::exchange(weekless_, {});
    add_note(log_, weekless_.size(), "epochs before the receiver knew the week were left out");
    add_note(log_, senseless_, "messages of a wrong length or time of week were left out");
    add_note(log_, placeless_, "epochs have a fix and no sensible place");
    return std::move(log_);
}

}  // namespace skyloop
