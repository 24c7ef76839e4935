#include <gtest/gtest.h>

#include "receiver/protocol/ubx_hardware.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "ubx_reports.hpp"

namespace skyloop::firmware {
namespace {

UbxReport high_precision() {
    UbxReport f9(9);
    f9.board.identity.extensions = {"ROM BASE 0x118B2060", "FWVER=HPG 1.32", "PROTVER=27.31"};
    f9.board.dual_frequency = true;
    return f9;
}

TEST(MonVerMessage, FillsTextsUpWithZeros) {
    const UbxReport m8(8);
    const auto m = m8.report<MonVer>();
    EXPECT_STREQ(m.sw_version.data(), "ROM CORE 3.01 (107888)");
    EXPECT_STREQ(m.hw_version.data(), "00080000");
    EXPECT_EQ(m.hw_version[9], '\0');
    ASSERT_EQ(m.extensions.size(), 2u);
    EXPECT_STREQ(m.extensions[1].data(), "PROTVER=18.00");
    EXPECT_EQ(m.extensions[1][29], '\0');
}

TEST(MonGnssMessage, SaysWhatIsOn) {
    UbxReport m9(9);
    EXPECT_EQ(m9.report<MonGnss>().supported, 0x0F);
    EXPECT_EQ(m9.report<MonGnss>().default_gnss, 0x09);
    EXPECT_EQ(m9.report<MonGnss>().simultaneous, 3);
    m9.config.set(in_ram, 0x10310025, 1);
    m9.config.set(in_ram, 0x10310021, 0);
    EXPECT_EQ(m9.report<MonGnss>().enabled & 0x0A, 0x02);
}

// RECEIVER.md 2.3, 3.2.
TEST(MonHwMessage, HasThreeForms) {
    EXPECT_EQ(UbxReport(6).frames(MonHw::message_id)[0].size(), 68u + 8);
    EXPECT_EQ(UbxReport(8).frames(MonHw::message_id)[0].size(), 60u + 8);
    EXPECT_EQ(UbxReport(9).frames(MonHw::message_id)[0].size(), 56u + 8);
    EXPECT_EQ(high_precision().frames(MonHw::message_id)[0].size(), 60u + 8);
}

TEST(MonHwMessage, ReportsTheMonitors) {
    UbxReport m8(8);
    m8.state.monitors = {{2, 300, 9000, 100000}, {}, AntennaStatus::short_circuit, 0, SpoofingIndication::none};
    const auto m = m8.report<MonHw>();
    EXPECT_EQ(m.a_status, 3);
    EXPECT_EQ(m.a_power, 0);
    EXPECT_EQ(m.flags, 0x09);
    EXPECT_EQ(m.jam_ind, 255);
    EXPECT_EQ(m.agc_cnt, 8191);
    EXPECT_EQ(m.noise_per_ms, 65535);
}

TEST(MonRfMessage, HasABlockForEachFrontEnd) {
    EXPECT_EQ(UbxReport(9).report<MonRf>().blocks.size(), 1u);
    const auto m = high_precision().report<MonRf>();
    ASSERT_EQ(m.blocks.size(), 2u);
    EXPECT_EQ(m.blocks[1].block_id, 1);
    EXPECT_EQ(m.blocks[0].flags, 1);
    EXPECT_EQ(m.blocks[0].ant_status, 2);
    EXPECT_EQ(m.blocks[0].jam_ind, 14);
    EXPECT_EQ(m.blocks[0].noise_per_ms, 69);
}

TEST(MonRfMessage, TellsEachBandByItself) {
    UbxReport report = high_precision();
    report.state.monitors.lower = {2, 120, 2700, 300};
    const auto m = report.report<MonRf>();
    EXPECT_EQ(m.blocks[0].flags, 1);
    EXPECT_EQ(m.blocks[0].jam_ind, 14);
    EXPECT_EQ(m.blocks[1].flags, 2);
    EXPECT_EQ(m.blocks[1].jam_ind, 120);
    EXPECT_EQ(m.blocks[1].agc_cnt, 2700);
    EXPECT_EQ(m.blocks[1].noise_per_ms, 300);
    EXPECT_EQ(report.report<MonSpan>().blocks[0].pga, high_precision().report<MonSpan>().blocks[0].pga);
    EXPECT_LT(report.report<MonSpan>().blocks[1].pga, report.report<MonSpan>().blocks[0].pga);
}

TEST(MonHardwareMessages, AreThere) {
    EXPECT_EQ(UbxReport(9).report<MonHw3>().pins.size(), 17u);
    EXPECT_STREQ(UbxReport(9).report<MonHw3>().hw_version.data(), "00190000");
    EXPECT_EQ(UbxReport(8).report<MonHw2>().cfg_source, 114);
    UbxReport quiet(9), jammed(9);
    jammed.state.monitors.upper.jamming_indicator = 200;
    const auto calm = quiet.report<MonSpan>(), loud = jammed.report<MonSpan>();
    EXPECT_GT(loud.blocks[0].spectrum[127], calm.blocks[0].spectrum[127] + 20);
    EXPECT_EQ(loud.blocks[0].spectrum[0], calm.blocks[0].spectrum[0]);
}

// As an X20P does and an F9P does not (RECEIVER.md 3.2).
TEST(MonPortMessages, NewerFirmwareTellsByWhichPortMonCommsLeaves) {
    UbxReport f10(10);
    EXPECT_EQ(f10.report<MonComms>().tx_errors, 0);
    f10.board.comms_output_port = true;
    EXPECT_EQ(f10.report<MonComms>().tx_errors, 2 << 2);
    PortStatus full;
    full.transmit_full = true;
    f10.ports = {full};
    EpochMessages made(f10.context());
    constexpr std::size_t tx_errors_of_frame = 6 + 2;
    EXPECT_EQ(made.of(MonComms::message_id, PortId::uart1, {}).at(0).at(tx_errors_of_frame), 2 << 2 | 2);
    EXPECT_EQ(made.of(MonComms::message_id, PortId::usb, {}).at(0).at(tx_errors_of_frame), 4 << 2 | 2);
}

TEST(MonPortMessages, CountBytesAndMessages) {
    UbxReport f9 = high_precision();
    PortStatus uart2;
    uart2.id = PortId::uart2;
    uart2.pending = 100000;
    uart2.bytes_out = 0x1'0000'0005;
    uart2.bytes_in = 7;
    uart2.usage_percent = 12;
    uart2.peak_usage_percent = 34;
    uart2.messages_in = {1, 2, 3, 4};
    uart2.skipped = 5;
    uart2.overruns = 6;
    uart2.transmit_full = true;
    f9.ports = {PortStatus{}, uart2};
    const auto comms = f9.report<MonComms>();
    EXPECT_EQ(comms.tx_errors, 2);
    EXPECT_EQ(comms.prot_ids, (std::array<std::uint8_t, 4>{0, 1, 5, 6}));
    ASSERT_EQ(comms.ports.size(), 1u);  // nothing has gone over the first
    EXPECT_EQ(comms.ports[0].port_id, 0x0201);
    EXPECT_EQ(comms.ports[0].tx_pending, 65535);
    EXPECT_EQ(comms.ports[0].tx_bytes, 5u);
    EXPECT_EQ(comms.ports[0].msgs[3], 4);
    const auto buffers = f9.report<MonTxbuf>();
    EXPECT_EQ(buffers.usage[2], 12);
    EXPECT_EQ(buffers.t_peak_usage, 34);
    EXPECT_EQ(buffers.errors, 0x84);
    EXPECT_EQ(f9.report<MonIo>().ports[2].overrun_errs, 6);
    EXPECT_EQ(f9.report<MonMsgpp>().msg[2 * 8 + 5], 3);
    EXPECT_EQ(f9.report<MonMsgpp>().skipped[2], 5u);
    EXPECT_EQ(f9.frames(MonRxbuf::message_id)[0].size(), 24u + 8);
    UbxReport m9(9);
    m9.ports = {uart2};
    EXPECT_EQ(m9.report<MonComms>().ports[0].port_id, 0x0200);
    EXPECT_EQ(m9.report<MonComms>().prot_ids[3], 255);
}

TEST(MonSystemMessages, AreThere) {
    UbxReport f9(9);
    EXPECT_EQ(f9.report<MonSys>().run_time, 456u);
    EXPECT_LT(f9.report<MonSys>().cpu_load, 30);
    EXPECT_EQ(f9.report<MonPatch>().n_entries, 0);
    EXPECT_EQ(f9.report<MonRxr>().flags, 1);
}

TEST(SecUniqidMessage, HasTwoVersions) {
    const auto m9 = UbxReport(9).report<SecUniqid>(), m10 = UbxReport(10).report<SecUniqid>();
    EXPECT_EQ(m9.version, 1);
    EXPECT_EQ(m9.unique_id.size(), 5u);
    EXPECT_EQ(m10.version, 2);
    EXPECT_EQ(m10.unique_id.size(), 6u);
}

TEST(SecSigMessage, TellsJammingAndSpoofing) {
    UbxReport m10(10);
    m10.config.set(in_ram, key::itfm_enable, 1);
    m10.state.monitors.upper.jamming_state = 2;
    m10.state.monitors.spoofing = SpoofingIndication::indicated;
    EXPECT_EQ(m10.report<SecSig1>().jam_flags, 0x05);
    EXPECT_EQ(m10.report<SecSig1>().spf_flags, 0x05);
    EXPECT_EQ(m10.report<SecSiglog>().events.size(), 2u);
    m10.board.identity.hardware = "000B0000";
    EXPECT_EQ(m10.report<SecSig2>().sig_sec_flags, 0x2D);
    const SecSig2 by_band = m10.report<SecSig2>();
    ASSERT_EQ(by_band.bands.size(), 3u);
    EXPECT_EQ(by_band.bands[0].centre, 1575420u);
    EXPECT_EQ(by_band.bands[0].jammed, 1);
    EXPECT_EQ(by_band.bands[1].jammed, 0);
    // Bits 0 to 23 the frequency, kHz, bit 24 jammed (RECEIVER.md 3.2).
    const Bytes payload = encode_payload(by_band);
    EXPECT_EQ(payload[4] | payload[5] << 8 | payload[6] << 16 | payload[7] << 24, 1575420 | 1 << 24);
    m10.state.monitors = {{1, 14, 4200, 69}, {}, AntennaStatus::ok, 1, SpoofingIndication::none};
    EXPECT_TRUE(m10.report<SecSiglog>().events.empty());
}

}  // namespace
}  // namespace skyloop::firmware
