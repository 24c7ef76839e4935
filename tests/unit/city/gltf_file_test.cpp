#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include <fmt/format.h>

#include "mesh_support.hpp"

namespace skyloop::gltf_file_test {
namespace {

using test::refusal;
using ::testing::HasSubstr;

// A wall 1 m wide along x and 2 m high along y, at z = 0: four corners as floats, six indices as shorts.
std::string wall_bytes() {
    std::string bytes;
    for (const float value : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 2.F, 0.F, 0.F, 2.F, 0.F}) {
        char raw[4];
        std::memcpy(raw, &value, 4);
        bytes.append(raw, 4);
    }
    for (const char corner : {'\0', '\1', '\2', '\0', '\2', '\3'})
        bytes += {corner, '\0'};
    return bytes;
}

std::string base64(const std::string& bytes) {
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63U];
    }
    return text;
}

// `buffer` is what tells of the buffer, `node` of where the wall stands.
std::string document(const std::string& buffer, const std::string& node = "") {
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
"nodes":[{{"name":"city","children":[1]}},{{"name":"house","mesh":0{}}}],
"meshes":[{{"name":"facade","primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"material":0}}]}}],
"materials":[{{"name":"itu_glass"}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},
{{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":12}}],
"buffers":[{{"byteLength":60{}}}]}})",
        node, buffer);
}

std::string embedded(const std::string& node = "") {
    return document(",\"uri\":\"data:application/octet-stream;base64," + base64(wall_bytes()) + "\"", node);
}

std::string word(std::size_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i)
        bytes += static_cast<char>(value >> (8 * i) & 255U);
    return bytes;
}

std::string binary(std::string text) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::string chunks = word(text.size()) + "JSON" + text + word(60) + std::string("BIN\0", 4) + wall_bytes();
    return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
}

Result<CityFile> read_gltf(std::string_view bytes, const CityFileSettings& settings = {}) {
    return parse_gltf(bytes, "city.gltf", settings);
}

std::string with(std::string text, const std::string& old, const std::string& put) {
    const std::size_t at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return text.replace(at, old.size(), put);
}

TEST(GltfFile, StandsUpright) {
    for (const std::string& bytes : {embedded(), binary(document(""))}) {
        const auto file = read_gltf(bytes);
        ASSERT_TRUE(file) << file.error().message;
        test::expect_sound(*file);
        EXPECT_EQ(file->format, "gltf");
        EXPECT_EQ(test::count_of(file->model, SurfaceKind::wall), 2U);
        EXPECT_EQ(test::highest_of(file->model).z(), 2);
        EXPECT_DOUBLE_EQ(test::area_of(file->model), 2);
        ASSERT_EQ(file->model.materials.size(), 2U);
        EXPECT_EQ(file->model.materials[file->model.triangles[0].material], "glass");
    }
}

TEST(GltfFile, PlacesNodes) {
    // Ten times as large, a quarter turn about y (x comes to point along -z: north), then 100 m along x and -200 along
    // z.
    const std::string moved =
        ",\"translation\":[100,0,-200],\"rotation\":[0,0.7071067811865476,0,0.7071067811865476],\"scale\":[10,10,10]";
    const auto file = read_gltf(embedded(moved));
    ASSERT_TRUE(file) << file.error().message;
    double north = 0;
    for (const Eigen::Vector3d& vertex : file->model.vertices) {
        EXPECT_NEAR(vertex.x(), 100, 1e-9) << "east";
        north = std::max(north, vertex.y());
    }
    EXPECT_NEAR(north, 210, 1e-9);
    EXPECT_NEAR(test::highest_of(file->model).z(), 20, 1e-9);
    // The same as a matrix by columns.
    const auto same = read_gltf(embedded(",\"matrix\":[0,0,-10,0, 0,10,0,0, 10,0,0,0, 100,0,-200,1]"));
    ASSERT_TRUE(same) << same.error().message;
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_LT((same->model.vertices[i] - file->model.vertices[i]).norm(), 1e-9) << i;
}

TEST(GltfFile, SaysThatInstancesAreNotRead) {
    const auto file =
        read_gltf(embedded(R"(,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}})"));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_DOUBLE_EQ(test::area_of(file->model), 2);
    EXPECT_THAT(file->warnings, ::testing::ElementsAre(
                                    HasSubstr("city.gltf: 1 nodes stand in many places by EXT_mesh_gpu_instancing")));
    const auto other = read_gltf(embedded(R"(,"extensions":{"KHR_node_visibility":{"visible":true}})"));
    ASSERT_TRUE(other) << other.error().message;
    EXPECT_THAT(other->warnings, ::testing::IsEmpty());
}

TEST(GltfFile, TakesGroundFromTheNameOfANode) {
    // Lying down: a quarter turn about x.
    const std::string lying = ",\"rotation\":[0.7071067811865476,0,0,0.7071067811865476]";
    const auto roof = read_gltf(embedded(lying));
    ASSERT_TRUE(roof);
    EXPECT_EQ(test::count_of(roof->model, SurfaceKind::roof), 2U);
    const auto ground = read_gltf(with(embedded(lying), "\"house\"", "\"Terrain\""));
    ASSERT_TRUE(ground);
    EXPECT_EQ(test::count_of(ground->model, SurfaceKind::ground), 2U);
}

