#include <fmt/format.h>

#include <algorithm>
#include <osmium/io/pbf_input.hpp>
#include <osmium/io/xml_input.hpp>
#include <osmium/osm/node.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/way.hpp>
#include <osmium/thread/pool.hpp>
#include <unordered_map>

#include "detail/city_text.hpp"
#include "detail/osm_checks.hpp"
#include "detail/outlines.hpp"

namespace skyloop::inline world {

namespace {

using NodeList = std::vector<osmium::object_id_type>;

/// Nodes, ways and areas of a file; places of nodes may follow the ways that name them.
class OsmReader {
public:
    explicit OsmReader(const OutlineUseOf& use_of) : use_of_(use_of) {}

    /// Throws what libosmium throws.
    void read(std::string_view bytes, const std::string& format);
    Outlines outlines();

private:
    struct Way {
        NodeList nodes;
        std::optional<OutlineUse> use;
    };
    struct Area {
        std::vector<osmium::object_id_type> outer, inner;
        OutlineUse use;
    };

    void take(const osmium::Way& way);
    void take(const osmium::Relation& relation);
    [[nodiscard]] std::optional<std::vector<Eigen::Vector2d>> ring_of(const NodeList& nodes) const;
    [[nodiscard]] std::vector<std::vector<Eigen::Vector2d>> rings_of(
        const std::vector<osmium::object_id_type>& members);
    void drop_repeating_borders();
    void add_area(const Area& area);

