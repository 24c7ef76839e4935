#include <fmt/format.h>

#include <array>

#include "detail/city_text.hpp"
#include "detail/companion_files.hpp"
#include "detail/gltf_document.hpp"
#include "detail/json_text.hpp"
#include "detail/mesh_builder.hpp"

namespace skyloop::inline world {
namespace {

// Nodes within nodes beyond which a file is not believed; a city has a handful.
constexpr int deepest_node = 64;

class GltfReader {
public:
    GltfReader(GltfDocument document, std::string_view name, const CityFileSettings& settings)
        : document_(std::move(document)), builder_(settings, name, "x,-z,y"), name_(name) {}

    Result<CityFile> read() {
        visited_.assign(document_.list("nodes").size(), false);
        for (const std::uint64_t root : roots())
            if (auto done = add_node(root, Eigen::Affine3d::Identity(), 0); !done) return fail(std::move(done.error()));
        if (instanced_ > 0)
            builder_.warn(
                fmt::format("{}: {} nodes stand in many places by EXT_mesh_gpu_instancing, which is not read: each "
                            "stands once",
                            name_, instanced_));
        return builder_.finish("gltf");
    }

private:
    // Those of the scene that is to be shown, else all that are nobody's child.
    std::vector<std::uint64_t> roots() const {
        const JsonData& scenes = document_.list("scenes");
        const std::uint64_t shown_scene = gltf_index(document_.root(), "scene").value_or(0);
        std::vector<std::uint64_t> roots;
        if (shown_scene < scenes.size() && scenes[shown_scene].is_object()) {
            for (const JsonData& node : scenes[shown_scene].value("nodes", JsonData::array()))
                if (node.is_number_unsigned()) roots.push_back(node.get<std::uint64_t>());
            return roots;
        }
        const JsonData& nodes = document_.list("nodes");
        std::vector<bool> child(nodes.size(), false);
        for (const JsonData& node : nodes)
            for (const std::uint64_t each : children_of(node))
                if (each < child.size()) child[each] = true;
        for (std::uint64_t i = 0; i < nodes.size(); ++i)
            if (!child[i]) roots.push_back(i);
        return roots;
    }
    static std::vector<std::uint64_t> children_of(const JsonData& node) {
        std::vector<std::uint64_t> children;
        const JsonData& told = member(node, "children");
        if (!told.is_array()) return children;
        for (const JsonData& child : told)
            if (child.is_number_unsigned()) children.push_back(child.get<std::uint64_t>());
        return children;
    }

    // Whether other places than the node's own are told; readers may leave the extension aside, unless it is required.
    static bool is_instanced(const JsonData& node) {
        return member(node, "extensions").contains("EXT_mesh_gpu_instancing");
    }

    // Section 3.5.3: a matrix by columns, or translation, rotation and scale.
    Result<Eigen::Affine3d> transform_of(const JsonData& node, std::uint64_t index) const {
        const auto matrix = gltf_numbers(node, "matrix", {});
        const auto move = gltf_numbers(node, "translation", {0, 0, 0}),
                   turn = gltf_numbers(node, "rotation", {0, 0, 0, 1}), scale = gltf_numbers(node, "scale", {1, 1, 1});
        Eigen::Affine3d transform = Eigen::Affine3d::Identity();
        if (node.contains("matrix")) {
            if (matrix.size() != 16)
                return document_.wrong(fmt::format("node {}: expected 16 numbers of a matrix", index));
            transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(matrix.data());
            return transform;
        }
        if (move.size() != 3 || turn.size() != 4 || scale.size() != 3)
            return document_.wrong(
                fmt::format("node {}: expected 3 numbers of translation and scale, 4 of rotation", index));
        transform.translate(Eigen::Vector3d(move[0], move[1], move[2]));
        transform.rotate(Eigen::Quaterniond(turn[3], turn[0], turn[1], turn[2]).normalized());
        transform.scale(Eigen::Vector3d(scale[0], scale[1], scale[2]));
        return transform;
    }

    Result<void> add_node(std::uint64_t index, const Eigen::Affine3d& parent, int depth) {
        const JsonData& nodes = document_.list("nodes");
        if (index >= nodes.size()) return document_.wrong(fmt::format("names node {} of {}", index, nodes.size()));
        if (depth > deepest_node || visited_[index])
            return document_.wrong(fmt::format("node {} is its own child, another's too, or too deep", index));
        visited_[index] = true;
        const JsonData& node = nodes[index];
        const auto own = transform_of(node, index);
        if (!own) return fail(own.error());
        const Eigen::Affine3d placed = parent * *own;
        if (const auto mesh = gltf_index(node, "mesh")) {
            if (is_instanced(node)) ++instanced_;
            if (auto done = add_mesh(*mesh, placed, text_member(node, "name")); !done) return done;
        }
        for (const std::uint64_t child : children_of(node))
            if (auto done = add_node(child, placed, depth + 1); !done) return done;
        return {};
    }

