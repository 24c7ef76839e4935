#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <pugixml.hpp>
#include <unordered_map>

#include "detail/city_objects.hpp"
#include "detail/city_text.hpp"

namespace skyloop::inline world {

namespace {

constexpr int deepest_elements = 200;

std::string_view local_name(const pugi::xml_node& node) {
    const std::string_view name = node.name();
    const auto colon = name.find(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

/// The child of such a name, whatever its prefix; an empty node when there is none.
pugi::xml_node child_named(const pugi::xml_node& node, std::string_view name) {
    return node.find_child([&](const pugi::xml_node& child) { return local_name(child) == name; });
}

/// Places of XML by their gml:id, whatever the prefix.
class NodesById : public pugi::xml_tree_walker {
public:
    bool for_each(pugi::xml_node& node) override {
        for (const pugi::xml_attribute& one : node.attributes())
            if (std::string_view(one.name()) == "id" || std::string_view(one.name()).ends_with(":id"))
                nodes_.emplace(one.value(), node);
        return true;
    }
    /// Of a link such as "#UUID_1"; an empty node when it leads elsewhere.
    [[nodiscard]] pugi::xml_node linked(std::string_view link) const {
        const auto found = link.starts_with('#') ? nodes_.find(link.substr(1)) : nodes_.end();
        return found == nodes_.end() ? pugi::xml_node() : found->second;
    }

private:
    std::unordered_map<std::string_view, pugi::xml_node> nodes_;
};

/// Reads CityGML 1, 2 and 3 (OGC 12-019, 20-010): polygons by the elements around them, whatever the prefixes.
class CityGmlReader {
public:
    explicit CityGmlReader(const CityFileSettings& settings) : settings_(settings) {}

    Result<CityObjects> read(const pugi::xml_document& document, std::string_view name);

private:
    /// Where an implicit geometry stands: a shape of metres about 0, 0, 0 is turned and scaled by the matrix, then
    /// moved to the reference point (OGC 12-019, 8.2). Its axes are taken to point east, north and up.
    struct Implicit {
        Eigen::Matrix<double, 3, 4> matrix;
        Eigen::Vector3d reference_point;
    };
    /// What the elements around a polygon say of it.
    struct Context {
        std::size_t object = none;
        int level = 0;
        SurfaceUse use = SurfaceUse::unknown;
        int depth = 0;
        const Implicit* implicit = nullptr;
    };
    static constexpr std::size_t none = ~std::size_t{0};

    void visit(const pugi::xml_node& node, Context context);
    void visit_implicit(const pugi::xml_node& node, Context context);
    [[nodiscard]] std::optional<Implicit> read_implicit(const pugi::xml_node& node);
    [[nodiscard]] pugi::xml_node shape_of(const pugi::xml_node& implicit);
    void take_system(const pugi::xml_node& node);
    [[nodiscard]] Context entered(const pugi::xml_node& node, Context context);
    void add_polygon_of(const pugi::xml_node& node, const Context& context);
    [[nodiscard]] bool read_ring(const pugi::xml_node& node, std::vector<Eigen::Vector3d>& ring,
                                 const Implicit* implicit) const;
    [[nodiscard]] bool read_numbers(std::string_view text, std::vector<double>& numbers) const;

    const CityFileSettings& settings_;
    CityObjects found_;
    std::optional<NodesById> by_id_;  ///< once a link asks for them
    pugi::xml_node root_;
    std::size_t shaped_ = 0;     ///< polygons of implicit geometries: links may name large shapes often
    std::size_t shapeless_ = 0;  ///< implicit geometries that could not be used
    bool too_deep_ = false;
};

/// Objects that stand for themselves.
bool begins_object(std::string_view name) {
    static constexpr std::array names{std::string_view("Building"),
                                      std::string_view("BuildingPart"),
                                      std::string_view("BuildingInstallation"),
                                      std::string_view("BuildingConstructiveElement"),
                                      std::string_view("OtherConstruction"),
                                      std::string_view("Bridge"),
                                      std::string_view("BridgePart"),
                                      std::string_view("BridgeConstructionElement"),
                                      std::string_view("BridgeInstallation"),
                                      std::string_view("Tunnel"),
                                      std::string_view("TunnelPart"),
                                      std::string_view("CityFurniture"),
                                      std::string_view("GenericCityObject"),
                                      std::string_view("GenericOccupiedSpace"),
                                      std::string_view("TINRelief"),
                                      std::string_view("LandUse"),
                                      std::string_view("Road"),
                                      std::string_view("Railway"),
                                      std::string_view("Track"),
                                      std::string_view("Square"),
                                      std::string_view("WaterBody"),
                                      std::string_view("PlantCover"),
                                      std::string_view("SolitaryVegetationObject"),
                                      std::string_view("BuildingRoom"),
                                      std::string_view("Room"),
                                      std::string_view("BuildingFurniture")};
    return std::find(names.begin(), names.end(), name) != names.end();
}

CityGmlReader::Context CityGmlReader::entered(const pugi::xml_node& node, Context context) {
    const std::string_view name = local_name(node);
    ++context.depth;
    if (begins_object(name)) {
        CityObject object;
        object.object_class = object_class(name);
        object.building = name == "Building" || name == "BuildingPart";
        if (name.ends_with("Part") && context.object != none) object.parent = context.object;
        context.object = found_.objects.size();
        context.level = object.object_class == ObjectClass::terrain ? 10 : 0;
        context.use = SurfaceUse::unknown;
        found_.objects.push_back(std::move(object));
    } else if (name.size() > 3 && name.starts_with("lod") && name[3] >= '0' && name[3] <= '4') {
        context.level = (name[3] - '0') * 10;
    } else if (const SurfaceUse use = surface_use(name); use != SurfaceUse::unknown) {
        context.use = use;
    } else if ((name == "boundedBy" || name == "boundary") && context.use == SurfaceUse::unknown) {
        context.use = SurfaceUse::by_slope;  // unless an element within tells it
    }
    return context;
}

void CityGmlReader::take_system(const pugi::xml_node& node) {
    if (found_.system) return;
    if (const pugi::xml_attribute system = node.attribute("srsName"))
        found_.system = reference_system_of_file(system.value(), settings_);
}

void CityGmlReader::visit(const pugi::xml_node& node, Context context) {
    if (context.depth > deepest_elements) {
        too_deep_ = true;
        return;
    }
    if (!context.implicit) take_system(node);
    const std::string_view name = local_name(node);
    if (name == "Polygon" || name == "PolygonPatch" || name == "Triangle" || name == "Rectangle") {
        add_polygon_of(node, context);
        return;
    }
    if (name == "appearance" || name == "appearanceMember") return;
    if (name == "ImplicitGeometry") {
        visit_implicit(node, context);
        return;
    }
    context = entered(node, context);
    for (const pugi::xml_node& child : node.children())
        if (child.type() == pugi::node_element) visit(child, context);
}

std::optional<CityGmlReader::Implicit> CityGmlReader::read_implicit(const pugi::xml_node& node) {
    const pugi::xml_node point = child_named(child_named(node, "referencePoint"), "Point");
    take_system(point);
    std::vector<double> matrix, place;
    if (!read_numbers(child_named(node, "transformationMatrix").child_value(), matrix) || matrix.size() != 16 ||
        !read_numbers(child_named(point, "pos").child_value(), place) || place.size() != 3)
        return std::nullopt;
    // Row by row; the last one is that of homogeneous coordinates.
    return Implicit{Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(matrix.data()),
                    Eigen::Vector3d(place[0], place[1], place[2])};
}

/// The polygons of a shape, told there or where a link leads.
pugi::xml_node CityGmlReader::shape_of(const pugi::xml_node& implicit) {
    pugi::xml_node shape = child_named(implicit, "relativeGMLGeometry");
    if (!shape) shape = child_named(implicit, "relativeGeometry");  // of CityGML 3
    const pugi::xml_attribute link = shape.attribute("xlink:href");
    if (!link) return shape;
    if (!by_id_) root_.traverse(by_id_.emplace());
    return by_id_->linked(link.value());
}

void CityGmlReader::visit_implicit(const pugi::xml_node& node, Context context) {
    if (context.object == none || found_.objects[context.object].object_class == ObjectClass::ignored) return;
    const std::optional<Implicit> implicit = read_implicit(node);
    const pugi::xml_node shape = shape_of(node);
    // Shapes hold no other shapes: links could go in circles.
    if (!implicit || !shape || context.implicit) {
        ++shapeless_;
        return;
    }
    context.implicit = &*implicit;
    ++context.depth;
    visit(shape, context);
}

bool CityGmlReader::read_numbers(std::string_view text, std::vector<double>& numbers) const {
    const char* at = text.data();
    const char* const end = at + text.size();
    const auto separates = [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == ','; };
    for (;;) {
        while (at != end && separates(*at))
            ++at;
        if (at == end) return true;
        double value = 0;
        const auto [rest, error] = std::from_chars(at, end, value);
        if (error != std::errc() || !std::isfinite(value) || (rest != end && !separates(*rest))) return false;
        numbers.push_back(value);
        at = rest;
    }
}

bool CityGmlReader::read_ring(const pugi::xml_node& node, std::vector<Eigen::Vector3d>& ring,
                              const Implicit* implicit) const {
    std::vector<double> numbers;
    int dimension = 3;
    for (const pugi::xml_node& outer : node.children())
        for (const pugi::xml_node& list : outer.children()) {
            if (local_name(list) == "posList" || local_name(list) == "pos" || local_name(list) == "coordinates")
                if (!read_numbers(list.child_value(), numbers)) return false;
            if (const pugi::xml_attribute given = list.attribute("srsDimension")) dimension = given.as_int();
        }
    if (dimension != 3 || numbers.size() < 9 || numbers.size() % 3 != 0) return false;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
        ring.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
        if (implicit) ring.back() = implicit->matrix * ring.back().homogeneous();
    }
    return true;
}

void CityGmlReader::add_polygon_of(const pugi::xml_node& node, const Context& context) {
    if (context.object == none) return;  // in a library of shapes or an appearance
    ObjectSurface surface;
    surface.use = context.use;
    if (context.implicit) {
        if (++shaped_ > settings_.most_triangles) return;
        surface.reference_point = context.implicit->reference_point;
    }
    bool good = true, has_outer = false;
    for (const pugi::xml_node& child : node.children()) {
        const std::string_view name = local_name(child);
        const bool outer = name == "exterior" || name == "outerBoundaryIs";
        if (!outer && name != "interior" && name != "innerBoundaryIs") continue;
        std::vector<Eigen::Vector3d> ring;
        good = good && read_ring(child, ring, context.implicit);
        has_outer = has_outer || outer;
        surface.rings.insert(outer ? surface.rings.begin() : surface.rings.end(), std::move(ring));
    }
    if (good && has_outer)
        found_.objects[context.object].levels[context.level].push_back(std::move(surface));
    else
        ++found_.dropped;
}

Result<CityObjects> CityGmlReader::read(const pugi::xml_document& document, std::string_view name) {
    root_ = document.document_element();
    if (local_name(root_) != "CityModel")
        return fail(ErrorCode::input, fmt::format("{}: the root element is <{}>, expected <CityModel> of CityGML", name,
                                                  shown(root_.name())));
    visit(root_, {});
    if (!found_.system) found_.system = reference_system_of_file("", settings_);
    if (too_deep_)
        return fail(ErrorCode::input, fmt::format("{}: elements nest deeper than {} levels", name, deepest_elements));
    if (shaped_ > settings_.most_triangles) return too_many_triangles(name, settings_);
    if (shapeless_ > 0)
        found_.warnings.push_back(fmt::format(
            "{} implicit geometries without a shape in the file, matrix or reference point were left out", shapeless_));
    return std::move(found_);
}

}  // namespace

Result<CityFile> parse_citygml(std::string_view text, std::string_view name, const CityFileSettings& settings) {
    pugi::xml_document document;
    const auto parsed = document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_auto);
    if (!parsed) {
        const auto offset = std::min(text.size(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0)));
        const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n');
        return fail(ErrorCode::input, fmt::format("{}:{}: this is no XML: {}", name, line, parsed.description()));
    }
    auto objects = CityGmlReader(settings).read(document, name);
    if (!objects) return fail(objects.error());
    return city_of_objects(std::move(*objects), "citygml", name, settings);
}

}  // namespace skyloop::inline world
