// BeiDou's almanacs, health and UTC in D1 and D2 (BDS-SIS-ICD B1I 3.0, sections 5.2.4 and 5.3.3).
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "detail/beidou_words.hpp"
#include "detail/broadcast_fields.hpp"
#include "world/gnss/broadcast_beidou.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::inline world {
namespace {

constexpr double toa_step_s = 4096;
constexpr int pages_in_superframe = 24, d1_message_bits = 224;
constexpr double inclination_of_moving = 0.3 * std::numbers::pi;  // from which theirs are told; of geostationary ones 0

// What a page holds beside its number.
struct BeidouPage {
    const BeidouSystemData& data;
    GpsTime time;
    int extension = 1;  // AmID: which of the expanded almanacs come in these twelve minutes, 1 … 3

    [[nodiscard]] GpsTime reference() const {
        const WeekAndTow now = bdt_week_and_tow(time);
        return time - now.tow + Nanoseconds(now.tow / std::chrono::seconds(4096) * std::chrono::seconds(4096));
    }
    [[nodiscard]] std::optional<KeplerEphemeris> record(int number) const {
        if (data.source == nullptr) return std::nullopt;
        const auto found = data.source->ephemeris({Constellation::beidou, number}, time);
        if (!found || !std::holds_alternative<KeplerEphemeris>(*found)) return std::nullopt;
        return std::get<KeplerEphemeris>(*found);
    }
};

// A geostationary satellite's ephemeris is told in a frame that is tilted by 5° (table 5-11), its almanac in that of
// all others: the orbit through its place and velocity at the time of reference.
KeplerEphemeris untilted(const KeplerEphemeris& record, GpsTime reference) {
    const SatelliteState state = satellite_state(record, reference);
    const Eigen::Vector3d r = state.position.vector();
    const Eigen::Vector3d v = state.velocity.vector() + Eigen::Vector3d(0, 0, earth_rotation_rate_beidou).cross(r);
    const Eigen::Vector3d h = r.cross(v);
    const Eigen::Vector3d shape = v.cross(h) / gravitational_constant_beidou - r.normalized();
    const Eigen::Vector3d node = Eigen::Vector3d(-h.y(), h.x(), 0).normalized();
    const Eigen::Vector3d across = h.normalized().cross(node);
    const auto angle = [&](const Eigen::Vector3d& towards) {
        return std::atan2(towards.dot(across), towards.dot(node));
    };
    KeplerEphemeris almanac = record;
    almanac.toe = almanac.toc = reference;
    almanac.e = shape.norm();
    almanac.i0 = std::atan2(std::hypot(h.x(), h.y()), h.z());
    almanac.omega = angle(shape);
    const double anomaly = angle(r) - almanac.omega;
    const double eccentric = 2 * std::atan2(std::sqrt(1 - almanac.e) * std::sin(anomaly / 2),
                                            std::sqrt(1 + almanac.e) * std::cos(anomaly / 2));
    almanac.m0 = eccentric - almanac.e * std::sin(eccentric);
    almanac.omega0 =
        std::atan2(node.y(), node.x()) + earth_rotation_rate_beidou * bdt_week_and_tow(reference).tow_seconds();
    almanac.omega_dot = 0;
    almanac.af0 = record.af0 + record.af1 * difference(reference, record.toc).value();
    return almanac;
}

void put_almanac(BitWriter& bits, const BeidouPage& page, int number) {
    const std::optional<KeplerEphemeris> found = page.record(number);
    if (!found) return;
    const GpsTime reference = page.reference();
    const bool stationary = is_beidou_geo(found->satellite);
    const KeplerEphemeris r = stationary ? untilted(*found, reference) : carried_almanac(*found, reference);
    put_scaled_unsigned(bits, r.sqrt_a, 24, power_of_two(-11));
    put_scaled(bits, r.af1, 11, power_of_two(-38));
    put_scaled(bits, r.af0, 11, power_of_two(-20));
    put_circle(bits, r.omega0, 24);
    put_scaled_unsigned(bits, r.e, 17, power_of_two(-21));
    put_semicircles(bits, r.i0 - (stationary ? 0 : inclination_of_moving), 16, -19);
    put_scaled_unsigned(bits, bdt_week_and_tow(reference).tow_seconds(), 8, toa_step_s);
    put_semicircles(bits, r.omega_dot, 17, -38);
    put_circle(bits, r.omega, 24);
    put_circle(bits, r.m0, 24);
}

// Table 5-15: of nine bits the second says that B1I is not to be used, and all nine that there is no such satellite.
void put_health(BitWriter& bits, const BeidouPage& page, int first, int last) {
    constexpr std::uint64_t no_b1i = 0b010000000, nobody = 0b111111111;
    for (int number = first; number <= last; ++number) {
        const auto record = page.record(number);
        bits.put(!record ? nobody : record->health_bits_clear() ? 0 : no_b1i, 9);
    }
}

void put_health_of_rest(BitWriter& bits, const BeidouPage& page) {
    constexpr int second_first = 20, second_last = 30;
    put_health(bits, page, second_first, second_last);
    bits.put_signed(bdt_week_and_tow(page.reference()).week % 256, 8);
    put_scaled_unsigned(bits, bdt_week_and_tow(page.reference()).tow_seconds(), 8, toa_step_s);
}

// BDT is UTC but for whole seconds, as GPS time is.
void put_utc(BitWriter& bits, const BeidouPage& page) {
    constexpr int bdt_behind = 14;                       // s, of GPS time
    constexpr std::uint64_t weeks_between = 1356 % 256;  // from the epoch of GPS to that of BDT
    const LeapChange change = leap_change(page.data.leap_seconds, page.time);
    bits.put_signed(page.data.leap_seconds.offset(page.time) - bdt_behind, 8);
    bits.put_signed(change.offset - bdt_behind, 8);
    bits.put((change.week + 256 - weeks_between) & 0xFF, 8);
    bits.put(0, 32 + 24);
    bits.put(change.day - 1, 8);
}

// The first of the thirteen satellites that an extension's pages are about, and how many of them there are.
struct Expanded {
    int first = 31, count = 13;
};
Expanded expanded(int extension) {
    constexpr std::array<Expanded, 3> all{{{31, 13}, {44, 13}, {57, 7}}};
    return all[static_cast<std::size_t>(extension - 1)];
}

void put_expanded_health(BitWriter& bits, const BeidouPage& page) {
    const Expanded of = expanded(page.extension);
    constexpr int told = 13;
    put_health(bits, page, of.first, of.first + of.count - 1);
    bits.put(0, 9 * (told - of.count));
    bits.put_signed(page.extension, 2);
}

// Numbers of pages: those that D1 has in subframe 5, after which D2's are the same.
enum class Page { almanac, health, rest_of_health, offsets, utc, expanded, expanded_health };
struct Told {
    Page page;
    int number = 0;  // of the satellite, or of the expanded almanac from 0 on
};

BitWriter whole(const BeidouPage& page, int subframe, int number, const Told& told, GpsTime sow) {
    constexpr std::uint64_t has_expanded = 3;  // AmEpID
    BitWriter bits;
    put_beidou_head(bits, subframe, sow);
    bits.put(0, 1);
    bits.put_signed(number, 7);
    const Expanded of = expanded(page.extension);
    const bool almanac = told.page == Page::almanac, more = told.page == Page::expanded;
    if (almanac) put_almanac(bits, page, told.number);
    if (more && told.number < of.count) put_almanac(bits, page, of.first + told.number);
    if (told.page == Page::health) put_health(bits, page, 1, 19);
    if (told.page == Page::rest_of_health) put_health_of_rest(bits, page);
    if (told.page == Page::utc) put_utc(bits, page);
    if (told.page == Page::expanded_health) put_expanded_health(bits, page);
    constexpr int almanac_end = d1_message_bits - 2;
    if (almanac || more) {
        while (bits.size() < static_cast<std::size_t>(almanac_end))
            bits.put(0, 1);
        bits.put(almanac ? has_expanded : static_cast<std::uint64_t>(page.extension), 2);
    }
    while (bits.size() < static_cast<std::size_t>(d1_message_bits))
        bits.put(0, 1);
    return bits;
}

// Of subframe 5 (figure 5-12).
Told told_by_d1(int number) {
    constexpr int in_subframe_4 = 24, almanacs = 6, first_expanded = 11, last_expanded = 23;
    if (number <= almanacs) return {Page::almanac, in_subframe_4 + number};
    if (number >= first_expanded && number <= last_expanded) return {Page::expanded, number - first_expanded};
    constexpr std::array<Page, 4> system{Page::health, Page::rest_of_health, Page::offsets, Page::utc};
    return number < first_expanded ? Told{system[static_cast<std::size_t>(number - almanacs - 1)]}
                                   : Told{Page::expanded_health};
}

// Of 120 pages (table 5-17).
std::optional<Told> told_by_d2(int number) {
    struct Range {
        int first, last;
        Page page;
        int of_first;
    };
    constexpr std::array<Range, 8> ranges{{{35, 35, Page::health, 0},
                                           {36, 36, Page::rest_of_health, 0},
                                           {37, 60, Page::almanac, 1},
                                           {95, 100, Page::almanac, 25},
                                           {101, 101, Page::offsets, 0},
                                           {102, 102, Page::utc, 0},
                                           {103, 115, Page::expanded, 0},
                                           {116, 116, Page::expanded_health, 0}}};
    for (const Range& range : ranges)
        if (number >= range.first && number <= range.last)
            return Told{range.page, range.of_first + number - range.first};
    return std::nullopt;
}

}  // namespace

