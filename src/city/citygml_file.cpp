#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <pugixml.hpp>

#include "city_objects.hpp"
#include "city_text.hpp"

namespace skyloop {

namespace {

constexpr int deepest_elements = 200;

std::string_view local_name(const pugi::xml_node& node) {
    const std::string_view name = node.name();
    const auto colon = name.find(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

/// Reads CityGML 1, 2 and 3 (OGC 12-019, 20-010): polygons by the elements around them, whatever the prefixes.
class CityGmlReader {
public:
    Result<CityObjects> read(const pugi::xml_document& document, std::string_view name);

private:
    /// What the elements around a polygon say of it.
    struct Context {
        std::size_t object = none;
        int level = 0;
        SurfaceUse use = SurfaceUse::unknown;
        int depth = 0;
    };
    static constexpr std::size_t none = ~std::size_t{0};

    void visit(const pugi::xml_node& node, Context context);
    [[nodiscard]] Context entered(const pugi::xml_node& node, Context context);
    void add_polygon_of(const pugi::xml_node& node, const Context& context);
    [[nodiscard]] bool read_ring(const pugi::xml_node& node, std::vector<Eigen::Vector3d>& ring) const;
    [[nodiscard]] bool read_numbers(std::string_view text, std::vector<double>& numbers) const;

    CityObjects found_;
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
    }
    return context;
}

void CityGmlReader::visit(const pugi::xml_node& node, Context context) {
    if (context.depth > deepest_elements) {
        too_deep_ = true;
        return;
    }
    if (!found_.system)
        if (const pugi::xml_attribute system = node.attribute("srsName"))
            found_.system = reference_system(system.value());
    const std::string_view name = local_name(node);
    if (name == "Polygon" || name == "PolygonPatch" || name == "Triangle" || name == "Rectangle") {
        add_polygon_of(node, context);
        return;
    }
    if (name == "appearance" || name == "appearanceMember") return;
    context = entered(node, context);
    for (const pugi::xml_node& child : node.children())
        if (child.type() == pugi::node_element) visit(child, context);
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

bool CityGmlReader::read_ring(const pugi::xml_node& node, std::vector<Eigen::Vector3d>& ring) const {
    std::vector<double> numbers;
    int dimension = 3;
    for (const pugi::xml_node& outer : node.children())
        for (const pugi::xml_node& list : outer.children()) {
            if (local_name(list) == "posList" || local_name(list) == "pos" || local_name(list) == "coordinates")
                if (!read_numbers(list.child_value(), numbers)) return false;
            if (const pugi::xml_attribute given = list.attribute("srsDimension")) dimension = given.as_int();
        }
    if (dimension != 3 || numbers.size() < 9 || numbers.size() % 3 != 0) return false;
    const bool swap = found_.system && found_.system->latitude_first;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
        ring.emplace_back(numbers[i + (swap ? 1 : 0)], numbers[i + (swap ? 0 : 1)], numbers[i + 2]);
    return true;
}

void CityGmlReader::add_polygon_of(const pugi::xml_node& node, const Context& context) {
    if (context.object == none) return;  // in a library of shapes or an appearance
    ObjectSurface surface;
    surface.use = context.use;
    bool good = true, has_outer = false;
    for (const pugi::xml_node& child : node.children()) {
        const std::string_view name = local_name(child);
        const bool outer = name == "exterior" || name == "outerBoundaryIs";
        if (!outer && name != "interior" && name != "innerBoundaryIs") continue;
        std::vector<Eigen::Vector3d> ring;
        good = good && read_ring(child, ring);
        has_outer = has_outer || outer;
        surface.rings.insert(outer ? surface.rings.begin() : surface.rings.end(), std::move(ring));
    }
    if (good && has_outer)
        found_.objects[context.object].levels[context.level].push_back(std::move(surface));
    else
        ++found_.dropped;
}

Result<CityObjects> CityGmlReader::read(const pugi::xml_document& document, std::string_view name) {
    const pugi::xml_node root = document.document_element();
    if (local_name(root) != "CityModel")
        return fail(ErrorCode::input, fmt::format("{}: the root element is <{}>, expected <CityModel> of CityGML", name,
                                                  shown(root.name())));
    visit(root, {});
    if (too_deep_)
        return fail(ErrorCode::input, fmt::format("{}: elements nest deeper than {} levels", name, deepest_elements));
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
    auto objects = CityGmlReader().read(document, name);
    if (!objects) return fail(objects.error());
    return city_of_objects(std::move(*objects), "citygml", name, settings);
}

}  // namespace skyloop
