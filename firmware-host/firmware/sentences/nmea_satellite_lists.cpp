// GSA, GSV and GRS (RECEIVER.md 5.2, 5.3, 5.6).
#include <algorithm>
#include <cmath>
#include <map>

#include "firmware/messages/field_values.hpp"
#include "firmware/sentences/nmea_report.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::size_t used_slots = 12;

// A C/N0 of one signal; nothing: not tracked.
struct ListedSatellite {
    SatelliteId id;
    std::optional<DbHz> cn0;
};

int to_whole_degrees(Angle angle) { return static_cast<int>(std::lround(angle.deg())); }

GsvSatellite gsv_satellite(const NmeaReport& r, const ListedSatellite& listed) {
    GsvSatellite line;
    line.number = nmea_satellite_number(listed.id, r.format.version, r.numbering);
    const auto status = std::find_if(r.satellites.begin(), r.satellites.end(),
                                     [&](const SatelliteStatus& s) { return s.id == listed.id; });
    if (status != r.satellites.end() && direction_known(*status, r.context.state)) {
        line.elevation_deg = to_whole_degrees(status->elevation);
        line.azimuth_deg = (to_whole_degrees(status->azimuth) % 360 + 360) % 360;
    }
    if (listed.cn0) line.cn0_dbhz = static_cast<int>(std::lround(std::clamp(listed.cn0->value(), 0.0, 99.0)));
    return line;
}

using SignalGroups = std::map<int, std::vector<ListedSatellite>>;  // by signal id

// Who measures nothing tracks the first signal of each satellite.
SignalGroups tracked_signals(const NmeaReport& r, const NmeaGroup& group) {
    SignalGroups signals;
    const auto listed = [&](SatelliteId id) {
        return r.belongs(id, group) && std::any_of(r.satellites.begin(), r.satellites.end(),
                                                   [&](const SatelliteStatus& s) { return s.id == id; });
    };
    const auto& observed = r.context.state.epoch.observations.signals;
    for (const Observation& o : observed)
        if (listed(o.satellite))
            signals[tracked_signal_id(r, o.satellite.constellation, o.signal)].push_back({o.satellite, o.cn0});
    if (!observed.empty()) return signals;
    for (const SatelliteStatus& s : r.satellites)
        if (s.cn0 && r.belongs(s.id, group)) signals[group.first_signal_id].push_back({s.id, s.cn0});
    return signals;
}

// The satellites of the group in view, each with the C/N0 that `tracked` has of it.
std::vector<ListedSatellite> all_in_view(const NmeaReport& r, const NmeaGroup& group,
                                         const std::vector<ListedSatellite>& tracked) {
    std::vector<ListedSatellite> all;
    for (const SatelliteStatus& s : r.satellites) {
        if (!r.belongs(s.id, group)) continue;
        const auto found =
            std::find_if(tracked.begin(), tracked.end(), [&](const ListedSatellite& t) { return t.id == s.id; });
        all.push_back({s.id, found == tracked.end() ? std::nullopt : found->cn0});
    }
    return all;
}

std::vector<ListedSatellite> untracked_ones(const NmeaReport& r, const NmeaGroup& group, const SignalGroups& signals) {
    std::vector<ListedSatellite> rest = all_in_view(r, group, {});
    std::erase_if(rest, [&](const ListedSatellite& in_view) {
        return std::any_of(signals.begin(), signals.end(), [&](const auto& signal) {
            return std::any_of(signal.second.begin(), signal.second.end(),
                               [&](const ListedSatellite& t) { return t.id == in_view.id; });
        });
    });
    return rest;
}

// Before 4.10 one list. In 4.10 firmware repeats what it does not track under every signal; in 4.11 such satellites
// have a list of their own under signal 0 (captures of M9N and F9R; RECEIVER.md 5.6).
SignalGroups lists_of(const NmeaReport& r, const NmeaGroup& group) {
    SignalGroups signals = tracked_signals(r, group);
    if (r.context.board.style.tracked_only) return signals;
    if (r.format.version < NmeaVersion::v4_10 || r.context.board.style.one_gsv_list) {
        std::vector<ListedSatellite> strongest;
        for (const SatelliteStatus& s : r.satellites)
            if (r.belongs(s.id, group)) strongest.push_back({s.id, s.cn0});
        return {{0, strongest}};
    }
    if (r.format.version >= NmeaVersion::v4_11) {
        const auto rest = untracked_ones(r, group, signals);
        auto& last = signals[0];
        last.insert(last.end(), rest.begin(), rest.end());
        if (last.empty()) signals.erase(0);
        return signals;
    }
    if (signals.empty() && !all_in_view(r, group, {}).empty()) signals[group.first_signal_id];
    for (auto& [id, list] : signals)
        list = all_in_view(r, group, list);
    return signals;
}

