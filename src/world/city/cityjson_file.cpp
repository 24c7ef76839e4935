#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "detail/city_objects.hpp"
#include "detail/city_text.hpp"
#include "detail/json_text.hpp"

namespace skyloop::inline world {

namespace {

/// Reads CityJSON 1.0, 1.1 and 2.0 (cityjson.org/specs).
class CityJsonReader {
public:
    CityJsonReader(const JsonData& root, std::string_view name) : root_(root), name_(name) {}

    Result<CityObjects> read();

private:
    [[nodiscard]] std::string read_vertices();
    void read_object(CityObject& object, const JsonData& value);
    void read_geometry(CityObject& object, const JsonData& geometry);
    void read_shell(std::vector<ObjectSurface>& surfaces, const JsonData& shell, const JsonData& values);
    [[nodiscard]] bool read_surface(ObjectSurface& surface, const JsonData& rings) const;
    void link_parts(const std::unordered_map<std::string, std::size_t>& numbers);

    const JsonData& root_;
    std::string_view name_;
    std::vector<Eigen::Vector3d> vertices_;
    const JsonData* semantics_ = nullptr;  ///< of the geometry being read
    std::size_t templates_ = 0;
    CityObjects found_;
};

bool number_triple(const JsonData& value, Eigen::Vector3d& out) {
    if (!value.is_array() || value.size() != 3) return false;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!value[i].is_number()) return false;
        out[static_cast<Eigen::Index>(i)] = value[i].get<double>();
    }
    return true;
}

std::string CityJsonReader::read_vertices() {
    Eigen::Vector3d scale = Eigen::Vector3d::Ones(), shift = Eigen::Vector3d::Zero();
    const JsonData& transform = member(root_, "transform");
    if (!transform.is_null() &&
        !(number_triple(member(transform, "scale"), scale) && number_triple(member(transform, "translate"), shift)))
        return "\"transform\" has no scale and translate of three numbers each";
    const JsonData& vertices = member(root_, "vertices");
    if (!vertices.is_array()) return "\"vertices\" is missing or no list";
    vertices_.reserve(vertices.size());
    for (const JsonData& vertex : vertices) {
        Eigen::Vector3d place;
        if (!number_triple(vertex, place)) return fmt::format("vertex {} is not of three numbers", vertices_.size());
        vertices_.push_back(place.cwiseProduct(scale) + shift);
    }
    return {};
}

/// "2.2" or 2.2 is 22; −1 for what is no level.
int level_of_detail(const JsonData& value) {
    double level = -1;
    if (value.is_number()) level = value.get<double>();
    if (value.is_string()) level = std::strtod(value.get_ref<const std::string&>().c_str(), nullptr);
    return level >= 0 && level < 10 ? static_cast<int>(std::lround(level * 10)) : -1;
}

bool CityJsonReader::read_surface(ObjectSurface& surface, const JsonData& rings) const {
    if (!rings.is_array()) return false;
    for (const JsonData& indices : rings) {
        if (!indices.is_array()) return false;
        auto& ring = surface.rings.emplace_back();
        for (const JsonData& index : indices) {
            if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= vertices_.size()) return false;
            ring.push_back(vertices_[index.get<std::size_t>()]);
        }
    }
    return !surface.rings.empty() && surface.rings.front().size() >= 3;
}

void CityJsonReader::read_shell(std::vector<ObjectSurface>& surfaces, const JsonData& shell, const JsonData& values) {
    if (!shell.is_array()) {
        ++found_.dropped;
        return;
    }
    const JsonData& kinds = member(*semantics_, "surfaces");
    for (std::size_t i = 0; i < shell.size(); ++i) {
        ObjectSurface surface;
        if (!read_surface(surface, shell[i])) {
            ++found_.dropped;
            continue;
        }
        if (values.is_array() && i < values.size() && values[i].is_number_unsigned()) {
            const auto number = values[i].get<std::uint64_t>();
            if (kinds.is_array() && number < kinds.size())
                surface.use = surface_use(text_member(kinds[number], "type"));
        }
        surfaces.push_back(std::move(surface));
    }
}

