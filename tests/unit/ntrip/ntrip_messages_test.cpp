#include "wire/ntrip/ntrip_messages.hpp"

#include <gtest/gtest.h>

#include "wire/ntrip/source_table.hpp"

namespace skyloop {
namespace {

NtripAddress address_of(std::string_view uri) {
    auto address = parse_ntrip_uri(uri);
    EXPECT_TRUE(address) << (address ? "" : address.error().message);
    return address.value_or(NtripAddress{});
}

std::string mistake_in(std::string_view uri) {
    const auto address = parse_ntrip_uri(uri);
    return address ? "" : address.error().message;
}

TEST(NtripAddress, HasPartsAndDefaults) {
    const NtripAddress full = address_of("ntrip://me:s%40cr%2Fet%25@caster.example:2110/BASE0");
    EXPECT_EQ(full.caster.host, "caster.example");
    EXPECT_EQ(full.caster.port, 2110);
    EXPECT_EQ(full.user, "me");
    EXPECT_EQ(full.password, "s@cr/et%");
    EXPECT_EQ(full.mount, "BASE0");
    EXPECT_FALSE(full.tls);
    const NtripAddress bare = address_of("ntrip://10.0.0.1/A");
    EXPECT_EQ(bare.caster.port, 2101);
    EXPECT_TRUE(bare.user.empty());
    const NtripAddress secure = address_of("ntrips://[::1]/A");
    EXPECT_TRUE(secure.tls);
    EXPECT_EQ(secure.caster.host, "::1");
    EXPECT_EQ(secure.caster.port, 2102);
    EXPECT_EQ(address_of("ntrip://a@b.example:p@h/M").user, "a@b.example");
}

TEST(NtripAddress, SaysWhatIsWrongWithoutSecrets) {
    EXPECT_EQ(mistake_in("ntrip://me:secret@host:2101"),
              "'ntrip://host:2101': the mount point is missing; expected ntrip://[USER:PASSWORD@]HOST[:PORT]/MOUNT");
    for (const char* wrong :
         {"http://h/M", "ntrip://me:secret@/M", "ntrip://me:secret@h:0/M", "ntrip://me:secret@h:x/M",
          "ntrip://me:sec%2ret@h/M", "ntrip://me:secret@h/A%20B", "ntrip://me:secret%0Ax@h/M", "ntrip://:secret@h/M",
          "ntrip://me:secret@h/M/N", "secret@h", "ntrip://me:secret@h/"}) {
        EXPECT_NE(mistake_in(wrong), "") << wrong;
        EXPECT_EQ(mistake_in(wrong).find("sec"), std::string::npos) << mistake_in(wrong);
    }
}

TEST(NtripAddress, IsShownWithoutSecrets) {
    EXPECT_EQ(shown_uri(address_of("ntrip://me:secret@host/M")), "ntrip://host:2101/M");
    EXPECT_EQ(shown_uri(address_of("ntrip://host/A%40b%25")), "ntrip://host:2101/A%40b%25");
    EXPECT_EQ(without_secrets("uart2=ntrip://me:se@cret@host:1/M"), "uart2=ntrip://host:1/M");
    EXPECT_EQ(without_secrets("ntrip://host/M"), "ntrip://host/M");
}

// RFC 4648, section 10.
TEST(Base64, HasTheTestVectorsOfItsStandard) {
    for (const auto& [plain, coded] : {std::pair{"", ""},
                                       {"f", "Zg=="},
                                       {"fo", "Zm8="},
                                       {"foo", "Zm9v"},
                                       {"foob", "Zm9vYg=="},
                                       {"fooba", "Zm9vYmE="},
                                       {"foobar", "Zm9vYmFy"}}) {
        EXPECT_EQ(base64(plain), coded);
        EXPECT_EQ(base64_decoded(coded), plain);
    }
    for (const char* wrong : {"Z", "Zg=", "Z===", "Zm9v!A==", "Zg==Zg=="})
        EXPECT_EQ(base64_decoded(wrong), std::nullopt) << wrong;
}

TEST(NtripRequest, IsReadAsItWasWritten) {
    const NtripAddress address = address_of("ntrip://me:a:b@host:2110/M");
    for (const int version : {1, 2}) {
        const auto request = parse_ntrip_request(ntrip_request_text(address, "M", version, "$GPGGA,1*00"));
        ASSERT_TRUE(request);
        EXPECT_EQ(request->method, "GET");
        EXPECT_EQ(request->mount, "M");
        EXPECT_EQ(request->version, version);
        EXPECT_EQ(request->chunked, version == 2);
        EXPECT_EQ(request->user, "me");
        EXPECT_EQ(request->password, "a:b");
        EXPECT_EQ(request->gga, version == 2 ? "$GPGGA,1*00" : "");
    }
}

TEST(NtripRequest, OfVersion2IsHttpWithItsHeaders) {
    EXPECT_EQ(ntrip_request_text(address_of("ntrip://me:pw@host:2110/M"), "M", 2, ""),
              "GET /M HTTP/1.1\r\nHost: host:2110\r\nNtrip-Version: Ntrip/2.0\r\nUser-Agent: NTRIP skyloop/1.0\r\n"
              "Authorization: Basic bWU6cHc=\r\nConnection: close\r\n\r\n");
    EXPECT_EQ(ntrip_request_text(address_of("ntrip://host/M"), "", 1, "$GPGGA"),
              "GET / HTTP/1.0\r\nUser-Agent: NTRIP skyloop/1.0\r\nConnection: close\r\n\r\n");
}

TEST(NtripRequest, ThatIsNoneIsNone) {
    for (const char* wrong : {"", "\r\n\r\n", "GET\r\n\r\n", "SOURCE secret /M\r\n\r\n", "GET /M HTTP/3.7\r\n\r\n",
                              "GET M HTTP/1.0\r\n\r\n", "GET /M HTTP/1.0\r\nA b\r\n\r\n", "GET /M HTTP/1.0\r\n"})
        EXPECT_FALSE(parse_ntrip_request(wrong)) << wrong;
    const auto odd = parse_ntrip_request("GET /M?a=b HTTP/1.1\r\nAuthorization: Basic !!\r\n\r\n");
    ASSERT_TRUE(odd);
    EXPECT_EQ(odd->mount, "M");
    EXPECT_EQ(odd->user, "");
    EXPECT_EQ(odd->version, 1);
}

TEST(NtripAnswers, TellVersionsApart) {
    NtripRequest old, two;
    two.version = 2;
    two.chunked = true;
    EXPECT_EQ(ntrip_stream_answer(old), "ICY 200 OK\r\n\r\n");
    EXPECT_NE(ntrip_stream_answer(two).find("\r\nTransfer-Encoding: chunked\r\n\r\n"), std::string::npos);
    EXPECT_TRUE(ntrip_missing_answer(old, "T").starts_with("SOURCETABLE 200 OK\r\n"));
    EXPECT_TRUE(ntrip_missing_answer(two, "T").starts_with("HTTP/1.1 404 Not Found\r\n"));
    EXPECT_TRUE(ntrip_password_answer(old).starts_with("HTTP/1.0 401 Unauthorized\r\n"));
    for (const NtripRequest& request : {old, two})
        EXPECT_NE(ntrip_password_answer(request).find("WWW-Authenticate: Basic realm="), std::string::npos);
    EXPECT_EQ(ntrip_chunk("0123456789abcdef"), "10\r\n0123456789abcdef\r\n");
}

TEST(NtripPassword, IsComparedWhole) {
    EXPECT_TRUE(same_password("secret", "secret"));
    EXPECT_TRUE(same_password("", ""));
    for (const char* wrong : {"", "secre", "secret ", "Secret", "secretsecret"})
        EXPECT_FALSE(same_password(wrong, "secret")) << wrong;
    EXPECT_FALSE(same_password("x", ""));
}

TEST(PositionSentence, HasAChecksumAndAPlace) {
    EXPECT_TRUE(is_position_sentence("$GPGGA,092725.00,4717.11399,N,00833.91590,E,1,08,1.01,499.6,M,48.0,M,,*5B"));
    for (const char* wrong : {"", "$GPGGA,092725.00,4717.11399,N,00833.91590,E,1,08,1.01,499.6,M,48.0,M,,*5C",
                              "$GPGGA,092725.00,,,,,0,00,99.99,,,,,,*6B", "$GPGGA*", "$GPRMC,1,2,3,4,5*00", "5B\r\n"})
        EXPECT_FALSE(is_position_sentence(wrong)) << wrong;
}

TEST(SourceTable, HasTheFieldsOfItsStandard) {
    SourceRecord record;
    record.mount = "BASE";
    record.identifier = "a;b\n";
    record.details = "1005(10),1077(1)";
    record.carrier = 2;
    record.systems = "GPS+GLO";
    record.latitude_deg = 46.4775;
    record.longitude_deg = -30.7326;
    record.needs_password = true;
    record.bit_rate = 4800;
    EXPECT_EQ(source_line(record),
              "STR;BASE;a b ;RTCM 3.3;1005(10),1077(1);2;GPS+GLO;none;;46.48;-30.73;0;0;skyloop;none;B;N;4800;\r\n");
    const std::string table = source_table({source_line(record), "NET;x;y\r\n", "STR;OTHER;\r\n"});
    EXPECT_TRUE(table.ends_with("ENDSOURCETABLE\r\n"));
    EXPECT_EQ(mounts_of(table), (std::vector<std::string>{"BASE", "OTHER"}));
    EXPECT_TRUE(mounts_of("STR;").empty());
}

}  // namespace
}  // namespace skyloop
