#include "detail/trajectory_kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string>
#include <string_view>

namespace skyloop {
namespace {

// What a kind's reader may need.
struct KindReading {
    TableReader& table;
    PlaceReader& places;
    const std::filesystem::path& folder;
    TrajectorySettings& trajectory;
};

struct TrajectoryKind {
    std::string_view name;
    void (*read)(const KindReading&);
};

constexpr std::array kinds{
    TrajectoryKind{"fixed", [](const KindReading& k) { read_fixed(k.table, k.places, k.trajectory); }},
    TrajectoryKind{"waypoints", [](const KindReading& k) { read_waypoints(k.table, k.places, k.trajectory); }},
    TrajectoryKind{"circle", [](const KindReading& k) { read_circle(k.table, k.places, k.trajectory); }},
    TrajectoryKind{"file", [](const KindReading& k) { read_file_track(k.table, k.places, k.folder, k.trajectory); }},
    TrajectoryKind{"live", [](const KindReading& k) { read_live(k.table, k.places, k.trajectory); }},
};

void read_kind(const KindReading& reading) {
    std::vector<std::string_view> names;
    for (const TrajectoryKind& kind : kinds)
        names.push_back(kind.name);
    const std::size_t others = names.size();
    const auto shapes = path_shape_names();
    // Waypoints come first of the shapes, and are one of the kinds above, too.
    names.insert(names.end(), shapes.begin() + 1, shapes.end());
    names.emplace_back("sequence");
    const auto kind = reading.table.choice("kind", names, "the shape of the way");
    reading.table.needs_one_of({"kind"},
                               fmt::format("has no kind; expected kind = \"{}\"", fmt::join(names, "\", \"")));
    if (!kind) {
        // What other keys there may be is the kind's to say.
        for (const std::string& key : reading.table.keys())
            reading.table.has_been_read(key);
        return;
    }
    if (*kind < others) return kinds[*kind].read(reading);
    if (*kind + 1 == names.size()) return read_sequence(reading.table, reading.places, reading.trajectory);
    read_generated(reading.table, reading.places, *kind - others + 1, reading.trajectory);
}

}  // namespace

std::optional<LevelFrame> read_frame(TableReader& top) {
    std::optional<LevelFrame> frame;
    top.table("frame", "where the coordinates of a game level lie on the Earth", [&](TableReader& table) {
        LevelPlacement placement;
        const auto origin = table.place("origin", "of the level: latitude, longitude, height");
        table.needs_one_of({"origin"}, "has no origin; expected origin = [latitude, longitude, height]");
        if (origin) placement.origin = *origin;
        table.degrees("yaw_deg", placement.yaw, {-360, 360}, "azimuth of the level's X axis, clockwise from north");
        table.quantity("unit_m", placement.unit, {1e-6, 1e6}, "length of one level unit; 0.01 for centimetres");
        table.boolean("left_handed", placement.left_handed, "true: Y points to the right of X");
        table.quantity("reach_m", placement.reach, NumberRange::positive(),
                       "a warning names points further from the origin, where a plane leaves the curved Earth");
        frame.emplace(placement);
    });
    return frame;
}

std::optional<TrajectorySettings> read_trajectory_keys(TableReader& parent, KeyText text,
                                                       const TrajectoryContext& context,
                                                       std::vector<std::string>& warnings) {
    std::optional<TrajectorySettings> trajectory;
    PlaceReader places(context.level, warnings);
    parent.table("trajectory", text, [&](TableReader& table) {
        trajectory.emplace();
        read_kind({table, places, context.folder, *trajectory});
    });
    return trajectory;
}

}  // namespace skyloop
