#include <fmt/format.h>

#include <set>

#include "detail/dataflash_places.hpp"

namespace skyloop::inline motion {
namespace {

// Microseconds since the start; milliseconds in logs of before 2015, where a receiver's TimeMS is that of the week.
std::optional<std::int64_t> dataflash_clock(const DataflashRecord& record) {
    if (record.has("TimeUS")) return flight_clock_ns(record.raw({"TimeUS"}));
    const auto ms = record.raw({record.name().starts_with("GPS") ? "T" : "TimeMS"});
    return ms ? flight_clock_ns(*ms * 1000) : std::nullopt;
}

class DataflashTrack {
public:
    explicit DataflashTrack(const TrackFile& file) : file_(file) {}
    Result<Track> read();

private:
    void read_records();
    void offer_simulation();
    void offer_filter();
    void offer_receivers();
    void offer(std::string name, std::vector<std::vector<FlightRow>> starts);
    [[nodiscard]] std::optional<std::pair<std::string, int>> chosen_core() const;
    std::string take_attitudes(bool of_simulation);
    void take_clocks();
    void learn_undulation();

    const TrackFile& file_;
    std::vector<DataflashStart> starts_;
    std::vector<FlightOffer> offers_;
    FlightLog flight_;
    std::size_t clockless_ = 0;
};

void DataflashTrack::read_records() {
    static const std::set<std::string, std::less<>> wanted{"SIM",  "SIM2", "GPS",  "GPS2", "GPA",  "GPA2",
                                                           "ATT",  "POS",  "ORGN", "XKF1", "XKF4", "XKQ",
                                                           "NKF1", "NKF4", "NKQ1", "NKQ"};
    DataflashReader reader(file_.bytes);
    AutopilotStarts starts;
    std::optional<DataflashRecord> refused;
    std::int64_t refused_ns = 0;
    const auto take = [&](const DataflashRecord& record, std::int64_t ns, std::size_t start) {
        if (!wanted.contains(record.name())) return;
        if (starts_.size() <= start) starts_.resize(start + 1);
        starts_[start].take(record, ns);
    };
    while (const auto record = reader.next()) {
        const auto ns = dataflash_clock(*record);
        if (!ns) continue;
        if (const auto start = starts.of(*ns)) {
            if (starts.confirmed()) take(*refused, refused_ns, *start), --clockless_;
            take(*record, *ns, *start);
        } else {
            refused.emplace(*record);
            refused_ns = *ns;
            ++clockless_;
        }
    }
    add_count_note(flight_.notes, reader.skipped_bytes(), "bytes that begin no record were passed over");
    add_count_note(flight_.notes, reader.is_cut() ? 1 : 0, "record is cut by the end of the file");
    add_count_note(flight_.notes, clockless_, "records with a time that no other confirms were left out");
}

void DataflashTrack::offer(std::string name, std::vector<std::vector<FlightRow>> starts) {
    std::size_t rows = 0;
    for (const auto& start : starts)
        rows += start.size();
    if (rows > 1) offers_.push_back({std::move(name), std::move(starts)});
}

void DataflashTrack::offer_simulation() {
    std::vector<std::vector<FlightRow>> rows;
    bool moves = false;
    for (const DataflashStart& start : starts_) {
        rows.push_back(joined_rows(start.simulated, start.simulated_motion, {}));
        moves = moves || !start.simulated_motion.empty();
    }
    offer(moves ? "SIM and SIM2" : "SIM", std::move(rows));
}

// The third filter before the second one, and of its cores the one that was primary most often.
std::optional<std::pair<std::string, int>> DataflashTrack::chosen_core() const {
    std::map<int, std::size_t> primary;
    for (const DataflashStart& start : starts_)
        for (const auto& [core, count] : start.primary)
            primary[core] += count;
    int best = 0;
    for (const auto& [core, count] : primary)
        if (count > primary[best]) best = core;
    for (const std::string_view kind : {"XKF1", "NKF1"})
        for (const int core : {best, 0})
            for (const DataflashStart& start : starts_) {
                const auto found = start.cores.find({std::string(kind), core});
                if (found != start.cores.end() && found->second.places.size() > 1) return found->first;
            }
    return std::nullopt;
}

void DataflashTrack::offer_filter() {
    const auto core = chosen_core();
    std::vector<std::vector<FlightRow>> rows;
    bool degrees = false;
    for (const DataflashStart& start : starts_) {
        static const std::vector<LocalSample> none;
        const auto found = core ? start.cores.find(*core) : start.cores.end();
        rows.push_back(
            joined_rows(start.estimated, found == start.cores.end() ? none : found->second.places, start.origin));
        degrees = degrees || !start.estimated.empty();
    }
    const std::string motion = core ? fmt::format("{} of core {}", core->first, core->second) : "";
    offer(!degrees ? motion : core ? "POS and " + motion : "POS", std::move(rows));
}

void DataflashTrack::offer_receivers() {
    std::map<int, std::size_t> counts;
    for (const DataflashStart& start : starts_)
        for (const auto& [number, receiver] : start.receivers)
            counts[number] += receiver.epochs.size();
    std::vector<std::pair<std::size_t, int>> order;
    for (const auto& [number, count] : counts)
        order.emplace_back(count, number);
    std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    constexpr std::int64_t latest_ns = 2'000'000'000;
    for (const auto& [count, number] : order) {
        std::vector<std::vector<FlightRow>> rows(starts_.size());
        for (std::size_t i = 0; i < starts_.size(); ++i) {
            DataflashReceiver& receiver = starts_[i].receivers[number];
            const auto undulation = middle_offset(receiver.undulations_mm);
            const auto offset = flight_.clocks[i].gps_offset_ns;
            for (const auto& [told, gps_ns] : receiver.epochs) {
                FlightRow row = told;
                // When the epoch was, not when it was logged.
                if (gps_ns && offset && *gps_ns >= *offset && std::abs(*gps_ns - *offset - row.ns) < latest_ns)
                    row.ns = *gps_ns - *offset;
                if (undulation) {
                    row.place.height.above_ellipsoid += Metres(static_cast<double>(*undulation) * 1e-3);
                    row.above_sea = false;
                }
                rows[i].push_back(row);
            }
        }
        offer(fmt::format("GPS of receiver {}", number), std::move(rows));
    }
}

std::string DataflashTrack::take_attitudes(bool of_simulation) {
    const auto core = chosen_core();
    const auto take = [&](auto&& series_of) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < starts_.size(); ++i)
            if (const AttitudeSeries* series = series_of(starts_[i]))
                count += series->size(), flight_.clocks[i].attitudes = *series;
        return count > 0;
    };
    const auto of_core = [&](AttitudeSeries DataflashCore::*member) {
        return [&core, member](const DataflashStart& start) -> const AttitudeSeries* {
            const auto found = core ? start.cores.find(*core) : start.cores.end();
            return found == start.cores.end() ? nullptr : &(found->second.*member);
        };
    };
    if (of_simulation && take([](const DataflashStart& start) { return &start.simulated_turns; }))
        return ", attitudes those of SIM";
    if (take([](const DataflashStart& start) { return &start.turns; })) return ", attitudes those of ATT";
    if (take(of_core(&DataflashCore::quaternions)))
        return fmt::format(", attitudes the quaternions of {}", core->first.substr(0, 1) + "KQ");
    if (take(of_core(&DataflashCore::angles))) return fmt::format(", attitudes those of {}", core->first);
    return {};
}

