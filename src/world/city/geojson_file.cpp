#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/core/std_additions.hpp"
#include "base/core/words.hpp"
#include "detail/city_text.hpp"
#include "detail/json_text.hpp"
#include "detail/outlines.hpp"

namespace skyloop::inline world {

namespace {

/// Reads GeoJSON (RFC 7946, and the "crs" member of the 2008 format).
class GeoJsonReader {
public:
    GeoJsonReader(const CityFileSettings& settings, std::string_view name) : settings_(settings), name_(name) {}

    Result<Outlines> read(const JsonData& root);

private:
    void read_feature(const JsonData& feature);
    void read_geometry(const JsonData& geometry, const OutlineUse& use);
    void read_polygon(const JsonData& rings, const OutlineUse& use);
    [[nodiscard]] ReferenceSystem find_system(const JsonData& root) const;

    const CityFileSettings& settings_;
    std::string_view name_;
    UnnamedOutline unnamed_ = UnnamedOutline::house;
    Outlines found_;
    std::size_t other_shapes_ = 0, other_uses_ = 0;
};

bool read_positions(const JsonData& positions, std::vector<Eigen::Vector2d>& ring) {
    if (!positions.is_array()) return false;
    for (const JsonData& position : positions) {
        if (!position.is_array() || position.size() < 2 || !position[0].is_number() || !position[1].is_number())
            return false;
        ring.emplace_back(position[0].get<double>(), position[1].get<double>());
    }
    return true;
}

/// Texts and numbers, by keys in small letters. An empty text is a column of a table without a value.
OutlineTags tags_of(const JsonData& properties) {
    OutlineTags tags;
    if (!properties.is_object()) return tags;
    for (const auto& [key, value] : properties.items()) {
        const std::string lower = lower_case(key);
        if (value.is_string() && !value.get_ref<const std::string&>().empty())
            tags.emplace(lower, value.get<std::string>());
        if (value.is_number()) tags.emplace(lower, fmt::format("{}", value.get<double>()));
        if (value.is_boolean()) tags.emplace(lower, value.get<bool>() ? "yes" : "no");
    }
    return tags;
}

/// Takes a text between quotes off the front, and what stands before it; a backslash stands before quotes and
/// backslashes within. @returns false when there is none
bool take_quoted(std::string_view& text, std::string& word) {
    word.clear();
    for (std::size_t i = std::min(text.find('"'), text.size()) + 1; i < text.size(); ++i) {
        if (text[i] == '"') {
            text.remove_prefix(i + 1);
            return true;
        }
        if (text[i] == '\\' && ++i == text.size()) break;
        word += text[i];
    }
    return false;
}

/// Tags in one text as GDAL writes those of OpenStreetMap that have no column (PostgreSQL manual, "hstore"):
/// "height"=>"21","name"=>"…".
OutlineTags tags_of_hstore(std::string_view text) {
    OutlineTags tags;
    for (std::string key, value; take_quoted(text, key) && take_quoted(text, value);)
        if (!value.empty()) tags.emplace(lower_case(key), value);
    return tags;
}

OutlineTags tags_of_feature(const JsonData& feature) {
    const JsonData& properties = member(feature, "properties");
    OutlineTags tags = tags_of(properties);
    tags.merge(tags_of(member(properties, "tags")));
    tags.merge(tags_of_hstore(text_member(properties, "other_tags")));
    return tags;
}

void GeoJsonReader::read_polygon(const JsonData& rings, const OutlineUse& use) {
    Outline outline{{}, use};
    bool good = rings.is_array() && !rings.empty();
    for (std::size_t i = 0; good && i < rings.size(); ++i)
        good = read_positions(rings[i], i == 0 ? outline.footprint.outer : outline.footprint.holes.emplace_back());
    if (good)
        found_.outlines.push_back(std::move(outline));
    else
        ++found_.dropped;
}

void GeoJsonReader::read_geometry(const JsonData& geometry, const OutlineUse& use) {
    const std::string_view type = text_member(geometry, "type");
    if (type == "Polygon") {
        read_polygon(member(geometry, "coordinates"), use);
    } else if (type == "MultiPolygon") {
        const JsonData& polygons = member(geometry, "coordinates");
        if (!polygons.is_array()) ++found_.dropped;
        if (polygons.is_array())
            for (const JsonData& polygon : polygons)
                read_polygon(polygon, use);
    } else if (type == "GeometryCollection") {
        const JsonData& geometries = member(geometry, "geometries");
        // Nesting is bounded by parse_json().
        if (geometries.is_array())
            for (const JsonData& inner : geometries)
                read_geometry(inner, use);
    } else {
        ++other_shapes_;
    }
}

void GeoJsonReader::read_feature(const JsonData& feature) {
    const OutlineUse use = outline_use(tags_of_feature(feature), settings_, unnamed_);
    if (use.kind == OutlineUse::Kind::none)
        ++other_uses_;
    else
        read_geometry(member(feature, "geometry"), use);
}

/// Whether outlines are in degrees (RFC 7946, 4), by their numbers: all on the globe, and together or mostly narrower
/// than metres would be. Parts of the file may lie on either side of the 180th meridian, or far away from the others.
bool are_in_degrees(const std::vector<Outline>& outlines) {
    PlaceOnEarth::Extent stated, turned;
    LongitudeTurn turn;
    std::vector<double> widths;
    for (const Outline& outline : outlines) {
        PlaceOnEarth::Extent own;
        LongitudeTurn own_turn;
        for (const Eigen::Vector2d& point : outline.footprint.outer) {
            stated.include(point);
            turned.include({turn(point.x()), point.y()});
            own.include({own_turn(point.x()), point.y()});
        }
        if (!own.empty()) widths.push_back(own.width());
    }
    if (!stated.on_globe() || widths.empty()) return false;
    PlaceOnEarth::Extent typical;
    typical.include({0, 0});
    typical.include({middle_of(widths), 0});
    return turned.fits_degrees() || typical.is_of_degrees();
}

ReferenceSystem GeoJsonReader::find_system(const JsonData& root) const {
    auto named = reference_system_of_file(text_member(member(member(root, "crs"), "properties"), "name"), settings_);
    // GeoJSON writes longitude first whatever the system says.
    if (named) named->north_first = false;
    if (named && named->kind == CoordinateKind::geographic) return *named;
    PlaceOnEarth::Extent extent;
    for (const Outline& outline : found_.outlines)
        for (const Eigen::Vector2d& point : outline.footprint.outer)
            extent.include(point);
    if (named ? extent.is_of_degrees() : are_in_degrees(found_.outlines))
        return wgs84_degrees(named ? named->name : "degrees");
    if (named && named->map) return *named;
    const double farthest =
        extent.empty() ? 0 : std::max(extent.lowest.cwiseAbs().maxCoeff(), extent.highest.cwiseAbs().maxCoeff());
    ReferenceSystem metres = named.value_or(unnamed_system(CoordinateKind::local, "metres"));
    metres.kind = farthest > farthest_local ? CoordinateKind::projected : CoordinateKind::local;
    return metres;
}

Result<Outlines> GeoJsonReader::read(const JsonData& root) {
    const std::string_view type = text_member(root, "type");
    if (type == "FeatureCollection") {
        const JsonData& features = member(root, "features");
        if (!features.is_array())
            return fail(ErrorCode::input, fmt::format("{}: \"features\" is missing or no list", name_));
        // Exports of maps name their buildings among roads, car parks and lakes; footprints alone need no name.
        if (std::any_of(features.begin(), features.end(),
                        [](const JsonData& feature) { return tells_buildings(tags_of_feature(feature)); }))
            unnamed_ = UnnamedOutline::tall_house;
        for (const JsonData& feature : features)
            read_feature(feature);
    } else if (type == "Feature") {
        read_feature(root);
    } else if (type == "Polygon" || type == "MultiPolygon" || type == "GeometryCollection") {
        read_geometry(root, outline_use({}, settings_, unnamed_));
    } else if (member(root, "elements").is_array()) {
        return fail(ErrorCode::input,
                    fmt::format("{}: this is JSON of Overpass; expected GeoJSON, or ask it for [out:xml] "
                                "and name the file .osm",
                                name_));
    } else {
        return fail(ErrorCode::input,
                    fmt::format("{}: \"type\" is \"{}\", expected \"FeatureCollection\", \"Feature\", "
                                "\"Polygon\" or \"MultiPolygon\"",
                                name_, shown(type)));
    }
    found_.system = find_system(root);
    if (found_.system.kind == CoordinateKind::local)
        found_.warnings.push_back(
            fmt::format("coordinates are taken as metres ({}) from the origin", shown(found_.system.name)));
    if (other_shapes_ + other_uses_ > 0)
        found_.warnings.push_back(
            fmt::format("{} shapes that are no polygons and {} features that are no buildings or "
                        "woods were left out",
                        other_shapes_, other_uses_));
    return std::move(found_);
}

}  // namespace

Result<CityFile> parse_geojson(std::string_view text, std::string_view name, const CityFileSettings& settings) {
    const auto root = parse_json(text, name);
    if (!root) return fail(root.error());
    auto outlines = GeoJsonReader(settings, name).read(*root);
    if (!outlines) return fail(outlines.error());
    return city_of_outlines(std::move(*outlines), "geojson", name, settings);
}

}  // namespace skyloop::inline world
