/// PLY files into a mesh; the header's grammar beside the reader of the body.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh_builder.hpp"

namespace skyloop::inline world {

enum class PlyEncoding { ascii, little_endian, big_endian };

/// A number's type: its size and how it is read from bytes in this machine's order.
struct PlyType {
    unsigned size = 0;
    bool integer = false;
    double (*number)(const void* bytes) = nullptr;
};

struct PlyProperty {
    std::string name;
    PlyType type;
    std::optional<PlyType> count_type;  ///< of a list
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    /// Bytes that one takes at least: its lists empty; in text a digit and a blank for each number.
    [[nodiscard]] std::uint64_t least_size(PlyEncoding encoding) const;
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::ascii;
    std::vector<PlyElement> elements;
    std::size_t size = 0;  ///< of the header, bytes
};

/// Reads until "end_header". Fails with `input` and NAME:LINE.
Result<PlyHeader> parse_ply_header(std::string_view bytes, std::string_view name);

/// Adds a file's facets to a mesh that has begun. Fails with `input` and NAME:LINE or the byte.
Result<void> add_ply(MeshBuilder& builder, std::string_view bytes, std::string_view name, MeshPart part);

}  // namespace skyloop::inline world
