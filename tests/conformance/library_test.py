"""The clients' library by itself: frames, parser and sentences, against known vectors and recorded receivers."""
import itertools
import os
import threading
import time
import tty
import unittest

import nmea
import receiver
import ubx
import wire

# Specification 1.1.
VECTORS = {
    "B5 62 0A 04 00 00 0E 34": ubx.frame("MON-VER"),
    "B5 62 05 01 02 00 06 01 0F 38": ubx.frame("ACK-ACK", b"\x06\x01"),
    "B5 62 05 00 02 00 06 8A 97 BC": ubx.frame("ACK-NAK", b"\x06\x8a"),
    "B5 62 06 00 01 00 01 08 22": ubx.frame("CFG-PRT", b"\x01"),
    "B5 62 06 00 14 00 01 00 00 00 D0 08 00 00 00 C2 01 00 01 00 01 00 00 00 00 00 B8 42":
        ubx.cfg_prt((1, 0x8D0, 115200, 1, 1)),
    "B5 62 06 01 03 00 01 07 01 13 51": ubx.cfg_msg("NAV-PVT", 1),
    "B5 62 06 08 06 00 C8 00 01 00 00 00 DD 68": ubx.cfg_rate(200, 1, 0),
    "B5 62 06 8A 0C 00 00 01 00 00 01 00 52 40 00 C2 01 00 F3 A5": ubx.valset([(0x40520001, 115200)]),
    "B5 62 06 8B 08 00 00 00 00 00 01 00 73 10 1D 8B": ubx.valget([0x10730001]),
    "B5 62 06 04 04 00 FF FF 02 00 0E 61": ubx.frame("CFG-RST", b"\xff\xff\x02\x00"),
}
VALGET_ANSWER = bytes.fromhex("B562068B0900010000000100731001 20BD")


class Frames(unittest.TestCase):
    def test_known_frames(self):
        for text, built in VECTORS.items():
            self.assertEqual(built.hex(" ").upper(), text)

    def test_first_batch_of_px4_has_39_bytes(self):
        import px4
        self.assertEqual(len(ubx.valset(px4.UART1_FIRST)), 8 + 39)
        self.assertEqual(len(px4.Px4.ports(38400)), 8 + 40)

    def test_navigation_settings_have_36_bytes(self):
        import betaflight
        import inav
        for rest in (bytes(32), inav.NAV5_REST, betaflight.NAV5_REST):
            self.assertEqual(len(ubx.cfg_nav5(0xFFFF, 7, 3, rest)), 8 + 36)

    def test_pairs_of_an_answer(self):
        answer = ubx.Parser().feed(VALGET_ANSWER)[0]
        self.assertEqual(ubx.valget_pairs(answer.payload), [(0x10730001, 1)])
        for broken in (b"", b"\0\0\0\0", answer.payload[:-1], answer.payload[:-2], b"\1\0\0\0\1\0\x73\0\1"):
            with self.assertRaises(ValueError):
                ubx.valget_pairs(broken)

    def test_negative_and_wide_values(self):
        frame = ubx.valset([(0x201100A4, -5), (0x50360006, 0x72B88), (0x30210001, 200)])
        self.assertEqual(frame[10:-2].hex(), "a4001120fb" "06003650882b070000000000" "01002130c800")


