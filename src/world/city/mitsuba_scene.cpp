#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <pugixml.hpp>

#include "base/core/archive.hpp"
#include "detail/city_text.hpp"
#include "detail/companion_files.hpp"
#include "detail/mesh_builder.hpp"
#include "detail/ply_file.hpp"

namespace skyloop::inline world {
namespace {

// Numbers between blanks and commas; empty when something else stands there.
std::vector<double> numbers_of(std::string_view text) {
    std::vector<double> numbers;
    const char *at = text.data(), *end = at + text.size();
    for (;;) {
        while (at != end && (*at == ',' || *at == ' ' || *at == '\t' || *at == '\n' || *at == '\r'))
            ++at;
        if (at == end) return numbers;
        const auto number = take_number(at, end);
        if (!number) return {};
        numbers.push_back(*number);
    }
}

double number_or(const pugi::xml_node& node, const char* attribute, double otherwise) {
    const std::vector<double> numbers = numbers_of(node.attribute(attribute).value());
    return numbers.size() == 1 ? numbers[0] : otherwise;
}

// "x, y, z" or one number for all as `value`, or the three of their own.
Eigen::Vector3d vector_of(const pugi::xml_node& node, double otherwise) {
    const std::vector<double> value = numbers_of(node.attribute("value").value());
    if (value.size() == 3) return {value[0], value[1], value[2]};
    if (value.size() == 1) return Eigen::Vector3d::Constant(value[0]);
    return {number_or(node, "x", otherwise), number_or(node, "y", otherwise), number_or(node, "z", otherwise)};
}

class MitsubaReader {
public:
    MitsubaReader(std::string_view xml, std::string_view name, const CityFileSettings& settings,
                  const CompanionFiles& companions)
        : xml_(xml), name_(name), builder_(settings, name, "x,y,z"), companions_(companions) {}

    Result<CityFile> read() {
        pugi::xml_document document;
        const auto parsed = document.load_buffer(xml_.data(), xml_.size());
        const pugi::xml_node scene = document.child("scene");
        if (!parsed)
            return fail(ErrorCode::input,
                        fmt::format("{}: {}", line_place(name_, xml_, static_cast<std::size_t>(parsed.offset)),
                                    parsed.description()));
        if (!scene) return fail(ErrorCode::input, fmt::format("{}: has no element 'scene' of Mitsuba", name_));
        for (const pugi::xml_node& bsdf : scene.children("bsdf"))
            materials_[bsdf.attribute("id").value()] = material(bsdf);
        for (const pugi::xml_node& shape : scene.children("shape"))
            if (auto done = add_shape(shape); !done) return fail(std::move(done.error()));
        if (scene.child("include"))
            return fail(ErrorCode::input,
                        fmt::format("{}: includes another scene, which is not read", place(scene.child("include"))));
        if (unknown_shapes_ > 0)
            builder_.warn(fmt::format("{}: dropped {} shapes of other kinds than ply, the first is '{}'", name_,
                                      unknown_shapes_, first_unknown_));
        return builder_.finish("mitsuba");
    }

private:
    [[nodiscard]] std::string place(const pugi::xml_node& node) const {
        return line_place(name_, xml_, static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, node.offset_debug())));
    }

    // Sionna's radio materials tell their type; others speak by their identity.
    static std::string material(const pugi::xml_node& bsdf) {
        if (std::string_view(bsdf.attribute("type").value()) == "itu-radio-material")
            for (const pugi::xml_node& text : bsdf.children("string"))
                if (std::string_view(text.attribute("name").value()) == "type") return text.attribute("value").value();
        return bsdf.attribute("id").value();
    }
    std::string material_of_shape(const pugi::xml_node& shape) {
        if (const pugi::xml_node own = shape.child("bsdf")) return material(own);
        for (const pugi::xml_node& ref : shape.children("ref")) {
            const char* id = ref.attribute("id").value();
            const auto known = materials_.find(id);
            return known != materials_.end() ? known->second : id;
        }
        return "";
    }

    Result<Eigen::Affine3d> to_world(const pugi::xml_node& shape) {
        Eigen::Affine3d all = Eigen::Affine3d::Identity();
        for (const pugi::xml_node& transform : shape.children("transform"))
            for (const pugi::xml_node& step : transform.children()) {
                const std::string_view kind = step.name();
                Eigen::Affine3d one = Eigen::Affine3d::Identity();
                if (step.type() != pugi::node_element) continue;
                if (kind == "translate") {
                    one.translate(vector_of(step, 0));
                } else if (kind == "scale") {
                    one.scale(vector_of(step, 1));
                } else if (kind == "rotate") {
                    const double angle = number_or(step, "angle", 0) * std::numbers::pi / 180;
                    one.rotate(Eigen::AngleAxisd(angle, vector_of(step, 0).normalized()));
                } else if (const auto values = numbers_of(step.attribute("value").value());
                           kind == "matrix" && values.size() == 16) {
                    one.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
                } else {
                    return fail(
                        ErrorCode::input,
                        fmt::format("{}: expected translate, scale, rotate or a matrix of 16 numbers, found '{}'",
                                    place(step), shown(kind)));
                }
                all = one * all;
            }
        return all;
    }

    Result<void> add_shape(const pugi::xml_node& shape) {
        const std::string_view type = shape.attribute("type").value(), id = shape.attribute("id").value();
        if (type != "ply") {
            if (unknown_shapes_++ == 0) first_unknown_ = shown(type);
            builder_.drop_shape();
            return {};
        }
        std::string file;
        for (const pugi::xml_node& text : shape.children("string"))
            if (std::string_view(text.attribute("name").value()) == "filename") file = text.attribute("value").value();
        const auto inside = name_inside(file);
        if (!inside)
            return fail(ErrorCode::input, fmt::format("{}: names the file '{}'; expected one inside the scene's folder",
                                                      place(shape), shown(file)));
        const auto placed = to_world(shape);
        if (!placed) return fail(placed.error());
        const auto bytes = companions_(*inside);
        if (!bytes) return fail(bytes.error().code, fmt::format("{}: {}", place(shape), bytes.error().message));
        builder_.begin_mesh(*placed);
        const MeshPart part = builder_.part(material_of_shape(shape), std::array{id});
        const auto added = add_ply(builder_, *bytes, *inside, part);
        if (!added) return fail(added.error().code, fmt::format("{}: {}", place(shape), added.error().message));
        return {};
    }

    std::string_view xml_, name_;
    MeshBuilder builder_;
    const CompanionFiles& companions_;
    std::map<std::string, std::string, std::less<>> materials_;
    std::size_t unknown_shapes_ = 0;
    std::string first_unknown_;
};

}  // namespace

Result<CityFile> parse_mitsuba(std::string_view xml, std::string_view name, const CityFileSettings& settings,
                               const CompanionFiles& companions) {
    return MitsubaReader(xml, name, settings, companions).read();
}

}  // namespace skyloop::inline world
