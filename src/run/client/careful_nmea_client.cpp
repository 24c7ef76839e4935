#include "run/client/careful_nmea_client.hpp"

#include <chrono>
#include <cmath>

#include "receiver/protocol/nmea_decode.hpp"

namespace skyloop {
namespace {

constexpr Nanoseconds longest_without_pair = std::chrono::seconds(3);
constexpr double day_s = 86400;

// Quality 6 is dead reckoning, 7 typed in by hand, 8 simulated, 3 military: none is a fix to fly by.
bool is_good_quality(int quality) { return quality == 1 || quality == 2 || quality == 4 || quality == 5; }

double seconds_of(const NmeaTime& time) {
    return time.hour * 3600.0 + time.minute * 60.0 + time.second + time.nanosecond * 1e-9;
}

std::optional<double> midnight_of(const NmeaDate& date) {
    const auto day = std::chrono::year(date.year) / std::chrono::month(date.month) / std::chrono::day(date.day);
    if (!day.ok()) return std::nullopt;
    const auto midnight = std::chrono::sys_days(day).time_since_epoch();
    return static_cast<double>(std::chrono::duration_cast<std::chrono::seconds>(midnight).count());
}

void add_motion(HeardSolution& s, const Rmc& rmc) {
    if (!rmc.speed) return;
    // Receivers leave the course empty when they stand: then the speed has no direction and hardly a size.
    const double course = rmc.course ? rmc.course->rad() : 0;
    s.velocity_mps = {rmc.speed->value() * std::cos(course), rmc.speed->value() * std::sin(course), 0};
}

HeardSolution of_pair(const Gga& gga, const Rmc& rmc) {
    HeardSolution s;
    s.has_place = gga.position.has_value();
    s.satellites = gga.satellites_used;
    if (gga.position) {
        s.latitude_deg = gga.position->latitude.deg();
        s.longitude_deg = gga.position->longitude.deg();
    }
    if (gga.altitude) s.height_m = gga.altitude->value();
    s.hdop = gga.hdop;
    s.seconds_wrap = day_s;
    if (gga.time) s.seconds = seconds_of(*gga.time);
    if (rmc.date && rmc.time)
        if (const auto midnight = midnight_of(*rmc.date)) s.utc_s = *midnight + seconds_of(*rmc.time);
    add_motion(s, rmc);
    return s;
}

}  // namespace

void CarefulNmeaClient::speed_found() {
    gga_.reset();
    rmc_.reset();
    fix_mode_.reset();
    solution_at_ = now();
}

void CarefulNmeaClient::watch() {
    if (now() - solution_at_ > longest_without_pair) doubt("no GGA and RMC of the same time for 3 s");
}

void CarefulNmeaClient::hear_message(const StreamPiece& piece) {
    const auto message = decode_nmea(to_string(piece.bytes));
    if (!message) return;
    if (const auto* gsa = std::get_if<Gsa>(&*message)) fix_mode_ = gsa->fix_mode;
    if (const auto* gga = std::get_if<Gga>(&*message)) gga_ = *gga;
    if (const auto* rmc = std::get_if<Rmc>(&*message)) rmc_ = *rmc;
    if (gga_ && rmc_ && gga_->time == rmc_->time) combine();
}

void CarefulNmeaClient::combine() {
    HeardSolution solution = of_pair(*gga_, *rmc_);
    solution.heard = now();
    const bool good = is_good_quality(gga_->quality);
    const bool agree = good == rmc_->valid;
    solution.valid = good && rmc_->valid;
    solution.three_dimensional = fix_mode_.value_or(3) == 3;
    gga_.reset();
    rmc_.reset();
    solution_at_ = now();
    judge(solution);
    if (!agree) doubt("GGA and RMC disagree on whether there is a fix");
}

}  // namespace skyloop