    const OutlineUseOf& use_of_;
    OsmDeletions deletions_;
    std::unordered_map<osmium::object_id_type, Eigen::Vector2d> places_;
    std::map<osmium::object_id_type, Way> ways_;
    std::map<osmium::object_id_type, Area> areas_;
    Outlines found_;
};

OutlineTags tags_of_object(const osmium::TagList& list) {
    OutlineTags tags;
    for (const osmium::Tag& tag : list)
        tags.emplace(tag.key(), tag.value());
    return tags;
}

/// Deleted objects stay in the files of editors, and in those that hold a history behind what they were.
bool is_there(const osmium::OSMObject& object, const std::set<std::int64_t>& deleted) {
    return object.visible() && !deleted.contains(object.id());
}

/// A way's corner. PBF files with LocationsOnWays and what Overpass calls "geom" tell its place within the way, may
/// have no node of it and even no number: it is then known by that place, as a number that is greater than those of
/// nodes.
osmium::object_id_type corner_of_way(const osmium::NodeRef& node) {
    if (!node.location().valid()) return node.ref();
    constexpr std::int64_t half_turns = std::int64_t{1} << 31U;  // more than 180° in units of 1e-7°
    return (node.location().x() + half_turns) << 31U | (node.location().y() + half_turns / 2);
}

void OsmReader::take(const osmium::Way& way) {
    if (!is_there(way, deletions_.ways)) {
        ways_.erase(way.id());
        return;
    }
    Way& kept = ways_[way.id()];
    kept = {};
    for (const osmium::NodeRef& node : way.nodes()) {
        kept.nodes.push_back(corner_of_way(node));
        if (node.location().valid()) places_[kept.nodes.back()] = {node.location().lon(), node.location().lat()};
    }
    const OutlineUse use = use_of_(tags_of_object(way.tags()));
    if (use.kind != OutlineUse::Kind::none) kept.use = use;
}

void OsmReader::take(const osmium::Relation& relation) {
    areas_.erase(relation.id());
    if (!is_there(relation, deletions_.relations)) return;
    const OutlineTags tags = tags_of_object(relation.tags());
    const auto type = tags.find("type");
    if (type == tags.end() || type->second != "multipolygon") return;
    Area area;
    area.use = use_of_(tags);
    if (area.use.kind == OutlineUse::Kind::none) return;
    for (const osmium::RelationMember& one : relation.members())
        if (one.type() == osmium::item_type::way)
            (std::string_view(one.role()) == "inner" ? area.inner : area.outer).push_back(one.ref());
    areas_[relation.id()] = std::move(area);
}

void OsmReader::read(std::string_view bytes, const std::string& format) {
    if (format == "osm") deletions_ = osm_deletions(bytes);
    const osmium::io::File file(bytes.data(), bytes.size(), format);
    osmium::thread::Pool pool(1);
    osmium::io::Reader reader(file, osmium::osm_entity_bits::nwr, osmium::io::read_meta::no, pool);
    while (const osmium::memory::Buffer buffer = reader.read()) {
        for (const auto& node : buffer.select<osmium::Node>())
            if (is_there(node, deletions_.nodes) && node.location().valid())
                places_[node.id()] = {node.location().lon(), node.location().lat()};
        for (const auto& way : buffer.select<osmium::Way>())
            take(way);
        for (const auto& relation : buffer.select<osmium::Relation>())
            take(relation);
    }
    reader.close();
}

std::optional<std::vector<Eigen::Vector2d>> OsmReader::ring_of(const NodeList& nodes) const {
    if (nodes.size() < 4 || nodes.front() != nodes.back()) return std::nullopt;
    std::vector<Eigen::Vector2d> ring;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        const auto found = places_.find(nodes[i]);
        if (found == places_.end()) return std::nullopt;
        ring.push_back(found->second);
    }
    return ring;
}

/// Joins ways at their ends to closed rings.
std::vector<std::vector<Eigen::Vector2d>> OsmReader::rings_of(const std::vector<osmium::object_id_type>& members) {
    std::vector<std::vector<Eigen::Vector2d>> rings;
    std::vector<const NodeList*> open;
    for (const auto id : members) {
        const auto found = ways_.find(id);
        if (found != ways_.end() && found->second.nodes.size() >= 2)
            open.push_back(&found->second.nodes);
        else
            ++found_.dropped;
    }
    std::unordered_multimap<osmium::object_id_type, std::size_t> ends;
    for (std::size_t i = 0; i < open.size(); ++i) {
        ends.emplace(open[i]->front(), i);
        ends.emplace(open[i]->back(), i);
    }
    std::vector<bool> used(open.size());
    for (std::size_t i = 0; i < open.size(); ++i) {
        if (used[i]) continue;
        used[i] = true;
        NodeList ring = *open[i];
        while (ring.front() != ring.back()) {
            const auto [from, to] = ends.equal_range(ring.back());
            const auto next = std::find_if(from, to, [&](const auto& end) { return !used[end.second]; });
            if (next == to) break;
            used[next->second] = true;
            const NodeList& nodes = *open[next->second];
            if (nodes.front() == ring.back())
                ring.insert(ring.end(), nodes.begin() + 1, nodes.end());
            else
                ring.insert(ring.end(), nodes.rbegin() + 1, nodes.rend());
        }
        if (auto placed = ring_of(ring))
            rings.push_back(std::move(*placed));
        else
            ++found_.dropped;
    }
    return rings;
}

/// Whether a border would fill what its area leaves open: the clearings of a wood, the courtyards of a building as
/// tall.
bool repeats(const OutlineUse& border, const OutlineUse& area, bool with_courtyards) {
    if (border.kind != area.kind) return false;
    if (area.kind == OutlineUse::Kind::trees) return true;
    if (area.kind == OutlineUse::Kind::land) return border.land == area.land;
    return with_courtyards && border.base == area.base && border.canopy == area.canopy &&
           (!border.top || !area.top || *border.top == *area.top);
}

/// Tags on a multipolygon's outer way that say again what its relation says are a known mistake of mappers
/// (osmlab/fixing-polygons-in-osm, issue 38).
void OsmReader::drop_repeating_borders() {
    std::size_t buildings = 0;
    for (auto& [id, area] : areas_)
        for (const auto member : area.outer) {
            const auto border = ways_.find(member);
            if (border == ways_.end() || !border->second.use) continue;
            if (!repeats(*border->second.use, area.use, !area.inner.empty())) continue;
            inherit(area.use, *border->second.use);
            border->second.use.reset();
            if (area.use.kind == OutlineUse::Kind::building || area.use.kind == OutlineUse::Kind::part) ++buildings;
        }
    if (buildings > 0)
        found_.warnings.push_back(fmt::format(
            "{} outer ways repeat the building of their multipolygon: left out, so that its courtyards stay open",
            buildings));
}

void OsmReader::add_area(const Area& area) {
    const auto outers = rings_of(area.outer);
    auto inners = rings_of(area.inner);
    for (const auto& outer : outers) {
        Outline outline{{outer, {}}, area.use};
        for (auto& inner : inners) {
            if (inner.empty()) continue;
            const Eigen::Vector2d middle = (inner[0] + inner[1]) / 2;
            if (outers.size() == 1 || inside_ring(outer, middle)) outline.footprint.holes.push_back(std::move(inner));
        }
        found_.outlines.push_back(std::move(outline));
    }
}

Outlines OsmReader::outlines() {
    found_.system = wgs84_degrees("EPSG:4326");
    drop_repeating_borders();
    for (const auto& [id, way] : ways_) {
        if (!way.use) continue;
        if (auto ring = ring_of(way.nodes))
            found_.outlines.push_back({{std::move(*ring), {}}, *way.use});
        else
            ++found_.dropped;
    }
    for (const auto& [id, area] : areas_)
        add_area(area);
    return std::move(found_);
}

/// What to do about elements of Overpass that libosmium refuses; empty for other mistakes.
std::string_view overpass_remedy(std::string_view what) {
    const bool within = what.ends_with("inside <member> allowed") || what.ends_with(">: center");
    return within ? "; ask Overpass for \"out body; >; out skel qt;\"" : "";
}

/// The first line of what libosmium says.
std::string first_line(std::string_view what) {
    std::string line(what.substr(0, what.find_first_of("\r\n")));
    for (char& c : line)
        if (static_cast<unsigned char>(c) < 0x20) c = '?';
    return line;
}

}  // namespace

