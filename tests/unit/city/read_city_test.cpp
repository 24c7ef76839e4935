#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "mesh_support.hpp"
#include "support/oracle_table.hpp"

namespace skyloop::read_city_test {
namespace {

namespace fs = std::filesystem;
using test::refusal;
using ::testing::Contains;
using ::testing::HasSubstr;

class ReadCity : public ::testing::Test {
protected:
    void SetUp() override {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::path(::testing::TempDir()) / (std::string("skyloop_read_city_") + test->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path put(const std::string& name, const std::string& content) const {
        std::ofstream(folder_ / name, std::ios::binary) << content;
        return folder_ / name;
    }
    fs::path folder_;
};

constexpr const char* small_obj = "v 0 0 0\nv 20 0 0\nv 0 0 20\nf 1 2 3\n";

TEST_F(ReadCity, GoesByTheEndingInAnyCase) {
    EXPECT_EQ(read_city(put("a.obj", small_obj), {})->format, "obj");
    EXPECT_EQ(read_city(put("A.OBJ", small_obj), {})->format, "obj");
    EXPECT_EQ(read_city(put("a.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 90\n1 2 3 4\n"), {})->format,
              "height grid");
    EXPECT_THAT(refusal(read_city(put("a.stl", "solid"), {})), HasSubstr("its ending is of no known city"));
    EXPECT_THAT(refusal(read_city(put("a.xml", "<?xml?><kml/>"), {})), HasSubstr("its first element is 'kml'"));
    EXPECT_THAT(refusal(read_city(put("b.obj", ""), {})), HasSubstr("is empty"));
}

TEST_F(ReadCity, SaysWhatCannotBeOpened) {
    const auto absent = read_city(folder_ / "absent.obj", {});
    ASSERT_FALSE(absent);
    EXPECT_EQ(absent.error().code, ErrorCode::outside);
    EXPECT_THAT(refusal(read_city(folder_, {})), HasSubstr("holds 0 .xml files"));
    EXPECT_THAT(refusal(read_city(put("cut.obj.gz", "\x1f\x8b\x08"), {})), HasSubstr("cut.obj.gz"));
}

TEST_F(ReadCity, NoFileMayHoldMoreThanTheSceneMayTake) {
    CityFileSettings small;
    small.memory_limit = std::size_t{1} << 20;
    EXPECT_TRUE(read_city(put("a.obj", small_obj), small));
    const auto file = put("b.obj", small_obj + std::string(std::size_t{1} << 20, ' '));
    EXPECT_TRUE(read_city(file, {}));
    EXPECT_THAT(refusal(read_city(file, small)),
                HasSubstr("b.obj: has more than 1048576 bytes of text, the most that is read (memory_limit_mb is 1)"));
}

TEST_F(ReadCity, TellsOfDoubtfulUnits) {
    const auto small = read_city(put("a.obj", "v 0 0 0\nv 20 0 0\nv 0 0 3\nf 1 2 3\n"), {});
    ASSERT_TRUE(small);
    EXPECT_THAT(small->warnings, Contains(HasSubstr("a.obj: the whole city is 3.00 m tall")));
    EXPECT_TRUE(read_city(put("b.obj", small_obj), {})->warnings.empty());
}

TEST_F(ReadCity, ReadsABufferBesideAGltfButNoneElsewhere) {
    const std::string text =
        R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"BUFFER"}]})";
    const float corners[9] = {0, 0, 0, 20, 0, 0, 0, 20, 0};
    put("the wall.bin", std::string(reinterpret_cast<const char*>(corners), sizeof corners));
    const auto with = [&](const std::string& uri) { return std::string(text).replace(text.find("BUFFER"), 6, uri); };
    const auto file = read_city(put("a.gltf", with("the%20wall.bin")), {});
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_DOUBLE_EQ(test::area_of(file->model), 200);
    EXPECT_THAT(refusal(read_city(put("b.gltf", with("../the%20wall.bin")), {})), HasSubstr("inside the folder"));
}

TEST_F(ReadCity, TellsATextSequenceFromACityJsonWhateverItsEnding) {
    const std::string head = R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)";
    const std::string house =
        R"("CityObjects":{"a":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]]}]}},)"
        R"("vertices":[[0,0,0],[20,0,0],[0,0,20]]})";
    const std::string sequence =
        head + R"("CityObjects":{},"vertices":[]})" + "\n" + R"({"type":"CityJSONFeature","id":"a",)" + house + "\n";
    for (const char* name : {"a.json", "a.city.json", "a.cityjson", "a.city.jsonl"}) {
        const auto file = read_city(put(name, sequence), {});
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(file->buildings, 1U) << name;
    }
    for (const char* name : {"b.json", "b.city.json"}) {
        const auto file = read_city(put(name, head + "\n" + house + "\n"), {});
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(file->buildings, 1U) << name;
    }
}

// Counts of the data's own list, munich.tar.gz and its kin.
void expect_real(const fs::path& path, std::size_t triangles) {
    const auto file = read_city(path, {});
    ASSERT_TRUE(file) << file.error().message;
    test::expect_sound(*file);
    EXPECT_EQ(file->model.triangles.size() + file->dropped, triangles);
    EXPECT_LT(file->dropped, triangles / 100);
    EXPECT_GT(test::count_of(file->model, SurfaceKind::wall), triangles / 3);
    EXPECT_GT(test::count_of(file->model, SurfaceKind::roof), triangles / 10);
    for (const std::string& doubt : doubts_about(file->model))
        ADD_FAILURE() << doubt;
}

TEST(RealCities, MunichHasMaterialsAndGround) {
    SKYLOOP_REQUIRE_SHARED(path, "city/munich.tar.gz");
    expect_real(path, 38938);
    const auto file = read_city(path, {});
    ASSERT_TRUE(file);
    EXPECT_THAT(file->model.materials, ::testing::UnorderedElementsAre("concrete", "marble", "metal", "brick", "wood"));
    double ground = 0;
    for (const CityTriangle& triangle : file->model.triangles) {
        const auto& [a, b, c] = triangle.corners;
        const auto& at = file->model.vertices;
        if (triangle.kind == SurfaceKind::ground) ground += 0.5 * (at[b] - at[a]).cross(at[c] - at[a]).norm();
    }
    EXPECT_GE(ground, 1475.4 * 1205.6) << "its plane";
    EXPECT_NEAR(test::highest_of(file->model).z(), 98.57, 0.01) << "the Frauenkirche";
}

TEST(RealCities, EtoileHasGroundUnderItsArch) {
    SKYLOOP_REQUIRE_SHARED(path, "city/etoile.tar.gz");
    expect_real(path, 13058);
    const auto file = read_city(path, {});
    ASSERT_TRUE(file);
    EXPECT_GE(test::count_of(file->model, SurfaceKind::ground), 2U);
    EXPECT_NEAR(test::highest_of(file->model).z(), 50, 0.01);
}

TEST(RealCities, OdaibaIsReadCompressed) {
    SKYLOOP_REQUIRE_SHARED(path, "city/tokyo_odaiba_109k.obj.gz");
    expect_real(path, 108644);
}

}  // namespace
}  // namespace skyloop::read_city_test
