#include "detail/ubx_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/time/week_of_date.hpp"
#include "detail/fix_table.hpp"
#include "detail/ubx_frames.hpp"

namespace skyloop {
namespace {

// Messages of class NAV (u-blox 6 and M8 protocol specifications, sections "UBX-NAV").
constexpr std::uint8_t nav_class = 0x01;
enum NavId : std::uint8_t {
    nav_posllh = 0x02,
    nav_status = 0x03,
    nav_sol = 0x06,
    nav_pvt = 0x07,
    nav_hpposllh = 0x14,
    nav_timegps = 0x20,
    nav_svinfo = 0x30,
    nav_sat = 0x35,
};

constexpr std::int64_t week_ms = seconds_per_week * 1000;

// Which payload lengths are right, and where the time of week stands.
struct NavLayout {
    std::uint8_t id;
    std::size_t itow_at;
    std::size_t length;      // of the part before repeated blocks
    std::size_t block;       // of one repeated block, 0: none
    std::size_t count_at;    // where the number of blocks stands
    std::size_t old_length;  // of an earlier protocol version, 0: none
};
constexpr std::array<NavLayout, 8> nav_layouts{{{nav_posllh, 0, 28, 0, 0, 0},
                                                {nav_status, 0, 16, 0, 0, 0},
                                                {nav_sol, 0, 52, 0, 0, 0},
                                                {nav_pvt, 0, 92, 0, 0, 84},
                                                {nav_hpposllh, 4, 36, 0, 0, 0},
                                                {nav_timegps, 0, 16, 0, 0, 0},
                                                {nav_svinfo, 0, 8, 12, 4, 0},
                                                {nav_sat, 0, 8, 12, 5, 0}}};

const NavLayout* nav_layout_of(const UbxFrame& frame) {
    if (frame.message_class != nav_class) return nullptr;
    const auto* const found = std::find_if(nav_layouts.begin(), nav_layouts.end(),
                                           [&](const NavLayout& layout) { return layout.id == frame.id; });
    return found == nav_layouts.end() ? nullptr : found;
}

bool length_is_right(const UbxFrame& frame, const NavLayout& layout) {
    const std::size_t size = frame.payload.size();
    if (size < layout.length) return layout.old_length != 0 && size == layout.old_length;
    return size == layout.length + (layout.block == 0 ? 0 : layout.block * frame.u1(layout.count_at));
}

// What fixType and gnssFixOK mean together.
enum class UbxFix { none, position, time_only };

UbxFix ubx_fix(std::uint8_t type, std::uint8_t flags) {
    constexpr std::uint8_t time_only = 5;
    if ((flags & 1u) == 0 || type == 0 || type > time_only) return UbxFix::none;
    return type == time_only ? UbxFix::time_only : UbxFix::position;
}

// What the messages of one time of week have said.
struct UbxEpoch {
    std::int64_t itow_ms = 0;
    std::optional<std::int64_t> week;
    std::optional<UbxFix> of_pvt, of_sol, of_status;
    bool has_position = false;  // a message for it came, whatever it said
    std::optional<Geodetic> precise, pvt, llh, sol;
    std::optional<int> used, listed_used;
};

class UbxLogReader {
public:
    explicit UbxLogReader(const std::string& name) { log_.series.name = name; }
    UbxLog read(std::string_view text);

private:
    void take(const UbxFrame& frame);
    void take_epoch_message(const UbxFrame& frame);
    void take_pvt(const UbxFrame& frame);
    void take_sol(const UbxFrame& frame);
    void take_satellites(const UbxFrame& frame);
    void take_week(std::int64_t week);
    void finish_epoch();
    void settle_signals();
    void date_samples();
    void add_warnings(std::size_t damaged);
    std::optional<Geodetic> checked(double latitude_deg, double longitude_deg, double height_m);