Result<Outlines> read_osm_outlines(std::string_view bytes, std::string_view format, std::string_view name,
                                   const OutlineUseOf& use_of) {
    if (format != "osm" && format != "osm.pbf" && format != "pbf")
        return fail(ErrorCode::input,
                    fmt::format("{}: unknown format \"{}\", expected osm or osm.pbf", name, shown(format)));
    if (bytes.empty()) return fail(ErrorCode::input, fmt::format("{}: the file is empty", name));
    if (format != "osm")
        if (const auto whole = check_pbf_blobs(bytes, name); !whole) return fail(whole.error());
    if (const auto wild = format == "osm" ? wild_coordinate(bytes) : std::nullopt)
        return fail(
            ErrorCode::input,
            fmt::format("{}: coordinate \"{}\"; expected degrees",
                        line_place(name, bytes, static_cast<std::size_t>(wild->data() - bytes.data())), shown(*wild)));
    OsmReader reader(use_of);
    try {
        reader.read(bytes, std::string(format));
    } catch (const osmium::xml_error& error) {
        // Of elements in the wrong place libosmium tells no line.
        const std::string line = error.line > 0 ? fmt::format(":{}", error.line) : "";
        return fail(ErrorCode::input,
                    fmt::format("{}{}: {}{}", name, line, first_line(error.what()), overpass_remedy(error.what())));
    } catch (const std::exception& error) {
        return fail(ErrorCode::input, fmt::format("{}: damaged or cut: {}", name, first_line(error.what())));
    }
    return reader.outlines();
}

Result<CityFile> parse_osm(std::string_view bytes, std::string_view format, std::string_view name,
                           const CityFileSettings& settings) {
    const auto use_of = [&](const OutlineTags& tags) { return outline_use(tags, settings, UnnamedOutline::nothing); };
    auto read = read_osm_outlines(bytes, format, name, use_of);
    if (!read) return fail(read.error());
    return city_of_outlines(std::move(*read), format == "osm" ? "osm" : "osm.pbf", name, settings);
}

}  // namespace skyloop::inline world
