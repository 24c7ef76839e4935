"""Galileo's pages of a run, checked with Python's hashes, the openssl program and the files beside the recording."""
import hashlib
import hmac
import pathlib
import re
import shutil
import struct
import subprocess
import unittest

from session import open_folder, skip, skyloop

SCENARIO = """[run]
start = 2024-03-05T12:10:00Z
duration_s = 400
[sky]
osnma = true
[trajectory]
kind = "fixed"
at = [48.1, 11.5, 600]
[[receiver]]
board = "ublox-f9p"
baud = 460800
[receiver.config]
CFG-UART1-BAUDRATE = 460800
CFG-MSGOUT-UBX_RXM_SFRBX_UART1 = 1
{more}"""
SUBFRAME = 30


def pages_of(log):
    """(satellite, bits of an even page, bits of an odd one) of E1-B, as they came."""
    at = 0
    while (at := log.find(b"\xb5\x62\x02\x13", at)) >= 0:
        length, = struct.unpack_from("<H", log, at + 4)
        payload = log[at + 6:at + 6 + length]
        at += 4
        if len(payload) == length and payload[0] == 2 and payload[2] == 1:
            words = struct.unpack("<8I", payload[8:40])
            yield payload[1], *("".join(f"{word:032b}" for word in words[i:i + 4]) for i in (0, 4))