// A group without satellites is one sentence. M10 calls the signal of GPS in it by its number (RECEIVER.md 5.5).
int signal_of_stub(const NmeaReport& r, const NmeaGroup& group) {
    return r.context.config.nmea.numbers_empty_lists && group.system.talker == "GP" ? group.first_signal_id : 0;
}

void append_pages(std::vector<Gsv>& out, const NmeaReport& r, const NmeaGroup& group, const SignalGroups& lists) {
    const std::uint64_t most = r.context.config.nmea.most_listed;
    // Signal 0 comes last (capture of F9R).
    std::vector<int> order;
    for (const auto& [id, list] : lists)
        order.push_back(id);
    std::stable_partition(order.begin(), order.end(), [](int id) { return id != 0; });
    for (const int id : order) {
        std::vector<GsvSatellite> lines;
        for (const ListedSatellite& listed : lists.at(id))
            if (most == 0 || lines.size() < most) lines.push_back(gsv_satellite(r, listed));
        for (const Gsv& page : gsv_pages(group.talker, lines, id))
            out.push_back(page);
    }
}

// Receivers whose lists have what is tracked alone list BeiDou before Galileo (the same capture as in
// talker_of_lists()).
std::vector<NmeaGroup> beidou_before_galileo(std::vector<NmeaGroup> groups) {
    const auto is_beidou = [](const NmeaGroup& group) { return group.system.talker == "GB"; };
    const auto galileo =
        std::ranges::find_if(groups, [](const NmeaGroup& group) { return group.system.talker == "GA"; });
    std::stable_partition(galileo, groups.end(), is_beidou);
    return groups;
}

std::vector<int> used_numbers(const NmeaReport& r, const NmeaGroup& group) {
    std::vector<int> numbers;
    for (const SatelliteStatus& s : r.used) {
        const auto number = nmea_satellite_number(s.id, r.format.version, r.numbering);
        if (number && r.belongs(s.id, group)) numbers.push_back(*number);
    }
    return numbers;
}

// One sentence has one system's id: none where its satellites are of several.
Gsa gsa_of_all(const NmeaReport& r, Gsa m) {
    for (const NmeaGroup& group : r.groups) {
        const std::vector<int> numbers = used_numbers(r, group);
        if (numbers.empty()) continue;
        m.system_id = m.satellites.empty() ? std::optional(group.system.system_id) : std::nullopt;
        m.satellites.insert(m.satellites.end(), numbers.begin(), numbers.end());
    }
    return m;
}

}  // namespace

std::vector<Gsv> gsv_messages(const NmeaReport& r) {
    const bool tracked_only = r.context.board.style.tracked_only;
    std::vector<NmeaGroup> reordered;
    if (tracked_only) reordered = beidou_before_galileo(r.groups);
    std::vector<Gsv> out;
    for (const NmeaGroup& group : tracked_only ? reordered : r.groups) {
        const SignalGroups lists = lists_of(r, group);
        if (!lists.empty())
            append_pages(out, r, group, lists);
        else if (!tracked_only)
            out.push_back(gsv_pages(group.talker, {}, signal_of_stub(r, group)).front());
    }
    if (out.empty() && tracked_only) out.push_back(gsv_pages("GP", {}, std::nullopt).front());
    return out;
}

std::vector<Gsa> gsa_messages(const NmeaReport& r) {
    Gsa m;
    m.talker = r.talker;
    const NmeaStyle& style = r.context.board.style;
    m.automatic = r.context.config.limits.mode == FixMode::automatic && !style.gsa_manual;
    m.fix_mode = r.fix_mode;
    if (const auto dops = shown_dops(r)) {
        m.pdop = dops->pdop;
        m.hdop = dops->hdop;
        m.vdop = dops->vdop;
    }
    if (style.gsa == GsaStyle::one) return {gsa_of_all(r, m)};
    std::vector<Gsa> out;
    for (const NmeaGroup& group : r.groups) {
        m.satellites = used_numbers(r, group);
        m.system_id = group.system.system_id;
        if (style.gsa == GsaStyle::by_talker) m.talker = group.talker;
        if (!style.tracked_only || !m.satellites.empty()) out.push_back(m);
    }
    if (!out.empty() || !style.tracked_only) return out;
    Gsa none;
    none.talker = "GP";
    none.has_mode = false;
    none.fix_mode = r.fix_mode;
    return {none};
}

std::vector<Grs> grs_messages(const NmeaReport& r) {
    Grs m;
    m.talker = r.talker;
    m.time = r.time;
    std::vector<Grs> out;
    for (const NmeaGroup& group : r.groups) {
        m.residuals.clear();
        m.system_id = group.system.system_id;
        m.signal_id = group.first_signal_id;
        for (const SatelliteStatus& s : r.used) {
            const bool has_number = nmea_satellite_number(s.id, r.format.version, r.numbering).has_value();
            if (has_number && r.belongs(s.id, group) && m.residuals.size() < used_slots)
                m.residuals.push_back(s.residual);
        }
        out.push_back(m);
    }
    return out;
}

}  // namespace skyloop::firmware