TEST(GltfFile, ReadsStripsFansAndPlainCorners) {
    const std::string bare = with(embedded(), ",\"indices\":1", ",\"mode\":6");
    const auto fan = read_gltf(bare);
    ASSERT_TRUE(fan) << fan.error().message;
    EXPECT_DOUBLE_EQ(test::area_of(fan->model), 2);
    const auto strip = read_gltf(with(bare, "\"mode\":6", "\"mode\":5"));
    ASSERT_TRUE(strip);
    EXPECT_EQ(strip->model.triangles.size(), 2U);
    const auto single = read_gltf(with(bare, "\"mode\":6", "\"mode\":4"));
    ASSERT_TRUE(single);
    EXPECT_EQ(single->model.triangles.size(), 1U);
    EXPECT_THAT(refusal(read_gltf(with(bare, "\"mode\":6", "\"mode\":1"))), HasSubstr("holds no triangle"));
}

TEST(GltfFile, SaysWhatIsWrong) {
    const auto changed = [](const std::string& old, const std::string& put) {
        return refusal(read_gltf(with(embedded(), old, put)));
    };
    EXPECT_THAT(changed("\"version\":\"2.0\"", "\"version\":\"1.0\""), HasSubstr("glTF version 1.0; expected 2"));
    EXPECT_THAT(changed("\"nodes\":[0]", "\"nodes\":[7]"), HasSubstr("names node 7 of 2"));
    EXPECT_THAT(changed("\"children\":[1]", "\"children\":[0]"), HasSubstr("its own child"));
    EXPECT_THAT(changed("\"mesh\":0", "\"mesh\":3"), HasSubstr("names mesh 3 of 1"));
    EXPECT_THAT(changed("\"POSITION\":0", "\"POSITION\":9"), HasSubstr("names accessor 9 of 2"));
    EXPECT_THAT(changed("\"POSITION\":0", "\"POSITION\":1"), HasSubstr("accessor 1: expected"));
    EXPECT_THAT(changed("\"count\":4", "\"count\":5"), HasSubstr("accessor 0: 5 of 12 bytes"));
    EXPECT_THAT(changed("\"count\":4", "\"count\":18446744073709551615"), HasSubstr("accessor 0: "));
    EXPECT_THAT(changed("\"count\":4", "\"count\":3"), HasSubstr("names vertex 3 of 3"));
    EXPECT_THAT(changed("\"byteLength\":48", "\"byteLength\":61"), HasSubstr("bufferView 0: 61 bytes from 0"));
    EXPECT_THAT(changed("\"byteOffset\":0,", "\"byteOffset\":18446744073709551615,"), HasSubstr("bufferView 0: "));
    EXPECT_THAT(changed("\"byteLength\":60", "\"byteLength\":6000000000"),
                HasSubstr("tells of 6000000000 bytes, but has 60"));
    EXPECT_THAT(changed("\"componentType\":5126,", "\"componentType\":5126,\"sparse\":{},"), HasSubstr("sparse"));
    EXPECT_THAT(changed("\"scene\":0", "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"scene\":0"),
                HasSubstr("KHR_draco_mesh_compression"));
    EXPECT_THAT(changed(";base64,AA", ";base64,?A"), HasSubstr("base64"));
    EXPECT_THAT(changed("\"asset\"", "\"asset"), HasSubstr("line 1: is no JSON"));
    EXPECT_THAT(changed("\"count\":4", "\"count\":1e999"), HasSubstr("beyond all bounds"));
    EXPECT_THAT(refusal(read_gltf(std::string(100'000, '['))), HasSubstr("is no JSON"));
    EXPECT_THAT(refusal(read_gltf("[]")), HasSubstr("no asset"));
}

TEST(GltfFile, OpensNoOtherFile) {
    EXPECT_THAT(refusal(read_gltf(document(",\"uri\":\"wall.bin\""))), HasSubstr("'wall.bin' beside it"));
    // Names are quoted in messages, and those are one line.
    EXPECT_THAT(refusal(read_gltf(document(",\"uri\":\"a\\nb.bin\""))), HasSubstr("'a?b.bin'; expected one inside"));
    EXPECT_THAT(refusal(read_gltf(document(",\"uri\":\"a%0Ab.bin\""))), HasSubstr("'a%0Ab.bin'; expected one inside"));
    for (const char* outside :
         {"/etc/passwd", "../wall.bin", "a/%2e%2e/%2E%2E/wall.bin", "file:///etc/passwd", "C:\\\\wall.bin"})
        EXPECT_THAT(refusal(read_gltf(document(fmt::format(",\"uri\":\"{}\"", outside)))),
                    HasSubstr("inside the folder"));
}

TEST(GltfFile, RefusesMoreTrianglesThanAllowed) {
    CityFileSettings settings;
    settings.most_triangles = 1;
    EXPECT_THAT(refusal(read_gltf(embedded(), settings)), HasSubstr("more than 1 triangles"));
}

TEST(GltfFile, EveryCutOfAFileIsRefusedWithASentence) {
    for (const std::string& whole : {embedded(), binary(document(""))})
        for (std::size_t size = 0; size < whole.size(); ++size) {
            const auto file = read_gltf(std::string_view(whole).substr(0, size));
            ASSERT_FALSE(file) << size;
            EXPECT_THAT(file.error().message, HasSubstr("city.gltf"));
        }
}

}  // namespace
}  // namespace skyloop::gltf_file_test
