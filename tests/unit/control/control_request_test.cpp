#include "run/control/control_request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run/control/status_json.hpp"
#include "snapshots.hpp"

namespace skyloop::test {
namespace {

using testing::HasSubstr;

/// A server without sockets.
struct Desk {
    AccessRules rules{"", "127.0.0.1", true};
    std::vector<Command> pushed{};
    bool full = false, measuring = true;
    std::vector<std::string> receivers{"front", "rear"};

    ControlResponse ask(const ControlRequest& request) {
        ControlSources sources;
        sources.snapshot = std::make_shared<const StatusSnapshot>(small_snapshot());
        sources.push = [this](Command command) {
            if (!full) pushed.push_back(std::move(command));
            return !full;
        };
        sources.receivers = &receivers;
        sources.measuring = measuring;
        sources.version = "1.2.3";
        return answer(request, rules, sources);
    }
    ControlResponse get(std::string target) { return ask({"GET", std::move(target), {{"Host", "127.0.0.1:80"}}, {}}); }
    ControlResponse post(std::string target, std::string body) {
        return ask({"POST",
                    std::move(target),
                    {{"Host", "localhost"}, {"Content-Type", "application/json"}},
                    std::move(body)});
    }
};

std::string error_of(const ControlResponse& response) {
    EXPECT_EQ(response.body.find('\n'), std::string::npos);
    return nlohmann::json::parse(response.body).at("error").get<std::string>();
}

TEST(ControlRequest, AnswersWhatIsAsked) {
    Desk desk;
    for (const char* target : {"/api/status", "/api/faults", "/api/timeline", "/api/commands", "/api/openapi.json"}) {
        const ControlResponse response = desk.get(target);
        EXPECT_EQ(response.status, 200) << target;
        EXPECT_TRUE(nlohmann::json::accept(response.body)) << target;
    }
    EXPECT_EQ(desk.get("/api/scene").status, 404);
    EXPECT_EQ(desk.get("/api/stream").status, 426);
    EXPECT_EQ(desk.get("/api/nothing").status, 404);
    const ControlResponse page = desk.get("/");
    EXPECT_EQ(page.content_type, "text/html; charset=utf-8");
    EXPECT_THAT(page.body, HasSubstr("<title>"));
    EXPECT_EQ(desk.get("/../etc/passwd").status, 404);
}

TEST(ControlRequest, HeadIsWhereGetIs) {
    Desk desk;
    for (const char* target : {"/", "/api/timeline", "/api/commands", "/api/scene", "/api/nothing"}) {
        const ControlResponse told = desk.ask({"HEAD", target, {{"Host", "localhost"}}, {}}), whole = desk.get(target);
        EXPECT_EQ(told.status, whole.status) << target;
        EXPECT_EQ(told.body.size(), whole.body.size()) << "the server tells its length, " << target;
    }
    EXPECT_EQ(desk.ask({"HEAD", "/api/faults/x", {{"Host", "localhost"}}, {}}).status, 405);
}

TEST(ControlRequest, QueuesCommands) {
    Desk desk;
    EXPECT_EQ(desk.post("/api/commands", R"({"command":"pause"})").status, 202);
    ASSERT_EQ(desk.pushed.size(), 1U);
    EXPECT_EQ(desk.pushed[0].verb, CommandVerb::pause);
    const ControlResponse wrong = desk.post("/api/commands", R"({"command":"pauze"})");
    EXPECT_EQ(wrong.status, 422);
    EXPECT_THAT(error_of(wrong), HasSubstr("did you mean 'pause'?"));
    EXPECT_EQ(desk.pushed.size(), 1U);
    desk.full = true;
    EXPECT_EQ(desk.post("/api/commands", R"({"command":"resume"})").status, 429);
}

TEST(ControlRequest, RefusesCommandsForNobody) {
    Desk desk;
    EXPECT_EQ(desk.post("/api/faults", R"({"kind":"outage","receiver":"front"})").status, 202);
    EXPECT_EQ(desk.post("/api/commands", R"({"command":"start_fault","fault":"wet plug"})").status, 202);
    EXPECT_EQ(desk.pushed.size(), 2U);
    const ControlResponse fault = desk.post("/api/faults", R"({"kind":"outage","receiver":"frnt"})");
    EXPECT_EQ(fault.status, 422);
    EXPECT_EQ(error_of(fault), "'receiver' is 'frnt'; expected one of front, rear, or none for all of them");
    const ControlResponse several = desk.post("/api/commands", R"({"command":"restart","receiver":"front,rear"})");
    EXPECT_EQ(several.status, 422);
    EXPECT_THAT(error_of(several), HasSubstr("'receiver' is 'front,rear'"));
    const ControlResponse unknown = desk.post("/api/commands", R"({"command":"start_fault","fault":"dry plug"})");
    EXPECT_EQ(unknown.status, 422);
    EXPECT_THAT(error_of(unknown), HasSubstr("'fault' is 'dry plug'"));
    EXPECT_EQ(desk.pushed.size(), 2U);
}

TEST(ControlRequest, TellsWhatALiveFaultIsCalled) {
    Desk desk;
    const auto called = [&](const std::string& body) {
        const ControlResponse response = desk.post("/api/faults", body);
        return nlohmann::json::parse(response.body).at("accepted").at("name").get<std::string>();
    };
    EXPECT_EQ(called(R"({"kind":"outage"})"), "outage");
    EXPECT_EQ(called(R"({"kind":"byte_loss","name":"wet plug"})"), "wet plug 2");
    EXPECT_EQ(desk.pushed.back().parameters.text("name"), "wet plug") << "by which it may be stopped, too";
}

TEST(ControlRequest, RefusesFaultsOfMeasurementsWhereNoneAreMade) {
    Desk desk;
    EXPECT_EQ(desk.post("/api/faults", R"({"kind":"cycle_slips"})").status, 202);
    desk.measuring = false;
    const ControlResponse slips = desk.post("/api/faults", R"({"kind":"cycle_slips"})");
    EXPECT_EQ(slips.status, 422);
    EXPECT_THAT(error_of(slips), HasSubstr("'kind' is 'cycle_slips', which spoils measurements"));
    EXPECT_EQ(desk.post("/api/faults", R"({"kind":"outage"})").status, 202);
}

TEST(ControlRequest, StopsAFaultByItsNameInThePath) {
    Desk desk;
    const auto remove = [&](std::string path) {
        return desk.ask({"DELETE", std::move(path), {{"Host", "127.0.0.1"}}, {}}).status;
    };
    EXPECT_EQ(remove("/api/faults/wet%20plug"), 202);
    ASSERT_EQ(desk.pushed.size(), 1U);
    EXPECT_EQ(desk.pushed[0].verb, CommandVerb::stop_fault);
    EXPECT_EQ(desk.pushed[0].parameters.text("fault"), "wet plug");
    EXPECT_EQ(remove("/api/faults/dry"), 404);
    EXPECT_EQ(remove("/api/faults/"), 400);
    EXPECT_EQ(remove("/api/faults/%4"), 400);
    EXPECT_EQ(remove("/api/status"), 405);
    EXPECT_EQ(desk.pushed.size(), 1U);
}

TEST(ControlRequest, RefusesForeignHosts) {
    Desk desk;
    const auto status = [&](const std::string& host) {
        return desk.ask({"GET", "/api/status", {{"Host", host}}, {}}).status;
    };
    for (const char* host : {"127.0.0.1:8080", "localhost", "[::1]:1", "LocalHost:80", "localhost.", "localhost.:80",
                             "[0:0:0:0:0:0:0:1]", "127.0.0.9"})
        EXPECT_EQ(status(host), 200) << host;
    for (const char* host :
         {"evil.example", "127.0.0.1.evil.example", "192.168.1.5", ".", "localhost.evil.example", "[::2]", "[::1"})
        EXPECT_EQ(status(host), 421) << host;
    EXPECT_EQ(desk.ask({"GET", "/api/status", {{"Host", "localhost"}, {"host", "evil"}}, {}}).status, 400);
    EXPECT_EQ(desk.ask({"GET", "/api/status", {}, {}}).status, 400);
    EXPECT_EQ(desk.ask({"GET", "/api/status", {}, {}, 10}).status, 200) << "HTTP/1.0 has no Host";
    EXPECT_EQ(desk.ask({"GET", "/api/status", {{"Host", "evil.example"}}, {}, 10}).status, 421);
    desk.rules = {"", "0.0.0.0", false};
    EXPECT_EQ(status("192.168.1.5:8080"), 200);
    EXPECT_EQ(status("evil.example"), 421);
    desk.rules = {"s3cret", "0.0.0.0", false};
    const auto shown = [&](const std::string& token) {
        return desk
            .ask({"GET", "/api/status", {{"Host", "raspberrypi.local:80"}, {"Authorization", "Bearer " + token}}, {}})
            .status;
    };
    EXPECT_EQ(shown("s3cret"), 200) << "a foreign page does not know the token";
    EXPECT_EQ(shown("guess"), 421);
    EXPECT_EQ(desk.ask({"GET", "/", {{"Host", "raspberrypi.local:80"}}, {}}).status, 200);
    desk.rules.loopback = true;
    EXPECT_EQ(shown("s3cret"), 421);
    desk.rules = {"", "Pi.local", true};
    EXPECT_EQ(status("pi.Local:1"), 200);
}

TEST(ControlRequest, MayNameTheServerInItsTarget) {
    Desk desk;
    const auto asked = [](std::string target) {
        ControlRequest request{"GET", std::move(target), {{"host", "a"}, {"Accept", "*/*"}}, {}};
        request.take_absolute_form();
        return request;
    };
    const ControlRequest status = asked("HTTP://127.0.0.1:8080/api/status?rate=2");
    EXPECT_EQ(status.path(), "/api/status");
    EXPECT_EQ(status.query("rate"), "2");
    EXPECT_EQ(status.header("Host"), "127.0.0.1:8080");
    EXPECT_EQ(status.header("Accept"), "*/*");
    EXPECT_EQ(desk.ask(status).status, 200);
    EXPECT_EQ(desk.ask(asked("http://localhost")).status, 200);
    EXPECT_EQ(asked("http://localhost?x=1").target, "/?x=1");
    EXPECT_EQ(desk.ask(asked("http://evil.example/api/status")).status, 421);
    EXPECT_EQ(desk.ask(asked("http:///api/status")).status, 400);
    EXPECT_EQ(asked("/http://a/").header("Host"), "a") << "a path is left alone";
}

TEST(ControlRequest, RefusesPagesOfOtherSites) {
    Desk desk;
    const auto status = [&](const std::string& origin) {
        return desk
            .ask({"POST",
                  "/api/commands",
                  {{"Host", "127.0.0.1:8080"}, {"Origin", origin}, {"Content-Type", "application/json"}},
                  R"({"command":"pause"})"})
            .status;
    };
    EXPECT_EQ(status("http://127.0.0.1:8080"), 202);
    EXPECT_EQ(status("http://evil.example"), 403);
    EXPECT_EQ(status("http://127.0.0.1:9090"), 403);
    EXPECT_EQ(status("https://127.0.0.1:8080"), 403);
    EXPECT_EQ(status("null"), 403);
    EXPECT_EQ(desk.pushed.size(), 1U);
}

TEST(ControlRequest, WantsTheTokenBelowApiAlone) {
    Desk desk;
    desk.rules.token = "s3cret";
    const auto status = [&](std::string name, std::string value) {
        return desk.ask({"GET", "/api/status", {{"Host", "localhost"}, {std::move(name), std::move(value)}}, {}})
            .status;
    };
    EXPECT_EQ(status("Authorization", "Bearer s3cret"), 200);
    EXPECT_EQ(status("Authorization", "bearer s3cret"), 200);
    EXPECT_EQ(status("Authorization", "BEARER  s3cret "), 200);
    EXPECT_EQ(status("sec-websocket-protocol", "skyloop, bearer.s3cret"), 200);
    EXPECT_EQ(status("Authorization", "Bearer s3creT"), 401);
    EXPECT_EQ(status("Authorization", "Bearer s3cret0"), 401);
    EXPECT_EQ(status("Authorization", "Bearer "), 401);
    EXPECT_EQ(status("Authorization", "s3cret"), 401);
    EXPECT_EQ(status("Authorization", "bearer"), 401);
    EXPECT_EQ(status("Authorization", ""), 401);
    EXPECT_EQ(status("X-Other", ""), 401);
    EXPECT_EQ(desk.get("/").status, 200);
}

TEST(ControlRequest, TakesJsonOfItsSizeAlone) {
    Desk desk;
    EXPECT_EQ(desk.ask({"POST",
                        "/api/commands",
                        {{"Host", "localhost"}, {"Content-Type", "text/plain"}},
                        R"({"command":"pause"})"})
                  .status,
              415);
    EXPECT_EQ(desk.post("/api/commands", std::string(70000, ' ')).status, 413);
    EXPECT_EQ(desk.ask({"PUT", "/api/commands", {{"Host", "localhost"}}, {}}).status, 405);
    for (const char* method : {"P", "", "T, P", "get"})
        EXPECT_EQ(desk.ask({method,
                            "/api/commands",
                            {{"Host", "localhost"}, {"Content-Type", "application/json"}},
                            R"({"command":"pause"})"})
                      .status,
                  405);
    EXPECT_TRUE(desk.pushed.empty());
}

// RFC 9110, sections 8.3.1 and 5.6.6.
TEST(ControlRequest, TakesEveryWritingOfItsMediaType) {
    Desk desk;
    const auto status = [&](std::string type) {
        return desk
            .ask({"POST",
                  "/api/commands",
                  {{"Host", "localhost"}, {"Content-Type", std::move(type)}},
                  R"({"command":"pause"})"})
            .status;
    };
    for (const char* type : {"Application/JSON", "application/json ; charset=utf-8", "application/json;charset=UTF-8"})
        EXPECT_EQ(status(type), 202) << type;
    for (const char* type : {"", " ", ";", "application/jsonx", "application/json+x", "text/json"})
        EXPECT_EQ(status(type), 415) << type;
}

// Whatever a server without sockets answers stands in the description.
TEST(ControlRequest, DescribesEveryAnswer) {
    const auto paths = nlohmann::json::parse(openapi_json("1.2.3"))["paths"];
    Desk desk;
    const std::pair<std::string, std::string> json{"Content-Type", "application/json"};
    const std::pair<std::string, std::string> methods[] = {{"GET", "get"}, {"POST", "post"}, {"DELETE", "delete"}};
    for (const auto& [path, operations] : paths.items())
        for (const auto& [method, operation] : methods) {
            if (!operations.contains(operation)) continue;
            const std::string target = path == "/api/faults/{name}" ? "/api/faults/wet%20plug" : path;
            const auto expect_described = [&desk, responses = operations[operation]["responses"],
                                           what = method + " " + path](const ControlRequest& request) {
                const std::string status = std::to_string(desk.ask(request).status);
                EXPECT_TRUE(responses.contains(status)) << what << status;
            };
            desk.rules.token.clear();
            expect_described({method, target, {{"Host", "localhost"}, json}, "{}"});
            expect_described({method, target, {{"Host", "localhost"}, json}, std::string(R"({"command":"pause"})")});
            expect_described({method, target, {{"Host", "evil.example"}, json}, {}});
            expect_described({method, target, {{"Host", "localhost"}, {"Origin", "http://evil.example"}}, {}});
            expect_described({method, target, {}, {}});
            desk.rules.token = "s3cret";
            expect_described({method, target, {{"Host", "localhost"}, json}, {}});
        }
    EXPECT_TRUE(paths["/api/stream"]["get"]["responses"].contains("101"));
}

// The members that the status has, and no others.
TEST(ControlRequest, DescribesTheCorrectionsOfTheStatus) {
    StatusSnapshot snapshot = small_snapshot();
    CorrectionsStatus& corrections = snapshot.receivers[0].corrections.emplace();
    corrections.base.emplace();
    corrections.baseline.emplace();
    const auto told = nlohmann::json::parse(status_json(snapshot))["receivers"][0]["corrections"];
    const auto json = nlohmann::json::parse(openapi_json("1.2.3"));
    const auto& schemas = json["components"]["schemas"];
    const auto& answer = json["paths"]["/api/status"]["get"]["responses"]["200"]["content"]["application/json"];
    EXPECT_EQ(answer["schema"]["$ref"], "#/components/schemas/Status");
    const auto& receiver = schemas["Status"]["properties"]["receivers"]["items"];
    EXPECT_EQ(receiver["properties"]["corrections"]["$ref"], "#/components/schemas/Corrections");
    const auto expect_same_members = [](const auto& schema, const auto& value) {
        EXPECT_EQ(schema["properties"].size(), value.size());
        for (const auto& [name, member] : value.items())
            EXPECT_TRUE(schema["properties"].contains(name)) << name;
    };
    expect_same_members(schemas["Corrections"], told);
    for (const char* part : {"base", "baseline"})
        expect_same_members(schemas["Corrections"]["properties"][part], told[part]);
    EXPECT_EQ(schemas["Corrections"]["required"].size(), told.size());
    EXPECT_EQ(schemas["Corrections"]["properties"]["solution"]["enum"].size(), correction_words.size());
}

TEST(ControlRequest, DescribesItselfByTheSameTables) {
    const auto json = nlohmann::json::parse(openapi_json("1.2.3"));
    EXPECT_EQ(json["openapi"], "3.1.0");
    EXPECT_EQ(json["info"]["version"], "1.2.3");
    EXPECT_EQ(json["components"]["schemas"]["Command"]["oneOf"].size(), command_kinds().size());
    const auto& first = json["components"]["schemas"]["Command"]["oneOf"][0];
    EXPECT_EQ(first["properties"]["command"]["const"], command_kinds()[0].name);
    EXPECT_EQ(first["required"][0], "command");
    EXPECT_TRUE(json["paths"]["/api/commands"].contains("post"));
    EXPECT_TRUE(json["paths"]["/api/faults/{name}"].contains("delete"));
    const auto& error = json["paths"]["/api/commands"]["post"]["responses"]["422"]["content"]["application/json"];
    EXPECT_EQ(error["schema"]["$ref"], "#/components/schemas/Error");
    EXPECT_EQ(json["components"]["schemas"]["Error"]["properties"]["error"]["type"], "string");
}

}  // namespace
}  // namespace skyloop::test