const JsonData& element(const JsonData& list, std::size_t index) {
    static const JsonData nothing;
    return list.is_array() && index < list.size() ? list[index] : nothing;
}

/// Beside told surfaces of the same geometry those of no type that is known belong to it as well.
void judge_untold(std::vector<ObjectSurface>& surfaces) {
    const auto untold = [](const ObjectSurface& surface) { return surface.use == SurfaceUse::unknown; };
    if (std::all_of(surfaces.begin(), surfaces.end(), untold)) return;
    for (ObjectSurface& surface : surfaces)
        if (untold(surface)) surface.use = SurfaceUse::by_slope;
}

void CityJsonReader::read_geometry(CityObject& object, const JsonData& geometry) {
    const std::string_view type = text_member(geometry, "type");
    const int level = level_of_detail(member(geometry, "lod"));
    if (type == "GeometryInstance") {
        ++templates_;
        return;
    }
    const JsonData& boundaries = member(geometry, "boundaries");
    semantics_ = &member(geometry, "semantics");
    const JsonData& values = member(*semantics_, "values");
    std::vector<ObjectSurface> surfaces;
    if (type == "MultiSurface" || type == "CompositeSurface") {
        read_shell(surfaces, boundaries, values);
    } else if (type == "Solid") {
        read_shell(surfaces, element(boundaries, 0), element(values, 0));
    } else if (type == "MultiSolid" || type == "CompositeSolid") {
        for (std::size_t i = 0; boundaries.is_array() && i < boundaries.size(); ++i)
            read_shell(surfaces, element(boundaries[i], 0), element(element(values, i), 0));
    } else {
        return;  // points and lines
    }
    if (surfaces.empty()) return;  // a level without any would hide the one below
    judge_untold(surfaces);
    auto& of_level = object.levels[std::max(level, 0)];
    of_level.insert(of_level.end(), std::make_move_iterator(surfaces.begin()), std::make_move_iterator(surfaces.end()));
}

void CityJsonReader::read_object(CityObject& object, const JsonData& value) {
    std::string_view type = text_member(value, "type");
    if (type.starts_with('+')) type.remove_prefix(1);
    object.object_class = object_class(type);
    object.building = type == "Building" || type == "BuildingPart";
    const JsonData& geometries = member(value, "geometry");
    if (!geometries.is_array() || object.object_class == ObjectClass::ignored) return;
    for (const JsonData& geometry : geometries)
        read_geometry(object, geometry);
}

void CityJsonReader::link_parts(const std::unordered_map<std::string, std::size_t>& numbers) {
    for (const auto& [id, value] : member(root_, "CityObjects").items()) {
        if (!text_member(value, "type").ends_with("Part")) continue;
        const JsonData& parent = element(member(value, "parents"), 0);
        if (!parent.is_string()) continue;
        const auto found = numbers.find(parent.get<std::string>());
        if (found != numbers.end()) found_.objects[numbers.at(id)].parent = found->second;
    }
}

/// Of its metadata. Maps have the easting first whatever the registry says, as cjio writes them.
std::optional<ReferenceSystem> system_told(const JsonData& metadata, const CityFileSettings& settings) {
    const JsonData& epsg = member(member(metadata, "crs"), "epsg");
    auto system = epsg.is_number_unsigned()
                      ? reference_system_of_file(fmt::format("EPSG:{}", epsg.get<std::uint64_t>()), settings)
                      : reference_system_of_file(text_member(metadata, "referenceSystem"), settings);
    if (system && system->kind == CoordinateKind::projected) system->north_first = false;
    return system;
}