D1Words d1_system_subframe(const BeidouSystemData& data, int subframe, GpsTime end) {
    constexpr std::chrono::seconds length{6}, frame{30};
    const GpsTime start = end - length;
    const auto count = bdt_week_and_tow(start).tow / frame;
    const int number = static_cast<int>(count % pages_in_superframe) + 1;
    const BeidouPage page{data, start, static_cast<int>(count / pages_in_superframe % 3) + 1};
    const Told told = subframe == 4 ? Told{Page::almanac, number} : told_by_d1(number);
    return with_d1_parity(whole(page, subframe, number, told, start));
}

std::optional<D1Words> d2_system_subframe_ending(const BeidouSystemData& data, GpsTime end) {
    constexpr std::chrono::seconds frame{3};
    constexpr int pages = 120, last_subframe = 5;
    const GpsTime start = end - frame;  // of the frame, which its last subframe ends
    const WeekAndTow at = bdt_week_and_tow(start);
    if (at.tow % frame != Nanoseconds(0)) return std::nullopt;
    const auto count = at.tow / frame;
    const int number = static_cast<int>(count % pages) + 1;
    const auto told = told_by_d2(number);
    if (!told) return std::nullopt;
    const BeidouPage page{data, start, static_cast<int>(count / pages % 3) + 1};
    return with_d1_parity(whole(page, last_subframe, number, *told, start));
}

}  // namespace skyloop::inline world
