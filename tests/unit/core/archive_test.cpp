#include "base/core/archive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/core/files.hpp"
#include "support/oracle_table.hpp"
#include "support/packed.hpp"

namespace skyloop {
namespace {

using test::archive_of;
using test::compressed;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::size_t most_bytes = std::size_t{1} << 20;

std::string refusal_of(const std::string& bytes, std::size_t max_size = most_bytes) {
    const auto text = unpacked(bytes, "x.zip", max_size);
    if (text) return "was read";
    EXPECT_EQ(text.error().code, ErrorCode::input);
    EXPECT_EQ(text.error().message.find('\n'), std::string::npos);
    return text.error().message;
}

std::string lines(int count) {
    std::string text;
    for (int i = 0; i < count; ++i)
        text += std::to_string(i * i) + " skyloop\n";
    return text;
}

TEST(Archive, EveryCompressionIsRead) {
    for (const char* filter : {"gzip", "compress", "bzip2", "xz", "zstd"}) {
        SCOPED_TRACE(filter);
        for (const std::string& text : {std::string("a"), lines(20'000)}) {
            const std::string packed = compressed(filter, text);
            EXPECT_TRUE(is_compressed(packed));
            EXPECT_EQ(unpacked(packed, "x", most_bytes).value(), text);
            EXPECT_EQ(unpacked(compressed("gzip", packed), "x", most_bytes).value(), text) << "twice";
        }
    }
    EXPECT_EQ(unpacked("BZh is no bzip2", "x", most_bytes).value(), "BZh is no bzip2");
    for (const char* text : {"", "B", "BZh", "BZh9", "PK", "\x1f"})
        EXPECT_EQ(unpacked(text, "x", most_bytes).value(), text);
}

TEST(Archive, TheOnlyFileOfAnArchiveIsItsContent) {
    const std::string text = lines(100);
    for (const char* format : {"zip", "ustar", "pax", "gnutar"}) {
        SCOPED_TRACE(format);
        const std::string archive =
            archive_of(format, {{"._a.rnx", "mac"}, {"in/a.rnx", text}, {"__MACOSX/b.rnx", "mac"}});
        EXPECT_TRUE(is_archive(archive));
        EXPECT_EQ(unpacked(archive, "x", most_bytes).value(), text);
        EXPECT_EQ(unpacked(compressed("xz", archive), "x", most_bytes).value(), text);
        EXPECT_EQ(unpacked(archive_of(format, {{"a.Z", compressed("compress", text)}}), "x", most_bytes).value(), text);
    }
    const std::string kmz = archive_of("zip", {{"doc.kml", "<kml/>"}});
    EXPECT_EQ(unpacked(kmz, "x", most_bytes).value(), kmz);
}

TEST(Archive, FilesHaveTheirNames) {
    const std::string far = std::string(150, 'd') + "/a";
    for (const char* format : {"zip", "pax", "gnutar"}) {
        SCOPED_TRACE(format);
        const auto files = archive_files(archive_of(format, {{"./größe", "1"}, {far, "2"}}), "x", most_bytes);
        ASSERT_TRUE(files) << files.error().message;
        EXPECT_EQ(*files, (ArchiveFiles{{"größe", "1"}, {far, "2"}}));
    }
    const auto wanted = archive_files(archive_of("zip", {{"a", "1"}, {"b", "2"}}), "x", most_bytes,
                                      [](std::string_view name) { return name == "b"; });
    EXPECT_EQ(wanted.value(), (ArchiveFiles{{"b", "2"}}));
}

TEST(Archive, SeveralFilesAreNoFile) {
    EXPECT_EQ(refusal_of(archive_of("zip", {{"a", "1"}, {"b", "2"}})),
              "x.zip: an archive of 2 files: a, b; expected one file in it");
    EXPECT_EQ(refusal_of(archive_of("zip", {{"._a", "1"}})), "x.zip: an archive of 0 files; expected one file in it");
}

TEST(Archive, NamesThatLeadOutAreRefused) {
    for (const char* name : {"../a", "/etc/passwd", "a/../../b", "..\\a", "c:/a"})
        EXPECT_THAT(refusal_of(archive_of("zip", {{name, "1"}})), HasSubstr(": leads out of the archive; expected"))
            << name;
    EXPECT_THAT(refusal_of(archive_of("ustar", {{"a", "1"}, {"../b", "1"}})), StartsWith("x.zip:../b: leads out"));
}

TEST(Archive, EncryptedFilesAreNamedAsSuch) {
    EXPECT_EQ(refusal_of(archive_of("zip", {{"in/a.rnx", "1"}}, "secret")),
              "x.zip:in/a.rnx: is encrypted; expected a file without a password");
}

TEST(Archive, CutDataIsRefused) {
    const std::string text = lines(1000);
    for (const char* filter : {"gzip", "bzip2", "xz", "zstd"}) {
        SCOPED_TRACE(filter);
        const std::string packed = compressed(filter, text);
        for (std::size_t size = 20; size < packed.size(); size += 97)
            EXPECT_THAT(refusal_of(packed.substr(0, size)), StartsWith("x.zip: "));
    }
    const std::string zip = archive_of("zip", {{"a", text}});
    for (std::size_t size = 4; size < zip.size(); size += 97)
        EXPECT_THAT(refusal_of(zip.substr(0, size)), StartsWith("x.zip: no whole zip archive (")) << size;
    const std::string tar = archive_of("ustar", {{"a", text}});
    EXPECT_THAT(refusal_of(tar.substr(0, 700)), StartsWith("x.zip:a: cannot be unpacked; expected a whole file ("));
    EXPECT_THAT(refusal_of(tar.substr(0, 400)), StartsWith("x.zip: no whole tar archive ("));
}

TEST(Archive, DamageIsNoticed) {
    std::string zip = archive_of("zip", {{"a.rnx", lines(1000)}});
    zip[zip.size() / 2] = static_cast<char>(zip[zip.size() / 2] ^ 0x5a);
    EXPECT_THAT(refusal_of(zip), StartsWith("x.zip:a.rnx: cannot be unpacked; expected a whole file ("));
    std::string packed = compressed("bzip2", lines(1000));
    packed[packed.size() / 2] = static_cast<char>(packed[packed.size() / 2] ^ 0x5a);
    EXPECT_THAT(refusal_of(packed), StartsWith("x.zip: "));
}

TEST(Archive, BombsAreRefused) {
    const std::string zeros(std::size_t{24} << 20, '\0');
    EXPECT_THAT(refusal_of(compressed("gzip", zeros)), HasSubstr("x.zip: unpacks to more than 1048576 bytes"));
    EXPECT_THAT(refusal_of(archive_of("zip", {{"a", zeros}})),
                HasSubstr("x.zip:a: unpacks to more than 1048576 bytes"));
    const std::string half(600'000, 'x');
    EXPECT_THAT(refusal_of(archive_of("zip", {{"a", half}, {"b", half}})),
                HasSubstr("x.zip:b: unpacks to more than 1048576 bytes"))
        << "all together";
    EXPECT_THAT(refusal_of(compressed("bzip2", zeros), zeros.size()),
                AllOf(HasSubstr("unpacks to more than 2000 times its"), HasSubstr("bytes; expected")));
    EXPECT_TRUE(unpacked(compressed("gzip", zeros), "x", zeros.size()).has_value()) << "1000 times may be honest";
    std::vector<std::pair<std::string, std::string>> many;
    for (std::size_t i = 0; i <= most_archive_files; ++i)
        many.emplace_back(std::to_string(i), "");
    EXPECT_EQ(refusal_of(archive_of("ustar", many)), "x.zip: holds more than 100000 files, the most that is read");
}

TEST(Archive, NestedArchivesHaveADepth) {
    std::string zip = lines(10), gzip = zip;
    for (int i = 0; i < deepest_packing; ++i) {
        zip = archive_of("zip", {{std::to_string(i) + ".zip", zip}});
        gzip = compressed("gzip", gzip);
        EXPECT_EQ(unpacked(zip, "x", most_bytes).value(), lines(10));
        EXPECT_EQ(unpacked(gzip, "x", most_bytes).value(), lines(10));
    }
    EXPECT_EQ(refusal_of(archive_of("zip", {{"4.zip", zip}})),
              "x.zip:4.zip:3.zip:2.zip:1.zip: an archive in 4 others; expected 3 at most");
    EXPECT_EQ(refusal_of(compressed("gzip", gzip)), "x.zip: is compressed more than 4 times over; expected once");
}

TEST(Archive, RealFilesAreTheSamePacked) {
    SKYLOOP_REQUIRE_SHARED(data, "nav");
    for (const char* name : {"nav/brdc1820.10n", "nav/AMEL00NLD_R_20210010000_01D_MN.rnx", "precise/igs15904.sp3"}) {
        const std::string text = read_text_file(data.parent_path() / name).value();
        ASSERT_FALSE(text.empty());
        for (const char* filter : {"gzip", "compress", "bzip2", "xz", "zstd"})
            EXPECT_TRUE(unpacked(compressed(filter, text), "x", text.size()).value() == text) << name << filter;
        EXPECT_TRUE(unpacked(archive_of("zip", {{name, text}}), "x", text.size()).value() == text) << name;
    }
}

}  // namespace
}  // namespace skyloop