    struct Clock {
        std::int64_t itow_ms = 0;
        std::optional<std::int64_t> week;
    };
    UbxLog log_;
    std::optional<UbxEpoch> epoch_;
    std::vector<Clock> clocks_;
    std::vector<SignalReport> of_sat_, of_svinfo_;   // since the last sample
    std::vector<std::vector<SignalReport>> svinfo_;  // of each sample
    std::size_t senseless_ = 0, time_only_ = 0, without_flags_ = 0;
};

UbxLog UbxLogReader::read(std::string_view text) {
    UbxFrames frames(text);
    while (const std::optional<UbxFrame> frame = frames.next()) {
        ++log_.messages;
        take(*frame);
    }
    finish_epoch();
    date_samples();
    settle_signals();
    add_warnings(frames.damaged());
    return std::move(log_);
}

void UbxLogReader::take(const UbxFrame& frame) {
    const NavLayout* layout = nav_layout_of(frame);
    if (!layout) return;
    if (!length_is_right(frame, *layout) || frame.u4(layout->itow_at) >= week_ms) {
        ++senseless_;
        return;
    }
    const std::int64_t itow_ms = frame.u4(layout->itow_at);
    if (!epoch_ || epoch_->itow_ms != itow_ms) {
        finish_epoch();
        epoch_.emplace();
        epoch_->itow_ms = itow_ms;
    }
    take_epoch_message(frame);
}

void UbxLogReader::take_epoch_message(const UbxFrame& frame) {
    switch (frame.id) {
        case nav_pvt:
            return take_pvt(frame);
        case nav_sol:
            return take_sol(frame);
        case nav_status:
            epoch_->of_status = ubx_fix(frame.u1(4), frame.u1(5));
            return;
        case nav_timegps:
            if (frame.u1(11) & 2u) take_week(frame.i2(8));
            return;
        case nav_posllh:
            epoch_->has_position = true;
            epoch_->llh = checked(frame.i4(8) * 1e-7, frame.i4(4) * 1e-7, frame.i4(12) * 1e-3);
            return;
        case nav_hpposllh:
            epoch_->has_position = true;
            if ((frame.u1(3) & 1u) == 0)  // invalidLlh
                epoch_->precise =
                    checked(frame.i4(12) * 1e-7 + frame.i1(25) * 1e-9, frame.i4(8) * 1e-7 + frame.i1(24) * 1e-9,
                            frame.i4(16) * 1e-3 + frame.i1(26) * 1e-4);
            return;
        default:
            return take_satellites(frame);
    }
}

void UbxLogReader::take_pvt(const UbxFrame& frame) {
    epoch_->has_position = true;
    epoch_->of_pvt = ubx_fix(frame.u1(20), frame.u1(21));
    epoch_->used = frame.u1(23);
    constexpr unsigned date_and_time = 3;  // validDate, validTime
    const UtcTime utc{.year = frame.u2(4),
                      .month = frame.u1(6),
                      .day = frame.u1(7),
                      .hour = frame.u1(8),
                      .minute = frame.u1(9),
                      .second = frame.u1(10)};
    if ((frame.u1(11) & date_and_time) == date_and_time && !epoch_->week)
        epoch_->week = week_of_date(utc, std::chrono::milliseconds(epoch_->itow_ms));
    constexpr std::size_t flags3_at = 78;
    if ((frame.u1(flags3_at) & 1u) == 0)  // invalidLlh
        epoch_->pvt = checked(frame.i4(28) * 1e-7, frame.i4(24) * 1e-7, frame.i4(32) * 1e-3);
}

void UbxLogReader::take_sol(const UbxFrame& frame) {
    epoch_->has_position = true;
    const std::uint8_t flags = frame.u1(11);
    epoch_->of_sol = ubx_fix(frame.u1(10), flags);
    if (!epoch_->used) epoch_->used = frame.u1(47);
    constexpr unsigned week_set = 4;
    if (flags & week_set) take_week(frame.i2(8));
    const Eigen::Vector3d ecef(frame.i4(12) * 1e-2, frame.i4(16) * 1e-2, frame.i4(20) * 1e-2);
    constexpr double deepest_radius = 6.3e6;  // m; below any place on Earth
    if (ecef.norm() > deepest_radius) epoch_->sol = to_geodetic(Position<Ecef>(ecef));
}

void UbxLogReader::take_week(std::int64_t week) {
    if (week >= 0 && week <= last_gps_week) epoch_->week = week;
}

// NAV-SAT and NAV-SVINFO have blocks of one size; C/N0 and elevation stand elsewhere in them.
void UbxLogReader::take_satellites(const UbxFrame& frame) {
    const bool sat = frame.id == nav_sat;
    const std::size_t count = (frame.payload.size() - 8) / 12;
    int used = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t block = 8 + 12 * i;
        const double cn0 = frame.u1(block + (sat ? 2 : 4));
        const double elevation = frame.i1(block + (sat ? 3 : 5));
        if ((sat ? frame.u1(block + 8) & 8u : frame.u1(block + 2) & 1u) != 0) ++used;
        if (cn0 > 0) (sat ? of_sat_ : of_svinfo_).push_back({Angle::degrees(elevation), DbHz(cn0)});
    }
    epoch_->listed_used = used;
}

std::optional<Geodetic> UbxLogReader::checked(double latitude_deg, double longitude_deg, double height_m) {
    const auto position = checked_position(latitude_deg, longitude_deg, height_m);
    if (position) return *position;
    ++senseless_;
    return std::nullopt;
}

void UbxLogReader::finish_epoch() {
    if (!epoch_ || !epoch_->has_position) return;
    const UbxEpoch& e = *epoch_;
    const std::optional<UbxFix> fix = e.of_pvt ? e.of_pvt : e.of_sol ? e.of_sol : e.of_status;
    FixSample sample;
    const auto place = e.precise ? e.precise : e.pvt ? e.pvt : e.llh ? e.llh : e.sol;
    sample.has_fix = place && fix.value_or(UbxFix::position) == UbxFix::position;
    if (sample.has_fix) sample.position = *place;
    sample.satellites_used = e.used ? e.used : e.listed_used;
    if (fix == UbxFix::time_only) ++time_only_;
    if (!fix) ++without_flags_;
    sample.signals = std::exchange(of_sat_, {});
    svinfo_.push_back(std::exchange(of_svinfo_, {}));
    log_.series.samples.push_back(std::move(sample));
    clocks_.push_back({e.itow_ms, e.week});
}

// What came behind the last position is of its sample, and NAV-SVINFO counts where no NAV-SAT does.
void UbxLogReader::settle_signals() {
    std::vector<FixSample>& samples = log_.series.samples;
    if (samples.empty()) return;
    samples.back().signals.insert(samples.back().signals.end(), of_sat_.begin(), of_sat_.end());
    svinfo_.back().insert(svinfo_.back().end(), of_svinfo_.begin(), of_svinfo_.end());
    if (!log_.series.signal_strength().empty()) return;
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i].signals = std::move(svinfo_[i]);
}

