/// A city in the making from a file of facets.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "world/city/city_file.hpp"

namespace skyloop::inline world {

/// What a facet belongs to.
struct MeshPart {
    std::uint8_t material = 0;
    bool ground = false;  ///< as its name says
};

/// Turns vertices and polygons as a file has them into a CityModel: axes and units, what cannot be used, what is wall,
/// roof and ground, and no more than allowed.
///
/// The kind of a triangle: |up component of its normal| ≤ 0.5 wall; else ground where its part is named so, and roof
/// otherwise; roofs within 0.5 m of the lowest corner of all become ground when together they cover a quarter of the
/// city's box and something stands 2 m above them.
class MeshBuilder {
public:
    /// @param settings outlive the builder
    /// @param usual_axes of the format, where the settings say nothing
    MeshBuilder(const CityFileSettings& settings, std::string_view name, std::string_view usual_axes);

    /// Begins a mesh that counts its vertices from 0 and stands where `placement` puts it, in axes and units of the
    /// file.
    void begin_mesh(const Eigen::Affine3d& placement = Eigen::Affine3d::Identity());
    /// What `material` speaks of, and whether one of the names is ground's.
    MeshPart part(std::string_view material, std::span<const std::string_view> names);

    /// True when as many more may be added; otherwise too_many() says so. Nothing is allocated.
    [[nodiscard]] bool may_add(std::size_t vertices, std::size_t triangles) const;
    [[nodiscard]] tl::unexpected<Error> too_many() const;
    /// For counts that are known to be true.
    void reserve(std::size_t vertices, std::size_t triangles);

    /// @returns false when it would be one too many
    [[nodiscard]] bool add_vertex(const Eigen::Vector3d& as_in_file);
    /// Vertices of the present mesh.
    [[nodiscard]] std::size_t vertices() const { return model_.vertices.size() - first_vertex_; }
    /// A polygon by vertices of the present mesh, each less than vertices(). @returns false when it would be too many
    [[nodiscard]] bool add_polygon(std::span<const std::uint32_t> corners, MeshPart part);
    /// Counts what the caller cannot read, and warns of.
    void drop_shape() { ++shapes_; }
    void warn(std::string warning) { warnings_.push_back(std::move(warning)); }

    /// The city. Fails when no triangle is left.
    Result<CityFile> finish(std::string format);

private:
    bool add_triangle(const std::array<std::uint32_t, 3>& corners, MeshPart part);
    bool add_concave(std::span<const std::uint32_t> corners, const Eigen::Vector3d& normal, MeshPart part);
    [[nodiscard]] const Eigen::Vector3d& at(std::uint32_t corner) const {
        return model_.vertices[first_vertex_ + corner];
    }
    void drop_unused_vertices();
    void find_ground();
    void tell_dropped();
    Result<void> lay_on_map(CityFile& file);

    std::string name_;
    const CityFileSettings& settings_;
    bool of_a_map_;  ///< by file_crs
    std::size_t most_triangles_, most_vertices_;
    Eigen::Affine3d to_city_, placement_;
    CityModel model_;
    std::size_t first_vertex_ = 0;
    std::size_t not_finite_ = 0, without_area_ = 0, shapes_ = 0;
    std::vector<std::string> warnings_;
};

}  // namespace skyloop::inline world