    Result<void> add_mesh(std::uint64_t index, const Eigen::Affine3d& placed, std::string_view node_name) {
        const JsonData& meshes = document_.list("meshes");
        if (index >= meshes.size() || !meshes[index].is_object())
            return document_.wrong(fmt::format("names mesh {} of {}", index, meshes.size()));
        const std::string_view mesh_name = text_member(meshes[index], "name");
        for (const JsonData& primitive : meshes[index].value("primitives", JsonData::array())) {
            const auto material = gltf_index(primitive, "material");
            const JsonData& materials = document_.list("materials");
            const std::string_view material_name =
                material && *material < materials.size() ? text_member(materials[*material], "name") : "";
            builder_.begin_mesh(placed);
            const MeshPart part = builder_.part(material_name, std::array<std::string_view, 2>{mesh_name, node_name});
            if (auto done = add_primitive(primitive, part); !done) return done;
        }
        return {};
    }

    Result<void> add_primitive(const JsonData& primitive, MeshPart part) {
        const std::uint64_t mode = gltf_index(primitive, "mode").value_or(4);
        if (mode < 4) return {};  // points and lines
        const auto position = gltf_index(member(primitive, "attributes"), "POSITION");
        if (!position || mode > 6)
            return document_.wrong("a primitive has no attribute POSITION, or no mode of facets");
        const auto places = document_.numbers(*position, "VEC3");
        if (!places) return fail(places.error());
        std::optional<GltfNumbers> corners;
        if (const auto indices = gltf_index(primitive, "indices")) {
            auto numbers = document_.numbers(*indices, "SCALAR");
            if (!numbers) return fail(std::move(numbers.error()));
            if (numbers->component.type == gltf_float) return document_.wrong("indices of facets are no whole numbers");
            corners = *numbers;
        }
        const std::size_t count = corners ? corners->count : places->count;
        const std::size_t triangles = mode == 4 ? count / 3 : count < 3 ? 0 : count - 2;
        if (!builder_.may_add(places->count, triangles)) return builder_.too_many();
        builder_.reserve(places->count, triangles);
        for (std::size_t i = 0; i < places->count; ++i)
            if (!builder_.add_vertex({places->number(i, 0), places->number(i, 1), places->number(i, 2)}))
                return builder_.too_many();
        for (std::size_t i = 0; i < triangles; ++i) {
            // Section 3.7.2.1: single triangles, a strip, a fan.
            const std::array<std::size_t, 3> at = mode == 4   ? std::array{3 * i, 3 * i + 1, 3 * i + 2}
                                                  : mode == 5 ? std::array{i, i + 1, i + 2}
                                                              : std::array{std::size_t{0}, i + 1, i + 2};
            if (auto done = add_facet(corners, at, part); !done) return done;
        }
        return {};
    }

    Result<void> add_facet(const std::optional<GltfNumbers>& corners, const std::array<std::size_t, 3>& at,
                           MeshPart part) {
        std::array<std::uint32_t, 3> facet{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double corner = corners ? corners->number(at[i], 0) : static_cast<double>(at[i]);
            if (!(corner >= 0 && corner < static_cast<double>(builder_.vertices())))
                return document_.wrong(
                    fmt::format("facet {} names vertex {} of {}", at[0] / 3, corner, builder_.vertices()));
            facet[i] = static_cast<std::uint32_t>(corner);
        }
        if (!builder_.add_polygon(facet, part)) return builder_.too_many();
        return {};
    }

    GltfDocument document_;
    MeshBuilder builder_;
    std::string_view name_;
    std::vector<bool> visited_;
    std::size_t instanced_ = 0;  ///< nodes
};

}  // namespace

Result<CityFile> parse_gltf_with(std::string_view bytes, std::string_view name, const CityFileSettings& settings,
                                 const CompanionFiles& companions) {
    auto document = GltfDocument::parse(bytes, name, companions, most_city_bytes(settings));
    if (!document) return fail(std::move(document.error()));
    return GltfReader(std::move(*document), name, settings).read();
}

Result<CityFile> parse_gltf(std::string_view bytes, std::string_view name, const CityFileSettings& settings) {
    return parse_gltf_with(bytes, name, settings, [](const std::string& inside) -> Result<std::string> {
        return fail(ErrorCode::input, fmt::format("names the file '{}' beside it, which is not at hand", inside));
    });
}

}  // namespace skyloop::inline world