// A time of week belongs to the week that puts it within half a week of the last one whose week was said, or of the
// first one that follows. Without any, weeks are counted from the start of the log.
void UbxLogReader::date_samples() {
    const auto first = std::find_if(clocks_.begin(), clocks_.end(), [](const Clock& c) { return c.week.has_value(); });
    log_.series.dated = first != clocks_.end();
    Clock mark = log_.series.dated ? *first : Clock{clocks_.empty() ? 0 : clocks_.front().itow_ms, 0};
    for (std::size_t i = 0; i < clocks_.size(); ++i) {
        const Clock& c = clocks_[i];
        const std::int64_t ahead = c.itow_ms - mark.itow_ms;
        const std::int64_t week = c.week.value_or(*mark.week + (ahead > week_ms / 2    ? -1
                                                                : ahead < -week_ms / 2 ? 1
                                                                                       : 0));
        log_.series.samples[i].time = to_gps_time(week, static_cast<double>(c.itow_ms) / 1000);
        if (!log_.series.dated || first <= clocks_.begin() + static_cast<std::ptrdiff_t>(i)) mark = {c.itow_ms, week};
    }
}

void UbxLogReader::add_warnings(std::size_t damaged) {
    const auto warn = [&](std::size_t count, const char* what) {
        if (count > 0) log_.series.warnings.push_back(fmt::format("{}: {} {}", log_.series.name, count, what));
    };
    warn(damaged, "UBX messages with a wrong checksum or a cut end were skipped");
    warn(senseless_, "UBX navigation messages with a wrong length, time or position were skipped");
    warn(time_only_, "epochs with a time-only fix are not counted as fixes: the receiver was told its position");
    warn(without_flags_, "positions without a message that tells whether they are fixes were taken as fixes");
}

}  // namespace

bool has_ubx_sync(std::string_view text) { return text.find("\xB5\x62") != std::string_view::npos; }

UbxLog parse_ubx_log(std::string_view text, const std::string& name) { return UbxLogReader(name).read(text); }

}  // namespace skyloop
