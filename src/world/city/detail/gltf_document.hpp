/// A glTF 2.0 document and the bytes of its buffers, with every index and length checked.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/json.hpp"
#include "companion_files.hpp"

namespace skyloop::inline world {

/// A kind of number in a buffer.
struct GltfComponent {
    std::uint64_t type = 0;  ///< 5120 … 5126, as componentType names it
    unsigned size = 0;       ///< bytes
    double (*read)(const void* bytes) = nullptr;
    double most = 0;  ///< what stands for 1 when it is normalized; 0 of floating ones, which never are
};
inline constexpr std::uint64_t gltf_float = 5126;

/// Numbers of an accessor where they lie: checked to be inside their buffer.
struct GltfNumbers {
    std::string_view bytes;  ///< from the first one on
    std::size_t count = 0, stride = 0;
    unsigned components = 1;
    GltfComponent component;
    bool normalized = false;
    /// @param index less than count @param which less than components
    [[nodiscard]] double number(std::size_t index, unsigned which) const;
};

/// Khronos Group, glTF 2.0 specification, sections 3.4 (concepts), 3.6 (buffers), 4.4 (GLB).
class GltfDocument {
public:
    /// Parses .gltf or .glb. `bytes` must outlive it. Fails with `input`: no JSON, another version, an extension that
    /// changes shapes.
    /// @param most_bytes of all buffers together, for one file may be named many times
    static Result<GltfDocument> parse(std::string_view bytes, std::string_view name, const CompanionFiles& companions,
                                      std::size_t most_bytes);

    [[nodiscard]] const JsonData& root() const { return root_; }
    /// An array of the document's root; an empty one where there is none.
    [[nodiscard]] const JsonData& list(const char* key) const;
    /// The numbers of an accessor of `type` ("VEC3", "SCALAR"). Fails with `input` and what is wrong.
    Result<GltfNumbers> numbers(std::uint64_t accessor, std::string_view type);
    [[nodiscard]] tl::unexpected<Error> wrong(std::string_view what) const;

private:
    Result<void> take_chunks(std::string_view bytes);
    Result<void> check_version() const;
    Result<std::string_view> buffer(std::uint64_t index);
    Result<std::string> load(const JsonData& buffer);

    std::string name_;
    CompanionFiles companions_;
    JsonData root_;
    std::optional<std::string_view> binary_;
    std::vector<std::optional<std::string>> loaded_;
    std::size_t loaded_bytes_ = 0, most_bytes_ = 0;
};

/// A whole number that is not negative; nothing when there is none of that name.
std::optional<std::uint64_t> gltf_index(const JsonData& object, const char* key);
/// All numbers of an array, `otherwise` when there is none of that name; empty when it holds something else.
std::vector<double> gltf_numbers(const JsonData& object, const char* key, std::vector<double> otherwise);

}  // namespace skyloop::inline world