def to_bytes(bits):
    bits += "0" * (-len(bits) % 8)
    return int(bits, 2).to_bytes(len(bits) // 8, "big")


def time_told(word):
    """Week and time of week that a word tells of its start."""
    kind = int(word[:6], 2)
    if kind == 5:
        return int(word[73:85], 2), int(word[85:105], 2)
    return (int(word[96:108], 2), int(word[108:128], 2)) if kind == 0 else None


def gst(seconds):
    return f"{seconds // 604800:012b}{seconds % 604800:020b}"


class Osnma(unittest.TestCase):
    def run_of(self, more="", sky=""):
        temporary = open_folder()
        self.addCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name)
        text = SCENARIO.format(more=more).replace("osnma = true\n", f"osnma = true\n{sky}")
        (folder / "s.toml").write_text(text, encoding="utf-8")
        skyloop("simulate", folder / "s.toml", "--out", folder / "run", "--quiet")
        return folder / "run"

    def heard(self, folder):
        """{(satellite, start of a subframe, s of GST): (words by type, 120 bits of HKROOT, 480 of MACK)}, of whole ones."""
        told, parts = {}, {}
        for satellite, even, odd in pages_of((folder / "port0.out").read_bytes()):
            word = even[2:114] + odd[2:18]
            if (at := time_told(word)) is not None:
                told[satellite] = at[0] * 604800 + at[1]
            elif satellite in told:
                told[satellite] += 2
            else:
                continue
            start = told[satellite]
            entry = parts.setdefault((satellite, start // SUBFRAME * SUBFRAME), ({}, {}, {}))
            place = start % SUBFRAME // 2
            entry[0][int(word[:6], 2)], entry[1][place], entry[2][place] = word, odd[18:26], odd[26:58]
        return {key: (words, "".join(root[i] for i in range(15)), "".join(mack[i] for i in range(15)))
                for key, (words, root, mack) in parts.items() if len(root) == 15}

    def root_of(self, subframes):
        """The bits of a whole DSM-KROOT, and its header."""
        blocks = {}
        for _, root, _ in subframes.values():
            self.assertLess(int(root[8:12], 2), 12)
            blocks[int(root[12:16], 2)] = root[16:]
        self.assertEqual(sorted(blocks), list(range(8)))
        return "".join(blocks[i] for i in range(8)), next(iter(subframes.values()))[1][:8]

    def test_root_chain_and_tags_hold(self):
        folder = self.run_of()
        subframes = self.heard(folder)
        self.assertGreater(len(subframes), 40)
        dsm, header = self.root_of(subframes)
        message, signature = to_bytes(header + dsm[8:232]), dsm[232:744]
        self.check_signature(folder, message, to_bytes(signature))
        self.assertEqual(hashlib.sha256(message + to_bytes(signature)).digest()[:11], to_bytes(dsm[744:]))

        first = int(dsm[36:48], 2) * 604800 + int(dsm[48:56], 2) * 3600
        keys = {start: to_bytes(mack[336:464]) for (_, start), (_, _, mack) in subframes.items()}
        for start, key in keys.items():
            while start > first - SUBFRAME:
                start -= SUBFRAME
                key = hashlib.sha256(key + to_bytes(gst(start)) + to_bytes(dsm[56:104])).digest()[:16]
            self.assertEqual(key, to_bytes(dsm[104:232]))
        self.assertGreater(self.own_tags(subframes, keys), 20)

    def own_tags(self, subframes, keys):
        """How many first tags there are, each of which must be right."""
        count = 0
        for (satellite, start), (_, _, mack) in subframes.items():
            before, key = subframes.get((satellite, start - SUBFRAME)), keys.get(start + SUBFRAME)
            if before is None or key is None:
                continue
            words = before[0]
            data = "".join(words[i][6:end] for i, end in ((1, 126), (2, 126), (3, 128), (4, 126), (5, 73)))
            message = f"{satellite:08b}{gst(start)}{1:08b}10{data}"
            self.assertEqual(to_bytes(mack[:40]), hmac.new(key, to_bytes(message), hashlib.sha256).digest()[:5])
            count += 1
        return count

    def check_signature(self, folder, message, signature):
        def integer(octets):
            octets = octets.lstrip(b"\0")
            octets = b"\0" + octets if octets[0] & 0x80 else octets
            return bytes([2, len(octets)]) + octets
        body = integer(signature[:32]) + integer(signature[32:])
        (folder / "message").write_bytes(message)
        (folder / "signature").write_bytes(bytes([0x30, len(body)]) + body)
        done = subprocess.run(["openssl", "dgst", "-sha256", "-verify", folder / "osnma_public_key_1.pem", "-signature",
                               folder / "signature", folder / "message"], capture_output=True, text=True, check=False)
        self.assertEqual(done.stdout, "Verified OK\n", done.stderr)

    def test_files_tell_the_tree(self):
        text = (self.run_of() / "osnma_keys.xml").read_text(encoding="ascii")
        nodes = {(int(j), int(i)): bytes.fromhex(x) for j, i, x in
                 re.findall(r"<j>(\d+)</j><i>(\d+)</i><lengthInBits>256</lengthInBits><x_ji>(\w+)</x_ji>", text)}
        self.assertEqual(len(nodes), 31)
        point = bytes.fromhex(re.search(r"<PKID>1</PKID><lengthInBits>264</lengthInBits><point>(\w+)<", text)[1])
        self.assertEqual(hashlib.sha256(b"\x11" + point).digest(), nodes[0, 0])
        for (level, place), node in nodes.items():
            if level > 0:
                both = nodes[level - 1, 2 * place] + nodes[level - 1, 2 * place + 1]
                self.assertEqual(hashlib.sha256(both).digest(), node)

    # SIS ICD 1.1, sections 3.2.2.2 and 6.2: a leaf that fills the message, by four nodes to the root.
    def test_an_alert_message_leads_to_the_root_of_the_tree(self):
        folder = self.run_of(sky="osnma_alert_s = 90\n")
        subframes, blocks = self.heard(folder), {}
        begin = min(start for _, start in subframes)
        for (_, start), (_, root, _) in subframes.items():
            if start < begin + 60:
                self.assertEqual(root[:8], "10010010")
            if start > begin + 120:
                self.assertEqual((root[:8], root[8:12]), ("11011110", "1111"), "do not use, chain 1, alert message")
                blocks[int(root[12:16], 2)] = root[16:]
        self.assertEqual(sorted(blocks), list(range(13)))
        dsm = "".join(blocks[i] for i in range(13))
        self.assertEqual(dsm[1032:1040], "01000000")
        node, place = hashlib.sha256(to_bytes(dsm[1032:])).digest(), int(dsm[4:8], 2)
        for level in range(4):
            other = to_bytes(dsm[8 + 256 * level:264 + 256 * level])
            node = hashlib.sha256(node + other if place % 2 == 0 else other + node).digest()
            place //= 2
        text = (folder / "osnma_keys.xml").read_text(encoding="ascii")
        root = re.search(r"<j>4</j><i>0</i><lengthInBits>256</lengthInBits><x_ji>(\w+)</x_ji>", text)[1]
        self.assertEqual(node.hex().upper(), root)

    def test_the_same_bytes_again_and_a_fault_that_changes_them(self):
        runs = [self.run_of(), self.run_of(), self.run_of('[[fault]]\nkind = "osnma_wrong_tags"\nat_s = 100\n')]
        bytes_of = [(run / "port0.out").read_bytes() for run in runs]
        self.assertEqual(bytes_of[0], bytes_of[1])
        self.assertNotEqual(bytes_of[0], bytes_of[2])


if __name__ == "__main__":
    if shutil.which("openssl") is None:
        skip("openssl is absent: apt-get install openssl")
    unittest.main()