class Stream(unittest.TestCase):
    def test_every_split_of_a_stream_gives_the_same(self):
        stream = (b"\xff\x55\x00" + ubx.frame("MON-VER", b"x" * 40) + nmea.sentence("PUBX,00") + b"\xb5" +
                  ubx.frame("ACK-ACK", b"\x06\x8a") + b"$GPGG\x80" + VALGET_ANSWER)
        whole = [str(i) for i in ubx.Parser().feed(stream)]
        self.assertEqual(whole, ["MON-VER[40]", "$PUBX,00*33", "ACK-ACK(CFG-VALSET)", "CFG-VALGET[9]"])
        for size in (1, 2, 3, 7):
            parser = ubx.Parser()
            found = [str(i) for n in range(0, len(stream), size) for i in parser.feed(stream[n:n + size])]
            self.assertEqual(found, whole)

    def test_a_wrong_length_swallows_no_frame_behind_it(self):
        good = ubx.frame("ACK-ACK", b"\x06\x01")
        wrong = bytearray(ubx.frame("NAV-DOP", bytes(18)))
        wrong[4] = 24
        self.assertEqual([str(i) for i in ubx.Parser().feed(bytes(wrong) + good)], ["ACK-ACK(CFG-MSG)"])

    def test_noise_of_the_wire_hides_nothing(self):
        for noise in itertools.product(wire.NOISE, repeat=3):
            found = ubx.Parser().feed(b"".join(noise) + ubx.frame("MON-VER"))
            self.assertEqual([str(item) for item in found], ["MON-VER[0]"], noise)

    def test_lower_case_sums_are_no_sentences(self):
        self.assertEqual(nmea.fields("$GNTXT,01,01,00,txbuf alloc*61")[-1], "txbuf alloc")
        self.assertIsNotNone(nmea.fields("$GNGGA,,,,,,0,00,99.99,,,,,,*56"))
        self.assertIsNone(nmea.fields("$PGRMC,x*7f"))
        self.assertIsNone(nmea.fields("$PUBX,00*34"))
        self.assertEqual(nmea.sentence("PUBX,41,1,0023,0001,230400,0"), b"$PUBX,41,1,0023,0001,230400,0*1E\r\n")
        self.assertAlmostEqual(nmea.degrees("12237.61382", "W"), -122.626897, places=6)


class Recorded(unittest.TestCase):
    def stream(self, name):
        path = receiver.SHARED / "serial" / name
        if not path.exists():
            self.skipTest(f"shared data absent: {path}")
        lines = path.read_bytes()
        while lines.startswith(b"#"):
            lines = lines.partition(b"\n")[2]
        parser = ubx.Parser()
        return parser.feed(lines), parser

    def test_f9p_with_corrections(self):
        items, parser = self.stream("ublox-zed-f9p-rtk.log")
        pvts = [ubx.nav_pvt(i.payload) for i in items if isinstance(i, ubx.Frame) and i.is_a("NAV-PVT")]
        self.assertGreater(len(pvts), 3)
        self.assertTrue(all(pvt["fix_type"] == 3 and pvt["month"] <= 12 for pvt in pvts))
        self.assertLess(len(parser.noise), 0.1 * sum(i.size for i in items))

    def test_m9_sentences(self):
        items, parser = self.stream("ublox-neo-m9n-nmea.log")
        self.assertGreater(sum(isinstance(i, ubx.Sentence) for i in items), 50)
        self.assertLess(len(parser.noise), 200)

    def test_rtcm3(self):
        items, _ = self.stream("ublox-f9p-rtcm.log")
        kinds = {i.kind for i in items if isinstance(i, ubx.Correction)}
        self.assertTrue({1005, 1077} & kinds, kinds)

    def test_version_of_an_m8(self):
        items, _ = self.stream("ublox8-uniqid-monhw.log")
        version = next(ubx.mon_ver(i.payload) for i in items if isinstance(i, ubx.Frame) and i.is_a("MON-VER"))
        self.assertEqual(version.hardware, "00080000")
        self.assertGreaterEqual(version.protocol, (15, 0))


class WireTest(unittest.TestCase):
    def setUp(self):
        self.master, self.slave = os.openpty()
        tty.setraw(self.slave)

    def tearDown(self):
        os.close(self.master)
        os.close(self.slave)

    def test_any_speed(self):
        line = wire.Wire(os.ttyname(self.slave), 38400)
        for speed in (4800, 9600, 230400, 460800, 123457):
            line.set_speed(speed)
            self.assertEqual(line.read_speed(), speed)
        line.close()

    def test_manners_of_writing_carry_the_same_frame(self):
        for manner in wire.WRITES:
            line = wire.Wire(os.ttyname(self.slave), 9600, manner)
            began = time.monotonic()
            writer = threading.Thread(target=line.write, args=(ubx.frame("MON-VER", bytes(20)),))
            writer.start()
            parser, found = ubx.Parser(), []
            while not found and time.monotonic() < began + 5:
                found = parser.feed(os.read(self.master, 100))
            writer.join()
            self.assertEqual(str(found[0]), "MON-VER[20]", manner)
            self.assertGreaterEqual(line.written_until - began, 28 * 10 / 9600)
            line.close()


if __name__ == "__main__":
    unittest.main(verbosity=2)