void DataflashTrack::take_clocks() {
    flight_.clocks.resize(starts_.size());
    for (std::size_t i = 0; i < starts_.size(); ++i) {
        DataflashStart& start = starts_[i];
        flight_.clocks[i].gps_offset_ns = middle_offset(start.offsets_3d.empty() ? start.offsets : start.offsets_3d);
    }
}

void DataflashTrack::learn_undulation() {
    std::vector<std::int64_t> all;
    for (DataflashStart& start : starts_)
        for (const auto& [number, receiver] : start.receivers)
            all.insert(all.end(), receiver.undulations_mm.begin(), receiver.undulations_mm.end());
    if (const auto middle = middle_offset(all)) flight_.undulation_m = static_cast<double>(*middle) * 1e-3;
}

Result<Track> DataflashTrack::read() {
    read_records();
    take_clocks();
    learn_undulation();
    offer_simulation();
    const std::size_t of_simulation = offers_.size();
    offer_filter();
    offer_receivers();
    const auto chosen = chosen_offer(offers_);
    if (!chosen)
        return fail(ErrorCode::input,
                    fmt::format("{}: a DataFlash log without two places of a vehicle; expected records of SIM, POS, "
                                "XKF1 or NKF1 with ORGN, or GPS with a fix",
                                file_.name));
    flight_.name = file_.name;
    flight_.places = std::move(offers_[*chosen]);
    flight_.format = "DataFlash, " + flight_.places.name;
    const std::string attitudes = take_attitudes(*chosen < of_simulation);
    flight_.notes.insert(flight_.notes.begin(), told_choice(flight_.places, *chosen) + attitudes);
    return track_of_flight(std::move(flight_), file_.reading.geoid);
}

}  // namespace

bool is_dataflash_track(const TrackFile& file) { return is_dataflash(file.bytes); }

Result<Track> read_dataflash_track(const TrackFile& file) { return DataflashTrack(file).read(); }

}  // namespace skyloop::inline motion
