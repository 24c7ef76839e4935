#include "base/core/random.hpp"
#include "client_bench.hpp"
#include "run/client/careful_client.hpp"
#include "run/client/configuration_dialogue.hpp"

namespace skyloop::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const UbxMessageId rate_id = CfgRate::message_id;
const UbxMessageId message_id = CfgMsg::message_id;

DialogueStep plain_step(UbxMessageId id) { return {id, encode_frame(id, Bytes{1})}; }

void acknowledge(ConfigurationDialogue& dialogue, UbxMessageId id, bool accepted = true) {
    dialogue.hear(accepted ? AckAck::message_id : AckNak::message_id, Bytes{id.message_class, id.id});
}

TEST(ConfigurationDialogue, RepeatsThreeTimesAndGoesOn) {
    ConfigurationDialogue dialogue({plain_step(rate_id), plain_step(message_id), plain_step(rate_id)});
    GpsTime now = bench_start;
    EXPECT_TRUE(dialogue.advance(now));
    EXPECT_FALSE(dialogue.advance(now + milliseconds(490)));
    EXPECT_TRUE(dialogue.advance(now + milliseconds(500)));
    EXPECT_TRUE(dialogue.advance(now + milliseconds(1000)));
    // The next step has one attempt of 0.2 s: the receiver has never answered.
    const auto second = dialogue.advance(now + milliseconds(1500));
    ASSERT_TRUE(second);
    EXPECT_EQ(*second, plain_step(message_id).request);
    EXPECT_TRUE(dialogue.advance(now + milliseconds(1700)));
    acknowledge(dialogue, rate_id);
    EXPECT_TRUE(dialogue.done());
    EXPECT_EQ(dialogue.unanswered(), 2);
    EXPECT_EQ(dialogue.confirmed(), 1);
}

TEST(ConfigurationDialogue, IsNotConfirmedByTheAnswerToAnotherMessage) {
    ConfigurationDialogue dialogue({plain_step(rate_id), plain_step(message_id)});
    dialogue.advance(bench_start);
    acknowledge(dialogue, message_id);
    EXPECT_EQ(dialogue.confirmed(), 0);
    acknowledge(dialogue, rate_id);
    EXPECT_EQ(dialogue.confirmed(), 1);
    acknowledge(dialogue, message_id);  // before it was asked
    EXPECT_EQ(dialogue.confirmed(), 1);
}

TEST(ConfigurationDialogue, EndsWhenSomethingNeededIsRefused) {
    DialogueStep needed = plain_step(message_id);
    needed.needed = true;
    ConfigurationDialogue dialogue({plain_step(rate_id), needed});
    dialogue.advance(bench_start);
    acknowledge(dialogue, rate_id, false);
    EXPECT_EQ(dialogue.failure(), "");
    dialogue.advance(bench_start);
    acknowledge(dialogue, message_id, false);
    EXPECT_EQ(dialogue.failure(), "the receiver refuses message 06-01");
    EXPECT_FALSE(dialogue.done());
    EXPECT_FALSE(dialogue.advance(bench_start + seconds(5)));
}

TEST(ConfigurationDialogue, WaitsForTheAnswerAndItsAcknowledgement) {
    DialogueStep poll = plain_step(rate_id);
    poll.answer = rate_id;
    poll.accept = [](ByteSpan payload) { return payload.size() == 6; };
    ConfigurationDialogue dialogue({poll});
    dialogue.advance(bench_start);
    dialogue.hear(rate_id, Bytes(5));  // not what was wanted
    acknowledge(dialogue, rate_id);
    EXPECT_FALSE(dialogue.done());
    dialogue.hear(rate_id, Bytes(6));
    EXPECT_TRUE(dialogue.done());
}

TEST(ConfigurationDialogue, ChangesTheSpeedUnlessThatIsRefused) {
    DialogueStep port = plain_step(CfgPrt::message_id);
    port.next_speed = 115200;
    ConfigurationDialogue unanswered({port, plain_step(rate_id)});
    unanswered.advance(bench_start);
    unanswered.advance(bench_start + milliseconds(250));
    EXPECT_EQ(unanswered.take_speed(), 115200u);
    EXPECT_FALSE(unanswered.take_speed());
    EXPECT_TRUE(unanswered.advance(bench_start + milliseconds(260)));

    ConfigurationDialogue refused({port, plain_step(rate_id)});
    refused.advance(bench_start);
    acknowledge(refused, CfgPrt::message_id, false);
    EXPECT_FALSE(refused.take_speed());
    EXPECT_TRUE(refused.advance(bench_start));
}

TEST(PortHunt, TriesEachSpeedAndBeginsAgainWithTheOneThatWorked) {
    PortHunt hunt({9600, 38400}, seconds(1));
    EXPECT_FALSE(hunt.hunting());
    hunt.start(bench_start);
    EXPECT_TRUE(hunt.advance(bench_start));
    EXPECT_EQ(hunt.speed(), 9600u);
    EXPECT_FALSE(hunt.advance(bench_start + milliseconds(900)));
    EXPECT_TRUE(hunt.advance(bench_start + seconds(1)));
    EXPECT_EQ(hunt.speed(), 38400u);
    hunt.found();
    EXPECT_FALSE(hunt.advance(bench_start + seconds(9)));
    hunt.start(bench_start + seconds(10));
    EXPECT_TRUE(hunt.advance(bench_start + seconds(10)));
    EXPECT_EQ(hunt.speed(), 38400u);
    EXPECT_TRUE(hunt.advance(bench_start + seconds(11)));
    EXPECT_EQ(hunt.speed(), 9600u);
}

// Whatever comes, no client falls over or trusts it.
TEST(ScriptedClients, SurviveAnyBytes) {
    for (const std::string_view name : client_names()) {
        ClientBench bench(name);
        RandomStream random(7, std::string(name));
        for (int i = 0; i < 2000; ++i) {
            NavPvt pvt;
            Bytes payload = encode_payload(pvt);
            for (std::uint8_t& byte : payload)
                byte = static_cast<std::uint8_t>(random.uniform() * 256);
            bench.say(ByteSpan(encode_frame(NavPvt::message_id, payload)));
            payload.resize(static_cast<std::size_t>(random.uniform() * 80));
            bench.say(ByteSpan(payload));
            bench.pass(milliseconds(50));
            if (name.starts_with("careful")) {
                ASSERT_FALSE(bench.trusts()) << bench.reason();
            }
        }
    }
}

}  // namespace
}  // namespace skyloop::test