Result<CityObjects> CityJsonReader::read() {
    if (const std::string problem = read_vertices(); !problem.empty())
        return fail(ErrorCode::input, fmt::format("{}: {}", name_, problem));
    const JsonData& objects = member(root_, "CityObjects");
    if (!objects.is_object())
        return fail(ErrorCode::input, fmt::format("{}: \"CityObjects\" is missing or no object", name_));
    std::unordered_map<std::string, std::size_t> numbers;
    for (const auto& [id, value] : objects.items()) {
        numbers.emplace(id, found_.objects.size());
        read_object(found_.objects.emplace_back(), value);
    }
    link_parts(numbers);
    if (templates_ > 0) found_.warnings.push_back(fmt::format("{} geometries by template were left out", templates_));
    return std::move(found_);
}

// CityJSON text sequences (CityJSONSeq): a line that is a CityJSON with what all share, and one for each feature, with
// corners of its own.
class CityJsonSequence {
public:
    CityJsonSequence(std::string_view text, std::string_view name, const CityFileSettings& settings)
        : text_(text), name_(name), settings_(settings) {}
    Result<CityObjects> read();

private:
    Result<void> take_line(std::string_view line, const std::string& where);
    void add(CityObjects part);

    std::string_view text_, name_;
    const CityFileSettings& settings_;
    JsonData transform_;
    bool begun_ = false;
    CityObjects found_;
};

void CityJsonSequence::add(CityObjects part) {
    const std::size_t before = found_.objects.size();
    for (CityObject& object : part.objects) {
        if (object.parent) *object.parent += before;
        found_.objects.push_back(std::move(object));
    }
    found_.dropped += part.dropped;
    for (std::string& warning : part.warnings)
        if (std::find(found_.warnings.begin(), found_.warnings.end(), warning) == found_.warnings.end())
            found_.warnings.push_back(std::move(warning));
}

Result<void> CityJsonSequence::take_line(std::string_view line, const std::string& where) {
    auto root = parse_json(line, where, JsonText::line);
    if (!root) return fail(root.error());
    const std::string_view expected = begun_ ? "CityJSONFeature" : "CityJSON", type = text_member(*root, "type");
    if (type != expected)
        return fail(ErrorCode::input,
                    fmt::format("{}: \"type\" is \"{}\", expected \"{}\"", where, shown(type), expected));
    if (begun_) {
        (*root)["transform"] = transform_;
    } else {
        transform_ = member(*root, "transform");
        found_.system = system_told(member(*root, "metadata"), settings_);
    }
    auto part = CityJsonReader(*root, where).read();
    if (!part) return fail(part.error());
    add(std::move(*part));
    begun_ = true;
    return {};
}

Result<CityObjects> CityJsonSequence::read() {
    std::size_t number = 0;
    for (std::string_view rest = text_; !rest.empty();) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view line = rest.substr(0, end);
        ++number;
        if (line.find_first_not_of(" \t\r\x1E") != std::string_view::npos)
            if (auto taken =
                    take_line(line.substr(line.find_first_not_of('\x1E')), fmt::format("{}:{}", name_, number));
                !taken)
                return fail(std::move(taken.error()));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    if (!begun_) return fail(ErrorCode::input, fmt::format("{}: no line; expected a CityJSON and its features", name_));
    return std::move(found_);
}

}  // namespace

Result<CityFile> parse_cityjson(std::string_view text, std::string_view name, const CityFileSettings& settings) {
    const auto root = parse_json(text, name);
    if (!root) return fail(root.error());
    if (text_member(*root, "type") != "CityJSON")
        return fail(ErrorCode::input, fmt::format("{}: \"type\" is \"{}\", expected \"CityJSON\"", name,
                                                  shown(text_member(*root, "type"))));
    auto objects = CityJsonReader(*root, name).read();
    if (!objects) return fail(objects.error());
    objects->system = system_told(member(*root, "metadata"), settings);
    return city_of_objects(std::move(*objects), "cityjson", name, settings);
}

Result<CityFile> parse_cityjson_sequence(std::string_view text, std::string_view name,
                                         const CityFileSettings& settings) {
    auto objects = CityJsonSequence(text, name, settings).read();
    if (!objects) return fail(objects.error());
    return city_of_objects(std::move(*objects), "cityjson", name, settings);
}

}  // namespace skyloop::inline world
